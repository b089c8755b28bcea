// tree_walk and the queue of triangles behind the testers, which is read at any time: it never overflows. A vertex is
// decided MEMORY_STAGES + PLANE_TEST_STAGES + DEPTH_CODE_STAGES clocks after its request, its triangle, if it makes
// one, is written a clock later, and the walk is told of RESERVE words more than there are (sphere_half).
// And spent_o comes as soon as the ranges are at their end and no sphere is under test, and stands until the next
// start: until then no object is requested.
//
// Assumptions: reset in the first clock, and nothing under test in it; a range is pushed only for a sphere that is
// decided; an end of a pencil is written only into a queue that is not full, when the walk is idle and no triangle
// is on its way.

localparam TEST = MEMORY_STAGES + PLANE_TEST_STAGES + DEPTH_CODE_STAGES;
localparam DEPTH = 1 << TRIANGLE_FIFO_DEPTH_LOG2;
localparam RESERVE = 2;

reg started = 0;
(* anyseq *) reg makes, ends, read;
reg [TEST:1]   objects = 0;    // bit k: requested k clocks ago
reg [TEST+1:1] vertices = 0;
reg [TRIANGLE_FIFO_DEPTH_LOG2:0] inside = 0;
wire triangle = makes && vertices[TEST+1];
wire last = ends && idle_o && vertices == 0 && inside < DEPTH;
always @(posedge clk_i) begin
  started  <= 1;
  objects  <= rst_i ? 0 : {objects[TEST-1:1], request_o};
  vertices <= rst_i ? 0 : {vertices[TEST:1], request_o && vertex_o};
  inside   <= rst_i ? 0 : inside + (triangle || last) - (read && inside != 0);
end

// vertices requested behind the last sphere under test; it may be decided in this clock
wire [TEST:1] spheres = objects & ~vertices[TEST:1];
reg           was_spent = 0;
always @(posedge clk_i) was_spent <= spent_o && !start_i && !rst_i;

reg [4:0] tests, coming, behind;
integer k;
always @* begin
  tests  = 0;
  coming = 0;
  behind = 0;
  for (k = TEST; k >= 1; k = k - 1) behind = spheres[k] ? 0 : behind + objects[k];
  for (k = 1; k <= TEST; k = k + 1) tests = tests + objects[k];
  for (k = 1; k <= TEST + 1; k = k + 1) coming = coming + vertices[k];
  assume (started || rst_i);
  assume (triangles_i == inside + RESERVE);
  assume (decided_i == objects[TEST]);
  if (push_i) assume (spheres[TEST]);
  if (started) begin
    room: assert (!(triangle || last) || inside < DEPTH);
    all_fit: assert (coming == 0 || inside + coming <= DEPTH);
    no_more: assert (inside <= DEPTH);
    under_test: assert (r_under_test == tests);
    vertices_too: assert ((vertices[TEST:1] & ~objects) == 0);
    spent: assert (spent_o == (!r_active && r_level == 0 && spheres == 0));
    no_request: assert (!spent_o || !request_o);
    stays_spent: assert (!was_spent || spent_o);
    counted: assert (spheres != 0 ? r_vertices == behind : r_vertices >= behind);
  end
end

// reg_t, from its first field
localparam BELOW = 2 + ID_BITS + COUNT_BITS + MAX_ROWS + MAX_COLUMNS + STACK_DEPTH_LOG2 + 1;
wire                              r_active = r[0];
wire [STACK_DEPTH_LOG2:0]         r_level = r[BELOW - 1 -: STACK_DEPTH_LOG2 + 1];
wire [TRIANGLE_FIFO_DEPTH_LOG2:0] r_under_test = r[BELOW +: TRIANGLE_FIFO_DEPTH_LOG2 + 1];
wire [3:0]                        r_vertices = r[BELOW + TRIANGLE_FIFO_DEPTH_LOG2 + 1 +: 4];
generate
  if ($bits(r) != BELOW + TRIANGLE_FIFO_DEPTH_LOG2 + 7 || TEST > 15) layout_of_reg_t_is_another refused();
endgenerate
