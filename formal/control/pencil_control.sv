// pencil_control: every bank that is started while it isn't busy is cleared in the next clock, and has exactly one
// turn, in the order of the starts: its planes, each index once: as many lines as the longer side has, then the two
// planes behind them of each side; its walk, with the last planes if no other pencil has a turn, or else when that
// one's token is gone; when that is over, its token, until it is taken. Its planes come when the planes before belong
// to a walk and no further object of that walk needs them: none is loaded while a walk isn't spent. The bank of a walk
// stands until its token is taken. A bank is busy from its start until its token is done.
// Two pencils never have a turn at the same time, and the queue of banks never overflows.
//
// Assumptions: reset in the first clock; rows_i and columns_i are 1 .. 16; a token is done only after it was taken.
// Nothing is assumed of walk_spent_i and walk_idle_i. The queue of banks is what control.fifo.depth4 proves of it:
// words come out in order, and none is lost unless it is written into a full queue.

reg started = 0;

// what each bank is at
reg [3:0] cleared = 0, queued = 0, planes = 0, turn = 0, ended = 0;
reg [3:0] start_of, take_of, walk_of, end_of, done_of;
reg [BANK_BITS-1:0] clear_bank, load_bank, turn_bank;
wire [3:0] all = cleared | queued | planes | turn | ended;
wire gone = token_o && token_ready_i;
always @* begin
  start_of = 0;
  take_of  = 0;
  walk_of  = 0;
  end_of   = 0;
  done_of  = 0;
  start_of[bank_i]     = start_i && !all[bank_i];
  take_of[q0_bank]     = take;
  walk_of[load_bank]   = walk_o;
  end_of[turn_bank]    = gone;
  done_of[done_bank_i] = done_i;
end
always @(posedge clk_i) begin
  started <= 1;
  cleared <= rst_i ? 0 : start_of;
  queued  <= rst_i ? 0 : (queued & ~take_of) | cleared;
  planes  <= rst_i ? 0 : (planes & ~walk_of) | take_of;
  turn    <= rst_i ? 0 : (turn & ~end_of) | walk_of;
  ended   <= rst_i ? 0 : (ended & ~done_of) | end_of;
  clear_bank <= bank_i;
  if (take) load_bank <= q0_bank;
  if (walk_o) turn_bank <= load_bank;
end

// the queue, as it is seen from outside: banks and the lines of their longer sides
localparam WAITING_BITS = BANK_BITS + LINE_BITS + 1;
reg [2:0]              waits = 0;
reg [WAITING_BITS-1:0] q0, q1, q2, q3;   // the front first
wire [BANK_BITS-1:0] q0_bank = q0[WAITING_BITS-1:LINE_BITS+1];
wire [LINE_BITS:0]   q0_lines = q0[LINE_BITS:0];
wire [WAITING_BITS-1:0] word = {clear_bank, rows_i > columns_i ? rows_i : columns_i};
wire write = cleared != 0;
wire full = waits == 4;
wire [2:0] place = waits - take;         // of the next word, if one is read
always @(posedge clk_i) begin
  waits <= rst_i ? 0 : waits + (write && !full) - take;
  if (take) begin
    q0 <= q1;
    q1 <= q2;
    q2 <= q3;
  end
  if (write && !full) begin
    if (place == 0) q0 <= word;
    if (place == 1) q1 <= word;
    if (place == 2) q2 <= word;
    if (place == 3) q3 <= word;
  end
end
always @* begin
  assume (waiting == (waits != 0));
  if (waits != 0) assume (waiting_out == q0);
end

function [3:0] bit_of(input [WAITING_BITS-1:0] waiting_word);
  bit_of = 1 << waiting_word[WAITING_BITS-1:LINE_BITS+1];
endfunction

function fits(input [LINE_BITS:0] longer);
  fits = longer >= 1 && longer <= MAX_ROWS;
endfunction

