// fp_add against its definition. One case for each distance of the exponents and each order of the operands:
// `distance` and `swap` are constants of the case, the rest is free.
//
// Definition (GUARD_BITS 2): the exact sum, an integer times a power of two, cut to 17 significant bits; an
// exponent below 1 gives +0, one above 127 the largest number of that sign. GUARD_BITS 1 and 0: the smaller
// operand is first cut GUARD_BITS below the last place of the larger one. Exponent field 0 is zero, whatever
// sign and fraction. SUBTRACT: b's sign is flipped first.

`include "operands.svh"
`include "sum_defined.svh"

// In a clock when `now` is 1 the unit gets the operands of the case, in all others any operands. bad is 1
// when, 4 clocks after such a clock, the result isn't the defined one.
module miter #(parameter GUARD_BITS = 2, SUBTRACT = 0) (
  input clk_i, now,
  input [6:0] distance,
  input swap,
  input [6:0] exponent,
  input [16:0] larger, smaller,
  input [23:0] other_a, other_b,
  output bad
);
  wire valid;
  wire [23:0] case_a, case_b, sum, defined;
  operands case_i (.distance(distance), .swap(swap), .exponent(exponent), .larger(larger), .smaller(smaller),
                   .valid(valid), .a(case_a), .b(case_b));
  wire [23:0] a = now ? case_a : other_a, b = now ? case_b : other_b;
  fp_add unit (.clk_i(clk_i), .a_i(a), .b_i(b), .sum_o(sum));
  reg [56:0] line1, line2, line3, line4;
  always @(posedge clk_i) begin
    line1 <= {now && valid, distance, swap, case_a, case_b};
    line2 <= line1;
    line3 <= line2;
    line4 <= line3;
  end
  sum_defined #(.GUARD_BITS(GUARD_BITS)) definition (
    .distance(line4[55:49]), .swap(line4[48]), .a(line4[47:24]), .b({line4[23] ^ (SUBTRACT != 0), line4[22:0]}),
    .sum(defined));
  assign bad = line4[56] && sum != defined;
endmodule
