// plane_sphere_decoder: the masks of a decided sphere are its flags, each at the place of its plane, of
// all its sets; planes that the pencil doesn't have are 0. A sphere is decided with its last set, once;
// it is a leaf if it is one and is met, pushed if it is an inner node and is met, never both.
//
// One row and one column are chosen, any; sets may come with gaps between them.
//
// Assumptions: reset in the first clock; the sets of a sphere come in order from 0, at most 16, and set 0
// follows the last; rows_i and columns_i keep their values during a sphere.

reg started = 0;
(* anyconst *) reg [LINE_BITS-1:0] row;
(* anyconst *) reg [LINE_BITS-1:0] column;

reg                 between = 1;  // no set of a sphere has come whose last set has not
reg [LINE_BITS-1:0] next_set = 0;
reg [LINE_BITS:0]   rows, columns;
reg                 row_met, column_met;
wire                first    = set_i == 0;
wire                row_here = set_i == row / NUM_ROWS;
wire                column_here = set_i == column / NUM_COLUMNS;
reg was_decided = 0, was_leaf;

always @(posedge clk_i) begin
  started     <= 1;
  was_decided <= valid_i && last_i && !rst_i;
  was_leaf    <= leaf_i;
  if (valid_i) begin
    between  <= last_i;
    next_set <= last_i ? 0 : set_i + 1;
    rows     <= rows_i;
    columns  <= columns_i;
    row_met  <= row_here ? row_flags_i[row % NUM_ROWS] && row < rows_i : first ? 0 : row_met;
    column_met <= column_here ? column_flags_i[column % NUM_COLUMNS] && column < columns_i
                              : first ? 0 : column_met;
  end
  if (rst_i) begin
    between  <= 1;
    next_set <= 0;
  end
end

always @* begin
  assume (started || rst_i);
  if (valid_i) assume (set_i == next_set && (last_i || set_i != MAX_ROWS - 1));
  if (valid_i && !between) assume (rows_i == rows && columns_i == columns);
  if (started) begin
    once: assert (decided_o == was_decided);
    leaf: assert (leaf_o == (was_decided && was_leaf && row_mask_o != 0 && column_mask_o != 0));
    inner: assert (push_o == (was_decided && !was_leaf && row_mask_o != 0 && column_mask_o != 0));
    exclusive: assert (!(leaf_o && push_o) && (decided_o || !leaf_o && !push_o));
    row_in_place: assert (!decided_o || row_mask_o[row] == row_met);
    column_in_place: assert (!decided_o || column_mask_o[column] == column_met);

    // before the last set
    row_so_far: assert (between && !decided_o || row_mask_o[row] == row_met);
    column_so_far: assert (between && !decided_o || column_mask_o[column] == column_met);
    row_to_come: assert (between || row / NUM_ROWS < next_set || !row_met);
    column_to_come: assert (between || column / NUM_COLUMNS < next_set || !column_met);
    in_sphere: assert (between == (next_set == 0));
  end
  joined: cover (started && leaf_o && row_met && !column_met && column_mask_o != 0);
  two: cover (started && push_o && valid_i && first && last_i);
end
