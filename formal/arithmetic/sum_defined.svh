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
