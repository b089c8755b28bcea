-- ============================================================================
-- ray_solver - does a ray hit a triangle, and where?
-- ----------------------------------------------------------------------------
--   @4   T = V0 - O                              fp_add        3 operations
--   @11  D x T                                   fp_cross      9
--   @22  N.D, N.T, (D x T).E2, (D x T).E1        fp_dot3      20
--        sign rule: t', u', v', d = |N.D|
--        hit?  -band <= u', -band <= v', 0 < t', 0 < d
--   @26  u' + v', d + band                       fp_add        2
--        hit?  u' + v' <= d + band
-- Moeller's test without the division (docs/ray_triangle.md). 34 operations,
-- each truncating, 68 DSP48 or, with EXPONENT_DSP = false, 34. The sign of N.D
-- is XORed into u', v', t' and N.D, so both facings are found. Unless band is
-- 0, t' far below N's largest component, and d far below that times the ray's
-- length, which band tells, may be of either sign. With CERTIFY = false band is
-- 0: one operation less.
-- model: cmodel/include/raplas/ray_triangle.hpp     tests: tb/unit/ray_solver
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;

entity ray_solver is
  generic (
    GUARD_BITS   : natural range 0 to 2 := 2;
    EXPONENT_DSP : boolean := true;   -- false: exponents in fabric, half the DSP48s
    CERTIFY      : boolean := true    -- false: band_i is ignored, and 0
  );
  port (
    clk_i       : in  std_ulogic;
    rst_i       : in  std_ulogic;
    valid_i     : in  std_ulogic;
    triangle_i  : in  triangle_word_t;
    direction_i : in  ray_word_t;
    origin_i    : in  std_ulogic_vector(3 * FP_BITS - 1 downto 0);   -- x y z
    band_i      : in  fp24_t;       -- error of u', v', d - u' - v'; exponent 0: the plain test
    t_s22_o     : out fp24_t;       -- @22: t' and d, early for depth_quotient
    d_s22_o     : out fp24_t;
    valid_o     : out std_ulogic;   -- @26, as all below
    hit_o       : out std_ulogic;   -- the triangle is hit, or may be
    rough_o     : out std_ulogic;   -- with band_i: t'/d may be some percent from the depth
    unsure_o    : out std_ulogic;   -- or says nothing of it
    t_o         : out fp24_t;
    d_o         : out fp24_t;
    u_o         : out fp24_t;
    v_o         : out fp24_t
  );
end entity ray_solver;

architecture rtl of ray_solver is

  constant VECTOR_BITS  : natural := 3 * FP_BITS;
  constant CROSS_STAGES : natural := MUL_STAGES + ADD_STAGES;
  constant DOT_STAGES   : natural := MUL_STAGES + 2 * ADD_STAGES;
  constant T_STAGE      : natural := ADD_STAGES;
  constant CROSS_STAGE  : natural := T_STAGE + CROSS_STAGES;     -- 11
  constant DOT_STAGE    : natural := CROSS_STAGE + DOT_STAGES;   -- 22
  constant SUM_STAGE    : natural := DOT_STAGE + ADD_STAGES;     -- 26

  subtype vector_t is std_ulogic_vector(VECTOR_BITS - 1 downto 0);
  subtype solution_t is std_ulogic_vector(4 * FP_BITS - 1 downto 0);   -- t' d u' v'
  subtype decided_t is std_ulogic_vector(3 downto 0);
                       -- any place, inside but for the sum, rough, unsure
  subtype fall_t is signed(EXPONENT_BITS + 2 downto 0);

  signal triangle : triangle_t;
  signal v0       : vector_t;
  signal edges    : std_ulogic_vector(2 * VECTOR_BITS - 1 downto 0);   -- E1 E2

  signal t_s4      : vector_t;
  signal vectors   : std_ulogic_vector(2 * VECTOR_BITS - 1 downto 0);  -- D N
  signal vectors_4 : std_ulogic_vector(2 * VECTOR_BITS - 1 downto 0);
  signal edges_s11 : std_ulogic_vector(2 * VECTOR_BITS - 1 downto 0);
  signal cross_s11 : vector_t;
  signal nd_s11    : fp24_t;
  signal nt_s15    : fp24_t;
  signal nd_s22    : fp24_t;
  signal nt_s22    : fp24_t;
  signal e2_s22    : fp24_t;
  signal e1_s22    : fp24_t;

  signal normal_s22   : exponent_t;   -- of N's largest component
  signal band_s22     : fp24_t;
  signal solution_s22 : solution_t;
  signal solution_s26 : solution_t;
  signal decided_s22  : decided_t;
  signal decided_s26  : decided_t;
  signal sum_s26      : fp24_t;
  signal most_s26     : fp24_t;
  signal valid_s0     : std_ulogic_vector(0 downto 0);
  signal valid_s26    : std_ulogic_vector(0 downto 0);

  function larger(a, b : exponent_t) return exponent_t is
  begin
    if a < b then
      return b;
    end if;
    return a;
  end function larger;

  -- by how many powers of two x is below a number with exponent `top`
  function fall(top : exponent_t; x : fp24_t) return fall_t is
  begin
    return signed("000" & top) - signed("000" & exponent_of(x));
  end function fall;

  -- x >= -band
  function not_below(x, band : fp24_t) return boolean is
  begin
    return sign_of(x) = '0' or magnitude_of(x) <= magnitude_of(band);
  end function not_below;

