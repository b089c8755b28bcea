-- ============================================================================
-- fixed_testers - an object against all planes of a pencil, one each clock
-- ----------------------------------------------------------------------------
-- An object is a sphere, or a vertex (r = 0); its reach is R = r + slack. 16 row planes,
-- 16 column planes: met if |d| <= R, above if d >= 0. Near plane: near_o if d + R >= 0.
-- Depth plane: depth_sum_code_o is the floor of d - R, z_o a lower bound of it. Down and
-- across plane: d + R itself. Exact but for the floor.
--   @1  R; y, z and R are delayed as the cascades want them
--   @6  all sums                                 dsp_plane_test
--   @8  depth code                               depth_code; all else is delayed
-- Planes loaded in clock k count for objects given from clock k + 1 on, and for none
-- given up to k - 2. 144 DSP48.
-- model: cmodel/include/raplas/fixed_point.hpp     tests: tb/unit/fixed_testers
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity fixed_testers is
  port (
    clk_i            : in  std_ulogic;
    load_i           : in  std_ulogic;             -- a plane of each side
    row_plane_i      : in  fixed_plane_word_t;     -- nx ny nz p: row, near or down plane
    column_plane_i   : in  fixed_plane_word_t;     -- column, depth or across plane
    index_i          : in  std_ulogic_vector(PLANE_INDEX_BITS - 1 downto 0);  -- of both
    object_i         : in  std_ulogic_vector(4 * COORDINATE_BITS - 1 downto 0);  -- x y z r
    slack_i          : in  std_ulogic_vector(COORDINATE_BITS - 1 downto 0);  -- r + slack < 2^18
    rows_meet_o      : out std_ulogic_vector(MAX_ROWS - 1 downto 0);  -- all outputs
    rows_above_o     : out std_ulogic_vector(MAX_ROWS - 1 downto 0);  -- PLANE_TEST_STAGES +
    columns_meet_o   : out std_ulogic_vector(MAX_COLUMNS - 1 downto 0);  -- DEPTH_CODE_STAGES
    columns_above_o  : out std_ulogic_vector(MAX_COLUMNS - 1 downto 0);  -- after object_i
    near_o           : out std_ulogic;
    z_o              : out std_ulogic_vector(DEPTH_BITS - 1 downto 0);
    depth_sum_code_o : out std_ulogic_vector(DEPTH_BITS - 1 downto 0);  -- without the margin
    down_sum_o       : out std_ulogic_vector(PLANE_SUM_BITS - 1 downto 0);  -- signed
    across_sum_o     : out std_ulogic_vector(PLANE_SUM_BITS - 1 downto 0)
  );
end entity fixed_testers;

architecture rtl of fixed_testers is
  constant LINES  : natural := MAX_ROWS + MAX_COLUMNS;
  constant B      : natural := COORDINATE_BITS;
  constant Y_SKEW : natural := 1;  -- clocks after x, as dsp_plane_test wants them
  constant Z_SKEW : natural := 2;
  constant R_SKEW : natural := 4;

  signal load         : std_ulogic_vector(SIDE_PLANES - 1 downto 0);  -- a clock after load_i
  signal row_plane    : fixed_plane_t;
  signal column_plane : fixed_plane_t;
  signal x            : std_ulogic_vector(B - 1 downto 0);
  signal y            : std_ulogic_vector(B - 1 downto 0);
  signal z            : std_ulogic_vector(B - 1 downto 0);
  signal reach        : std_ulogic_vector(B - 1 downto 0);  -- R, a clock after the object
  signal r            : std_ulogic_vector(B - 1 downto 0);
  signal meets        : std_ulogic_vector(LINES downto 0);  -- near plane, columns, rows
  signal above        : std_ulogic_vector(LINES - 1 downto 0);
  signal depth        : std_ulogic_vector(47 downto 0);
  signal down_sum     : std_ulogic_vector(47 downto 0);
  signal across_sum   : std_ulogic_vector(47 downto 0);
  signal flags        : std_ulogic_vector(2 * LINES downto 0);
  signal late         : std_ulogic_vector(2 * LINES downto 0);
