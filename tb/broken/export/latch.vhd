-- Broken on purpose: q_o keeps its value while enable_i = '0', a latch.
library ieee;
use ieee.std_logic_1164.all;

entity latch is
  port (
    enable_i : in  std_ulogic;
    d_i      : in  std_ulogic_vector(7 downto 0);
    q_o      : out std_ulogic_vector(7 downto 0)
  );
end entity latch;

architecture rtl of latch is
begin

  hold : process (enable_i, d_i)
  begin
    if enable_i = '1' then
      q_o <= d_i;
    end if;
  end process hold;

end architecture rtl;
