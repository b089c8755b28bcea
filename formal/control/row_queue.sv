// row_selector and the queue of rows behind it, which is read at any time: it never overflows, though a row takes
// ROW_STAGES clocks on its way to it. No end of a pencil is lost or made: those taken are those written and those
// inside.
//
// Assumptions: reset in the first clock; row_count_i is the number of words written and not yet read.

localparam DEPTH = 1 << ROW_FIFO_DEPTH_LOG2;
localparam ROW = 1 + BANK_BITS + ID_BITS + DEPTH_BITS + LINE_BITS + MAX_COLUMNS;
localparam STAGES = ROW_INTERVAL_STAGES + 1;

reg started = 0;
(* anyseq *) reg read;
reg [ROW_FIFO_DEPTH_LOG2:0] inside = 0;
reg [2:0] ends = 0;   // of pencils, taken and not yet written
wire taken = valid_i && ready_o;
wire last = word_i[$bits(word_i)-1];
always @(posedge clk_i) begin
  started <= 1;
  inside  <= rst_i ? 0 : inside + row_valid_o - (read && inside != 0);
  ends    <= rst_i ? 0 : ends + (taken && last) - (row_valid_o && row_word_o[ROW-1]);
end

always @* begin
  assume (started || rst_i);
  assume (row_count_i == inside);
  if (started) begin
    room: assert (!row_valid_o || inside < DEPTH);
    on_the_way: assert (inside + under_way <= DEPTH);
    no_end_lost: assert (ends == ends_under_way);
    no_row_without_rays: assert (!row_valid_o || row_word_o[ROW-1] || row_word_o[MAX_COLUMNS-1:0] != 0);
    nothing_of_no_word: assert (!ready_o || valid_i);
  end
  fills: cover (started && inside == DEPTH);
  ended: cover (started && row_valid_o && row_word_o[ROW-1] && ends == 3);
end

// reg_t, from its first field; element 1 of an array is the highest
wire [MAX_ROWS-1:0]       rows_left;
wire                      fresh;
wire [STAGES*(ROW+1)-1:0] stages;   // of each: valid is the lowest bit, then last
assign {stages, rows_left, fresh} = r;
reg [2:0] under_way, ends_under_way;
integer k;
always @* begin
  under_way = 0;
  ends_under_way = 0;
  for (k = 0; k < STAGES; k = k + 1) begin
    under_way = under_way + stages[k*(ROW+1)];
    ends_under_way = ends_under_way + (stages[k*(ROW+1)] && stages[k*(ROW+1)+1]);
  end
end
generate
  if ($bits(r) != 1 + MAX_ROWS + STAGES * (ROW + 1) || STAGES > 7) layout_of_reg_t_is_another refused();
endgenerate
