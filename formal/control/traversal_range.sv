// traversal, behind traversal.sv: every sphere of every range is tested against every plane set exactly
// once before the walk ends, and no other sphere is.
//
// One address and one set are chosen, any. When idle_o comes, the pair was requested once if the address
// lies in a range that was given since the walk began (root or child) and the set is the pencil's; never
// more than once, and never before its range was given.
//
// Assumptions, beside those of traversal.sv: at most one range of a walk holds the chosen address, as in a
// tree; the root range has at most 2^ID_BITS spheres; the stack doesn't overflow (traversal_stack.sv).
//
// `entry` and `top_was_good` as in traversal_stack.sv.

(* anyconst *) reg [ID_BITS-1:0]  address;
(* anyconst *) reg [SET_BITS-1:0] set;
(* anyconst *) reg [STACK_DEPTH_LOG2-1:0] entry;

function holds(input [ID_BITS-1:0] first, input [ID_BITS:0] count);
  reg [ID_BITS-1:0] offset;
  begin
    offset = address - first;
    holds = offset < count;
  end
endfunction

// what the ports say
wire given = start_i && holds(root_first_i, root_count_i) || push_i && holds(push_first_i, push_count_i);
wire asked = request_o && address_o == address && set_o == set;
reg  received = 0;       // a range with the address was given
reg [1:0] requests = 0;  // for the address and the set
always @(posedge clk_i) begin
  received <= !rst_i && (given || received && !idle_o);
  requests <= rst_i || idle_o ? 0 : requests + asked;
end

// where it is
reg stacked = 0;
reg [STACK_DEPTH_LOG2-1:0] place;
wire [STACK_DEPTH_LOG2-1:0] top_entry = r_level[STACK_DEPTH_LOG2-1:0] - 1;
wire [STACK_DEPTH_LOG2:0] rin_level = rin[1+ID_BITS+ID_BITS+1+SET_BITS +: STACK_DEPTH_LOG2+1];
wire current = r_active && holds(r_address, r_left);
reg  top_was_good = 1;
always @(posedge clk_i) begin
  if (given && write) begin
    stacked <= 1;
    place   <= r_level;
  end else if (rin_level + 1 == r_level && place == top_entry) stacked <= 0;
  top_was_good <= rst_i || r_level == 0 || good(top_entry, stack[top_entry]);
  if (rst_i) stacked <= 0;
end

function good(input [STACK_DEPTH_LOG2-1:0] where, input [ID_BITS+COUNT_BITS-1:0] word);
  good = word[COUNT_BITS-1:0] != 0
         && holds(word[ID_BITS+COUNT_BITS-1:COUNT_BITS], word[COUNT_BITS-1:0]) == (stacked && place == where);
endfunction

always @* begin
  if (given) assume (!received || idle_o);
  if (start_i) assume (root_count_i <= 1 << ID_BITS);
  assume (top_was_good);
  assume (r_level <= STACK_DEPTH && !(write && r_level == STACK_DEPTH));
  if (started) begin
    exactly_once: assert (!idle_o || requests == (received && set <= last_set_i));
    at_most_once: assert (requests <= received);

    // the range is stacked, or worked through, or done
    entry_good: assert (entry >= r_level || good(entry, stack[entry]));
    one_place: assert (!stacked || received && !current && place < r_level);
    only_given: assert (!current || received);
    waiting: assert (!stacked || requests == 0);
    walking: assert (!current || requests == (r_address == address && set < set_o));
    done: assert (!received || stacked || current || requests == (set <= last_set_i));
    not_empty: assert (!r_active || r_left != 0 && r_left <= 1 << ID_BITS);
  end
  seen: cover (started && requests == 1 && stack_level_o == 0 && idle_o && set == 1);
  was_stacked: cover (started && requests == 1 && was_stacked_once);
end
reg was_stacked_once = 0;
always @(posedge clk_i) was_stacked_once <= !rst_i && (was_stacked_once || stacked);
