// The operands of a case: |ea - eb| = distance, ea < eb if swap. `valid`: there are such operands.
module operands (
  input  [6:0] distance,
  input  swap,
  input  [6:0] exponent,          // the larger one
  input  [16:0] larger, smaller,  // sign, fraction
  output valid,
  output [23:0] a, b
);
  wire [6:0] lower = exponent - distance;
  wire [23:0] x = {larger[16], exponent, larger[15:0]};
  wire [23:0] y = {smaller[16], lower, smaller[15:0]};
  assign valid = exponent >= distance;
  assign a = swap ? y : x;
  assign b = swap ? x : y;
endmodule
