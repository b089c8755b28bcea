-- ============================================================================
-- ray_triangle - does a ray hit a triangle, and nearer than its best hit?
-- ----------------------------------------------------------------------------
--   @4   T = V0 - O                              fp_add        3 operations
--   @11  D x T                                   fp_cross      9
--   @22  N.D, N.T, (D x T).E2, (D x T).E1        fp_dot3      20
--        sign rule: t', u', v', d = |N.D|
--   @26  u' + v'                                 fp_add        1
--        hit?  0 <= u', 0 <= v', u' + v' <= d, 0 < t', 0 < d
--   @29  nearer than the best hit?               nearest_hit   2
-- Moeller's test without the division (docs/ray_triangle.md). 35 operations,
-- each truncating, 70 DSP48. The sign of N.D is XORed into u', v', t' and N.D,
-- so both facings are found.
-- model: cmodel/include/raplas/ray_triangle.hpp     tests: tb/unit/ray_triangle
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;

entity ray_triangle is
  generic (
    GUARD_BITS : natural range 0 to 2 := 2
  );
  port (
    clk_i         : in  std_ulogic;
    rst_i         : in  std_ulogic;
    valid_i       : in  std_ulogic;
    ray_i         : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    triangle_id_i : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    triangle_i    : in  triangle_word_t;
    direction_i   : in  ray_word_t;
    origin_i      : in  std_ulogic_vector(3 * FP_BITS - 1 downto 0);    -- x y z
    best_ray_o    : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);  -- @24: its best hit, please
    best_i        : in  result_word_t;                                  -- @26
    valid_o       : out std_ulogic;                                     -- @29, as all below
    hit_o         : out std_ulogic;                                     -- the triangle is hit
    write_o       : out std_ulogic;                                -- and nearer: result_o is stored
    first_o       : out std_ulogic;                                    -- and the ray had no hit yet
    ray_o         : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    result_o      : out result_word_t
  );
end entity ray_triangle;

architecture rtl of ray_triangle is

  constant VECTOR_BITS  : natural := 3 * FP_BITS;
  constant CROSS_STAGES : natural := MUL_STAGES + ADD_STAGES;
  constant DOT_STAGES   : natural := MUL_STAGES + 2 * ADD_STAGES;
  constant T_STAGE      : natural := ADD_STAGES;
  constant CROSS_STAGE  : natural := T_STAGE + CROSS_STAGES;     -- 11
  constant DOT_STAGE    : natural := CROSS_STAGE + DOT_STAGES;   -- 22
  constant SUM_STAGE    : natural := DOT_STAGE + ADD_STAGES;     -- 26
  constant BEST_STAGE   : natural := SUM_STAGE - MEMORY_STAGES;  -- 24
  constant ID_WIDTH     : natural := ID_BITS + 2 * LINE_BITS;

  subtype vector_t is std_ulogic_vector(VECTOR_BITS - 1 downto 0);
  subtype pair_t is std_ulogic_vector(ID_WIDTH - 1 downto 0);
  subtype solution_t is std_ulogic_vector(4 * FP_BITS - 1 downto 0);   -- t' d u' v'

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

  signal solution_s22 : solution_t;
  signal solution_s26 : solution_t;
  signal solution_s29 : solution_t;
  signal sum_s26      : fp24_t;

  signal pair_s0   : pair_t;
  signal pair_s24  : pair_t;
  signal pair_s26  : pair_t;
  signal pair_s29  : pair_t;
  signal valid_s0  : std_ulogic_vector(0 downto 0);
  signal valid_s26 : std_ulogic_vector(0 downto 0);
  signal event_s26 : std_ulogic_vector(1 downto 0);   -- valid, hit
  signal event_s29 : std_ulogic_vector(1 downto 0);
  signal nearer    : std_ulogic;
  signal first     : std_ulogic;

