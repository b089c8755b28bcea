// event_counters: in each clock a counter grows by exactly its event, from 0 in the first clock of a
// pencil; spheres tested and skipped always add up to those in the scene.
//
// Assumption: clear_i in the first clock.

reg started = 0;
reg [COUNTER_BITS-1:0] cycles, tested, planes, pairs, hits, stalls, spheres;

wire sphere = sphere_i && first_set_i;
always @(posedge clk_i) begin
  started <= 1;
  cycles  <= (clear_i ? 0 : cycles) + busy_i;
  tested  <= (clear_i ? 0 : tested) + sphere;
  planes  <= (clear_i ? 0 : planes) + (sphere ? rows_i + columns_i : 0);
  pairs   <= (clear_i ? 0 : pairs) + issue_i;
  hits    <= (clear_i ? 0 : hits) + first_hit_i;
  stalls  <= (clear_i ? 0 : stalls) + stall_i;
  if (clear_i) spheres <= spheres_i;
end

wire [COUNTER_BITS-1:0] skipped = counters_o[COUNTER_SPHERES_SKIPPED*COUNTER_BITS +: COUNTER_BITS];
always @* begin
  assume (started || clear_i);
  if (started) begin
    counts_cycles: assert (counters_o[COUNTER_CYCLES*COUNTER_BITS +: COUNTER_BITS] == cycles);
    counts_tested: assert (counters_o[COUNTER_SPHERES_TESTED*COUNTER_BITS +: COUNTER_BITS] == tested);
    counts_planes: assert (counters_o[COUNTER_PLANE_TESTS*COUNTER_BITS +: COUNTER_BITS] == planes);
    counts_pairs: assert (counters_o[COUNTER_PAIRS_TESTED*COUNTER_BITS +: COUNTER_BITS] == pairs);
    counts_hits: assert (counters_o[COUNTER_HITS*COUNTER_BITS +: COUNTER_BITS] == hits);
    counts_stalls: assert (counters_o[COUNTER_STALL_CYCLES*COUNTER_BITS +: COUNTER_BITS] == stalls);
    adds_up: assert (skipped + tested == spheres);
  end
  all_at_once: cover (started && planes == 32 && hits == 1 && stalls == 1 && skipped == 7);
end
