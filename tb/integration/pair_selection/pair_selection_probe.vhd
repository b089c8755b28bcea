-- ============================================================================
-- pair_selection_probe - ray_bounds, row_selector, queue of rows, column_selector
-- ----------------------------------------------------------------------------
-- Simulation only: these units as they work together. Which rows had an update is
-- kept here, as in result_memory.
-- tests: tb/integration/pair_selection
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity pair_selection_probe is
  port (
    clk_i            : in  std_ulogic;
    rst_i            : in  std_ulogic;
    clear_i          : in  std_ulogic;                                     -- as ray_bounds
    clear_bank_i     : in  bank_t;
    clear_rows_i     : in  std_ulogic_vector(LINE_BITS downto 0);
    clear_far_i      : in  depth_t;
    update_i         : in  std_ulogic;
    update_bank_i    : in  bank_t;
    update_columns_i : in  std_ulogic_vector(LINE_BITS downto 0);
    update_far_i     : in  depth_t;
    update_ray_i     : in  std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    update_bound_i   : in  depth_t;
    valid_i          : in  std_ulogic;                                     -- as row_selector
    word_i           : in  cut_triangle_word_t;
    ready_o          : out std_ulogic;
    read_o           : out std_ulogic;
    row_valid_o      : out std_ulogic;
    row_count_o      : out std_ulogic_vector(ROW_FIFO_DEPTH_LOG2 downto 0);
    stall_i          : in  std_ulogic;                                     -- as column_selector
    issue_o          : out std_ulogic;
    ray_o            : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    triangle_o       : out std_ulogic_vector(ID_BITS - 1 downto 0);
    z_o              : out depth_t;
    bank_o           : out bank_t;
    last_o           : out std_ulogic
  );
end entity pair_selection_probe;

architecture rtl of pair_selection_probe is

  signal read        : std_ulogic;
  signal read_bank   : bank_t;
  signal read_row    : line_t;
  signal bounds      : line_bounds_t;
  signal row_hit     : std_ulogic;
  signal update_row  : std_ulogic_vector(BANK_BITS + LINE_BITS - 1 downto 0);
  signal hit_rows    : std_ulogic_vector(PENCIL_BANKS * MAX_ROWS - 1 downto 0);
  signal row_valid   : std_ulogic;
  signal row_word    : queued_row_word_t;
  signal row_count   : std_ulogic_vector(ROW_FIFO_DEPTH_LOG2 downto 0);
  signal front_valid : std_ulogic;
  signal front_word  : queued_row_word_t;
  signal front_ready : std_ulogic;

begin

  update_row <= update_bank_i & update_ray_i(2 * LINE_BITS - 1 downto LINE_BITS);

  hit_rows_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      for k in hit_rows'range loop
        if clear_i = '1' and unsigned(clear_bank_i) = k / MAX_ROWS then
          hit_rows(k) <= '0';
        elsif update_i = '1' and unsigned(update_row) = k then
          hit_rows(k) <= '1';
        end if;
      end loop;
    end if;
  end process hit_rows_p;

  ray_bounds_i : entity raplas.ray_bounds
    port map (
      clk_i             => clk_i,
      rst_i             => rst_i,
      clear_i           => clear_i,
      clear_bank_i      => clear_bank_i,
      clear_rows_i      => clear_rows_i,
      clear_far_i       => clear_far_i,
      hit_rows_i        => hit_rows,
      update_i          => update_i,
      update_bank_i     => update_bank_i,
      update_columns_i  => update_columns_i,
      update_far_i      => update_far_i,
      update_ray_i      => update_ray_i,
      update_bound_i    => update_bound_i,
      read_i            => read,
      read_bank_i       => read_bank,
      read_row_i        => read_row,
      bounds_o          => bounds,
      row_hit_o         => row_hit,
      walk_bank_i       => read_bank,
      row_bounds_o      => open,
      pair_bank_i       => read_bank,
      pair_row_bounds_o => open
    );

  row_selector_i : entity raplas.row_selector
    port map (
      clk_i       => clk_i,
      rst_i       => rst_i,
      valid_i     => valid_i,
      word_i      => word_i,
      ready_o     => ready_o,
      read_o      => read,
      bank_o      => read_bank,
      row_o       => read_row,
      bounds_i    => bounds,
      row_hit_i   => row_hit,
      row_valid_o => row_valid,
      row_word_o  => row_word,
      row_count_i => row_count
    );

  rows_i : entity raplas.fifo
    generic map (WIDTH => QUEUED_ROW_BITS, DEPTH_LOG2 => ROW_FIFO_DEPTH_LOG2)
    port map (
      clk_i   => clk_i,
      rst_i   => rst_i,
      write_i => row_valid,
      data_i  => row_word,
      read_i  => front_ready,
      data_o  => front_word,
      valid_o => front_valid,
      ready_o => open,
      count_o => row_count
    );

  column_selector_i : entity raplas.column_selector
    port map (
      clk_i      => clk_i,
      rst_i      => rst_i,
      valid_i    => front_valid,
      row_word_i => front_word,
      ready_o    => front_ready,
      stall_i    => stall_i,
      issue_o    => issue_o,
      ray_o      => ray_o,
      triangle_o => triangle_o,
      z_o        => z_o,
      bank_o     => bank_o,
      last_o     => last_o
    );

  read_o      <= read;
  row_valid_o <= row_valid;
  row_count_o <= row_count;

end architecture rtl;
