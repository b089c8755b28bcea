-- ============================================================================
-- fp_mul - fp24 product, truncated toward zero
-- ----------------------------------------------------------------------------
--   @1  significands multiplied, exponents into registers    fp_product
--   @2  exponents added, bias subtracted                     fp_product
--   @3  normalise by one bit, saturate or flush, pack
-- Underflow gives +0, overflow the largest finite number. Two DSP48;
-- one with EXPONENT_DSP = false.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/fp_mul
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;

entity fp_mul is
  generic (
    EXPONENT_DSP : boolean := true   -- false: exponents are added in fabric
  );
  port (
    clk_i     : in  std_ulogic;
    a_i       : in  fp24_t;
    b_i       : in  fp24_t;
    product_o : out fp24_t   -- MUL_STAGES clocks after its operands
  );
end entity fp_mul;

architecture rtl of fp_mul is
  constant TOP : natural := 2 * FRACTION_BITS + 1;

  signal sign_s0     : std_ulogic_vector(0 downto 0);
  signal sign_s2     : std_ulogic_vector(0 downto 0);
  signal significand : std_ulogic_vector(TOP downto 0);
  signal exponent    : std_ulogic_vector(EXPONENT_BITS + 1 downto 0);
begin

  product_i : entity raplas.fp_product
    generic map (EXPONENT_DSP => EXPONENT_DSP)
    port map (
      clk_i         => clk_i,
      a_i           => a_i,
      b_i           => b_i,
      significand_o => significand,
      exponent_o    => exponent
    );

  sign_s0(0) <= sign_of(a_i) xor sign_of(b_i);

  sign_i : entity raplas.delay
    generic map (WIDTH => 1, STAGES => MUL_STAGES - 1)
    port map (clk_i => clk_i, rst_i => '0', data_i => sign_s0, data_o => sign_s2);

  normalise_p : process (clk_i)
    variable exponent_v : signed(EXPONENT_BITS + 1 downto 0);
    variable fraction_v : std_ulogic_vector(FRACTION_BITS - 1 downto 0);
  begin
    if rising_edge(clk_i) then
      if significand(TOP) = '1' then
        exponent_v := signed(exponent) + 1;
        fraction_v := significand(TOP - 1 downto TOP - FRACTION_BITS);
      else
        exponent_v := signed(exponent);
        fraction_v := significand(TOP - 2 downto TOP - FRACTION_BITS - 1);
      end if;
      if significand(TOP downto TOP - 1) = "00" or exponent_v < 1 then
        product_o <= FP24_ZERO;
      elsif exponent_v(EXPONENT_BITS) = '1' then
        product_o <= saturated(sign_s2(0));
      else
        product_o <= sign_s2(0)
          & std_ulogic_vector(exponent_v(EXPONENT_BITS - 1 downto 0)) & fraction_v;
      end if;
    end if;
  end process normalise_p;

end architecture rtl;
