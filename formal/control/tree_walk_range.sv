// tree_walk, behind tree_walk.sv: every object of every range is requested exactly once before the walk ends,
// with its range's masks, unless no row is left; a row leaves a mask only when its bound was reached.
//
// One address, of a sphere or of a vertex, and one row are chosen, any. When idle_o comes, the object was
// requested once if it lies in a range that was given since the walk began (root or below a met sphere), or
// that range was dropped; never both, never more than once, never before the range was given. If the chosen
// row was in the range's mask and is not in the one shown with the object, or if the range was dropped, then
// in some clock since it was given its depth was not below the row's bound.
//
// Assumptions, beside those of tree_walk.sv: at most one range of a walk holds the chosen object, as in a tree;
// the stack doesn't overflow (tree_walk_stack.sv).
//
// `entry` and `refill_was_good` as in tree_walk_stack.sv.

(* anyconst *) reg [ID_BITS-1:0] address;
(* anyconst *) reg               vertex;
(* anyconst *) reg [LINE_BITS-1:0] row;
(* anyconst *) reg [STACK_DEPTH_LOG2-1:0] entry;

localparam ROWS_LSB = DEPTH_BITS + MAX_COLUMNS;
localparam FIRST_LSB = ROWS_LSB + MAX_ROWS;
localparam COUNT_LSB = FIRST_LSB + ID_BITS;

function [COUNT_BITS-1:0] count(input [RANGE_BITS-1:0] range);
  count = range[COUNT_LSB +: COUNT_BITS];
endfunction

function contains(input leaf, input [ID_BITS-1:0] first, input [COUNT_BITS-1:0] left);
  reg [ID_BITS-1:0] offset;
  begin
    offset = address - first;
    contains = leaf == vertex && offset < left;
  end
endfunction

function holds(input [RANGE_BITS-1:0] range);
  holds = contains(range[RANGE_BITS-1], range[FIRST_LSB +: ID_BITS], count(range));
endfunction

// what the ports say
wire [RANGE_BITS-1:0] root = {1'b0, root_count_i, root_first_i, rows_i, columns_i, {DEPTH_BITS{1'b0}}};
wire given = start_i && holds(root) || push_i && holds(push_range_i);
wire asked = request_o && address_o == address && vertex_o == vertex;
wire [DEPTH_BITS-1:0] bound = row_bounds_i >> (row * DEPTH_BITS);
reg  received = 0;             // a range with the object was given
reg  [RANGE_BITS-1:0] its;     // that range
reg  beaten = 0;               // since then its depth was not below the row's bound
reg  dropped = 0;
reg  [1:0] requests = 0;
always @(posedge clk_i) begin
  received <= !rst_i && (given || received && !idle_o);
  requests <= rst_i || idle_o ? 0 : requests + asked;
  dropped  <= !rst_i && !idle_o && (dropped || pop && live == 0 && holds(top_0));
  beaten   <= !rst_i && !given && (beaten || received && its[DEPTH_BITS-1:0] >= bound);
  if (given) its <= start_i ? root : push_range_i;
end

// where it is
wire current = r_active && contains(r_leaf, r_address, r_left);
wire in_0 = r_level > 0 && holds(top_0);
wire in_1 = r_level > 1 && holds(top_1);
wire in_2 = r_level > 2 && holds(top_2);
wire in_3 = r_level > 3 && holds(top_3);
reg  in_ram = 0;
reg  [STACK_DEPTH_LOG2-1:0] place;
reg  refill_was_good = 1;
wire [STACK_DEPTH_LOG2-1:0] refill_entry = r_level[STACK_DEPTH_LOG2-1:0] - 1;
always @(posedge clk_i) begin
  if (push_i && !pop && in_3) begin
    in_ram <= 1;
    place  <= r_level;
  end else if (pop && !push_i && place == refill_entry) in_ram <= 0;
  refill_was_good <= rst_i || r_level <= SORTED_RANGES || good(refill_entry, stack[refill_entry]);
  if (rst_i) in_ram <= 0;
end

function good(input [STACK_DEPTH_LOG2-1:0] where, input [RANGE_BITS-1:0] range);
  good = count(range) != 0 && holds(range) == (in_ram && place == where) && (!holds(range) || range == its);
endfunction

wire [2:0] places = current + in_0 + in_1 + in_2 + in_3 + in_ram + dropped;

always @* begin
  if (given) assume (!received || idle_o);
  assume (refill_was_good);
  assume (row < MAX_ROWS);
  assume (r_level <= STACK_DEPTH && !(push_i && !pop && r_level == STACK_DEPTH));
  if (started) begin
    once_or_dropped: assert (!idle_o || requests + dropped == received);
    at_most_once: assert (requests <= received);
    its_masks: assert (!asked || columns_o == its[DEPTH_BITS +: MAX_COLUMNS] && (rows_o & ~its[ROWS_LSB +: MAX_ROWS]) == 0);
    only_beaten_rows: assert (!asked || !its[ROWS_LSB + row] || rows_o[row] || beaten);
    only_beaten_ranges: assert (!dropped || !its[ROWS_LSB + row] || beaten);

    // the range is at one place, or done; none is empty
    not_empty: assert (!r_active || r_left != 0);
    one_place: assert (places + requests == received);
    its_word: assert ((!in_0 || top_0 == its) && (!in_1 || top_1 == its) && (!in_2 || top_2 == its)
                      && (!in_3 || top_3 == its));
    counts: assert ((r_level < 1 || count(top_0) != 0) && (r_level < 2 || count(top_1) != 0)
                    && (r_level < 3 || count(top_2) != 0) && (r_level < 4 || count(top_3) != 0));
    its_current: assert (!current || r_columns == its[DEPTH_BITS +: MAX_COLUMNS]
                         && (r_rows & ~its[ROWS_LSB +: MAX_ROWS]) == 0
                         && (!its[ROWS_LSB + row] || r_rows[row] || beaten));
    entry_good: assert (entry < SORTED_RANGES || entry >= r_level || good(entry, stack[entry]));
    siblings_stacked: assert (r_siblings <= r_level);
    ram_place: assert (!in_ram || place >= SORTED_RANGES && place < r_level);
  end
  seen: cover (started && requests == 1 && idle_o && vertex);
  was_dropped: cover (started && dropped && idle_o);
  refilled: cover (started && in_3 && was_in_ram);
end
reg was_in_ram = 0;
always @(posedge clk_i) was_in_ram <= !rst_i && (was_in_ram || in_ram);
