// Techmap: a product is a sum of rows, lowest first, without the top bits of the operands that are constant 0. So
// the signed 18 x 18 multiplier of a DSP48, GHDL's 34 x 34 and a 17 x 17 `*` become the very same circuit. (Yosys'
// own mapping orders the rows by the names of the wires.)
(* techmap_celltype = "$mul" *)
module mul_rows (A, B, Y);
  parameter A_SIGNED = 0, B_SIGNED = 0, A_WIDTH = 2, B_WIDTH = 2, Y_WIDTH = 2;
  parameter [A_WIDTH-1:0] _TECHMAP_CONSTMSK_A_ = 0, _TECHMAP_CONSTVAL_A_ = 0;
  parameter [B_WIDTH-1:0] _TECHMAP_CONSTMSK_B_ = 0, _TECHMAP_CONSTVAL_B_ = 0;
  input [A_WIDTH-1:0] A;
  input [B_WIDTH-1:0] B;
  output [Y_WIDTH-1:0] Y;

  // bits up to the highest one that isn't constant 0
  function integer width(input [63:0] zeros, input integer bits);
    integer k;
    begin
      width = 1;
      for (k = 0; k < bits; k = k + 1)
        if (!zeros[k]) width = k + 1;
    end
  endfunction
  localparam A_BITS = width(_TECHMAP_CONSTMSK_A_ & ~_TECHMAP_CONSTVAL_A_, A_WIDTH);
  localparam B_BITS = width(_TECHMAP_CONSTMSK_B_ & ~_TECHMAP_CONSTVAL_B_, B_WIDTH);
  wire _TECHMAP_FAIL_ = A_SIGNED && (A_BITS == A_WIDTH || B_BITS == B_WIDTH);  // it may be negative

  localparam BITS = A_BITS + B_BITS;
  wire [(B_BITS+1)*BITS-1:0] sum;  // of 0, 1, 2 .. rows
  assign sum[BITS-1:0] = 0;
  genvar k;
  generate
    for (k = 0; k < B_BITS; k = k + 1) begin : rows
      wire [BITS-1:0] row = (A[A_BITS-1:0] & {A_BITS{B[k]}}) << k;
      assign sum[(k+1)*BITS +: BITS] = sum[k*BITS +: BITS] + row;
    end
  endgenerate
  assign Y = sum[B_BITS*BITS +: BITS];
endmodule
