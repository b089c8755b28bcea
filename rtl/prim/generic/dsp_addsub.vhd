-- ============================================================================
-- dsp_addsub - registered 48-bit adder/subtracter: p = c +- (ab + carry)
-- ----------------------------------------------------------------------------
--   @1  (AB_REG = 1: ab, subtract, carry; C_REG = 1: c) input registers
--   @1 + inputs  sum
-- plain VHDL twin of prim/xc4v/dsp_addsub.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/dsp_addsub
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity dsp_addsub is
  generic (
    AB_REG : natural := 0;  -- 1: ab_i, subtract_i and carry_i are registered first
    C_REG  : natural := 0   -- 1: c_i is registered first
  );
  port (
    clk_i      : in  std_ulogic;
    subtract_i : in  std_ulogic;                      -- 1: c - (ab + carry)
    carry_i    : in  std_ulogic;
    c_i        : in  std_ulogic_vector(47 downto 0);
    ab_i       : in  std_ulogic_vector(35 downto 0);  -- sign-extended to 48 bits
    p_o        : out std_ulogic_vector(47 downto 0)
  );
end entity dsp_addsub;

architecture rtl of dsp_addsub is
  signal c        : std_ulogic_vector(47 downto 0);
  signal ab       : std_ulogic_vector(35 downto 0);
  signal subtract : std_ulogic;
  signal carry    : std_ulogic;
begin

  ab_reg_g : if AB_REG = 1 generate
    ab_reg_p : process (clk_i)
    begin
      if rising_edge(clk_i) then
        ab       <= ab_i;
        subtract <= subtract_i;
        carry    <= carry_i;
      end if;
    end process ab_reg_p;
  end generate ab_reg_g;

  ab_wire_g : if AB_REG = 0 generate
    ab       <= ab_i;
    subtract <= subtract_i;
    carry    <= carry_i;
  end generate ab_wire_g;

  c_reg_g : if C_REG = 1 generate
    c_reg_p : process (clk_i)
    begin
      if rising_edge(clk_i) then
        c <= c_i;
      end if;
    end process c_reg_p;
  end generate c_reg_g;

  c_wire_g : if C_REG = 0 generate
    c <= c_i;
  end generate c_wire_g;

  sum_p : process (clk_i)
    variable addend_v : signed(47 downto 0);
    variable carry_v  : signed(1 downto 0);
  begin
    if rising_edge(clk_i) then
      carry_v  := signed(std_ulogic_vector'('0' & carry));
      addend_v := resize(signed(ab), 48) + carry_v;
      if subtract = '1' then
        p_o <= std_ulogic_vector(signed(c) - addend_v);
      else
        p_o <= std_ulogic_vector(signed(c) + addend_v);
      end if;
    end if;
  end process sum_p;

end architecture rtl;
