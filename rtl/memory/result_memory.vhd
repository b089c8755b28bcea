-- ============================================================================
-- result_memory - the nearest hit so far of each ray, PENCIL_BANKS banks
-- ----------------------------------------------------------------------------
--   @2  word of the ray asked for, at both read ports
-- The top bits of the words, the hit bits, live in a small memory of their own, a word
-- for each row, which counts from the row's first write on; a register for each row
-- tells that. clear_i empties a bank at once.
-- model: cmodel/include/raplas/intersection_unit.hpp     tests: tb/unit/result_memory
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity result_memory is
  generic (
    WIDTH : positive := RESULT_BITS   -- of a word
  );
  port (
    clk_i        : in  std_ulogic;
    clear_i      : in  std_ulogic;                                    -- no ray of it has a hit
    clear_bank_i : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    write_i      : in  std_ulogic;
    write_bank_i : in  std_ulogic_vector(BANK_BITS - 1 downto 0);     -- not the one that is cleared
    write_ray_i  : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    write_data_i : in  std_ulogic_vector(WIDTH - 1 downto 0);         -- its hit bit counts as 1
    best_bank_i  : in  std_ulogic_vector(BANK_BITS - 1 downto 0);
    best_ray_i   : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    best_o       : out std_ulogic_vector(WIDTH - 1 downto 0);         -- MEMORY_STAGES later
    host_ray_i   : in  std_ulogic_vector(BANK_BITS + 2 * LINE_BITS - 1 downto 0);   -- bank, ray
    host_data_o  : out std_ulogic_vector(WIDTH - 1 downto 0);         -- MEMORY_STAGES later
    hit_rows_o   : out std_ulogic_vector(PENCIL_BANKS * MAX_ROWS - 1 downto 0)
                    -- bank b, row r at b * MAX_ROWS + r: a ray of it has a hit
  );
end entity result_memory;

architecture rtl of result_memory is

  constant DATA_BITS    : natural := WIDTH - 1;
  constant ADDRESS_BITS : natural := BANK_BITS + 2 * LINE_BITS;
  subtype ray_address_t is std_ulogic_vector(ADDRESS_BITS - 1 downto 0);
  subtype data_t is std_ulogic_vector(DATA_BITS - 1 downto 0);
  subtype row_hits_t is std_ulogic_vector(MAX_COLUMNS - 1 downto 0);
  type hits_t is array (natural range 0 to PENCIL_BANKS * MAX_ROWS - 1) of row_hits_t;

  signal write_address : ray_address_t;
  signal best_address  : ray_address_t;
  signal best_data     : data_t;
  signal host_data     : data_t;

  signal hits     : hits_t;
  signal hit_rows : std_ulogic_vector(PENCIL_BANKS * MAX_ROWS - 1 downto 0);
  signal best_hit : std_ulogic_vector(1 downto 0);   -- k+1 clocks old
  signal host_hit : std_ulogic_vector(1 downto 0);

  function row_of(address : ray_address_t) return natural is
  begin
    return to_integer(unsigned(address(ADDRESS_BITS - 1 downto LINE_BITS)));
  end function row_of;

  -- the hits of the row of an address
  function hits_of(words : hits_t; written : std_ulogic_vector; address : ray_address_t)
    return row_hits_t is
    variable written_v : std_ulogic := '0';
  begin
    for k in written'range loop
      if row_of(address) = k then
        written_v := written(k);
      end if;
    end loop;
    if written_v = '1' then
      return words(row_of(address));
    end if;
    return (others => '0');
  end function hits_of;

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

  hits_p : process (clk_i)
    variable row_v : row_hits_t;
  begin
    if rising_edge(clk_i) then
      row_v := hits_of(hits, hit_rows, write_address);
      for k in row_v'range loop
        if unsigned(write_address(LINE_BITS - 1 downto 0)) = k then
          row_v(k) := '1';
        end if;
      end loop;
      if write_i = '1' then
        hits(row_of(write_address)) <= row_v;
      end if;
      for k in hit_rows'range loop
        if clear_i = '1' and unsigned(clear_bank_i) = k / MAX_ROWS then
          hit_rows(k) <= '0';
        elsif write_i = '1' and row_of(write_address) = k then
          hit_rows(k) <= '1';
        end if;
      end loop;
      best_hit <= best_hit(0) & bit_of(hits_of(hits, hit_rows, best_address), best_address);
      host_hit <= host_hit(0) & bit_of(hits_of(hits, hit_rows, host_ray_i), host_ray_i);
    end if;
  end process hits_p;

  best_o      <= best_hit(1) & best_data;
  host_data_o <= host_hit(1) & host_data;
  hit_rows_o  <= hit_rows;

end architecture rtl;
