// dsp_plane_test against its definition in integers, in each MODE, for all words: a plane loaded in the clock of x
// (and none in the two clocks after), y one clock later, z two, R four. d = n.c + p fits 40 bits, and is computed
// in 48. The three products are free words, but of the right operands: mul_pair.v. Any operands in all other
// clocks.
module miter (
  input clk_i, now, load,
  input signed [17:0] nx, ny, nz,
  input signed [35:0] p,
  input signed [17:0] x, y, z,
  input [17:0] r,
  output bad
);
  parameter MODE = 0;
  wire above, meets;
  wire signed [47:0] sum;
  dsp_plane_test unit (.clk_i(clk_i), .load_i(load), .nx_i(nx), .ny_i(ny), .nz_i(nz), .p_i(p), .x_i(x), .y_i(y),
                       .z_i(z), .r_i(r), .above_o(above), .meets_o(meets), .sum_o(sum));

  // index k: k + 1 clocks old
  reg [5:0] nows, loads;
  reg [107:0] nxs, nys, nzs, xs, ys, zs, rs;
  reg [215:0] ps;
  always @(posedge clk_i) begin
    nows <= {nows[4:0], now};
    loads <= {loads[4:0], load};
    {nxs, nys, nzs} <= {nxs[89:0], nx, nys[89:0], ny, nzs[89:0], nz};
    {xs, ys, zs, rs} <= {xs[89:0], x, ys[89:0], y, zs[89:0], z, rs[89:0], r};
    ps <= {ps[179:0], p};
  end
  wire signed [17:0] nx0 = nxs[107:90], ny0 = nys[107:90], nz0 = nzs[107:90];
  wire signed [17:0] x0 = xs[107:90], y1 = ys[89:72], z2 = zs[71:54];
  wire signed [35:0] p0 = ps[215:180], px = x0 * nx0, py = y1 * ny0, pz = z2 * nz0;
  wire signed [47:0] d = p0 + px + py + pz;
  wire signed [47:0] reach = {13'd0, rs[35:18], 17'd0};
  wire signed [47:0] magnitude = d < 0 ? -d : d;
  wire assumed = nows[5] && loads[5] && !loads[4] && !loads[3];

  wire defined_meets = MODE == 0 ? magnitude <= reach : MODE == 1 ? d + reach >= 0 : d - reach >= 0;
  wire signed [47:0] defined_sum = MODE == 1 || MODE == 0 && d < 0 ? d + reach
                                 : MODE == 0 ? d - reach - 1 : d - reach;
  // a sum of 48 bits is the integer itself: nothing wrapped
  wire fits = d >= -48'sd549755813888 && d < 48'sd549755813888;
  assign bad = assumed && (above != (d >= 0) || meets != defined_meets || sum != defined_sum || !fits);
endmodule
