// fp_mul against its definition, for all operands at once.
//
// Definition: the exact product of two integers times a power of two, cut to 17 significant bits; an exponent
// below 1 gives +0, one above 127 the largest number of that sign. Exponent field 0 is zero.
// The product of the significands is a `*` on both sides: proven is everything around it, and that the unit
// multiplies the right integers. In each clock the unit gets any operands; bad is 1 when, 3 clocks
// after a clock when `now` is 1, the result isn't the defined one.
module miter (
  input clk_i, now,
  input [23:0] a, b,
  output bad
);
  wire [23:0] product;
  fp_mul unit (.clk_i(clk_i), .a_i(a), .b_i(b), .product_o(product));
  reg [48:0] line1, line2, line3;
  always @(posedge clk_i) begin
    line1 <= {now, a, b};
    line2 <= line1;
    line3 <= line2;
  end
  wire [23:0] x = line3[47:24], y = line3[23:0];
  wire [16:0] x_significand = x[22:16] == 0 ? 17'd0 : {1'b1, x[15:0]};
  wire [16:0] y_significand = y[22:16] == 0 ? 17'd0 : {1'b1, y[15:0]};
  wire [33:0] exact = x_significand * y_significand;  // from 2^32 on if no operand is zero
  wire signed [9:0] exponent = $signed({3'd0, x[22:16]}) + $signed({3'd0, y[22:16]}) - 63 + exact[33];
  wire [15:0] fraction = exact[33] ? exact[32:17] : exact[31:16];
  wire [23:0] defined = exact == 0 || exponent < 1 ? 24'd0
                      : exponent > 127 ? {x[23] ^ y[23], 23'h7fffff}
                      : {x[23] ^ y[23], exponent[6:0], fraction};
  assign bad = line3[48] && product != defined;
endmodule
