-- ============================================================================
-- SRL16E - simulation model of the Virtex-4 LUT shift register
-- ----------------------------------------------------------------------------
-- Simulation only, library unisim; bound by default binding in GHDL runs.
-- Source of the definition: the Virtex-4 libraries guide, SRL16E.
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity SRL16E is
  generic (
    INIT : bit_vector := X"0000"  -- contents at power-up, bit 0 youngest
  );
  port (
    Q   : out std_ulogic;  -- the bit A3..A0 + 1 clocks old
    A0  : in  std_ulogic;  -- address, least significant bit
    A1  : in  std_ulogic;
    A2  : in  std_ulogic;
    A3  : in  std_ulogic;
    CE  : in  std_ulogic;  -- shift enable
    CLK : in  std_ulogic;
    D   : in  std_ulogic   -- bit shifted in
  );
end entity SRL16E;

architecture sim of SRL16E is
  signal bits : std_logic_vector(15 downto 0) := to_stdlogicvector(INIT);
begin

  shift : process (CLK)
  begin
    if rising_edge(CLK) and CE = '1' then
      bits <= bits(14 downto 0) & D;
    end if;
  end process shift;

  select_bit : process (bits, A0, A1, A2, A3)
    variable address_v : std_logic_vector(3 downto 0);
  begin
    address_v := A3 & A2 & A1 & A0;
    if is_x(address_v) then
      Q <= 'X';
    else
      Q <= bits(to_integer(unsigned(address_v)));
    end if;
  end process select_bit;

end architecture sim;
