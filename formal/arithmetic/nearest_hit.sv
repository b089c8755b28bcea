// nearest_hit's comparison against its definition: this product < the best hit's product in exact integers; if
// equal, the lower triangle ID; always if the ray has no hit yet. And its tie: the places of the two products are
// less than 3 * 2^25 apart (a rough tie: 2^29), on a scale on which powers of two are 2^33 apart, and even between them. One case for each difference of the exponents,
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
  wire nearer, tie, rough_tie, first;
  wire [23:0] t, d, best_t, best_d;
  assign {t, best_d} = {5'd0, this_exponent, this_significand};
  assign {best_t, d} = {5'd0, best_exponent, best_significand};
  nearest_hit unit (.clk_i(clk_i), .t_i(t), .d_i(d), .triangle_i(this_id),
                    .best_i({best_hit, best_id, best_t, best_d, 48'd0}), .nearer_o(nearer), .tie_o(tie), .rough_tie_o(rough_tie), .first_o(first));

  wire [7:0] up = difference < 0 ? 0 : difference, down = difference < 0 ? -difference : 0;
  wire [289:0] this_exact = this_significand << up, best_exact = best_significand << down;
  wire assumed = this_significand[33:32] != 0 && best_significand[33:32] != 0
              && this_exponent - best_exponent == difference
              && this_exponent >= -61 && this_exponent <= 191 && best_exponent >= -61 && best_exponent <= 191;
  wire defined = !best_hit || this_exact < best_exact || this_exact == best_exact && this_id < best_id;
  function signed [35:0] place(input [33:0] significand);   // within the exponent: linear from power to power
    place = significand[33] ? {2'd0, significand} : 2 * {2'd0, significand} - 36'sh200000000;
  endfunction
  wire signed [44:0] apart = difference * 45'sh200000000 + place(this_significand) - place(best_significand);
  wire tied = apart >= -45'sh6000000 && apart < 45'sh6000000;
  wire rough_tied = apart >= -45'sh20000000 && apart < 45'sh20000000;
  reg [4:0] line1, line2, line3;
  always @(posedge clk_i) begin
    line1 <= {now && assumed, defined, tied, rough_tied, !best_hit};
    line2 <= line1;
    line3 <= line2;
  end
  assign bad = line3[4] && {nearer, tie, rough_tie, first} != line3[3:0];
endmodule
