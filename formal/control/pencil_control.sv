// pencil_control: every bank that is started while it isn't busy has exactly one turn, in the order of the
// starts: its planes, each index once: as many lines as the longer side has, then the two planes behind them of
// each side; then, when nothing is being cleared, its walk;
// when that is over, its token, until it is taken. A bank is busy from its start until its token is done.
// Two pencils never have a turn at the same time, and the queue of banks never overflows.
//
// Assumptions: reset in the first clock; rows_i and columns_i are 1 .. 16 and stand while lines are loaded; a
// token is done only after it was taken. The queue of banks is what control.fifo.depth4 proves of it: words come
// out in order, and none is lost unless it is written into a full queue.

reg started = 0;

// the queue, as it is seen from outside
reg [2:0]           waits = 0;
reg [BANK_BITS-1:0] q0, q1, q2, q3;   // the front first
wire full = waits == 4;
wire [2:0] place = waits - take;      // of the next word, if one is read
always @(posedge clk_i) begin
  waits <= rst_i ? 0 : waits + (start && !full) - take;
  if (take) begin
    q0 <= q1;
    q1 <= q2;
    q2 <= q3;
  end
  if (start && !full) begin
    if (place == 0) q0 <= bank_i;
    if (place == 1) q1 <= bank_i;
    if (place == 2) q2 <= bank_i;
    if (place == 3) q3 <= bank_i;
  end
end
always @* begin
  assume (waiting == (waits != 0));
  if (waits != 0) assume (next_bank == q0);
end

// what each bank is at
reg [3:0] queued = 0, turn = 0, ended = 0;
reg [3:0] start_of, take_of, end_of, done_of;
wire gone = token_o && token_ready_i;
always @* begin
  start_of = 0;
  take_of  = 0;
  end_of   = 0;
  done_of  = 0;
  start_of[bank_i]     = start_i && !(queued[bank_i] || turn[bank_i] || ended[bank_i]);
  take_of[q0]          = take;
  end_of[bank_o]       = gone;
  done_of[done_bank_i] = done_i;
end
always @(posedge clk_i) begin
  started <= 1;
  queued  <= rst_i ? 0 : (queued & ~take_of) | start_of;
  turn    <= rst_i ? 0 : (turn & ~end_of) | take_of;
  ended   <= rst_i ? 0 : (ended & ~done_of) | end_of;
end

// the turn: planes given, then the walk, then the token
reg [5:0] given = 0;
reg       loaded = 0, walked = 0, over = 0;
reg [4:0] rows, columns;
wire [4:0] lines = rows > columns ? rows : columns;
wire [5:0] wanted = given < lines ? given : AXIS_PLANE + given - lines;
wire all_given = given == lines + 1;
always @(posedge clk_i) begin
  if (take || rst_i) begin
    given  <= 0;
    loaded <= 0;
    walked <= 0;
    over   <= 0;
  end else begin
    if (load_o) begin
      given  <= given + 1;
      loaded <= all_given;
    end
    if (walk_o) walked <= 1;
    if (walked && walk_idle_i) over <= 1;
  end
  if (load_o) begin
    rows    <= rows_i;
    columns <= columns_i;
  end
end

always @* begin
  assume (started || rst_i);
  assume (rows_i >= 1 && rows_i <= MAX_ROWS && columns_i >= 1 && columns_i <= MAX_COLUMNS);
  if (load_o && given != 0) assume (rows_i == rows && columns_i == columns);
  if (load_o && given == 0) assume (rows == rows_i && columns == columns_i);  // seen from the first line on
  if (done_i) assume (ended[done_bank_i]);
  if (started) begin
    room: assert (!(start && full));
    accepts: assert (start == (start_of != 0));
    takes: assert (!take || (turn == 0 && waits != 0));
    one: assert ((turn & (turn - 1)) == 0);
    busy_bits: assert (busy_o == (queued | turn | ended));
    loads: assert (load_o == (turn != 0 && !loaded));
    in_order: assert (!load_o || line_o == wanted);
    clears: assert (clear_o == (load_o && given == 0));
    walks: assert (walk_o == (turn != 0 && loaded && !walked && !clearing_i));
    tokens: assert (token_o == (turn != 0 && over));
    its_bank: assert (turn == 0 || turn[bank_o]);

    // each bank is at one place
    apart: assert ((queued & turn) == 0 && (queued & ended) == 0 && (turn & ended) == 0);
    number: assert (waits == queued[0] + queued[1] + queued[2] + queued[3]);
    in_queue: assert (queued == ((waits > 0 ? 1 << q0 : 0) | (waits > 1 ? 1 << q1 : 0)
                                 | (waits > 2 ? 1 << q2 : 0) | (waits > 3 ? 1 << q3 : 0)));
    order: assert (!over || walked);
    order_2: assert (!walked || loaded);
    count: assert (turn == 0 || loaded || given <= lines + 1 || given == 0);
    state: assert (turn == 0 ? {r_loading, r_settling, r_walking, r_token} == 0
                             : {r_loading, r_settling, r_walking, r_token}
                               == {!loaded, loaded && !walked, walked && !over, over});
  end
  second: cover (started && token_o && walked && waits == 2 && ended != 0);
end

// reg_t, from its first field
wire r_loading, r_clear, r_settling, r_walking, r_token;
wire [PLANE_INDEX_BITS-1:0] r_line;
wire [BANK_BITS-1:0] r_bank;
wire [PENCIL_BANKS-1:0] r_busy;
assign {r_busy, r_bank, r_line, r_token, r_walking, r_settling, r_clear, r_loading} = r;
generate
  if ($bits(r) != 5 + PLANE_INDEX_BITS + BANK_BITS + PENCIL_BANKS || PENCIL_BANKS != 4) layout_of_reg_t_is_another refused();
endgenerate
