// fp_product against its definition: for operands other than zero the exact product of the significands, 2^32 or
// more, and the sum of the exponents minus the bias; significand 0 if an operand is zero.
// `*` stands on both sides, as in fp_mul.sv. Any operands in all other clocks.
module miter (
  input clk_i, now,
  input [23:0] a, b,
  output bad
);
  wire [33:0] significand;
  wire signed [8:0] exponent;
  fp_product unit (.clk_i(clk_i), .a_i(a), .b_i(b), .significand_o(significand), .exponent_o(exponent));
  reg [48:0] line1, line2;
  always @(posedge clk_i) begin
    line1 <= {now, a, b};
    line2 <= line1;
  end
  wire [23:0] x = line2[47:24], y = line2[23:0];
  wire zero = x[22:16] == 0 || y[22:16] == 0;
  wire [33:0] product = {x[22:16] != 0, x[22:16] == 0 ? 16'd0 : x[15:0]}
                      * {y[22:16] != 0, y[22:16] == 0 ? 16'd0 : y[15:0]};
  wire signed [9:0] sum = $signed({3'd0, x[22:16]}) + $signed({3'd0, y[22:16]}) - 63;
  assign bad = line2[48] && (significand != product || zero != (significand[33:32] == 0)
                             || !zero && exponent != sum);
endmodule
