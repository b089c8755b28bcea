// column_selector: the pairs of every row that is taken go exactly once, lowest column first, no other does, with
// the row's bank, triangle and depth. An end of a pencil goes once, after all pairs of the rows taken before it and
// before those of the rows behind it. Nothing goes while stalled, and without a stall there is no bubble.
//
// Assumption: reset in the first clock.

reg started = 0;

// what the ports say: the word that was taken last, and what of it has not gone
reg [MAX_COLUMNS-1:0] left = 0;
reg                   last = 0;
reg [BANK_BITS-1:0]   bank;
reg [ID_BITS-1:0]     triangle;
reg [DEPTH_BITS-1:0]  z;
reg [LINE_BITS-1:0]   row_number;
wire [LINE_BITS-1:0]  column = ray_o[LINE_BITS-1:0];
wire [MAX_COLUMNS-1:0] gone = issue_o ? 16'd1 << column : 16'd0;
wire taken = valid_i && ready_o;

wire in_last;
wire [BANK_BITS-1:0]   in_bank;
wire [ID_BITS-1:0]     in_triangle;
wire [DEPTH_BITS-1:0]  in_z;
wire [LINE_BITS-1:0]   in_row;
wire [MAX_COLUMNS-1:0] in_columns;
assign {in_last, in_bank, in_triangle, in_z, in_row, in_columns} = row_word_i;

always @(posedge clk_i) begin
  started <= 1;
  left    <= rst_i ? 0 : taken ? (in_last ? 0 : in_columns) : left & ~gone;
  last    <= rst_i ? 0 : taken ? in_last : last && !last_o;
  if (taken) begin
    bank       <= in_bank;
    triangle   <= in_triangle;
    z          <= in_z;
    row_number <= in_row;
  end
end

always @* begin
  assume (started || rst_i);
  if (started) begin
    goes: assert (issue_o == (left != 0 && !stall_i));
    ends: assert (last_o == (last && !stall_i));
    not_both: assert (!(last && left != 0));
    lowest_first: assert (!issue_o || left[column] && (left & (gone - 1)) == 0);
    its_row: assert (!issue_o || ray_o[2*LINE_BITS-1:LINE_BITS] == row_number && triangle_o == triangle && z_o == z);
    its_bank: assert (!(issue_o || last_o) || bank_o == bank);
    takes: assert (ready_o == ((left & ~gone) == 0 && (!last || last_o)));

    // the register
    register: assert (r_columns == left && r_last == last);
    word: assert (left == 0 && !last || r_bank == bank && r_triangle == triangle && r_z == z && r_row == row_number);
  end
  back_to_back: cover (started && last_o && taken && !in_last);
  walked: cover (started && issue_o && column == 9 && left == 16'h0200 && taken);
end

// queued_row_t, from its first field
wire r_last;
wire [BANK_BITS-1:0]   r_bank;
wire [ID_BITS-1:0]     r_triangle;
wire [DEPTH_BITS-1:0]  r_z;
wire [LINE_BITS-1:0]   r_row;
wire [MAX_COLUMNS-1:0] r_columns;
assign {r_columns, r_row, r_z, r_triangle, r_bank, r_last} = row;
generate
  if ($bits(row) != 1 + BANK_BITS + ID_BITS + DEPTH_BITS + LINE_BITS + MAX_COLUMNS) layout_of_row_is_another refused();
endgenerate
