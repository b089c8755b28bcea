-- ============================================================================
-- plane_sphere_subunit - one sphere against NUM_ROWS + NUM_COLUMNS planes a clock
-- ----------------------------------------------------------------------------
--   @12  a flag for each plane, valid, tag       plane_sphere_tester
-- The sphere is broadcast to all testers, each with a plane of its own. The tag
-- passes beside them. 12 DSP48 a plane: 96 for 4 + 4.
-- model: cmodel/include/raplas/plane_sphere.hpp     tests: tb/unit/plane_sphere_subunit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library raplas;
use raplas.raplas_constants.all;

entity plane_sphere_subunit is
  generic (
    NUM_ROWS    : positive := 4;
    NUM_COLUMNS : positive := 4;
    TAG_BITS    : positive := 1;
    GUARD_BITS  : natural range 0 to 2 := 2
  );
  port (
    clk_i          : in  std_ulogic;
    rst_i          : in  std_ulogic;
    valid_i        : in  std_ulogic;
    ball_i         : in  std_ulogic_vector(4 * FP_BITS - 1 downto 0);  -- cx cy cz r
    planes_i       : in  std_ulogic_vector((NUM_ROWS + NUM_COLUMNS) * PLANE_BITS - 1 downto 0);
                      -- row planes from the low end, then columns
    tag_i          : in  std_ulogic_vector(TAG_BITS - 1 downto 0);
    valid_o        : out std_ulogic;
    row_flags_o    : out std_ulogic_vector(NUM_ROWS - 1 downto 0);
    column_flags_o : out std_ulogic_vector(NUM_COLUMNS - 1 downto 0);
    tag_o          : out std_ulogic_vector(TAG_BITS - 1 downto 0)
  );
end entity plane_sphere_subunit;

architecture rtl of plane_sphere_subunit is
  constant NUM_PLANES : positive := NUM_ROWS + NUM_COLUMNS;
  constant STAGES     : positive := MUL_STAGES + 2 * ADD_STAGES + COMPARE_STAGES;

  signal flags     : std_ulogic_vector(NUM_PLANES - 1 downto 0);
  signal valid_s0  : std_ulogic_vector(0 downto 0);
  signal valid_s12 : std_ulogic_vector(0 downto 0);
begin

  testers_g : for k in 0 to NUM_PLANES - 1 generate
    tester_i : entity raplas.plane_sphere_tester
      generic map (GUARD_BITS => GUARD_BITS)
      port map (
        clk_i   => clk_i,
        plane_i => planes_i((k + 1) * PLANE_BITS - 1 downto k * PLANE_BITS),
        ball_i  => ball_i,
        meets_o => flags(k)
      );
  end generate testers_g;

  valid_s0(0) <= valid_i;

  valid_delay : entity raplas.delay
    generic map (WIDTH => 1, STAGES => STAGES)
    port map (clk_i => clk_i, rst_i => rst_i, data_i => valid_s0, data_o => valid_s12);

  tag_delay : entity raplas.delay
    generic map (WIDTH => TAG_BITS, STAGES => STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => tag_i, data_o => tag_o);

  valid_o        <= valid_s12(0);
  row_flags_o    <= flags(NUM_ROWS - 1 downto 0);
  column_flags_o <= flags(NUM_PLANES - 1 downto NUM_ROWS);

end architecture rtl;
