-- ============================================================================
-- row_selector - the rows of a triangle in which it matters to a ray
-- ----------------------------------------------------------------------------
--   @0  a row that is left goes into row_interval
--   @4  it is read from ray_bounds                         READ_STAGES
--   @6  its columns between the edges; its rays' bounds    ROW_INTERVAL_STAGES
--   @7  the columns whose ray may have a nearer hit; a row without any is dropped
-- Lowest row first, one a clock. The word stays at the front of its queue until its
-- last row goes, and a word without a row costs a clock. The end of a pencil passes
-- in order. A row goes only if the row queue has room for it behind all that can be
-- under way. Its words have columns of the pencil only, and rows whose bound is
-- beyond z: so a row whose rays have no bounds yet keeps all its columns.
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
    clk_i       : in  std_ulogic;
    rst_i       : in  std_ulogic;
    valid_i     : in  std_ulogic;            -- front of the queue of cut triangles
    word_i      : in  cut_triangle_word_t;
    ready_o     : out std_ulogic;            -- takes it in this clock; 0 while valid_i is 0
    read_o      : out std_ulogic;            -- a row is asked for ...
    bank_o      : out bank_t;
    row_o       : out line_t;
    bounds_i    : in  line_bounds_t;         -- ... its rays' bounds, MEMORY_STAGES later,
    row_hit_i   : in  std_ulogic;            -- if they have any; else all are far enough
    row_valid_o : out std_ulogic;            -- into the queue of rows
    row_word_o  : out queued_row_word_t;
    row_count_i : in  std_ulogic_vector(ROW_FIFO_DEPTH_LOG2 downto 0)   -- words in it
  );
end entity row_selector;

architecture rtl of row_selector is

  constant ROW_STAGES  : positive := ROW_INTERVAL_STAGES + 1;   -- from a row's start to its write
  constant READ_STAGES : positive := ROW_INTERVAL_STAGES - MEMORY_STAGES;
  constant NO_LINES    : line_mask_t := (others => '0');
  constant FIRST_LINE  : line_mask_t := (0 => '1', others => '0');

  type stage_t is record
    valid : std_ulogic;
    row   : queued_row_t;
  end record;
  type stages_t is array (1 to ROW_STAGES) of stage_t;   -- k clocks old

  type reg_t is record
    fresh     : std_ulogic;     -- no row of the front word has gone
    rows_left : line_mask_t;    -- of the front word; if fresh, all
    s         : stages_t;
  end record;

  signal r        : reg_t;
  signal rin      : reg_t;
  signal front    : cut_triangle_t;
  signal rows     : line_mask_t;   -- those left of the front word
  signal row      : line_t;        -- the lowest
  signal interval : line_mask_t;   -- @6

begin

  front <= unpack_cut_triangle(word_i);
  rows  <= FIRST_LINE when front.last = '1' else   -- goes as one row
           front.rows when r.fresh = '1' else r.rows_left;
  row   <= lowest(rows);

  interval_i : entity raplas.row_interval
    port map (
      clk_i     => clk_i,
      row_i     => row,
      cuts_i    => word_i(edge_cuts_word_t'range),
      whole_i   => front.whole,
      columns_o => interval
    );

  comb_p : process (r, valid_i, front, rows, row, interval, bounds_i, row_hit_i,
                    row_count_i)
    variable v         : reg_t;
    variable rest_v    : line_mask_t;
    variable columns_v : line_mask_t;
    variable go_v      : std_ulogic;   -- a row, or the end of the pencil
    variable end_v     : std_ulogic;   -- nothing is left of this word
  begin
    v := r;

    rest_v := without_lowest(rows);
    go_v   := '0';
    end_v  := '0';
    if rows = NO_LINES then
      end_v := valid_i;
    elsif unsigned(row_count_i) < 2 ** ROW_FIFO_DEPTH_LOG2 - ROW_STAGES then
      go_v := valid_i;
      if rest_v = NO_LINES then
        end_v := valid_i;
      end if;
    end if;
    v.fresh := end_v or (r.fresh and not go_v);
    if go_v = '1' then
      v.rows_left := rest_v;
    end if;

    v.s(1).valid        := go_v;
    v.s(1).row.last     := front.last;
    v.s(1).row.bank     := front.bank;
    v.s(1).row.triangle := front.triangle;
    v.s(1).row.z        := front.z;
    v.s(1).row.row      := row;
    v.s(1).row.columns  := front.columns;
    for k in 2 to ROW_STAGES loop
      v.s(k) := r.s(k - 1);
    end loop;
    columns_v := r.s(ROW_INTERVAL_STAGES).row.columns and interval;
    if row_hit_i = '1' then
      columns_v := columns_v and lines_beyond(r.s(ROW_INTERVAL_STAGES).row.z, bounds_i);
    end if;
    v.s(ROW_STAGES).row.columns := columns_v;
    if columns_v = NO_LINES and r.s(ROW_INTERVAL_STAGES).row.last = '0' then
      v.s(ROW_STAGES).valid := '0';
    end if;

    ready_o <= end_v;
    rin     <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.fresh <= '1';
        for k in stages_t'range loop
          r.s(k).valid <= '0';
        end loop;
      end if;
    end if;
  end process reg_p;

  read_o      <= r.s(READ_STAGES).valid and not r.s(READ_STAGES).row.last;
  bank_o      <= r.s(READ_STAGES).row.bank;
  row_o       <= r.s(READ_STAGES).row.row;
  row_valid_o <= r.s(ROW_STAGES).valid;
  row_word_o  <= pack_queued_row(r.s(ROW_STAGES).row);

end architecture rtl;
