// row_selector and the queue of rows behind it, which is read at any time: it never overflows, though a row takes
// ROW_STAGES clocks on its way to it. No end of a pencil is lost or made: those taken are those written and those
// inside.
//
// Assumptions: reset in the first clock; row_count_i is the number of words written and not yet read.

localparam DEPTH = 1 << ROW_FIFO_DEPTH_LOG2;
localparam ROW = 1 + BANK_BITS + ID_BITS + DEPTH_BITS + LINE_BITS + MAX_COLUMNS;
localparam WORD = 1 + BANK_BITS + ID_BITS + COUNT_BITS + DEPTH_BITS + MAX_ROWS + MAX_COLUMNS;

reg started = 0;
(* anyseq *) reg read;
reg [ROW_FIFO_DEPTH_LOG2:0] inside = 0;
reg [2:0] ends = 0;   // of pencils, taken and not yet written
wire taken = valid_i && ready_o;
always @(posedge clk_i) begin
  started <= 1;
  inside  <= rst_i ? 0 : inside + row_valid_o - (read && inside != 0);
  ends    <= rst_i ? 0 : ends + (taken && word_i[WORD-1]) - (row_valid_o && row_word_o[ROW-1]);
end

always @* begin
  assume (started || rst_i);
  assume (row_count_i == inside);
  if (started) begin
    room: assert (!row_valid_o || inside < DEPTH);
    on_the_way: assert (inside + s1[0] + s2[0] + s3[0] <= DEPTH);
    no_end_lost: assert (ends == (last && rows_left != 0) + (s1[0] && s1[1]) + (s2[0] && s2[1]) + (s3[0] && s3[1]));
    no_row_without_rays: assert (!row_valid_o || row_word_o[ROW-1] || row_word_o[MAX_COLUMNS-1:0] != 0);
    end_is_one_row: assert (!last || rows_left == 0 || rows_left == 1);
  end
  fills: cover (started && inside == DEPTH);
  ended: cover (started && row_valid_o && row_word_o[ROW-1] && ends == 3);
end

// reg_t, from its first field; element 1 of an array is the highest
wire [WORD-1:0]     word;
wire [MAX_ROWS-1:0] rows_left;
wire [ROW:0]        s1, s2, s3;   // valid is the lowest bit, then last
assign {s1, s2, s3, rows_left, word} = r;
wire last = word[0];
generate
  if ($bits(r) != WORD + MAX_ROWS + 3 * (ROW + 1)) layout_of_reg_t_is_another refused();
endgenerate
