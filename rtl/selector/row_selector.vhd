-- ============================================================================
-- row_selector - the rows of a triangle in which it matters to a ray
-- ----------------------------------------------------------------------------
--   @0  a row that is left is read from ray_bounds
--   @2  its rays' bounds                                   MEMORY_STAGES
--   @3  the columns whose ray may have a nearer hit; a row without any is dropped
-- On taking a word: rows that cannot matter by their row bound are left out.
-- Triangles in the outer loop, rows inside, lowest first, one a clock; the next
-- word is taken in the clock of the last row. A word without a row costs a clock.
-- The end of a pencil passes in order. A row goes only if the row queue has room
-- for it behind all that can be under way.
-- model: cmodel/include/raplas/pair_selection.hpp     tests: tb/unit/row_selector
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity row_selector is
  port (
    clk_i        : in  std_ulogic;
    rst_i        : in  std_ulogic;
    valid_i      : in  std_ulogic;                 -- front of the queue of triangles
    word_i       : in  queued_triangle_word_t;
    ready_o      : out std_ulogic;                 -- takes it in this clock
    pair_bank_o  : out bank_t;                     -- of the word at the front ...
    row_bounds_i : in  line_bounds_t;              -- ... its row bounds, in the same clock
    read_o       : out std_ulogic;                 -- a row is asked for ...
    bank_o       : out bank_t;
    row_o        : out line_t;
    bounds_i     : in  line_bounds_t;              -- ... its rays' bounds, MEMORY_STAGES later
    row_valid_o  : out std_ulogic;                 -- into the queue of rows
    row_word_o   : out queued_row_word_t;
    row_count_i  : in  std_ulogic_vector(ROW_FIFO_DEPTH_LOG2 downto 0)   -- words in it
  );
end entity row_selector;

architecture rtl of row_selector is

  constant ROW_STAGES : positive := MEMORY_STAGES + 1;   -- from a row's read to its write
  constant NO_LINES   : line_mask_t := (others => '0');

  type stage_t is record
    valid : std_ulogic;
    row   : queued_row_t;
  end record;
  type stages_t is array (1 to ROW_STAGES) of stage_t;   -- k clocks old

  type reg_t is record
    triangle  : queued_triangle_t;                -- first is the next one, count with it
    rows_left : line_mask_t;                      -- of this triangle; 0: nothing to do
    s         : stages_t;
  end record;

  signal r     : reg_t;
  signal rin   : reg_t;
  signal front : queued_triangle_t;

begin

  front       <= unpack_queued_triangle(word_i);
  pair_bank_o <= front.bank;
  bank_o      <= r.triangle.bank;
  row_o       <= lowest(r.rows_left);

  comb_p : process (r, valid_i, front, row_bounds_i, bounds_i, row_count_i)
    variable v         : reg_t;
    variable rest_v    : line_mask_t;
    variable columns_v : line_mask_t;
    variable busy_v    : std_ulogic;
    variable go_v      : std_ulogic;   -- a row, or the end of the pencil
    variable end_v     : std_ulogic;   -- the last of this word
  begin
    v := r;

    busy_v := '0';
    if r.rows_left /= NO_LINES then
      busy_v := '1';
    end if;
    go_v := '0';
    if unsigned(row_count_i) < 2 ** ROW_FIFO_DEPTH_LOG2 - ROW_STAGES then
      go_v := busy_v;
    end if;
    rest_v := without_lowest(r.rows_left);
    end_v  := '0';
    if rest_v = NO_LINES and (unsigned(r.triangle.count) = 1 or r.triangle.last = '1') then
      end_v := go_v;
    end if;
    if go_v = '1' then
      v.rows_left := rest_v;
      if rest_v = NO_LINES then
        v.rows_left      := r.triangle.rows;
        v.triangle.first := std_ulogic_vector(unsigned(r.triangle.first) + 1);
        v.triangle.count := std_ulogic_vector(unsigned(r.triangle.count) - 1);
      end if;
    end if;

    if busy_v = '0' or end_v = '1' then
      v.triangle      := front;
      v.triangle.rows := front.rows and lines_beyond(front.z, row_bounds_i);
      if front.last = '1' then   -- goes as one row
        v.triangle.rows    := NO_LINES;
        v.triangle.rows(0) := '1';
      end if;
      v.rows_left := NO_LINES;
      if valid_i = '1' then
        v.rows_left := v.triangle.rows;
      end if;
    end if;

    v.s(1).valid        := go_v;
    v.s(1).row.last     := r.triangle.last;
    v.s(1).row.bank     := r.triangle.bank;
    v.s(1).row.triangle := r.triangle.first;
    v.s(1).row.z        := r.triangle.z;
    v.s(1).row.row      := lowest(r.rows_left);
    v.s(1).row.columns  := r.triangle.columns;
    for k in 2 to ROW_STAGES loop
      v.s(k) := r.s(k - 1);
    end loop;
    columns_v := r.s(MEMORY_STAGES).row.columns
                 and lines_beyond(r.s(MEMORY_STAGES).row.z, bounds_i);
    v.s(ROW_STAGES).row.columns := columns_v;
    if columns_v = NO_LINES and r.s(MEMORY_STAGES).row.last = '0' then
      v.s(ROW_STAGES).valid := '0';
    end if;

    ready_o <= end_v or not busy_v;
    read_o  <= go_v and not r.triangle.last;
    rin     <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.rows_left <= NO_LINES;
        for k in stages_t'range loop
          r.s(k).valid <= '0';
        end loop;
      end if;
    end if;
  end process reg_p;

  row_valid_o <= r.s(ROW_STAGES).valid;
  row_word_o  <= pack_queued_row(r.s(ROW_STAGES).row);

end architecture rtl;
