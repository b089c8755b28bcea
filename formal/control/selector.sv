// selector: every (ray, triangle) pair of a leaf's range and masks comes out exactly once, no other
// does, and they come in the documented order: triangles, then rows, then columns, lowest first. Under
// every pattern of offers, stalls and resets, at full width: 127 triangles, 16 x 16 rays.
//
// One pair is chosen, any one: triangle first + offset, row, column. What holds for it holds for all.
// In each clock it has come out if and only if it belongs to the leaf and is before the pair that stands
// at the outputs. With "the pair at the outputs belongs to the leaf" and "it moves upwards", that is
// exactly once, in order. A leaf's number of pairs is not bounded by anything here but its ports.
//
// Assumptions: reset in the first clock; an offered leaf has count_i >= 1 and no empty mask.

reg started = 0;
(* anyconst *) reg [COUNT_BITS-1:0] offset;
(* anyconst *) reg [LINE_BITS-1:0]  row;
(* anyconst *) reg [LINE_BITS-1:0]  column;

// what the ports say: the leaf that was taken last
wire leaf_taken = valid_i && ready_o;
wire pair_taken = valid_o && ready_i;
reg                   open = 0;  // a leaf was taken and is not finished
reg [ID_BITS-1:0]     first;
reg [COUNT_BITS-1:0]  count;
reg [MAX_ROWS-1:0]    rows;
reg [MAX_COLUMNS-1:0] columns;
reg                   emitted;   // the chosen pair came out

wire member = offset < count && rows[row] && columns[column];
wire chosen = triangle_o == first + offset && ray_o == {row, column};

// the pair at the outputs
wire [ID_BITS-1:0]   out_offset = triangle_o - first;
wire [LINE_BITS-1:0] out_row    = ray_o[2*LINE_BITS-1:LINE_BITS];
wire [LINE_BITS-1:0] out_column = ray_o[LINE_BITS-1:0];
wire [ID_BITS+2*LINE_BITS-1:0] place        = {out_offset, out_row, out_column};
wire [ID_BITS+2*LINE_BITS-1:0] chosen_place = {{ID_BITS-COUNT_BITS{1'b0}}, offset, row, column};
wire [MAX_ROWS-1:0]    rows_above    = rows & ~((16'd2 << out_row) - 16'd1);
wire [MAX_COLUMNS-1:0] columns_above = columns & ~((16'd2 << out_column) - 16'd1);
wire final_pair = out_offset == count - 1 && rows_above == 0 && columns_above == 0;

reg stalled = 0, moved = 0, had_leaf = 0;
reg [ID_BITS+2*LINE_BITS-1:0] was;
always @(posedge clk_i) begin
  started  <= 1;
  stalled  <= valid_o && !ready_i && !rst_i;
  moved    <= pair_taken && !leaf_taken && !ready_o && !rst_i;
  had_leaf <= leaf_taken && !rst_i;
  was      <= place;
  if (leaf_taken) begin
    open    <= 1;
    first   <= first_i;
    count   <= count_i;
    rows    <= row_mask_i;
    columns <= column_mask_i;
    emitted <= 0;
  end else begin
    if (pair_taken && final_pair) open <= 0;
    if (pair_taken && chosen) emitted <= 1;
  end
  if (rst_i) open <= 0;
end

always @* begin
  assume (started || rst_i);
  if (valid_i) assume (count_i != 0 && row_mask_i != 0 && column_mask_i != 0);
  if (started) begin
    // a leaf is taken when there is none, or with its last pair: no bubble, no loss
    shown: assert (valid_o == open);
    takes: assert (ready_o == (!open || ready_i && final_pair));
    no_bubble: assert (!had_leaf || valid_o && place == first_place);

    if (valid_o) begin
      belongs: assert (out_offset < count && rows[out_row] && columns[out_column]);
      once: assert (emitted == (member && chosen_place < place));
      complete: assert (!final_pair || !member || emitted || chosen);
      stable: assert (!stalled || place == was);
      upwards: assert (!moved || place > was);

      // the registers
      leaf: assert (r_row_mask == rows && r_column_mask == columns);
      position: assert (r_left == count - out_offset && count != 0);
      rows_to_do: assert (r_rows_left == (rows & ~((16'd1 << out_row) - 16'd1)));
      columns_to_do: assert (r_columns_left == (columns & ~((16'd1 << out_column) - 16'd1)));
    end
  end
  back_to_back: cover (started && leaf_taken && pair_taken && emitted);
  walked: cover (started && emitted && out_offset == 2 && stalled);
end

// reg_t, from its first field
wire [COUNT_BITS-1:0]  r_left;
wire [MAX_ROWS-1:0]    r_row_mask, r_rows_left;
wire [MAX_COLUMNS-1:0] r_column_mask, r_columns_left;
wire [ID_BITS:0]       r_active_triangle;
assign {r_columns_left, r_rows_left, r_column_mask, r_row_mask, r_left, r_active_triangle} = r;
generate
  if ($bits(r) != 1 + ID_BITS + COUNT_BITS + 2 * (MAX_ROWS + MAX_COLUMNS)) layout_of_reg_t_is_another refused();
endgenerate

// the first pair of the leaf: bit k of a mask is its lowest
reg [LINE_BITS-1:0] lowest_row, lowest_column;
integer k;
always @* begin
  lowest_row = 0;
  lowest_column = 0;
  for (k = MAX_ROWS - 1; k >= 0; k = k - 1)
    if (rows[k]) lowest_row = k;
  for (k = MAX_COLUMNS - 1; k >= 0; k = k - 1)
    if (columns[k]) lowest_column = k;
end
wire [ID_BITS+2*LINE_BITS-1:0] first_place = {{ID_BITS{1'b0}}, lowest_row, lowest_column};
