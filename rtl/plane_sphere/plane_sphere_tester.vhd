-- ============================================================================
-- plane_sphere_tester - does a plane meet a sphere?  |n.c + p| <= r
-- ----------------------------------------------------------------------------
--   @3   nx*cx, ny*cy, nz*cz                     fp_mul
--   @7   nx*cx + ny*cy, nz*cz + p                fp_add
--   @11  signed distance                         fp_add
--   @12  magnitude compared with r
-- Each of the 6 operations truncates; the stored radius carries the error bound
-- (docs/radius.md), so that no sphere that is met is missed. 12 DSP48.
-- model: cmodel/include/raplas/plane_sphere.hpp     tests: tb/unit/plane_sphere_tester
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;

entity plane_sphere_tester is
  generic (
    GUARD_BITS : natural range 0 to 2 := 2
  );
  port (
    clk_i   : in  std_ulogic;
    plane_i : in  plane_word_t;                                 -- nx ny nz p
    ball_i  : in  std_ulogic_vector(4 * FP_BITS - 1 downto 0);  -- cx cy cz r
    meets_o : out std_ulogic   -- MUL_STAGES + 2 * ADD_STAGES + COMPARE_STAGES later
  );
end entity plane_sphere_tester;

architecture rtl of plane_sphere_tester is
  constant DISTANCE_STAGES : natural := MUL_STAGES + 2 * ADD_STAGES;

  signal products : std_ulogic_vector(3 * FP_BITS - 1 downto 0);
  signal p        : fp24_t;
  signal xy       : fp24_t;
  signal zp       : fp24_t;
  signal distance : fp24_t;
  signal radius   : fp24_t;
begin

  products_g : for k in 0 to 2 generate
    mul_i : entity raplas.fp_mul
      port map (
        clk_i     => clk_i,
        a_i       => plane_i((k + 2) * FP_BITS - 1 downto (k + 1) * FP_BITS),
        b_i       => ball_i((k + 2) * FP_BITS - 1 downto (k + 1) * FP_BITS),
        product_o => products((k + 1) * FP_BITS - 1 downto k * FP_BITS)
      );
  end generate products_g;

  p_i : entity raplas.delay
    generic map (WIDTH => FP_BITS, STAGES => MUL_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => plane_i(FP_BITS - 1 downto 0), data_o => p);

  radius_i : entity raplas.delay
    generic map (WIDTH => FP_BITS, STAGES => DISTANCE_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => ball_i(FP_BITS - 1 downto 0),
              data_o => radius);

  xy_i : entity raplas.fp_add
    generic map (GUARD_BITS => GUARD_BITS)
    port map (
      clk_i => clk_i,
      a_i   => products(3 * FP_BITS - 1 downto 2 * FP_BITS),
      b_i   => products(2 * FP_BITS - 1 downto FP_BITS),
      sum_o => xy
    );

  zp_i : entity raplas.fp_add
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => products(FP_BITS - 1 downto 0), b_i => p, sum_o => zp);

  distance_i : entity raplas.fp_add
    generic map (GUARD_BITS => GUARD_BITS)
    port map (clk_i => clk_i, a_i => xy, b_i => zp, sum_o => distance);

  compare_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if magnitude_of(distance) <= magnitude_of(radius) then
        meets_o <= '1';
      else
        meets_o <= '0';
      end if;
    end if;
  end process compare_p;

end architecture rtl;