begin

  triangle <= unpack_triangle(triangle_i);
  v0       <= triangle.v0x & triangle.v0y & triangle.v0z;
  edges    <= triangle.e1x & triangle.e1y & triangle.e1z
    & triangle.e2x & triangle.e2y & triangle.e2z;
  vectors  <= direction_i & triangle.nx & triangle.ny & triangle.nz;

  -- s4: T = V0 - O
  t_g : for k in 0 to 2 generate
    t_i : entity raplas.fp_add
      generic map (GUARD_BITS => GUARD_BITS, SUBTRACT => true)
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
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => vectors_4(2 * VECTOR_BITS - 1 downto VECTOR_BITS), b_i => t_s4,
              cross_o => cross_s11);

  edges_delay : entity raplas.delay
    generic map (WIDTH => 2 * VECTOR_BITS, STAGES => CROSS_STAGE)
    port map (clk_i => clk_i, rst_i => '0', data_i => edges, data_o => edges_s11);

  -- s22: the four dot products
  nd_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => vectors(VECTOR_BITS - 1 downto 0),
              b_i => vectors(2 * VECTOR_BITS - 1 downto VECTOR_BITS), dot_o => nd_s11);

  nd_delay : entity raplas.delay
    generic map (WIDTH => FP_BITS, STAGES => DOT_STAGE - DOT_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => nd_s11, data_o => nd_s22);

  nt_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => vectors_4(VECTOR_BITS - 1 downto 0), b_i => t_s4,
              dot_o => nt_s15);

  nt_delay : entity raplas.delay
    generic map (WIDTH => FP_BITS, STAGES => DOT_STAGE - DOT_STAGES - T_STAGE)
    port map (clk_i => clk_i, rst_i => '0', data_i => nt_s15, data_o => nt_s22);

  e2_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => cross_s11, b_i => edges_s11(VECTOR_BITS - 1 downto 0),
              dot_o => e2_s22);

  e1_i : entity raplas.fp_dot3
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => cross_s11,
              b_i => edges_s11(2 * VECTOR_BITS - 1 downto VECTOR_BITS), dot_o => e1_s22);

  -- s22: sign rule; u' has a minus of its own
  solution_s22 <= flip_sign(nt_s22, sign_of(nd_s22)) & flip_sign(nd_s22, sign_of(nd_s22))
    & flip_sign(e2_s22, not sign_of(nd_s22)) & flip_sign(e1_s22, sign_of(nd_s22));

  -- s26: u' + v'
  sum_i : entity raplas.fp_add
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => solution_s22(2 * FP_BITS - 1 downto FP_BITS),
              b_i => solution_s22(FP_BITS - 1 downto 0), sum_o => sum_s26);

  solution_26_delay : entity raplas.delay
    generic map (WIDTH => 4 * FP_BITS, STAGES => ADD_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => solution_s22, data_o => solution_s26);

  hit_p : process (solution_s26, sum_s26, valid_s26)
    variable t_v   : fp24_t;
    variable d_v   : fp24_t;
    variable u_v   : fp24_t;
    variable v_v   : fp24_t;
    variable hit_v : std_ulogic;
  begin
    t_v := solution_s26(4 * FP_BITS - 1 downto 3 * FP_BITS);
    d_v := solution_s26(3 * FP_BITS - 1 downto 2 * FP_BITS);
    u_v := solution_s26(2 * FP_BITS - 1 downto FP_BITS);
    v_v := solution_s26(FP_BITS - 1 downto 0);
    hit_v := valid_s26(0);
    if sign_of(t_v) = '1' or is_zero(t_v) or is_zero(d_v)
      or sign_of(u_v) = '1' or sign_of(v_v) = '1'
      or magnitude_of(sum_s26) > magnitude_of(d_v) then
      hit_v := '0';
    end if;
    event_s26 <= valid_s26(0) & hit_v;
  end process hit_p;

  -- s29: nearer than the best hit of the ray?
  nearest_i : entity raplas.nearest_hit
    port map (
      clk_i      => clk_i,
      t_i        => solution_s26(4 * FP_BITS - 1 downto 3 * FP_BITS),
      d_i        => solution_s26(3 * FP_BITS - 1 downto 2 * FP_BITS),
      triangle_i => pair_s26(ID_WIDTH - 1 downto 2 * LINE_BITS),
      best_i     => best_i,
      nearer_o   => nearer,
      first_o    => first
    );

  solution_29_delay : entity raplas.delay
    generic map (WIDTH => 4 * FP_BITS, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => solution_s26, data_o => solution_s29);

  -- the pair and its valid bit beside the data
  pair_s0     <= triangle_id_i & ray_i;
  valid_s0(0) <= valid_i;

  pair_24_delay : entity raplas.delay
    generic map (WIDTH => ID_WIDTH, STAGES => BEST_STAGE)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s0, data_o => pair_s24);

  pair_26_delay : entity raplas.delay
    generic map (WIDTH => ID_WIDTH, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s24, data_o => pair_s26);

  pair_29_delay : entity raplas.delay
    generic map (WIDTH => ID_WIDTH, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s26, data_o => pair_s29);

  valid_delay : entity raplas.delay
    generic map (WIDTH => 1, STAGES => SUM_STAGE)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => valid_s0, data_o => valid_s26);

  event_delay : entity raplas.delay
    generic map (WIDTH => 2, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => event_s26, data_o => event_s29);

  best_ray_o <= pair_s24(2 * LINE_BITS - 1 downto 0);
  valid_o    <= event_s29(1);
  hit_o      <= event_s29(0);
  write_o    <= event_s29(0) and nearer;
  first_o    <= event_s29(0) and first;
  ray_o      <= pair_s29(2 * LINE_BITS - 1 downto 0);
  result_o   <= event_s29(0) & pair_s29(ID_WIDTH - 1 downto 2 * LINE_BITS) & solution_s29;

end architecture rtl;
