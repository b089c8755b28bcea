// tree_walk, behind tree_walk.sv: the stack never overflows, for every tree that docs/tree_walk.md admits and
// every behaviour of testers, triangle queue and row bounds. That page's proof, as invariants.
//
// A range carries a budget: the largest sum of (spheres - 1) over the ranges of spheres on a path that begins
// with it. The root's is at most BUDGET; if i >= 1 spheres of a range are met, then the budgets of the ranges
// below them are at most its own - (i - 1). Both are free otherwise. A range's column mask is its budget here:
// the unit hands that mask through and decides nothing by it, and its value is free.
//
// Assumptions, beside those of tree_walk.sv: the budgets; the testers keep order, so an object that is decided
// belongs to the range that was taken last only when no older one is under test; and last_sibling_i comes at
// least with the last object of the older ranges, and with the last one of a range that is done.
//
// A sibling that is sorted in lifts those above it: they have to have room for all siblings that may come.
//
// The invariant on the LUT RAM holds for one entry, any one. When an entry is read it is needed for the top of
// the RAM, which may be another: then it is assumed for the clock before. That is no circle: look at the first
// clock in which any entry breaks it, and choose that entry.

localparam BUDGET = STACK_DEPTH - STACK_WATERMARK - OBJECTS;
localparam N = STACK_DEPTH_LOG2 + 2;

(* anyseq *)   reg [N-1:0] inner;      // met spheres of the range that is taken
(* anyconst *) reg [STACK_DEPTH_LOG2-1:0] entry;

reg [N-1:0] older = 0;                 // objects under test of ranges before the current one
reg [N-1:0] inner_left = 0;            // met spheres of the current range that may still be pushed
reg [N-1:0] children = 0;              // budget of the ranges below them
reg         refill_was_good = 1;

function [MAX_COLUMNS-1:0] budget(input [RANGE_BITS-1:0] range);
  budget = range[DEPTH_BITS +: MAX_COLUMNS];
endfunction

wire [MAX_COLUMNS-1:0] arriving = budget(push_range_i);
wire                   taken = start_i || pop && live != 0;
wire [MAX_COLUMNS-1:0] taken_budget = start_i ? columns_i : budget(top_0);
wire [STACK_DEPTH_LOG2-1:0] refill_entry = r_level[STACK_DEPTH_LOG2-1:0] - 1;
wire [N-1:0] still = older != 0 ? older : inner_left;  // siblings that may still come

always @(posedge clk_i) begin
  if (decided_i && older != 0) older <= older - 1;
  if (push_i && older == 0) inner_left <= inner_left - 1;
  if (taken) begin
    older      <= testing + request_o - decided_i;
    inner_left <= inner;
    children   <= inner == 0 ? taken_budget : taken_budget - (inner - 1);
  end
  refill_was_good <= rst_i || r_level <= SORTED_RANGES
                     || fits(refill_entry - SORTED_RANGES, budget(stack[refill_entry]), 0);
  if (rst_i) begin
    older      <= 0;
    inner_left <= 0;
    children   <= 0;
  end
end

// an entry that may be lifted `lifts` times and has that many below it
function fits(input [N-1:0] place, input [MAX_COLUMNS-1:0] its_budget, input [N-1:0] lifts);
  fits = its_budget <= BUDGET && place + 1 + lifts + its_budget <= STACK_DEPTH;
endfunction

always @* begin
  // the tree
  if (start_i) assume (columns_i <= BUDGET);
  if (push_i) assume (older != 0 ? arriving <= BUDGET : inner_left != 0 && arriving <= children);
  if (taken) assume (inner <= taken_budget + 1);
  // the testers
  if (decided_i && (older == 1 || older == 0 && testing == 1 && !r_active)) assume (last_sibling_i);
  assume (refill_was_good);
  if (started) begin
    no_overflow: assert (stack_level_o <= STACK_DEPTH && (!push_i || pop || stack_level_o < STACK_DEPTH));
    top_fit: assert ((r_level < 1 || fits(r_level - 1, budget(top_0), r_siblings > 0 ? still : 0))
                     && (r_level < 2 || fits(r_level - 2, budget(top_1), r_siblings > 1 ? still : 0))
                     && (r_level < 3 || fits(r_level - 3, budget(top_2), r_siblings > 2 ? still : 0))
                     && (r_level < 4 || fits(r_level - 4, budget(top_3), 0)));
    entry_fit: assert (entry < SORTED_RANGES || entry >= r_level
                       || fits(entry - SORTED_RANGES, budget(stack[entry]), 0));

    // above the watermark: what may still come fits
    relaxed_or_alone: assert (!taken || r_level < STACK_WATERMARK || testing == 0);
    older_fit: assert (r_level < STACK_WATERMARK || older == 0
                       || r_level + older <= STACK_WATERMARK - 1 + OBJECTS);
    children_fit: assert (r_level < STACK_WATERMARK || inner_left == 0
                          || r_level + older + inner_left + children <= STACK_DEPTH);
    budgets: assert (children <= BUDGET && (inner_left == 0 || inner_left + children <= BUDGET + 1));
    in_order: assert (older <= testing);
    siblings_stacked: assert (r_siblings <= stack_level_o);
    no_siblings_alone: assert (r_active || testing != 0 || r_siblings == 0);
  end
  high: cover (started && stack_level_o > STACK_WATERMARK + OBJECTS);
end
