-- ============================================================================
-- fifo - first-word fall-through queue in registers and LUT RAM
-- ----------------------------------------------------------------------------
--   @1  a word written is at the front of an empty queue
-- DEPTH is a power of two. A write into a full queue and a read from an empty
-- one are ignored; read and write in one clock are independent.
-- model: cmodel/include/raplas/clocked.hpp     tests: tb/unit/fifo
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity fifo is
  generic (
    WIDTH      : positive := 8;
    DEPTH_LOG2 : positive := 4
  );
  port (
    clk_i   : in  std_ulogic;
    rst_i   : in  std_ulogic;
    write_i : in  std_ulogic;
    data_i  : in  std_ulogic_vector(WIDTH - 1 downto 0);
    read_i  : in  std_ulogic;                              -- takes the front word
    data_o  : out std_ulogic_vector(WIDTH - 1 downto 0);   -- front word
    valid_o : out std_ulogic;                              -- not empty
    ready_o : out std_ulogic;                              -- not full
    count_o : out std_ulogic_vector(DEPTH_LOG2 downto 0)   -- words inside
  );
end entity fifo;

architecture rtl of fifo is
  subtype word_t is std_ulogic_vector(WIDTH - 1 downto 0);
  type memory_t is array (natural range 0 to 2 ** DEPTH_LOG2 - 1) of word_t;
  signal memory     : memory_t;
  signal head       : unsigned(DEPTH_LOG2 - 1 downto 0);
  signal tail       : unsigned(DEPTH_LOG2 - 1 downto 0);
  signal count      : unsigned(DEPTH_LOG2 downto 0);
  signal read_now   : std_ulogic;
  signal write_now  : std_ulogic;
begin

  read_now  <= '1' when read_i = '1' and count /= 0 else '0';
  write_now <= '1' when write_i = '1' and count(DEPTH_LOG2) = '0' else '0';

  memory_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if write_now = '1' then
        memory(to_integer(tail)) <= data_i;
      end if;
    end if;
  end process memory_p;

  state_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if rst_i = '1' then
        head  <= (others => '0');
        tail  <= (others => '0');
        count <= (others => '0');
      else
        if read_now = '1' then
          head <= head + 1;
        end if;
        if write_now = '1' then
          tail <= tail + 1;
        end if;
        if write_now = '1' and read_now = '0' then
          count <= count + 1;
        elsif write_now = '0' and read_now = '1' then
          count <= count - 1;
        end if;
      end if;
    end if;
  end process state_p;

  data_o  <= memory(to_integer(head));
  valid_o <= '1' when count /= 0 else '0';
  ready_o <= not count(DEPTH_LOG2);
  count_o <= std_ulogic_vector(count);

end architecture rtl;
