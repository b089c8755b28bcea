// The tester's comparison against its definition: meets_o, 12 clocks later, is 1 exactly when |distance| <= radius,
// as integers times 2^-79. fp_mul and fp_add are replaced by registers that pass their first operand on, so that the
// distance is nx of the plane, and free. Assumed, and proven of fp_add: a distance whose exponent field is 0 is
// +0. The radius is any word but a negative number. Any operands in all other clocks.
module fp_mul (input clk_i, input [23:0] a_i, b_i, output [23:0] product_o);
  reg [71:0] line;
  always @(posedge clk_i) line <= {line[47:0], a_i};
  assign product_o = line[71:48];
endmodule

module fp_add (input clk_i, input [23:0] a_i, b_i, output [23:0] sum_o);
  reg [95:0] line;
  always @(posedge clk_i) line <= {line[71:0], a_i};
  assign sum_o = line[95:72];
endmodule

module miter (
  input clk_i, now,
  input [23:0] distance, radius,
  input [71:0] plane_rest, centre,
  output bad
);
  wire meets;
  plane_sphere_tester unit (.clk_i(clk_i), .plane_i({distance, plane_rest}), .ball_i({centre, radius}),
                            .meets_o(meets));
  function [143:0] scaled(input [23:0] x);
    scaled = x[22:16] == 0 ? 144'd0 : {127'd0, 1'b1, x[15:0]} << x[22:16];
  endfunction
  wire assumed = (distance[22:16] != 0 || distance == 0);
  reg [11:0] checked, defined;
  always @(posedge clk_i) begin
    checked <= {checked[10:0], now && assumed};
    defined <= {defined[10:0], scaled(distance) <= scaled(radius)};
  end
  assign bad = checked[11] && meets != defined[11];
endmodule
