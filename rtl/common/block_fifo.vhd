-- ============================================================================
-- block_fifo - first-word fall-through queue in block RAM
-- ----------------------------------------------------------------------------
--   @1  a word written counts in count_o and ready_o
--   @2  and is at the front of an empty queue
-- As fifo, but for the clock more: the RAM is read at the head that the next clock has,
-- and its output register is data_o. A word in and a word out each clock; for that the
-- depth is at least 4. A write into a full queue and a read while valid_o = 0 are ignored.
-- The RAM's word of a read and a write in one clock at one address is never shown.
-- model: cmodel/include/raplas/clocked.hpp     tests: tb/unit/fifo
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity block_fifo is
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
    data_o  : out std_ulogic_vector(WIDTH - 1 downto 0);   -- front word, if valid_o
    valid_o : out std_ulogic;                              -- data_o is a word
    ready_o : out std_ulogic;                              -- not full
    count_o : out std_ulogic_vector(DEPTH_LOG2 downto 0)   -- words inside, shown or not yet
  );
end entity block_fifo;

architecture rtl of block_fifo is
  subtype word_t is std_ulogic_vector(WIDTH - 1 downto 0);
  type memory_t is array (natural range 0 to 2 ** DEPTH_LOG2 - 1) of word_t;
  signal memory    : memory_t;
  signal head      : unsigned(DEPTH_LOG2 - 1 downto 0);
  signal next_head : unsigned(DEPTH_LOG2 - 1 downto 0);
  signal tail      : unsigned(DEPTH_LOG2 - 1 downto 0);
  signal count     : unsigned(DEPTH_LOG2 downto 0);
  signal valid     : std_ulogic;
  signal read_now  : std_ulogic;
  signal write_now : std_ulogic;
begin

  read_now  <= read_i and valid;
  write_now <= write_i and not count(DEPTH_LOG2);
  next_head <= head + 1 when read_now = '1' else head;

  memory_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if write_now = '1' then
        memory(to_integer(tail)) <= data_i;
      end if;
      data_o <= memory(to_integer(next_head));
    end if;
  end process memory_p;

  state_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if rst_i = '1' then
        head  <= (others => '0');
        tail  <= (others => '0');
        count <= (others => '0');
        valid <= '0';
      else
        head <= next_head;
        if write_now = '1' then
          tail <= tail + 1;
        end if;
        if write_now = '1' and read_now = '0' then
          count <= count + 1;
        elsif write_now = '0' and read_now = '1' then
          count <= count - 1;
        end if;
        -- the RAM has a word behind the one that goes: one written before this clock
        valid <= '0';
        if count > 1 or (count = 1 and read_now = '0') then
          valid <= '1';
        end if;
      end if;
    end if;
  end process state_p;

  valid_o <= valid;
  ready_o <= not count(DEPTH_LOG2);
  count_o <= std_ulogic_vector(count);

end architecture rtl;
