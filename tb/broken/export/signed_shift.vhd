-- GHDL 2.0.0 makes a shift of it that fills with zeros.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity signed_shift is
  port (
    a_i : in  std_ulogic_vector(7 downto 0);
    n_i : in  std_ulogic_vector(2 downto 0);
    y_o : out std_ulogic_vector(7 downto 0)
  );
end entity signed_shift;

architecture rtl of signed_shift is
begin
  y_o <= std_ulogic_vector(shift_right(signed(a_i), to_integer(unsigned(n_i))));
end architecture rtl;
