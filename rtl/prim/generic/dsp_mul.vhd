-- ============================================================================
-- dsp_mul - registered unsigned 17 x 17 multiplier
-- ----------------------------------------------------------------------------
--   @1  product
--   @2  output register
-- plain VHDL twin of prim/xc4v/dsp_mul. Exact.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/dsp_mul
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity dsp_mul is
  port (
    clk_i : in  std_ulogic;
    c_i   : in  std_ulogic_vector(47 downto 0);  -- C port of the tile: not used, see prim/xc4v
    a_i   : in  std_ulogic_vector(16 downto 0);
    b_i   : in  std_ulogic_vector(16 downto 0);
    p_o   : out std_ulogic_vector(33 downto 0)
  );
end entity dsp_mul;

architecture rtl of dsp_mul is
  signal m : std_ulogic_vector(33 downto 0);
begin

  mul_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      m   <= std_ulogic_vector(unsigned(a_i) * unsigned(b_i));
      p_o <= m;
    end if;
  end process mul_p;

end architecture rtl;
