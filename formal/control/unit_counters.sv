// unit_counters: in each clock a counter grows by exactly its event, from 0 at reset.
//
// Assumption: reset in the first clock.

reg started = 0;
reg [BITS-1:0] cycles, tested, vertices, planes, pairs, hits, stalls, skipped;

wire sphere = request_i && !vertex_i;
always @(posedge clk_i) begin
  started  <= 1;
  cycles   <= rst_i ? 0 : cycles + busy_i;
  tested   <= rst_i ? 0 : tested + sphere;
  vertices <= rst_i ? 0 : vertices + (request_i && vertex_i);
  planes   <= rst_i ? 0 : planes + (request_i ? rows_i + columns_i : 0);
  pairs    <= rst_i ? 0 : pairs + issue_i;
  hits     <= rst_i ? 0 : hits + first_hit_i;
  stalls   <= rst_i ? 0 : stalls + stall_i;
  skipped  <= rst_i ? 0 : skipped + (walk_i ? spheres_i : 0) - sphere;
end

always @* begin
  assume (started || rst_i);
  if (started) begin
    counts_cycles: assert (counters_o[COUNTER_CYCLES*BITS +: BITS] == cycles);
    counts_tested: assert (counters_o[COUNTER_SPHERES_TESTED*BITS +: BITS] == tested);
    counts_skipped: assert (counters_o[COUNTER_SPHERES_SKIPPED*BITS +: BITS] == skipped);
    counts_vertices: assert (counters_o[COUNTER_VERTICES_TESTED*BITS +: BITS] == vertices);
    counts_planes: assert (counters_o[COUNTER_PLANE_TESTS*BITS +: BITS] == planes);
    counts_pairs: assert (counters_o[COUNTER_PAIRS_TESTED*BITS +: BITS] == pairs);
    counts_hits: assert (counters_o[COUNTER_HITS*BITS +: BITS] == hits);
    counts_stalls: assert (counters_o[COUNTER_STALL_CYCLES*BITS +: BITS] == stalls);
  end
  all_at_once: cover (started && planes == 32 && hits == 1 && stalls == 1 && skipped == 7);
end
