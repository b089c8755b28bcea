// tree_walk: requests, objects under test, room in the triangle queue, order on the stack, end of the walk.
//
// Assumptions, of this file and of the two that are put behind it:
//   reset in the first clock; start_i only when idle_o, with a count of 1 or more;
//   decided_i only while an object is at the testers that was requested in an earlier clock;
//   at most OBJECTS are under test; push_i only with decided_i, with a count of 1 or more;
//   the triangle queue grows by one at most, and only with a decided vertex.
// Nothing is assumed about how long testers and triangle queue take, about ranges, depths and bounds.

localparam OBJECTS = 1 << TRIANGLE_FIFO_DEPTH_LOG2;
localparam TESTED_BITS = TRIANGLE_FIFO_DEPTH_LOG2 + 1;
localparam RANGE_BITS = 1 + COUNT_BITS + ID_BITS + MAX_ROWS + MAX_COLUMNS + DEPTH_BITS;

reg started = 0;
(* anyseq *) reg vertex_decided;  // what is decided is a vertex

// what the ports say
reg [TESTED_BITS-1:0] testing = 0;        // objects requested and not decided
reg [TESTED_BITS-1:0] vertices = 0;       // of these, vertices
reg [TESTED_BITS-1:0] triangles_max = 0;  // words that the triangle queue can hold
reg                   was_request = 0, was_last, ready_to_go = 0;
reg [STACK_DEPTH_LOG2:0] was_level;

always @(posedge clk_i) begin
  started       <= 1;
  testing       <= testing + request_o - decided_i;
  vertices      <= vertices + (request_o && vertex_o) - (decided_i && vertex_decided);
  triangles_max <= triangles_i + (decided_i && vertex_decided);
  was_request   <= request_o && !rst_i;
  was_last      <= last_o;
  was_level     <= stack_level_o;
  ready_to_go   <= !r_active && !idle_o && testing == 0 && !rst_i;
  if (rst_i) begin
    testing       <= 0;
    vertices      <= 0;
    triangles_max <= 0;
  end
end

// what the current range shows, in this clock and in the one before
wire [ID_BITS+MAX_ROWS+MAX_COLUMNS:0] shown = {r_leaf, r_address, r_rows, r_columns};
reg  [ID_BITS+MAX_ROWS+MAX_COLUMNS:0] was_shown;
reg  was_waiting = 0;
wire [ID_BITS+MAX_ROWS+MAX_COLUMNS:0] one_address = 1 << (MAX_ROWS + MAX_COLUMNS);
always @(posedge clk_i) begin
  was_shown   <= shown;
  was_waiting <= r_active && !request_o && !rst_i;
end

always @* begin
  assume (started || rst_i);
  if (start_i) assume (idle_o && root_count_i != 0);
  if (decided_i) assume (testing != 0 && (vertex_decided ? vertices != 0 : testing != vertices));
  assume (testing != OBJECTS || !request_o || decided_i);
  if (push_i) assume (decided_i && push_range_i[RANGE_BITS-2 -: COUNT_BITS] != 0);
  if (started) assume (triangles_i <= triangles_max);
  if (started) begin
    // no more vertices under test than the triangle queue can take, should all close triangles
    counted: assert (r_under_test == testing);
    room: assert (vertices + triangles_i <= OBJECTS);

    // a range's objects in order, with one pair of masks
    marks: assert (last_o == (r_left == 1) && vertex_o == r_leaf && address_o == r_address
                   && rows_o == r_rows && columns_o == r_columns);
    in_sequence: assert (!was_request || was_last || r_active && shown[ID_BITS+MAX_ROWS+MAX_COLUMNS]
                         == was_shown[ID_BITS+MAX_ROWS+MAX_COLUMNS]
                         && shown[ID_BITS+MAX_ROWS+MAX_COLUMNS-1:0]
                         == ((was_shown + one_address) & ~(one_address << ID_BITS)));
    waits: assert (!was_waiting || r_active && shown == was_shown);
    not_without_rows: assert (!request_o || start_masks || rows_o != 0);

    // no clock is lost, nothing hangs: with room the object goes; with nothing under test the stack is read
    goes: assert (request_o == (r_active && (!vertex_o || testing + triangles_i < OBJECTS)));
    goes_on: assert (!ready_to_go || r_active || stack_level_o + 1 == was_level);
    at_the_end: assert (idle_o == (!r_active && stack_level_o == 0 && testing == 0));
    spent_first: assert (!idle_o || spent_o);

    // the upper siblings lie nearest first
    sorted: assert ((r_siblings < 2 || top_0[DEPTH_BITS-1:0] <= top_1[DEPTH_BITS-1:0])
                    && (r_siblings < 3 || top_1[DEPTH_BITS-1:0] <= top_2[DEPTH_BITS-1:0]));

    // the registers
    under_way: assert (vertices <= testing && testing <= OBJECTS);
    room_kept: assert (vertices + triangles_max <= OBJECTS);
    rows_left: assert (!r_active || start_masks || r_rows != 0);
  end
  filled: cover (started && triangles_i == 1 && testing == OBJECTS - 1 && r_active && vertex_o);
  walked: cover (started && idle_o && was_request_before && triangles_i != 0);
  stacked: cover (started && stack_level_o == 2 && r_siblings == 2 && was_request);
  discarded: cover (started && stack_level_o < was_level && was_waiting);
end
reg was_request_before = 0;
reg start_masks = 0;  // the current range is the root, whose masks are the host's
always @(posedge clk_i) begin
  was_request_before <= (was_request_before || was_request) && !rst_i;
  start_masks <= !rst_i && (start_i || start_masks && !(pop && live != 0));
end

// reg_t, from its first field; the upper entries of the stack, the top first
wire                      r_active, r_leaf;
wire [ID_BITS-1:0]        r_address;
wire [COUNT_BITS-1:0]     r_left;
wire [MAX_ROWS-1:0]       r_rows;
wire [MAX_COLUMNS-1:0]    r_columns;
wire [STACK_DEPTH_LOG2:0] r_level;
wire [TESTED_BITS-1:0]    r_under_test;
wire [3:0]                r_vertices;
wire [1:0]                r_siblings;
assign {r_siblings, r_vertices, r_under_test, r_level, r_columns, r_rows, r_left, r_address, r_leaf, r_active} = r;
wire [RANGE_BITS-1:0]     top_0, top_1, top_2, top_3;
assign {top_0, top_1, top_2, top_3} = top;
generate
  if ($bits(r) != 2 + ID_BITS + COUNT_BITS + MAX_ROWS + MAX_COLUMNS + STACK_DEPTH_LOG2 + 1 + TESTED_BITS + 6
      || $bits(top) != SORTED_RANGES * RANGE_BITS || SORTED_RANGES != 4) layout_of_reg_t_is_another refused();
endgenerate