// the planes given of the pencil in front of the walk; whether the walk is over
reg [4:0]         given = 0;
reg               over = 0, early = 0;
reg [LINE_BITS:0] lines;
wire [4:0] wanted = given < lines ? given : AXIS_PLANE + given - lines;
wire loaded = given == lines + 2;
wire loaded_now = load_o && given == lines + 1;
wire walking = turn != 0 && !over;
always @(posedge clk_i) begin
  if (take) begin
    given <= 0;
    lines <= q0_lines;
    early <= walking;
  end else if (load_o) given <= given + 1;
  over <= !rst_i && !walk_o && (over || walking && walk_idle_i);
end

always @* begin
  assume (started || rst_i);
  assume (rows_i >= 1 && rows_i <= MAX_ROWS && columns_i >= 1 && columns_i <= MAX_COLUMNS);
  if (done_i) assume (ended[done_bank_i]);
  if (started) begin
    clears: assert (clear_o == write && (!clear_o || clear_bank_o == clear_bank));
    room: assert (!(write && full));
    writes: assert (r_clear == write && (!write || waiting_in == word));
    takes: assert (take == (waits != 0 && planes == 0 && (!walking || walk_spent_i)));
    one: assert ((turn & (turn - 1)) == 0 && (planes & (planes - 1)) == 0);
    busy_bits: assert (busy_o == all);
    loads: assert (load_o == (planes != 0 && !loaded));
    in_order: assert (!load_o || line_o == wanted);
    its_planes: assert (!load_o || load_bank_o == load_bank);
    walks: assert (walk_o == (planes != 0 && (loaded || loaded_now) && turn == 0));
    tokens: assert (token_o == (turn != 0 && over));
    its_bank: assert (!walk_o || bank_o == load_bank);
    bank_stays: assert (turn == 0 || bank_o == turn_bank);

    // each bank is at one place
    apart: assert ((cleared & queued) == 0 && (planes & turn) == 0 && ((cleared | queued) & (planes | turn)) == 0
                   && (ended & (cleared | queued | planes | turn)) == 0);
    at_clear: assert (cleared == 0 || cleared == 1 << clear_bank);
    at_planes: assert (planes == 0 || planes == 1 << load_bank);
    at_turn: assert (turn == 0 || turn == 1 << turn_bank);
    number: assert (waits == queued[0] + queued[1] + queued[2] + queued[3]);
    in_queue: assert (queued == ((waits > 0 ? bit_of(q0) : 0) | (waits > 1 ? bit_of(q1) : 0)
                                 | (waits > 2 ? bit_of(q2) : 0) | (waits > 3 ? bit_of(q3) : 0)));
    sizes: assert ((waits < 1 || fits(q0[LINE_BITS:0])) && (waits < 2 || fits(q1[LINE_BITS:0]))
                   && (waits < 3 || fits(q2[LINE_BITS:0])) && (waits < 4 || fits(q3[LINE_BITS:0])));
    count: assert (planes == 0 || fits(lines) && given <= lines + 2);
    state: assert ({r_loading, r_loaded} == (planes == 0 ? 0 : {!loaded, loaded}));
    state_2: assert ({r_walking, r_token} == (turn == 0 ? 0 : {!over, over}));
    registers: assert (planes == 0 || r_load_bank == load_bank && r_lines == lines
                                      && (turn != 0 || r_bank == load_bank));
    clear_register: assert (r_clear_bank == clear_bank);
  end
  second: cover (started && token_o && planes != 0 && loaded && early && waits == 1 && ended != 0);
end

// reg_t, from its first field
wire r_clear, r_loading, r_loaded, r_walking, r_token;
wire [BANK_BITS-1:0] r_clear_bank, r_load_bank, r_bank;
wire [LINE_BITS:0] r_lines;
wire [PLANE_INDEX_BITS-1:0] r_line;
wire [PENCIL_BANKS-1:0] r_busy;
assign {r_busy, r_bank, r_token, r_walking, r_line, r_lines, r_load_bank, r_loaded, r_loading, r_clear_bank,
        r_clear} = r;
generate
  if ($bits(r) != 5 + 3 * BANK_BITS + LINE_BITS + 1 + PLANE_INDEX_BITS + PENCIL_BANKS || PENCIL_BANKS != 4)
    layout_of_reg_t_is_another refused();
endgenerate
