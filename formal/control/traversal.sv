// traversal: requests, spheres under test, room in the leaf queue, end of the walk.
//
// Assumptions, of this file and of the two that are put behind it:
//   reset in the first clock; start_i only when idle_o; last_set_i changes only when idle_o was 1;
//   decided_i only while a sphere is at the testers whose last set was requested in an earlier clock;
//   push_i only with decided_i, with a count of 1 or more;
//   the leaf queue grows by one at most, and only with a decided sphere that was not pushed.
// Nothing is assumed about how long the testers and the leaf queue take, nor about ranges and addresses.

localparam TESTED_BITS = LEAF_FIFO_DEPTH_LOG2 + 2;
localparam SET_BITS = LINE_BITS;

reg started = 0;

// what the ports say
wire sphere_starts = request_o && first_o;
wire sphere_ends   = request_o && last_o;
reg [TESTED_BITS-1:0] testing = 0;     // spheres started and not decided
reg [TESTED_BITS-1:0] complete = 0;    // their last set was requested, too
reg [TESTED_BITS-1:0] leaves_max = 0;  // words that the leaf queue can hold
reg                was_request = 0, was_last, was_idle = 0, ready_to_go = 0;
reg [SET_BITS-1:0] was_set, last_set;
reg [ID_BITS-1:0]  was_address;

always @(posedge clk_i) begin
  started     <= 1;
  testing     <= testing + sphere_starts - decided_i;
  complete    <= complete + sphere_ends - decided_i;
  leaves_max  <= leaves_i + (decided_i && !push_i);
  was_request <= request_o && !rst_i;
  was_last    <= last_o;
  was_idle    <= idle_o;
  was_set     <= set_o;
  was_address <= address_o;
  last_set    <= last_set_i;
  ready_to_go <= !r_active && !idle_o && testing == 0 && !rst_i;
  if (rst_i) begin
    testing    <= 0;
    complete   <= 0;
    leaves_max <= 0;
  end
end

always @* begin
  assume (started || rst_i);
  if (start_i) assume (idle_o);
  if (started && !was_idle) assume (last_set_i == last_set);
  if (decided_i) assume (complete != 0);
  if (push_i) assume (decided_i && push_count_i != 0);
  if (started) assume (leaves_i <= leaves_max);
  if (started) begin
    // no more spheres under test than the leaf queue can take, should all be leaves
    counted: assert (r_under_test == testing);
    room: assert (testing + leaves_i <= LEAF_FIFO_DEPTH);

    // the sets of a sphere follow each other at once, from 0 to the last
    marks: assert (first_o == (set_o == 0) && last_o == (set_o == last_set_i));
    at_once: assert (!was_request || was_last || request_o && set_o == was_set + 1 && address_o == was_address);
    set_0: assert (was_request && !was_last || set_o == 0);

    // no clock is lost, nothing hangs: with room the next set goes; with nothing under test the stack is read
    goes: assert (request_o == (r_active && (set_o != 0 || testing + leaves_i < LEAF_FIFO_DEPTH)));
    goes_on: assert (!ready_to_go || r_active);
    at_the_end: assert (idle_o == (!r_active && stack_level_o == 0 && testing == 0));

    // the registers
    sets: assert (r_set <= last_set_i && (r_set == 0 || r_active && was_request && !was_last));
    under_way: assert (complete <= testing && testing == complete + (r_set != 0));
    room_kept: assert (testing + leaves_max <= LEAF_FIFO_DEPTH);
  end
  filled: cover (started && leaves_i == 1 && testing == LEAF_FIFO_DEPTH - 1 && r_active);
  walked: cover (started && idle_o && was_request_before && leaves_i != 0);
  pushed: cover (started && stack_level_o == 2 && decided_i && sphere_starts);
end
reg was_request_before = 0;
always @(posedge clk_i) was_request_before <= (was_request_before || was_request) && !rst_i;

// reg_t, from its first field
wire                      r_active;
wire [ID_BITS-1:0]        r_address;
wire [ID_BITS:0]          r_left;
wire [SET_BITS-1:0]       r_set;
wire [STACK_DEPTH_LOG2:0] r_level;
wire [TESTED_BITS-1:0]    r_under_test;
assign {r_under_test, r_level, r_set, r_left, r_address, r_active} = r;
generate
  if ($bits(r) != 2 + 2 * ID_BITS + SET_BITS + STACK_DEPTH_LOG2 + 1 + TESTED_BITS) layout_of_reg_t_is_another refused();
endgenerate
