// The cases of fp_add.sv leave no pair of operands out: for every a and b there are a distance in 0 .. 127, an
// order, and values of the free inputs, with which the module `operands` gives just a and b.
`include "operands.svh"

module miter (
  input now,
  input [23:0] a, b,
  output bad
);
  wire swap = a[22:16] < b[22:16];
  wire [23:0] x = swap ? b : a, y = swap ? a : b;
  wire valid;
  wire [23:0] case_a, case_b;
  operands case_i (.distance(x[22:16] - y[22:16]), .swap(swap), .exponent(x[22:16]), .larger({x[23], x[15:0]}),
                   .smaller({y[23], y[15:0]}), .valid(valid), .a(case_a), .b(case_b));
  assign bad = now && !(valid && case_a == a && case_b == b && (x[22:16] != y[22:16] || !swap));
endmodule
