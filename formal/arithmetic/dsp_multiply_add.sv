// dsp_multiply_add against its definition in integers, for all words: c a clock after a and b. The product is a free
// word, but of the right operands: mul_pair.v. Any operands in all other clocks.
module miter (
  input clk_i, now,
  input signed [17:0] a, b,
  input signed [47:0] c,
  output bad
);
  wire signed [47:0] sum;
  dsp_multiply_add unit (.clk_i(clk_i), .a_i(a), .b_i(b), .c_i(c), .p_o(sum));

  // index k: k + 1 clocks old
  reg [2:0] nows;
  reg [53:0] as, bs;
  reg [95:0] cs;
  always @(posedge clk_i) begin
    nows <= {nows[1:0], now};
    {as, bs, cs} <= {as[35:0], a, bs[35:0], b, cs[47:0], c};
  end
  wire signed [17:0] a0 = as[53:36], b0 = bs[53:36];
  wire signed [47:0] c1 = cs[95:48];
  wire signed [35:0] product = a0 * b0;
  assign bad = nows[2] && sum - product != c1;  // a sum here would be the unit's very gates
endmodule
