// How wrong the adder without guard bits can be: what bounds.py takes for granted. By the definition:
//   signs equal: it is the exact sum, truncated, as with guard bits;
//   signs opposite: it is at least the exact difference of the magnitudes, and less than a last place of the larger
//   operand above it, unless the result became 0 or saturated.
`include "operands.svh"
`include "sum_defined.svh"

module miter (
  input now,
  input [6:0] distance,
  input swap,
  input [6:0] exponent,
  input [16:0] larger, smaller,
  output bad
);
  localparam UNIT = 127;
  wire valid;
  wire [23:0] a, b, cut, exact;
  operands case_i (.distance(distance), .swap(swap), .exponent(exponent), .larger(larger), .smaller(smaller),
                   .valid(valid), .a(a), .b(b));
  sum_defined #(.GUARD_BITS(0)) cut_i (.distance(distance), .swap(swap), .a(a), .b(b), .sum(cut));
  sum_defined #(.GUARD_BITS(2)) exact_i (.distance(distance), .swap(swap), .a(a), .b(b), .sum(exact));

  wire [23:0] x = swap ? b : a, y = swap ? a : b;
  wire [144:0] x_integer = {x[22:16] != 0, x[22:16] == 0 ? 16'd0 : x[15:0], {UNIT{1'b0}}};
  wire [144:0] y_integer = {y[22:16] != 0, y[22:16] == 0 ? 16'd0 : y[15:0], {UNIT{1'b0}}} >> distance;
  wire [144:0] difference = x_integer < y_integer ? y_integer - x_integer : x_integer - y_integer;
  wire [4:0] down = x[22:16] - cut[22:16];  // places that the result lies below the larger operand, 0 .. 16
  wire [144:0] result = {1'b1, cut[15:0], {UNIT{1'b0}}} >> down;
  wire normal = cut != 0 && cut[22:0] != 23'h7fffff;
  wire near = cut[22:16] <= x[22:16] && x[22:16] - cut[22:16] <= 16 && result >= difference
           && result - difference < (145'd1 << UNIT);
  assign bad = now && valid && (a[23] == b[23] ? cut != exact : normal && !near);
endmodule
