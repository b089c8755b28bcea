-- ============================================================================
-- ray_bounds - how near an object must be to matter, for each ray and each row
-- ----------------------------------------------------------------------------
--   @2  bounds of the row asked for                        MEMORY_STAGES
--   @6  their maximum, by a tree of one level a clock      LINE_BITS
--   @7  it is the row's bound
-- A depth code for each ray of four pencils. clear_i begins a pencil: its rows have
-- the bound `far` at once; those of a row's rays count from its first update on, which
-- writes them all: hit_rows_i tells which rows had one.
-- What is beyond a ray's bound never matters again in that pencil: a row's bound,
-- which is that of its last read, may lag and is never too low.
-- No read of a bank in the clock of its clear_i and the 5 before: its maximum would
-- come too late.
-- model: cmodel/include/raplas/pair_selection.hpp     tests: tb/unit/ray_bounds
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity ray_bounds is
  port (
    clk_i             : in  std_ulogic;
    rst_i             : in  std_ulogic;
    clear_i           : in  std_ulogic;                               -- a pencil begins
    clear_bank_i      : in  bank_t;
    clear_rows_i      : in  std_ulogic_vector(LINE_BITS downto 0);    -- of the pencil, 1 .. 16
    clear_far_i       : in  depth_t;                                  -- bound of its rows; 0 beyond
    hit_rows_i        : in  std_ulogic_vector(PENCIL_BANKS * MAX_ROWS - 1 downto 0);
                      -- bank b, row r at b * MAX_ROWS + r: updated since clear_i, before this clock
    update_i          : in  std_ulogic;
    update_bank_i     : in  bank_t;
    update_columns_i  : in  std_ulogic_vector(LINE_BITS downto 0);    -- of its pencil, 1 .. 16
    update_far_i      : in  depth_t;                                  -- as it was at clear_i
    update_ray_i      : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);  -- row, column
    update_bound_i    : in  depth_t;                                  -- right for the whole pencil
    read_i            : in  std_ulogic;
    read_bank_i       : in  bank_t;
    read_row_i        : in  line_t;
    bounds_o          : out line_bounds_t;                            -- MEMORY_STAGES later, for
    row_hit_o         : out std_ulogic;                               -- a row that was updated
    walk_bank_i       : in  bank_t;
    row_bounds_o      : out line_bounds_t;                            -- of its rows, same clock
    pair_bank_i       : in  bank_t;
    pair_row_bounds_o : out line_bounds_t                             -- of its rows, same clock
  );
end entity ray_bounds;

architecture rtl of ray_bounds is

  constant MAXIMUM_STAGES : positive := MEMORY_STAGES + LINE_BITS;
  constant ADDRESS_BITS   : positive := BANK_BITS + LINE_BITS;

  subtype address_t is std_ulogic_vector(ADDRESS_BITS - 1 downto 0);

  type read_t is record
    valid : std_ulogic;
    bank  : bank_t;
    row   : line_t;
  end record;
  type reads_t is array (1 to MAXIMUM_STAGES) of read_t;   -- of k clocks ago

  type depths_t is array (natural range <>) of depth_t;
  type banks_t is array (0 to PENCIL_BANKS - 1) of line_bounds_t;

  signal write_address : address_t;
  signal read_address  : address_t;
  signal first_update  : std_ulogic;                        -- of its row
  signal row_hit       : std_ulogic_vector(1 downto 0);     -- k+1 clocks old
  signal bounds        : line_bounds_t;
  signal reads         : reads_t;
  signal s3            : depths_t(0 to 7);
  signal s4            : depths_t(0 to 3);
  signal s5            : depths_t(0 to 1);
  signal s6            : depth_t;
  signal row_bounds    : banks_t;

  function greater(a, b : depth_t) return depth_t is
  begin
    if unsigned(a) < unsigned(b) then
      return b;
    end if;
    return a;
  end function greater;

  function of_bank(banks : banks_t; bank : bank_t) return line_bounds_t is
    variable bounds_v : line_bounds_t;
  begin
    bounds_v := banks(0);
    for b in 1 to PENCIL_BANKS - 1 loop
      if unsigned(bank) = b then
        bounds_v := banks(b);
      end if;
    end loop;
    return bounds_v;
  end function of_bank;

  function bit_of(rows : std_ulogic_vector; address : address_t) return std_ulogic is
    variable bit_v : std_ulogic := '0';
  begin
    for k in rows'range loop
      if unsigned(address) = k then
        bit_v := rows(k);
      end if;
    end loop;
    return bit_v;
  end function bit_of;

