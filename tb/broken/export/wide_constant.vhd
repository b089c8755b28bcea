-- Broken on purpose: GHDL 2.0.0 writes constants over 32 bits as quoted strings.
library ieee;
use ieee.std_logic_1164.all;

entity wide_constant is
  port (
    a_i : in  std_ulogic_vector(47 downto 0);
    q_o : out std_ulogic_vector(47 downto 0)
  );
end entity wide_constant;

architecture rtl of wide_constant is
begin
  q_o <= a_i xor X"123456789ABC";
end architecture rtl;
