// fp_add against its definition. One case for each distance of the exponents and each order of the operands:
// `distance` and `swap` are constants of the case, the rest is free.
//
// Definition (GUARD_BITS 2): the exact sum, an integer times a power of two, cut to 17 significant bits; an
// exponent below 1 gives +0, one above 127 the largest number of that sign. GUARD_BITS 1 and 0: the smaller
// operand is first cut GUARD_BITS below the last place of the larger one. Exponent field 0 is zero, whatever
// sign and fraction. SUBTRACT: b's sign is flipped first.

`include "operands.svh"

// The definition. Counted in 2^-127 last places of the larger operand every sum is an integer.
module sum_defined #(parameter GUARD_BITS = 2) (
  input  [6:0] distance,
  input  swap,
  input  [23:0] a, b,
  output reg [23:0] sum
);
  localparam UNIT = 127;
  localparam BITS = 18 + UNIT;
  localparam CUT = GUARD_BITS == 2 ? 0 : UNIT - GUARD_BITS;  // places of the smaller operand that are cut
  wire [23:0] x = swap ? b : a, y = swap ? a : b;            // the exponent of x is not the lower one
  wire [BITS-1:0] x_integer = {x[22:16] != 0, x[22:16] == 0 ? 16'd0 : x[15:0], {UNIT{1'b0}}};
  wire [BITS-1:0] y_integer = {y[22:16] != 0, y[22:16] == 0 ? 16'd0 : y[15:0], {UNIT{1'b0}}} >> distance
                              >> CUT << CUT;
  wire same = x[23] == y[23], less = x_integer < y_integer;
  wire [BITS-1:0] total = same ? x_integer + y_integer
                        : less ? y_integer - x_integer : x_integer - y_integer;
  wire sign = !same && less ? y[23] : x[23];
  wire [BITS+15:0] padded = {total, 16'd0};
  integer k;
  reg [7:0] top;         // place of the highest one
  reg [15:0] fraction;   // the 16 bits below it
  reg signed [9:0] exponent;
  always @* begin
    top = 0;
    fraction = 0;
    for (k = 0; k < BITS; k = k + 1)
      if (total[k]) begin
        top = k;
        fraction = padded[k +: 16];
      end
    exponent = $signed({3'd0, x[22:16]}) + $signed({2'd0, top}) - 16 - UNIT;
    if (total == 0 || exponent < 1) sum = 24'd0;
    else if (exponent > 127) sum = {sign, 23'h7fffff};
    else sum = {sign, exponent[6:0], fraction};
  end
endmodule

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
