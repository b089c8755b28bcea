-- ============================================================================
-- result_memory - the nearest hit so far of each ray, PENCIL_BANKS banks
-- ----------------------------------------------------------------------------
--   @2  word of the ray asked for, at both read ports
-- The hit bits live in a small memory of their own, a word for each row. clear_i
-- empties a bank's in MAX_ROWS clocks, not counting those in which write_i, for
-- another bank, has their only write port.
-- model: cmodel/include/raplas/intersection_unit.hpp     tests: tb/unit/result_memory
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity result_memory is
  port (
    clk_i        : in  std_ulogic;
    rst_i        : in  std_ulogic;
    clear_i      : in  std_ulogic;                                    -- starts to clear a bank ...
    clear_bank_i : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    clearing_o   : out std_ulogic;                                    -- ... which is not over yet
    write_i      : in  std_ulogic;
    write_bank_i : in  std_ulogic_vector(BANK_BITS - 1 downto 0);     -- not the one being cleared
    write_ray_i  : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    write_data_i : in  result_word_t;                                 -- its hit bit counts as 1
    best_bank_i  : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    best_ray_i   : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    best_o       : out result_word_t;                                 -- MEMORY_STAGES later
    host_ray_i   : in  std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - 1 downto 0);   -- bank, ray
    host_data_o  : out result_word_t                                  -- MEMORY_STAGES later
  );
end entity result_memory;

architecture rtl of result_memory is

  constant DATA_BITS    : natural := RESULT_BITS - 1;
  constant ADDRESS_BITS : natural := BANK_BITS + 2 * LINE_BITS;
  subtype ray_address_t is std_ulogic_vector(ADDRESS_BITS - 1 downto 0);
  subtype data_t is std_ulogic_vector(DATA_BITS - 1 downto 0);
  subtype row_hits_t is std_ulogic_vector(MAX_COLUMNS - 1 downto 0);
  type hits_t is array (natural range 0 to PENCIL_BANKS * MAX_ROWS - 1) of row_hits_t;

  signal write_address : ray_address_t;
  signal best_address  : ray_address_t;
  signal best_data     : data_t;
  signal host_data     : data_t;

  signal hits       : hits_t;
  signal best_hit   : std_ulogic_vector(1 downto 0);   -- k+1 clocks old
  signal host_hit   : std_ulogic_vector(1 downto 0);
  signal clearing   : std_ulogic;
  signal clear_bank : unsigned(BANK_BITS - 1 downto 0);
  signal clear_row  : unsigned(LINE_BITS - 1 downto 0);

  function row_of(address : ray_address_t) return natural is
  begin
    return to_integer(unsigned(address(ADDRESS_BITS - 1 downto LINE_BITS)));
  end function row_of;

  function bit_of(row : row_hits_t; address : ray_address_t) return std_ulogic is
    variable bit_v : std_ulogic := '0';
  begin
    for k in row'range loop
      if unsigned(address(LINE_BITS - 1 downto 0)) = k then
        bit_v := row(k);
      end if;
    end loop;
    return bit_v;
  end function bit_of;

begin

  write_address <= write_bank_i & write_ray_i;
  best_address  <= best_bank_i & best_ray_i;

  best_i : entity raplas.ram
    generic map (WIDTH => DATA_BITS, ADDRESS_BITS => ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write_i,
      write_address_i => write_address,
      write_data_i    => write_data_i(DATA_BITS - 1 downto 0),
      read_address_i  => best_address,
      read_data_o     => best_data
    );

  host_i : entity raplas.ram
    generic map (WIDTH => DATA_BITS, ADDRESS_BITS => ADDRESS_BITS)
    port map (
      clk_i           => clk_i,
      write_i         => write_i,
      write_address_i => write_address,
      write_data_i    => write_data_i(DATA_BITS - 1 downto 0),
      read_address_i  => host_ray_i,
      read_data_o     => host_data
    );

  clear_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if rst_i = '1' then
        clearing <= '0';
      elsif clear_i = '1' then
        clearing <= '1';
      elsif clear_row = MAX_ROWS - 1 and write_i = '0' then
        clearing <= '0';
      end if;
      if clear_i = '1' then
        clear_bank <= unsigned(clear_bank_i);
        clear_row  <= (others => '0');
      elsif write_i = '0' then
        clear_row <= clear_row + 1;
      end if;
    end if;
  end process clear_p;

  hits_p : process (clk_i)
    variable address_v : unsigned(BANK_BITS + LINE_BITS - 1 downto 0);
    variable row_v     : row_hits_t;
  begin
    if rising_edge(clk_i) then
      if write_i = '0' then
        address_v := clear_bank & clear_row;
        row_v     := (others => '0');
      else
        address_v := unsigned(write_address(ADDRESS_BITS - 1 downto LINE_BITS));
        row_v     := hits(to_integer(address_v));
        for k in row_v'range loop
          if unsigned(write_address(LINE_BITS - 1 downto 0)) = k then
            row_v(k) := '1';
          end if;
        end loop;
      end if;
      if clearing = '1' or write_i = '1' then
        hits(to_integer(address_v)) <= row_v;
      end if;
      best_hit <= best_hit(0) & bit_of(hits(row_of(best_address)), best_address);
      host_hit <= host_hit(0) & bit_of(hits(row_of(host_ray_i)), host_ray_i);
    end if;
  end process hits_p;

  clearing_o  <= clearing;
  best_o      <= best_hit(1) & best_data;
  host_data_o <= host_hit(1) & host_data;

end architecture rtl;