begin

  write_address <= update_bank_i & update_ray_i(2 * LINE_BITS - 1 downto LINE_BITS);
  read_address  <= read_bank_i & read_row_i;
  first_update  <= not bit_of(hit_rows_i, write_address);

  column_g : for k in 0 to NUM_LINES - 1 generate
    signal write_now : std_ulogic;
    signal data      : depth_t;
  begin
    write_p : process (update_i, update_columns_i, update_far_i, update_ray_i, update_bound_i,
                       first_update)
    begin
      write_now <= update_i and first_update;
      data      <= (others => '0');
      if k < unsigned(update_columns_i) then
        data <= update_far_i;
      end if;
      if unsigned(update_ray_i(LINE_BITS - 1 downto 0)) = k then
        write_now <= update_i;
        data      <= update_bound_i;
      end if;
    end process write_p;

    ram_i : entity raplas.ram
      generic map (WIDTH => DEPTH_BITS, ADDRESS_BITS => ADDRESS_BITS)
      port map (
        clk_i           => clk_i,
        write_i         => write_now,
        write_address_i => write_address,
        write_data_i    => data,
        read_address_i  => read_address,
        read_data_o     => bounds((k + 1) * DEPTH_BITS - 1 downto k * DEPTH_BITS)
      );
  end generate column_g;

  maximum_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      row_hit <= row_hit(0) & bit_of(hit_rows_i, read_address);
      for k in s3'range loop
        s3(k) <= greater(bounds((2 * k + 1) * DEPTH_BITS - 1 downto 2 * k * DEPTH_BITS),
                         bounds((2 * k + 2) * DEPTH_BITS - 1 downto (2 * k + 1) * DEPTH_BITS));
      end loop;
      for k in s4'range loop
        s4(k) <= greater(s3(2 * k), s3(2 * k + 1));
      end loop;
      for k in s5'range loop
        s5(k) <= greater(s4(2 * k), s4(2 * k + 1));
      end loop;
      s6 <= greater(s5(0), s5(1));

      reads(1) <= (read_i, read_bank_i, read_row_i);
      for k in 2 to MAXIMUM_STAGES loop
        reads(k) <= reads(k - 1);
      end loop;
      reads(MEMORY_STAGES + 1).valid <= reads(MEMORY_STAGES).valid and row_hit(1);
      if rst_i = '1' then
        for k in reads_t'range loop
          reads(k).valid <= '0';
        end loop;
      end if;
    end if;
  end process maximum_p;

  row_bounds_p : process (clk_i)
    variable bound_v : depth_t;
  begin
    if rising_edge(clk_i) then
      for b in banks_t'range loop
        for k in 0 to NUM_LINES - 1 loop
          bound_v := row_bounds(b)((k + 1) * DEPTH_BITS - 1 downto k * DEPTH_BITS);
          if reads(MAXIMUM_STAGES).valid = '1' and unsigned(reads(MAXIMUM_STAGES).bank) = b
             and unsigned(reads(MAXIMUM_STAGES).row) = k then
            bound_v := s6;
          end if;
          if clear_i = '1' and unsigned(clear_bank_i) = b then
            bound_v := (others => '0');
            if k < unsigned(clear_rows_i) then
              bound_v := clear_far_i;
            end if;
          end if;
          row_bounds(b)((k + 1) * DEPTH_BITS - 1 downto k * DEPTH_BITS) <= bound_v;
        end loop;
      end loop;
    end if;
  end process row_bounds_p;

  bounds_o          <= bounds;
  row_hit_o         <= row_hit(1);
  row_bounds_o      <= of_bank(row_bounds, walk_bank_i);
  pair_row_bounds_o <= of_bank(row_bounds, pair_bank_i);

end architecture rtl;
