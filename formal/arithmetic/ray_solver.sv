// The hit rule of ray_solver with certified hits against its definition: with s the sign of N.D,
//   t' = s N.T, d = |N.D|, u' = -s (DxT).E2, v' = s (DxT).E1, and top the largest exponent of N's components,
// plain (the band's exponent is 0): 0 < t', 0 < d, 0 <= u', 0 <= v', u' + v' <= d; neither rough nor unsure;
// else: small(d, BLIND_SHIFT), or
//   0 < t' or small(t', BLIND_SHIFT), 0 < d, -band <= u', -band <= v', u' + v' <= d + band;
//   rough: small(t', ROUGH_SHIFT) or small(d, ROUGH_SHIFT); unsure: the same with UNSURE_SHIFT,
// where small(t', k): its exponent + k < top, and small(d, k): its exponent + k + BAND_EXPONENT < top + the band's.
// The operators are replaced by registers that pass parts of their operands on, so that the four dot products are
// free: D.x, V0.x, E2.x and E1.x, and N too. The sums u' + v' and d + band are mixtures of their operands' bits, but
// a + 0 is a.
// Assumed, and proven of fp_add: a result whose exponent field is 0 is +0; a + 0 = a; neither of two numbers above 0
// nor of zeros is a sum below 0. The band is not negative.
module fp_add (input clk_i, input [23:0] a_i, b_i, output [23:0] sum_o);
  reg [95:0] line;
  wire [23:0] b = b_i[22:16] == 0 ? 24'd0 : b_i;
  always @(posedge clk_i) line <= {line[71:0], a_i ^ {b[10:0], b[23:11]}};
  assign sum_o = line[95:72];
endmodule

`include "free_products.svh"

module miter (
  input clk_i, now,
  input [23:0] nd, nt, e2, e1, nx, ny, nz, band,
  output bad
);
  localparam BAND_EXPONENT = 49, ROUGH_SHIFT = 2, UNSURE_SHIFT = 4, BLIND_SHIFT = 10;
  wire valid_o, hit_o, rough_o, unsure_o;
  wire [23:0] t_o, d_o, u_o, v_o;
  wire [23:0] zero = 24'd0;
  ray_solver unit (
    .clk_i(clk_i), .rst_i(1'b0), .valid_i(now),
    .triangle_i({nt, zero, zero, e1, zero, zero, e2, zero, zero, nx, ny, nz}),
    .direction_i({nd, zero, zero}), .origin_i(72'd0), .band_i(band),
    .valid_o(valid_o), .hit_o(hit_o), .rough_o(rough_o), .unsure_o(unsure_o), .t_o(t_o), .d_o(d_o), .u_o(u_o),
    .v_o(v_o));

  function canonical(input [23:0] x);
    canonical = x[22:16] != 0 || x == 0;
  endfunction
  function [23:0] sum_of(input [23:0] a, b);
    sum_of = a ^ (b[22:16] == 0 ? 24'd0 : {b[10:0], b[23:11]});
  endfunction
  function positive(input [23:0] x);
    positive = x[22:16] != 0 && !x[23];
  endfunction
  function at_most(input [23:0] a, b);  // |a| <= |b|: exponents, then fractions
    at_most = a[22:16] == 0 || b[22:16] != 0
           && (a[22:16] < b[22:16] || a[22:16] == b[22:16] && a[15:0] <= b[15:0]);
  endfunction
  function small_t(input [23:0] x, input [7:0] shift, input [23:0] n1, n2, n3);  // any component of N
    reg [7:0] raised;
    begin
      raised = {1'b0, x[22:16]} + shift;
      small_t = n1[22:16] > raised || n2[22:16] > raised || n3[22:16] > raised;
    end
  endfunction
  function small_d(input [23:0] x, input [7:0] shift, input [23:0] n1, n2, n3, width);
    reg [8:0] raised, wide;
    begin
      raised = x[22:16] + shift + BAND_EXPONENT;
      wide = {2'b00, width[22:16]};
      small_d = n1[22:16] + wide > raised || n2[22:16] + wide > raised || n3[22:16] + wide > raised;
    end
  endfunction

  wire sign = nd[23];
  function [23:0] signed_by(input [23:0] x, input flip);
    signed_by = x[22:16] == 0 ? 24'd0 : {x[23] ^ flip, x[22:0]};
  endfunction
  wire [23:0] t = signed_by(nt, sign), d = signed_by(nd, sign);
  wire [23:0] u = signed_by(e2, !sign), v = signed_by(e1, sign);
  wire [23:0] sum = sum_of(u, v), most = sum_of(d, band);
  wire certify = band[22:16] != 0;
  wire assumed = canonical(nd) && canonical(nt) && canonical(e2) && canonical(e1) && canonical(sum) && canonical(most)
              && !most[23] && (certify ? !band[23] : u[23] || v[23] || !sum[23]);

  wire plain = positive(t) && positive(d) && !u[23] && !v[23] && at_most(sum, d);
  wire any_place = small_d(d, BLIND_SHIFT, nx, ny, nz, band), any_depth = small_t(t, BLIND_SHIFT, nx, ny, nz);
  wire inside = (!u[23] || at_most(u, band)) && (!v[23] || at_most(v, band)) && (sum[23] || at_most(sum, most));
  wire possible = any_place || inside && (positive(t) || any_depth) && positive(d);
  wire hit = certify ? possible : plain;
  wire rough = certify && (small_d(d, ROUGH_SHIFT, nx, ny, nz, band) || small_t(t, ROUGH_SHIFT, nx, ny, nz));
  wire unsure = certify && (small_d(d, UNSURE_SHIFT, nx, ny, nz, band) || small_t(t, UNSURE_SHIFT, nx, ny, nz));

  reg [100:0] line [0:25];
  integer k;
  always @(posedge clk_i) begin
    line[0] <= {now, assumed, hit, rough, unsure, t, d, u, v};
    for (k = 1; k < 26; k = k + 1) line[k] <= line[k - 1];
  end
  wire was, ok, was_hit, was_rough, was_unsure;
  wire [95:0] solution;
  assign {was, ok, was_hit, was_rough, was_unsure, solution} = line[25];
  wire wrong = hit_o != was_hit || rough_o != was_rough || unsure_o != was_unsure
            || {t_o, d_o, u_o, v_o} != solution;
  assign bad = valid_o != was || was && ok && wrong;
endmodule
