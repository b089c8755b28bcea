-- ============================================================================
-- fp_product - the exact product of two fp24 magnitudes, not yet normalised
-- ----------------------------------------------------------------------------
--   @1  significands multiplied                  dsp_mul
--       exponents into registers                 dsp_addsub
--   @2  product out, exponents added, minus bias
-- |a| * |b| = significand * 2^(exponent - EXPONENT_BIAS - 2 * FRACTION_BITS),
-- significand 0 or 2^32 .. 2^34 - 1. Two DSP48 of one tile; with EXPONENT_DSP =
-- false one, and the exponents are added in fabric, in the same clocks.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/fp_mul, tb/unit/nearest_hit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;

entity fp_product is
  generic (
    EXPONENT_DSP : boolean := true   -- false: exponents are added in fabric
  );
  port (
    clk_i         : in  std_ulogic;
    a_i           : in  fp24_t;
    b_i           : in  fp24_t;
    significand_o : out std_ulogic_vector(2 * FRACTION_BITS + 1 downto 0);
    exponent_o    : out std_ulogic_vector(EXPONENT_BITS + 1 downto 0)  -- signed; any value if zero
  );
end entity fp_product;

architecture rtl of fp_product is
  signal a  : std_ulogic_vector(FRACTION_BITS downto 0);
  signal b  : std_ulogic_vector(FRACTION_BITS downto 0);
  signal c  : std_ulogic_vector(47 downto 0);
  signal ab : std_ulogic_vector(35 downto 0);
  signal p  : std_ulogic_vector(47 downto 0);

  signal sum_s1 : signed(EXPONENT_BITS + 1 downto 0);
begin

  a <= std_ulogic_vector(significand_of(a_i));
  b <= std_ulogic_vector(significand_of(b_i));

  significand_i : entity raplas.dsp_mul
    port map (
      clk_i => clk_i,
      c_i   => c,
      a_i   => a,
      b_i   => b,
      p_o   => significand_o
    );

  -- a + b - 63 = a + (b - 64) + 1; b - 64 in two's complement is b with its top bit made a sign
  operands_p : process (a_i, b_i)
    variable a_v      : exponent_t;
    variable b_v      : exponent_t;
    variable offset_v : signed(EXPONENT_BITS - 1 downto 0);
  begin
    a_v      := exponent_of(a_i);
    b_v      := exponent_of(b_i);
    offset_v := signed((not b_v(EXPONENT_BITS - 1)) & b_v(EXPONENT_BITS - 2 downto 0));
    c        <= std_ulogic_vector(resize(a_v, 48));
    ab       <= std_ulogic_vector(resize(offset_v, 36));
  end process operands_p;

  exponent_dsp_g : if EXPONENT_DSP generate
    exponent_i : entity raplas.dsp_addsub
      generic map (AB_REG => 1, C_REG => 1)
      port map (
        clk_i      => clk_i,
        subtract_i => '0',
        carry_i    => '1',
        c_i        => c,
        ab_i       => ab,
        p_o        => p
      );

    exponent_o <= p(EXPONENT_BITS + 1 downto 0);
  end generate exponent_dsp_g;

  exponent_fabric_g : if not EXPONENT_DSP generate
    exponent_p : process (clk_i)
    begin
      if rising_edge(clk_i) then
        sum_s1 <= signed(resize(exponent_of(a_i), EXPONENT_BITS + 2))
          + signed(resize(exponent_of(b_i), EXPONENT_BITS + 2)) - EXPONENT_BIAS;
        exponent_o <= std_ulogic_vector(sum_s1);
      end if;
    end process exponent_p;
  end generate exponent_fabric_g;

end architecture rtl;
