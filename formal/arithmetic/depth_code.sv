// depth_code against its definition, for all distances below 2^40: 0 below 2^14; else the place of the top bit and
// the 10 bits below it; and that code stands for no more than the distance. z_o is less by the margin of 4.
module miter (
  input clk_i, now,
  input signed [47:0] d,
  output bad
);
  wire [14:0] z, code_seen;
  depth_code unit (.clk_i(clk_i), .d_i(d), .code_o(code_seen), .z_o(z));
  reg [48:0] line1, line2;
  always @(posedge clk_i) begin
    line1 <= {now, d};
    line2 <= line1;
  end
  wire signed [47:0] x = line2[47:0];
  wire assumed = line2[48] && x < 48'sh10000000000;

  reg [14:0] code;
  integer top;
  always @* begin
    code = 0;
    for (top = 14; top < 40; top = top + 1)
      if (x >= 0 && x[top]) code = ((top - 13) << 10) | (x >> (top - 10)) & 1023;
  end
  wire [14:0] defined = code < 1024 ? 0 : code - 4;
  wire [39:0] stands_for = code < 1024 ? 0 : {29'd0, 1'b1, code[9:0]} << (code[14:10] + 3);
  wire below = code < 1024 || stands_for <= x[39:0];
  assign bad = assumed && (code_seen != code || z != defined || !below);
endmodule
