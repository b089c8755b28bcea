-- Not broken: shows that the checks let a good unit pass.
library ieee;
use ieee.std_logic_1164.all;

entity good is
  port (
    clk_i    : in  std_ulogic;
    select_i : in  std_ulogic_vector(1 downto 0);
    a_i      : in  std_ulogic_vector(47 downto 0);
    q_o      : out std_ulogic_vector(47 downto 0)
  );
end entity good;

architecture rtl of good is
begin

  choose : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if select_i = "00" then
        q_o <= a_i;
      else
        q_o <= not a_i;
      end if;
    end if;
  end process choose;

end architecture rtl;
