-- ============================================================================
-- fp_cross - fp24 cross product a x b
-- ----------------------------------------------------------------------------
--   @3  six products                             fp_mul
--   @7  ay*bz - az*by, az*bx - ax*bz, ax*by - ay*bx    fp_add
-- Each of the 9 operations truncates. 18 DSP48.
-- model: cmodel/include/raplas/vector.hpp     tests: tb/unit/ray_triangle
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library raplas;
use raplas.raplas_constants.all;

entity fp_cross is
  generic (
    GUARD_BITS   : natural range 0 to 2 := 2;
    EXPONENT_DSP : boolean := true   -- false: exponents in fabric, half the DSP48s
  );
  port (
    clk_i   : in  std_ulogic;
    a_i     : in  std_ulogic_vector(3 * FP_BITS - 1 downto 0);  -- x y z
    b_i     : in  std_ulogic_vector(3 * FP_BITS - 1 downto 0);  -- x y z
    cross_o : out std_ulogic_vector(3 * FP_BITS - 1 downto 0)  -- MUL_STAGES + ADD_STAGES later
  );
end entity fp_cross;

architecture rtl of fp_cross is
  type vector_t is array (0 to 2) of fp24_t;
  signal a             : vector_t;
  signal b             : vector_t;
  signal left_product  : vector_t;
  signal right_product : vector_t;
begin

  components_g : for k in 0 to 2 generate
    a(k) <= a_i((3 - k) * FP_BITS - 1 downto (2 - k) * FP_BITS);
    b(k) <= b_i((3 - k) * FP_BITS - 1 downto (2 - k) * FP_BITS);

    positive_i : entity raplas.fp_mul
      generic map (EXPONENT_DSP => EXPONENT_DSP)
      port map (
        clk_i     => clk_i,
        a_i       => a((k + 1) mod 3),
        b_i       => b((k + 2) mod 3),
        product_o => left_product(k)
      );

    negative_i : entity raplas.fp_mul
      generic map (EXPONENT_DSP => EXPONENT_DSP)
      port map (
        clk_i     => clk_i,
        a_i       => a((k + 2) mod 3),
        b_i       => b((k + 1) mod 3),
        product_o => right_product(k)
      );

    difference_i : entity raplas.fp_add
      generic map (GUARD_BITS => GUARD_BITS, SUBTRACT => true,
                   EXPONENT_DSP => EXPONENT_DSP)
      port map (
        clk_i => clk_i,
        a_i   => left_product(k),
        b_i   => right_product(k),
        sum_o => cross_o((3 - k) * FP_BITS - 1 downto (2 - k) * FP_BITS)
      );
  end generate components_g;

end architecture rtl;
