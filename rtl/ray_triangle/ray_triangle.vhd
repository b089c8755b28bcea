-- ============================================================================
-- ray_triangle - does a ray hit a triangle, and nearer than its best hit?
-- ----------------------------------------------------------------------------
--   @26  hit? t', u', v', d                      ray_solver   33 operations
--   @29  nearer than the best hit?               nearest_hit   2
-- 35 operations, 70 DSP48 (docs/ray_triangle.md).
-- model: cmodel/include/raplas/ray_triangle.hpp     tests: tb/unit/ray_triangle
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library raplas;
use raplas.raplas_constants.all;

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

  constant SUM_STAGE  : natural := 2 * MUL_STAGES + 5 * ADD_STAGES;   -- 26: latency of ray_solver
  constant BEST_STAGE : natural := SUM_STAGE - MEMORY_STAGES;         -- 24
  constant ID_WIDTH   : natural := ID_BITS + 2 * LINE_BITS;

  subtype pair_t is std_ulogic_vector(ID_WIDTH - 1 downto 0);
  subtype solution_t is std_ulogic_vector(4 * FP_BITS - 1 downto 0);   -- t' d u' v'

  signal solution_s26 : solution_t;
  signal solution_s29 : solution_t;
  signal pair_s0      : pair_t;
  signal pair_s24     : pair_t;
  signal pair_s26     : pair_t;
  signal pair_s29     : pair_t;
  signal event_s26    : std_ulogic_vector(1 downto 0);   -- valid, hit
  signal event_s29    : std_ulogic_vector(1 downto 0);
  signal nearer       : std_ulogic;
  signal first        : std_ulogic;

begin

  -- s26
  solver_i : entity raplas.ray_solver
    generic map (GUARD_BITS => GUARD_BITS, CERTIFY => false)
    port map (
      clk_i       => clk_i,
      rst_i       => rst_i,
      valid_i     => valid_i,
      triangle_i  => triangle_i,
      direction_i => direction_i,
      origin_i    => origin_i,
      band_i      => (others => '0'),
      t_s22_o     => open,
      d_s22_o     => open,
      valid_o     => event_s26(1),
      hit_o       => event_s26(0),
      rough_o     => open,
      unsure_o    => open,
      t_o         => solution_s26(4 * FP_BITS - 1 downto 3 * FP_BITS),
      d_o         => solution_s26(3 * FP_BITS - 1 downto 2 * FP_BITS),
      u_o         => solution_s26(2 * FP_BITS - 1 downto FP_BITS),
      v_o         => solution_s26(FP_BITS - 1 downto 0)
    );

  -- s29: nearer than the best hit of the ray?
  nearest_i : entity raplas.nearest_hit
    port map (
      clk_i      => clk_i,
      t_i        => solution_s26(4 * FP_BITS - 1 downto 3 * FP_BITS),
      d_i        => solution_s26(3 * FP_BITS - 1 downto 2 * FP_BITS),
      triangle_i => pair_s26(ID_WIDTH - 1 downto 2 * LINE_BITS),
      best_i     => best_i,
      nearer_o   => nearer,
      tie_o      => open,
      rough_tie_o => open,
      first_o    => first
    );

  solution_29_delay : entity raplas.delay
    generic map (WIDTH => 4 * FP_BITS, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => solution_s26, data_o => solution_s29);

  -- the pair beside the data
  pair_s0 <= triangle_id_i & ray_i;

  pair_24_delay : entity raplas.delay
    generic map (WIDTH => ID_WIDTH, STAGES => BEST_STAGE)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s0, data_o => pair_s24);

  pair_26_delay : entity raplas.delay
    generic map (WIDTH => ID_WIDTH, STAGES => MEMORY_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s24, data_o => pair_s26);

  pair_29_delay : entity raplas.delay
    generic map (WIDTH => ID_WIDTH, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => pair_s26, data_o => pair_s29);

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
