-- ============================================================================
-- plane_memory - a plane for each tester every clock
-- ----------------------------------------------------------------------------
--   @2  planes of the set                        ram, one for each tester
-- Row plane k is the business of row tester k mod NUM_ROWS in set k / NUM_ROWS,
-- columns likewise; two pencils have room (banks).
-- model: cmodel/include/raplas/intersection_unit.hpp     tests: tb/integration
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity plane_memory is
  generic (
    NUM_ROWS    : positive := 4;   -- powers of two, at most MAX_ROWS
    NUM_COLUMNS : positive := 4
  );
  port (
    clk_i           : in  std_ulogic;
    write_i         : in  std_ulogic;
    write_address_i : in  std_ulogic_vector(LINE_BITS + 1 downto 0);   -- bank, column?, number
    write_data_i    : in  plane_word_t;
    bank_i          : in  std_ulogic;
    set_i           : in  std_ulogic_vector(LINE_BITS - 1 downto 0);
    planes_o        : out std_ulogic_vector((NUM_ROWS + NUM_COLUMNS) * PLANE_BITS - 1 downto 0)
                      -- MEMORY_STAGES later; row planes from the low end, then columns
  );
end entity plane_memory;

architecture rtl of plane_memory is
  signal write   : std_ulogic_vector(NUM_ROWS + NUM_COLUMNS - 1 downto 0);
  signal address : std_ulogic_vector(LINE_BITS downto 0);
  signal read    : std_ulogic_vector(LINE_BITS downto 0);
begin

  read <= bank_i & set_i;

  write_p : process (write_i, write_address_i)
    variable number_v : unsigned(LINE_BITS - 1 downto 0);
    variable set_v    : unsigned(LINE_BITS - 1 downto 0);
  begin
    number_v := unsigned(write_address_i(LINE_BITS - 1 downto 0));
    write    <= (others => '0');
    if write_address_i(LINE_BITS) = '1' then
      set_v := number_v / NUM_COLUMNS;
      for k in 0 to NUM_COLUMNS - 1 loop
        if number_v mod NUM_COLUMNS = k then
          write(NUM_ROWS + k) <= write_i;
        end if;
      end loop;
    else
      set_v := number_v / NUM_ROWS;
      for k in 0 to NUM_ROWS - 1 loop
        if number_v mod NUM_ROWS = k then
          write(k) <= write_i;
        end if;
      end loop;
    end if;
    address <= write_address_i(LINE_BITS + 1) & std_ulogic_vector(set_v);
  end process write_p;

  testers_g : for k in 0 to NUM_ROWS + NUM_COLUMNS - 1 generate
    plane_i : entity raplas.ram
      generic map (WIDTH => PLANE_BITS, ADDRESS_BITS => LINE_BITS + 1)
      port map (
        clk_i           => clk_i,
        write_i         => write(k),
        write_address_i => address,
        write_data_i    => write_data_i,
        read_address_i  => read,
        read_data_o     => planes_o((k + 1) * PLANE_BITS - 1 downto k * PLANE_BITS)
      );
  end generate testers_g;

end architecture rtl;
