// fifo and block_fifo: the k-th word read is the k-th word written; none is lost, repeated or reordered, in any
// pattern of writes, reads and resets, writes into a full queue and reads while nothing is valid included.
//
// One accepted write, any one, is tagged (tag is free in each clock). From then on the accepted reads
// that must come before it are counted down; when none is left, the tagged word must stand in front.
// Words are never looked at by the queue, so what holds for a free word holds for all.
//
// Assumptions: reset in the first clock.

reg started = 0;
(* anyseq *) reg tag;
localparam DEPTH = 1 << DEPTH_LOG2;

// what the ports say
wire accepted = write_i && ready_o;
wire taken    = read_i && valid_o;
reg [DEPTH_LOG2:0] inside = 0;  // words written and not read
reg                tagged = 0;  // the tagged word is inside
reg [WIDTH-1:0]    word;
reg [DEPTH_LOG2:0] ahead;       // words in front of it

always @(posedge clk_i) begin
  started <= 1;
  inside  <= inside + accepted - taken;
  if (tagged) begin
    ahead <= ahead - taken;
    if (taken && ahead == 0) tagged <= 0;
  end else if (accepted && tag) begin
    tagged <= 1;
    word   <= data_i;
    ahead  <= inside - taken;
  end
  if (rst_i) begin
    inside <= 0;
    tagged <= 0;
  end
end

// a word that is not taken stays in front
reg             waiting = 0;
reg [WIDTH-1:0] front;
always @(posedge clk_i) begin
  waiting <= valid_o && !read_i && !rst_i;
  front   <= data_o;
end

always @* begin
  assume (started || rst_i);
  if (started) begin
    counted: assert (count_o == inside && inside <= DEPTH);
    not_full: assert (ready_o == (inside != DEPTH));
    in_order: assert (!tagged || ahead < inside && (ahead != 0 || !valid_o || data_o == word));
    stable: assert (!waiting || valid_o && data_o == front);

    // the registers
    pointers: assert (tail == head + count[DEPTH_LOG2-1:0]);
    stored: assert (!tagged || memory[head + ahead[DEPTH_LOG2-1:0]] == word);
  end
  full_again: cover (inside == DEPTH && tagged && ahead == 0 && head != 0 && started);
end
