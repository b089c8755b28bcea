-- ============================================================================
-- fp_dot3 - fp24 dot product of two vectors, (ax*bx + ay*by) + az*bz
-- ----------------------------------------------------------------------------
--   @3   three products                          fp_mul
--   @7   x + y, and z delayed                    fp_add
--   @11  sum                                     fp_add
-- Each of the 5 operations truncates. 10 DSP48.
-- model: cmodel/include/raplas/vector.hpp     tests: tb/unit/ray_triangle
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library raplas;
use raplas.raplas_constants.all;

entity fp_dot3 is
  generic (
    GUARD_BITS   : natural range 0 to 2 := 2;
    EXPONENT_DSP : boolean := true   -- false: exponents in fabric, half the DSP48s
  );
  port (
    clk_i : in  std_ulogic;
    a_i   : in  std_ulogic_vector(3 * FP_BITS - 1 downto 0);  -- x y z
    b_i   : in  std_ulogic_vector(3 * FP_BITS - 1 downto 0);  -- x y z
    dot_o : out fp24_t   -- MUL_STAGES + 2 * ADD_STAGES clocks after its operands
  );
end entity fp_dot3;

architecture rtl of fp_dot3 is
  signal products : std_ulogic_vector(3 * FP_BITS - 1 downto 0);
  signal xy       : fp24_t;
  signal z        : fp24_t;
begin

  products_g : for k in 0 to 2 generate
    mul_i : entity raplas.fp_mul
      generic map (EXPONENT_DSP => EXPONENT_DSP)
      port map (
        clk_i     => clk_i,
        a_i       => a_i((k + 1) * FP_BITS - 1 downto k * FP_BITS),
        b_i       => b_i((k + 1) * FP_BITS - 1 downto k * FP_BITS),
        product_o => products((k + 1) * FP_BITS - 1 downto k * FP_BITS)
      );
  end generate products_g;

  xy_i : entity raplas.fp_add
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (
      clk_i => clk_i,
      a_i   => products(3 * FP_BITS - 1 downto 2 * FP_BITS),
      b_i   => products(2 * FP_BITS - 1 downto FP_BITS),
      sum_o => xy
    );

  z_i : entity raplas.delay
    generic map (WIDTH => FP_BITS, STAGES => ADD_STAGES)
    port map (clk_i => clk_i, rst_i => '0', data_i => products(FP_BITS - 1 downto 0), data_o => z);

  dot_i : entity raplas.fp_add
    generic map (GUARD_BITS => GUARD_BITS, EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => xy, b_i => z, sum_o => dot_o);

end architecture rtl;
