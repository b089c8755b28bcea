-- ============================================================================
-- column_selector - the (ray, triangle) pairs of a row, one a clock
-- ----------------------------------------------------------------------------
--   @1  first pair of a row, lowest column first
-- The next row is taken in the clock of the last pair, so there is no bubble
-- between rows. The end of a pencil passes in order, and takes a clock as a pair
-- does. Neither goes while stall_i is 1.
-- model: cmodel/include/raplas/pair_selection.hpp     tests: tb/unit/column_selector
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity column_selector is
  port (
    clk_i      : in  std_ulogic;
    rst_i      : in  std_ulogic;
    valid_i    : in  std_ulogic;                                     -- front of the queue of rows
    row_word_i : in  queued_row_word_t;
    ready_o    : out std_ulogic;                                     -- takes it in this clock
    stall_i    : in  std_ulogic;                                     -- nothing may go
    issue_o    : out std_ulogic;                                     -- a pair goes in this clock
    ray_o      : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);  -- row, column
    triangle_o : out std_ulogic_vector(ID_BITS - 1 downto 0);
    z_o        : out depth_t;                                        -- of the triangle
    bank_o     : out bank_t;                                         -- of the pair or the end
    last_o     : out std_ulogic                                      -- the end of a pencil goes
  );
end entity column_selector;

architecture rtl of column_selector is

  constant NO_COLUMNS : line_mask_t := (others => '0');

  signal row          : queued_row_t;   -- its columns are those left
  signal pairs_left   : std_ulogic;
  signal columns_rest : line_mask_t;
  signal ready        : std_ulogic;

begin

  pairs_left   <= '0' when row.columns = NO_COLUMNS else '1';
  columns_rest <= without_lowest(row.columns);
  -- nothing goes, or nothing is left behind what does; an end has no columns
  ready        <= '1' when (row.last = '0' and pairs_left = '0')
                           or (stall_i = '0' and columns_rest = NO_COLUMNS) else '0';

  row_p : process (clk_i)
    variable row_v : queued_row_t;
  begin
    if rising_edge(clk_i) then
      row_v := unpack_queued_row(row_word_i);
      if ready = '1' then
        row      <= row_v;
        row.last <= row_v.last and valid_i;
        if valid_i = '0' or row_v.last = '1' then
          row.columns <= NO_COLUMNS;
        end if;
      elsif stall_i = '0' then
        row.columns <= columns_rest;
      end if;
      if rst_i = '1' then
        row.last    <= '0';
        row.columns <= NO_COLUMNS;
      end if;
    end if;
  end process row_p;

  ready_o    <= ready;
  issue_o    <= pairs_left and not stall_i;
  last_o     <= row.last and not stall_i;
  ray_o      <= row.row & lowest(row.columns);
  triangle_o <= row.triangle;
  z_o        <= row.z;
  bank_o     <= row.bank;

end architecture rtl;