begin

  load_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      row_plane    <= unpack_fixed_plane(row_plane_i);
      column_plane <= unpack_fixed_plane(column_plane_i);
      for k in load'range loop
        if load_i = '1' and unsigned(index_i) = k then
          load(k) <= '1';
        else
          load(k) <= '0';
        end if;
      end loop;
    end if;
  end process load_p;

  reach_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      reach <= std_ulogic_vector(unsigned(object_i(B - 1 downto 0)) + unsigned(slack_i));
    end if;
  end process reach_p;

  x <= object_i(4 * B - 1 downto 3 * B);

  y_i : entity raplas.delay
    generic map (WIDTH => B, STAGES => Y_SKEW)
    port map (clk_i => clk_i, rst_i => '0', data_i => object_i(3 * B - 1 downto 2 * B),
              data_o => y);

  z_i : entity raplas.delay
    generic map (WIDTH => B, STAGES => Z_SKEW)
    port map (clk_i => clk_i, rst_i => '0', data_i => object_i(2 * B - 1 downto B), data_o => z);

  r_i : entity raplas.delay
    generic map (WIDTH => B, STAGES => R_SKEW - 1)
    port map (clk_i => clk_i, rst_i => '0', data_i => reach, data_o => r);

  lines_g : for k in 0 to MAX_ROWS - 1 generate
    row_i : entity raplas.dsp_plane_test
      generic map (MODE => 0)
      port map (clk_i => clk_i, load_i => load(k),
                nx_i => row_plane.nx, ny_i => row_plane.ny, nz_i => row_plane.nz,
                p_i => row_plane.p, x_i => x, y_i => y, z_i => z, r_i => r,
                above_o => above(k), meets_o => meets(k), sum_o => open);

    column_i : entity raplas.dsp_plane_test
      generic map (MODE => 0)
      port map (clk_i => clk_i, load_i => load(k),
                nx_i => column_plane.nx, ny_i => column_plane.ny, nz_i => column_plane.nz,
                p_i => column_plane.p, x_i => x, y_i => y, z_i => z, r_i => r,
                above_o => above(MAX_ROWS + k), meets_o => meets(MAX_ROWS + k), sum_o => open);
  end generate lines_g;

  near_i : entity raplas.dsp_plane_test
    generic map (MODE => 1)
    port map (clk_i => clk_i, load_i => load(AXIS_PLANE),
              nx_i => row_plane.nx, ny_i => row_plane.ny, nz_i => row_plane.nz,
              p_i => row_plane.p, x_i => x, y_i => y, z_i => z, r_i => r,
              above_o => open, meets_o => meets(LINES), sum_o => open);

  depth_i : entity raplas.dsp_plane_test
    generic map (MODE => 2)
    port map (clk_i => clk_i, load_i => load(AXIS_PLANE),
              nx_i => column_plane.nx, ny_i => column_plane.ny, nz_i => column_plane.nz,
              p_i => column_plane.p, x_i => x, y_i => y, z_i => z, r_i => r,
              above_o => open, meets_o => open, sum_o => depth);

  down_i : entity raplas.dsp_plane_test
    generic map (MODE => 1)
    port map (clk_i => clk_i, load_i => load(GRID_PLANE),
              nx_i => row_plane.nx, ny_i => row_plane.ny, nz_i => row_plane.nz,
              p_i => row_plane.p, x_i => x, y_i => y, z_i => z, r_i => r,
              above_o => open, meets_o => open, sum_o => down_sum);

  across_i : entity raplas.dsp_plane_test
    generic map (MODE => 1)
    port map (clk_i => clk_i, load_i => load(GRID_PLANE),
              nx_i => column_plane.nx, ny_i => column_plane.ny, nz_i => column_plane.nz,
              p_i => column_plane.p, x_i => x, y_i => y, z_i => z, r_i => r,
              above_o => open, meets_o => open, sum_o => across_sum);

  code_i : entity raplas.depth_code
    port map (clk_i => clk_i, d_i => depth, code_o => depth_sum_code_o, z_o => z_o);

  flags <= above & meets;

  flags_i : entity raplas.delay
    generic map (WIDTH => 2 * LINES + 1, STAGES => DEPTH_CODE_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => flags, data_o => late);

  down_delay_i : entity raplas.delay
    generic map (WIDTH => PLANE_SUM_BITS, STAGES => DEPTH_CODE_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => down_sum(PLANE_SUM_BITS - 1 downto 0),
              data_o => down_sum_o);

  across_delay_i : entity raplas.delay
    generic map (WIDTH => PLANE_SUM_BITS, STAGES => DEPTH_CODE_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => across_sum(PLANE_SUM_BITS - 1 downto 0),
              data_o => across_sum_o);

  rows_meet_o     <= late(MAX_ROWS - 1 downto 0);
  columns_meet_o  <= late(LINES - 1 downto MAX_ROWS);
  near_o          <= late(LINES);
  rows_above_o    <= late(LINES + MAX_ROWS downto LINES + 1);
  columns_above_o <= late(2 * LINES downto LINES + MAX_ROWS + 1);

end architecture rtl;
