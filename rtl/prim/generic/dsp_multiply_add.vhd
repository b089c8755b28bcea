-- ============================================================================
-- dsp_multiply_add - c + a * b, signed integers
-- ----------------------------------------------------------------------------
--   @1  a, b
--   @2  product; c
--   @3  p_o
-- c_i comes a clock after its a_i and b_i. Exact, modulo 2^48.
-- plain VHDL twin of prim/xc4v/dsp_multiply_add.
-- model: plain integers     tests: tb/unit/dsp_multiply_add
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity dsp_multiply_add is
  port (
    clk_i : in  std_ulogic;
    a_i   : in  std_ulogic_vector(17 downto 0);  -- signed
    b_i   : in  std_ulogic_vector(17 downto 0);  -- signed
    c_i   : in  std_ulogic_vector(47 downto 0);  -- signed; a clock after a_i and b_i
    p_o   : out std_ulogic_vector(47 downto 0)   -- MULTIPLY_ADD_STAGES after a_i and b_i
  );
end entity dsp_multiply_add;

architecture rtl of dsp_multiply_add is
  signal a : signed(17 downto 0);
  signal b : signed(17 downto 0);
  signal c : signed(47 downto 0);
  signal m : signed(35 downto 0);
begin

  sum_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      a   <= signed(a_i);
      b   <= signed(b_i);
      m   <= a * b;
      c   <= signed(c_i);
      p_o <= std_ulogic_vector(c + resize(m, 48));
    end if;
  end process sum_p;

end architecture rtl;
