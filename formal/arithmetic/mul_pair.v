// Techmap: a signed 18 x 18 product becomes its operands side by side. So the products are free words, and yet it
// counts which operands meet. (DSP48's `*` has 18 bits, GHDL's 36, sign-extended.)
(* techmap_celltype = "$mul" *)
module mul_pair (A, B, Y);
  parameter A_SIGNED = 0, B_SIGNED = 0, A_WIDTH = 18, B_WIDTH = 18, Y_WIDTH = 36;
  input [A_WIDTH-1:0] A;
  input [B_WIDTH-1:0] B;
  output [Y_WIDTH-1:0] Y;
  wire _TECHMAP_FAIL_ = A_WIDTH < 18 || B_WIDTH < 18 || Y_WIDTH != 36;
  assign Y = {A[17:0], B[17:0]};
endmodule
