// traversal, behind traversal.sv: the stack never overflows, for every tree that docs/traversal.md admits
// and every behaviour of testers and leaf queue. That page's proof, as invariants.
//
// A range carries a budget: the largest sum of (inner children - 1) over the ranges on a path that begins
// with it. The root's is at most BUDGET; if a range has i >= 1 inner nodes, then the budget of their
// ranges is at most its own - (i - 1). Both are free otherwise: a range shows its number of inner nodes
// when it is taken, and a child range its budget when it arrives.
//
// Assumptions, beside those of traversal.sv: the budgets; the testers keep order, so a sphere that is
// decided belongs to the range that is being worked through only when no older one is under test.
//
// The invariant on the stack holds for one entry, any one. When an entry is taken it is needed for the
// top, which may be another: then it is assumed for the top of the clock before. That is no circle: look
// at the first clock in which any entry breaks it, and choose that entry.

localparam BUDGET = STACK_DEPTH - STACK_WATERMARK - LEAF_FIFO_DEPTH;
localparam N = STACK_DEPTH_LOG2 + 2;

(* anyseq *)   reg [N-1:0] inner;           // inner nodes of the range that is taken
(* anyseq *)   reg [N-1:0] arriving;        // budget of the range that arrives
(* anyconst *) reg [STACK_DEPTH_LOG2-1:0] entry;

reg [N-1:0] budget [0:STACK_DEPTH-1];       // of the stacked ranges
reg [N-1:0] older = 0;                      // spheres under test of ranges before the current one
reg [N-1:0] inner_left = 0;                 // inner nodes of the current range that may still be pushed
reg [N-1:0] children = 0;                   // budget of their ranges
reg         top_was_good = 1;

// a range is taken: the root, the range that arrives, or the top of the stack
wire [STACK_DEPTH_LOG2-1:0] top_entry = r_level[STACK_DEPTH_LOG2-1:0] - 1;
wire          pushed_now = push_i && write;
wire          through    = push_i && !write;
wire          popped     = rin_level + 1 == r_level;
wire          taken      = start_i && root_count_i != 0 || through || popped;
wire [N-1:0]  taken_budget = popped ? budget[top_entry] : arriving;
wire [STACK_DEPTH_LOG2:0] rin_level = rin[1+ID_BITS+ID_BITS+1+SET_BITS +: STACK_DEPTH_LOG2+1];

always @(posedge clk_i) begin
  if (pushed_now) budget[r_level[STACK_DEPTH_LOG2-1:0]] <= arriving;
  if (decided_i && older != 0) older <= older - 1;
  if (push_i && older == 0) inner_left <= inner_left - 1;
  if (taken) begin
    older      <= testing + sphere_starts - decided_i;
    inner_left <= inner;
    children   <= inner == 0 ? taken_budget : taken_budget - (inner - 1);
  end
  top_was_good <= r_level == 0 || good(top_entry, budget[top_entry]);
  if (rst_i) begin
    older      <= 0;
    inner_left <= 0;
    children   <= 0;
    top_was_good <= 1;
  end
end

function good(input [N-1:0] place, input [N-1:0] its_budget);
  good = its_budget <= BUDGET && place + 1 + its_budget <= STACK_DEPTH;
endfunction

always @* begin
  // the tree
  if (start_i) assume (arriving <= BUDGET);
  if (push_i) assume (older != 0 ? arriving <= BUDGET : inner_left != 0 && arriving <= children);
  if (taken) assume (inner <= taken_budget + 1);
  assume (top_was_good);
  if (started) begin
    no_overflow: assert (stack_level_o <= STACK_DEPTH && (!write || stack_level_o < STACK_DEPTH));
    entry_good: assert (entry >= r_level || good(entry, budget[entry]));

    // above the watermark: what may still come fits
    relaxed_or_alone: assert (!popped || r_level < STACK_WATERMARK || testing == 0);
    older_fit: assert (r_level < STACK_WATERMARK || older == 0
                       || r_level + older <= STACK_WATERMARK - 1 + LEAF_FIFO_DEPTH);
    children_fit: assert (r_level < STACK_WATERMARK || inner_left == 0
                          || r_level + older + inner_left + children <= STACK_DEPTH);
    budgets: assert (children <= BUDGET && (inner_left == 0 || inner_left + children <= BUDGET + 1));
    in_order: assert (older <= testing);
  end
  high: cover (started && stack_level_o > STACK_WATERMARK + LEAF_FIFO_DEPTH);
end
