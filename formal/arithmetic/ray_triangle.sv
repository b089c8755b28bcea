// The hit rule of ray_triangle against its definition: with s the sign of N.D,
//   t' = s N.T > 0, d = |N.D| > 0, u' = -s (DxT).E2 >= 0, v' = s (DxT).E1 >= 0, u' + v' <= d,
// and a hit is written when nearest_hit says that it is nearer. The operators are replaced by registers that pass
// parts of their operands on, so that the four dot products are free: D.x, V0.x, E2.x and E1.x. The sum u' + v'
// is any word that is zero exactly when both are; it is compared as an integer times 2^-79.
// Assumed, and proven of fp_add: a result whose exponent field is 0 is +0.
module fp_add (input clk_i, input [23:0] a_i, b_i, output [23:0] sum_o);
  reg [95:0] line;
  always @(posedge clk_i) line <= {line[71:0], a_i[23], a_i[22:0] ^ b_i[22:0]};
  assign sum_o = line[95:72];
endmodule

`include "free_products.svh"

module nearest_hit (
  input clk_i,
  input [23:0] t_i, d_i,
  input [20:0] triangle_i,
  input [117:0] best_i,
  output nearer_o, tie_o, rough_tie_o, first_o
);
  reg [2:0] nearer, first;
  always @(posedge clk_i) begin
    nearer <= {nearer[1:0], best_i[117]};
    first <= {first[1:0], best_i[116]};
  end
  assign nearer_o = nearer[2], tie_o = 0, rough_tie_o = 0, first_o = first[2];
endmodule

module miter (
  input clk_i, now,
  input [23:0] nd, nt, e2, e1,
  input [7:0] ray,
  input [20:0] id,
  input nearer, first,    // at @26
  output bad
);
  wire valid_o, hit_o, write_o, first_o;
  wire [7:0] ray_o;
  wire [117:0] result_o;
  wire [23:0] zero = 24'd0;
  ray_triangle unit (
    .clk_i(clk_i), .rst_i(1'b0), .valid_i(now), .ray_i(ray), .triangle_id_i(id),
    .triangle_i({nt, zero, zero, e1, zero, zero, e2, zero, zero, zero, zero, zero}),
    .direction_i({nd, zero, zero}), .origin_i(72'd0), .best_i({nearer, first, 116'd0}),
    .valid_o(valid_o), .hit_o(hit_o), .write_o(write_o), .first_o(first_o), .ray_o(ray_o), .result_o(result_o));

  function canonical(input [23:0] x);
    canonical = x[22:16] != 0 || x == 0;
  endfunction
  function [143:0] scaled(input [22:0] x);
    scaled = x[22:16] == 0 ? 144'd0 : {127'd0, 1'b1, x[15:0]} << x[22:16];
  endfunction
  wire zero_t = nt[22:16] == 0, zero_d = nd[22:16] == 0, zero_u = e2[22:16] == 0, zero_v = e1[22:16] == 0;
  wire sign = nd[23];
  wire [22:0] sum = e2[22:0] ^ e1[22:0];
  wire assumed = canonical(nd) && canonical(nt) && canonical(e2) && canonical(e1)
              && (sum[22:16] == 0) == (zero_u && zero_v) ;
  wire hit = !zero_t && nt[23] == sign && !zero_d && (zero_u || e2[23] != sign) && (zero_v || e1[23] == sign)
          && scaled(sum) <= scaled(nd[22:0]);
  wire [23:0] t = zero_t ? zero : {nt[23] ^ sign, nt[22:0]}, d = zero_d ? zero : {1'b0, nd[22:0]};
  wire [23:0] u = zero_u ? zero : {!e2[23] ^ sign, e2[22:0]}, v = zero_v ? zero : {e1[23] ^ sign, e1[22:0]};

  reg [127:0] line [0:28];
  reg [1:0] side [0:2];
  integer k;
  always @(posedge clk_i) begin
    line[0] <= {now, assumed, hit, ray, id, t, d, u, v};
    side[0] <= {nearer, first};
    for (k = 1; k < 29; k = k + 1) line[k] <= line[k - 1];
    for (k = 1; k < 3; k = k + 1) side[k] <= side[k - 1];
  end
  wire was, ok, was_hit;
  wire [124:0] rest;
  assign {was, ok, was_hit, rest} = line[28];
  wire wrong = hit_o != was_hit || write_o != (was_hit && side[2][1]) || first_o != (was_hit && side[2][0])
            || ray_o != rest[124:117] || result_o != {was_hit, rest[116:0]};
  assign bad = valid_o != was || was && ok && wrong;
endmodule