begin

  triangle <= unpack_triangle(triangle_i);
  v0       <= triangle.v0x & triangle.v0y & triangle.v0z;
  edges    <= triangle.e1x & triangle.e1y & triangle.e1z
    & triangle.e2x & triangle.e2y & triangle.e2z;
  vectors  <= direction_i & triangle.nx & triangle.ny & triangle.nz;

  -- s4: T = V0 - O
  t_g : for k in 0 to 2 generate
    t_i : entity raplas.fp_add
      generic map (GUARD_BITS => GUARD_BITS, SUBTRACT => true,
                   EXPONENT_DSP => EXPONENT_DSP)
      port map (
        clk_i => clk_i,
        a_i   => v0((k + 1) * FP_BITS - 1 downto k * FP_BITS),
        b_i   => origin_i((k + 1) * FP_BITS - 1 downto k * FP_BITS),
        sum_o => t_s4((k + 1) * FP_BITS - 1 downto k * FP_BITS)
      );
  end generate t_g;

  vectors_delay : entity raplas.delay
    generic map (WIDTH => 2 * VECTOR_BITS, STAGES => T_STAGE)
    port map (clk_i => clk_i, rst_i => '0', data_i => vectors, data_o => vectors_4);

  -- s11: D x T
  cross_i : entity raplas.fp_cross
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => vectors_4(2 * VECTOR_BITS - 1 downto VECTOR_BITS), b_i => t_s4,
              cross_o => cross_s11);

  edges_delay : entity raplas.delay
    generic map (WIDTH => 2 * VECTOR_BITS, STAGES => CROSS_STAGE)
    port map (clk_i => clk_i, rst_i => '0', data_i => edges, data_o => edges_s11);

  -- s22: the four dot products
  nd_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => vectors(VECTOR_BITS - 1 downto 0),
              b_i => vectors(2 * VECTOR_BITS - 1 downto VECTOR_BITS), dot_o => nd_s11);

  nd_delay : entity raplas.delay
    generic map (WIDTH => FP_BITS, STAGES => DOT_STAGE - DOT_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => nd_s11, data_o => nd_s22);

  nt_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => vectors_4(VECTOR_BITS - 1 downto 0), b_i => t_s4,
              dot_o => nt_s15);

  nt_delay : entity raplas.delay
    generic map (WIDTH => FP_BITS, STAGES => DOT_STAGE - DOT_STAGES - T_STAGE)
    port map (clk_i => clk_i, rst_i => '0', data_i => nt_s15, data_o => nt_s22);

  e2_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => cross_s11, b_i => edges_s11(VECTOR_BITS - 1 downto 0),
              dot_o => e2_s22);

  e1_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => cross_s11,
              b_i => edges_s11(2 * VECTOR_BITS - 1 downto VECTOR_BITS), dot_o => e1_s22);

  -- s22: sign rule; u' has a minus of its own
  solution_s22 <= flip_sign(nt_s22, sign_of(nd_s22)) & flip_sign(nd_s22, sign_of(nd_s22))
    & flip_sign(e2_s22, not sign_of(nd_s22)) & flip_sign(e1_s22, sign_of(nd_s22));

  -- s26: u' + v'
  sum_i : entity raplas.fp_add
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => solution_s22(2 * FP_BITS - 1 downto FP_BITS),
              b_i => solution_s22(FP_BITS - 1 downto 0), sum_o => sum_s26);

  solution_26_delay : entity raplas.delay
    generic map (WIDTH => 4 * FP_BITS, STAGES => ADD_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => solution_s22, data_o => solution_s26);

  -- d + band, and what it takes
  certify_g : if CERTIFY generate
    subtype beside_t is std_ulogic_vector(EXPONENT_BITS + FP_BITS - 1 downto 0);   -- normal band
    signal beside_s0  : beside_t;
    signal beside_s22 : beside_t;
  begin
    beside_s0 <= std_ulogic_vector(larger(exponent_of(triangle.nx),
                                          larger(exponent_of(triangle.ny),
                                                 exponent_of(triangle.nz)))) & band_i;

    beside_delay : entity raplas.delay
      generic map (WIDTH => EXPONENT_BITS + FP_BITS, STAGES => DOT_STAGE)
      port map (clk_i => clk_i, rst_i => '0', data_i => beside_s0, data_o => beside_s22);

    normal_s22 <= unsigned(beside_s22(EXPONENT_BITS + FP_BITS - 1 downto FP_BITS));
    band_s22   <= beside_s22(FP_BITS - 1 downto 0);

    most_i : entity raplas.fp_add
      generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
      port map (clk_i => clk_i, a_i => solution_s22(3 * FP_BITS - 1 downto 2 * FP_BITS),
                b_i => band_s22, sum_o => most_s26);
  end generate certify_g;

  plain_g : if not CERTIFY generate
    normal_s22 <= (others => '0');
    band_s22   <= FP24_ZERO;
    most_s26   <= solution_s26(3 * FP_BITS - 1 downto 2 * FP_BITS);
  end generate plain_g;

  -- s22: all of the decision but u' + v' <= d + band
  decide_p : process (solution_s22, band_s22, normal_s22)
    variable t_v       : fp24_t;
    variable d_v       : fp24_t;
    variable fall_t_v  : fall_t;
    variable fall_d_v  : fall_t;
    variable certify_v : boolean;
    variable before_v  : boolean;
  begin
    t_v := solution_s22(4 * FP_BITS - 1 downto 3 * FP_BITS);
    d_v := solution_s22(3 * FP_BITS - 1 downto 2 * FP_BITS);
    fall_t_v  := fall(normal_s22, t_v);
    -- d grows with the ray's length, as the band does
    fall_d_v  := fall(normal_s22, d_v) + signed("000" & exponent_of(band_s22)) - BAND_EXPONENT;
    certify_v := not is_zero(band_s22);
    before_v  := sign_of(t_v) = '0' and not is_zero(t_v);
    decided_s22 <= (others => '0');
    if certify_v and fall_d_v > BLIND_SHIFT then
      decided_s22(3) <= '1';
    end if;
    if (before_v or (certify_v and fall_t_v > BLIND_SHIFT)) and not is_zero(d_v)
      and not_below(solution_s22(2 * FP_BITS - 1 downto FP_BITS), band_s22)
      and not_below(solution_s22(FP_BITS - 1 downto 0), band_s22) then
      decided_s22(2) <= '1';
    end if;
    if certify_v and (fall_d_v > ROUGH_SHIFT or fall_t_v > ROUGH_SHIFT) then
      decided_s22(1) <= '1';
    end if;
    if certify_v and (fall_d_v > UNSURE_SHIFT or fall_t_v > UNSURE_SHIFT) then
      decided_s22(0) <= '1';
    end if;
  end process decide_p;

  decided_delay : entity raplas.delay
    generic map (WIDTH => 4, STAGES => ADD_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => decided_s22, data_o => decided_s26);

  hit_p : process (decided_s26, sum_s26, most_s26, valid_s26)
    variable hit_v : std_ulogic;
  begin
    hit_v := decided_s26(2);
    if sign_of(sum_s26) = '0' and magnitude_of(sum_s26) > magnitude_of(most_s26) then
      hit_v := '0';
    end if;
    hit_o <= valid_s26(0) and (decided_s26(3) or hit_v);
  end process hit_p;

  valid_s0(0) <= valid_i;

  valid_delay : entity raplas.delay
    generic map (WIDTH => 1, STAGES => SUM_STAGE)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => valid_s0, data_o => valid_s26);

  t_s22_o  <= solution_s22(4 * FP_BITS - 1 downto 3 * FP_BITS);
  d_s22_o  <= solution_s22(3 * FP_BITS - 1 downto 2 * FP_BITS);
  rough_o  <= decided_s26(1);
  unsure_o <= decided_s26(0);
  valid_o  <= valid_s26(0);
  t_o      <= solution_s26(4 * FP_BITS - 1 downto 3 * FP_BITS);
  d_o      <= solution_s26(3 * FP_BITS - 1 downto 2 * FP_BITS);
  u_o      <= solution_s26(2 * FP_BITS - 1 downto FP_BITS);
  v_o      <= solution_s26(FP_BITS - 1 downto 0);

end architecture rtl;
