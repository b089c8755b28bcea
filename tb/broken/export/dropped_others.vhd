-- Broken on purpose: GHDL 2.0.0 drops the "when others" arm in Verilog.
library ieee;
use ieee.std_logic_1164.all;

entity dropped_others is
  port (
    select_i : in  std_ulogic_vector(1 downto 0);
    a_i      : in  std_ulogic_vector(7 downto 0);
    b_i      : in  std_ulogic_vector(7 downto 0);
    q_o      : out std_ulogic_vector(7 downto 0)
  );
end entity dropped_others;

architecture rtl of dropped_others is
begin

  choose : process (select_i, a_i, b_i)
  begin
    case select_i is
      when "00"   => q_o <= a_i;
      when "01"   => q_o <= b_i;
      when "10"   => q_o <= not a_i;
      when others => q_o <= not b_i;
    end case;
  end process choose;

end architecture rtl;
