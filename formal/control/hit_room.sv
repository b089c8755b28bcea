// hit_queue: it never overflows. Pairs and ends of pencils that may come to it were sent MEMORY_STAGES +
// SOLVER_STAGES (pair_half) clocks before, and none is sent while stall_o = 1.
//
// Assumptions: reset in the first clock, and nothing on the way in it; a hit or an end of a pencil comes only from
// what was sent.

localparam WAY = MEMORY_STAGES + 2 * MUL_STAGES + 5 * ADD_STAGES;   // memories, ray_solver
localparam DEPTH = 1 << HIT_FIFO_DEPTH_LOG2;

reg started = 0;
(* anyseq *) reg sends;
wire sent = sends && !stall_o && !rst_i;
reg [WAY:1] on_the_way = 0;   // bit k: sent k clocks ago
always @(posedge clk_i) begin
  started    <= 1;
  on_the_way <= rst_i ? 0 : {on_the_way[WAY-1:1], sent};
end

reg [6:0] number;
integer k;
always @* begin
  number = 0;
  for (k = 1; k <= WAY; k = k + 1) number = number + on_the_way[k];
  assume (started || rst_i);
  if (valid_i || last_i) assume (on_the_way[WAY]);
  if (started) begin
    room: assert (!(valid_i || last_i) || count < DEPTH);
    all_fit: assert (count + number <= DEPTH / 2 - 1 + WAY + 1 && count + number < DEPTH);
    stalls: assert (stall_o == (count >= DEPTH / 2));
  end
end
