// nearest_hit's comparison against its definition: this product < the best hit's product in exact integers; if
// equal, the lower triangle ID; always if the ray has no hit yet. One case for each difference of the exponents,
// -252 .. 252: `difference` is a constant of the case, the rest is free.
// The products are free too: fp_product is replaced by registers that pass 43 of its operands' 48 bits on, as
// significand and exponent. Assumed, and proven of fp_product for operands other than zero: significands from
// 2^32 on, exponents -61 .. 191.
module fp_product (
  input clk_i,
  input [23:0] a_i, b_i,
  output [33:0] significand_o,
  output [8:0] exponent_o
);
  reg [42:0] line1, line2;
  always @(posedge clk_i) begin
    line1 <= {a_i, b_i};
    line2 <= line1;
  end
  assign {exponent_o, significand_o} = line2;
endmodule

module miter (
  input clk_i, now,
  input signed [9:0] difference,
  input [33:0] this_significand, best_significand,
  input signed [8:0] this_exponent, best_exponent,
  input best_hit,
  input [20:0] this_id, best_id,
  output bad
);
  wire nearer, first;
  wire [23:0] t, d, best_t, best_d;
  assign {t, best_d} = {5'd0, this_exponent, this_significand};
  assign {best_t, d} = {5'd0, best_exponent, best_significand};
  nearest_hit unit (.clk_i(clk_i), .t_i(t), .d_i(d), .triangle_i(this_id),
                    .best_i({best_hit, best_id, best_t, best_d, 48'd0}), .nearer_o(nearer), .first_o(first));

  wire [7:0] up = difference < 0 ? 0 : difference, down = difference < 0 ? -difference : 0;
  wire [289:0] this_exact = this_significand << up, best_exact = best_significand << down;
  wire assumed = this_significand[33:32] != 0 && best_significand[33:32] != 0
              && this_exponent - best_exponent == difference
              && this_exponent >= -61 && this_exponent <= 191 && best_exponent >= -61 && best_exponent <= 191;
  wire defined = !best_hit || this_exact < best_exact || this_exact == best_exact && this_id < best_id;
  reg [2:0] line1, line2, line3;
  always @(posedge clk_i) begin
    line1 <= {now && assumed, defined, !best_hit};
    line2 <= line1;
    line3 <= line2;
  end
  assign bad = line3[2] && {nearer, first} != line3[1:0];
endmodule
