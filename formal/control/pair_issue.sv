// pair_issue: the waiting pair goes exactly when no pair of its ray went in the HAZARD_CLOCKS - 1 clocks
// before. So never too soon, never held back without cause, and within HAZARD_CLOCKS clocks.
//
// One ray is chosen, any one. What holds for it holds for all.
//
// Assumptions: reset in the first clock. None about valid_i and ray_i: a pair may even change while it
// waits.

localparam HAZARD_CLOCKS = MEMORY_STAGES + MUL_STAGES + 1;

reg started = 0;
(* anyconst *) reg [2*LINE_BITS-1:0] ray;
wire waits = valid_i && ray_i == ray;

reg [3:0] age = HAZARD_CLOCKS;  // clocks since a pair of the ray went, at most HAZARD_CLOCKS
reg [3:0] patience = 0;         // clocks for which pairs of the ray wait without a break
always @(posedge clk_i) begin
  started <= 1;
  age <= rst_i ? HAZARD_CLOCKS : waits && issue_o ? 1 : age == HAZARD_CLOCKS ? age : age + 1;
  patience <= waits && !issue_o && !rst_i ? patience + 1 : 0;
end

integer k;
always @* begin
  assume (started || rst_i);
  if (started) begin
    only_pairs: assert (!issue_o || valid_i);
    not_too_soon: assert (!(waits && issue_o) || age == HAZARD_CLOCKS);
    not_held_back: assert (!waits || issue_o || age < HAZARD_CLOCKS);
    in_time: assert (patience < HAZARD_CLOCKS && !(patience == HAZARD_CLOCKS - 1 && waits && !issue_o));
    stalls: assert (stall_o == (valid_i && !issue_o));

    // the registers: a bit for each clock in which a pair of the ray went
    ages: assert (age >= 1 && age <= HAZARD_CLOCKS);
    window: assert (recent == (age == HAZARD_CLOCKS ? 0 : 1 << (age - 1)));
    waited: assert (patience < age);
  end
  twice: cover (started && waits && issue_o && patience == HAZARD_CLOCKS - 1);
end

// history_t: element 1, the pair of the last clock, is the highest; an element is ray & valid
reg [HAZARD_CLOCKS-2:0] recent;
localparam ENTRY = 2 * LINE_BITS + 1;
always @*
  for (k = 0; k < HAZARD_CLOCKS - 1; k = k + 1)
    recent[k] = history[(HAZARD_CLOCKS-2-k)*ENTRY]
                && history[(HAZARD_CLOCKS-2-k)*ENTRY+1 +: 2*LINE_BITS] == ray;
