-- ============================================================================
-- ram - block RAM, one write port, one read port
-- ----------------------------------------------------------------------------
--   @1  array read
--   @2  output register
-- MEMORY_STAGES = 2. A read in the clock of a write to the same address gives
-- either word: nobody relies on it.
-- model: cmodel/include/raplas/clocked.hpp     tests: tb/unit/result_memory, tb/integration
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity ram is
  generic (
    WIDTH        : positive := 24;
    ADDRESS_BITS : positive := 8
  );
  port (
    clk_i           : in  std_ulogic;
    write_i         : in  std_ulogic;
    write_address_i : in  std_ulogic_vector(ADDRESS_BITS - 1 downto 0);
    write_data_i    : in  std_ulogic_vector(WIDTH - 1 downto 0);
    read_address_i  : in  std_ulogic_vector(ADDRESS_BITS - 1 downto 0);
    read_data_o     : out std_ulogic_vector(WIDTH - 1 downto 0)   -- MEMORY_STAGES later
  );
end entity ram;

architecture rtl of ram is
  subtype word_t is std_ulogic_vector(WIDTH - 1 downto 0);
  type memory_t is array (natural range 0 to 2 ** ADDRESS_BITS - 1) of word_t;
  signal memory : memory_t;
  signal s1     : std_ulogic_vector(WIDTH - 1 downto 0);
begin

  ports_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if write_i = '1' then
        memory(to_integer(unsigned(write_address_i))) <= write_data_i;
      end if;
      s1          <= memory(to_integer(unsigned(read_address_i)));
      read_data_o <= s1;
    end if;
  end process ports_p;

end architecture rtl;
