-- ============================================================================
-- pair_selection_pkg - words and functions of the units that choose pairs
-- ----------------------------------------------------------------------------
-- The words of the queue of triangles and of the queue of rows, packed most
-- significant field first; rows and columns as masks; bounds of 16 lines as one
-- word, line k at k * DEPTH_BITS.
-- model: cmodel/include/raplas/pair_selection.hpp     tests: those of the units
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

package pair_selection_pkg is

  constant NUM_LINES : positive := 2 ** LINE_BITS;   -- most rows, and most columns

  subtype bank_t is std_ulogic_vector(BANK_BITS - 1 downto 0);
  subtype depth_t is std_ulogic_vector(DEPTH_BITS - 1 downto 0);
  subtype line_t is std_ulogic_vector(LINE_BITS - 1 downto 0);
  subtype line_mask_t is std_ulogic_vector(NUM_LINES - 1 downto 0);
  subtype line_bounds_t is std_ulogic_vector(NUM_LINES * DEPTH_BITS - 1 downto 0);

  -- a vertex on the pencil's grid of lines: numbers from the middle, GRID_FRACTION fraction bits
  type grid_point_t is record
    known  : std_ulogic;                                   -- else the others don't count
    aside  : std_ulogic_vector(GRID_BITS - 1 downto 0);    -- signed: across, a word of AMS-VHDL
    down   : std_ulogic_vector(GRID_BITS - 1 downto 0);    -- signed
  end record;
  constant GRID_POINT_BITS : positive := 1 + 2 * GRID_BITS;
  subtype grid_place_t is std_ulogic_vector(2 * GRID_BITS - 1 downto 0);   -- without known
  type grid_places_t is array (0 to 2) of grid_place_t;
  type grid_points_t is array (0 to 2) of grid_point_t;    -- of slots 0, 1, 2

  -- a triangle that a pencil meets, or the end of a pencil
  type queued_triangle_t is record
    last     : std_ulogic;                                 -- end of the pencil: only bank counts
    bank     : bank_t;
    triangle : std_ulogic_vector(ID_BITS - 1 downto 0);
    z        : depth_t;                                    -- it is not nearer
    rows     : line_mask_t;
    columns  : line_mask_t;
    points   : grid_points_t;
  end record;
  constant QUEUED_TRIANGLE_BITS : positive :=
    1 + BANK_BITS + ID_BITS + DEPTH_BITS + 2 * NUM_LINES + 3 * GRID_POINT_BITS;
  subtype queued_triangle_word_t is std_ulogic_vector(QUEUED_TRIANGLE_BITS - 1 downto 0);

  -- the line through an edge: rows that the edge may reach, and where it cuts them
  constant CUT_LINE_BITS : positive := LINE_BITS + 1;
  constant MARGIN_BITS   : positive := SLOPE_BITS - 1;
  type edge_cut_t is record
    open_cut : std_ulogic;                                     -- anywhere: last three don't count
    first    : std_ulogic_vector(CUT_LINE_BITS - 1 downto 0);  -- signed, from the middle line
    last     : std_ulogic_vector(CUT_LINE_BITS - 1 downto 0);  -- signed
    at       : std_ulogic_vector(CUT_BITS - 1 downto 0);       -- signed: column on the middle line
    slope    : std_ulogic_vector(SLOPE_BITS - 1 downto 0);     -- signed
    margin   : std_ulogic_vector(MARGIN_BITS - 1 downto 0);
  end record;
  constant EDGE_CUT_BITS : positive := 1 + 2 * CUT_LINE_BITS + CUT_BITS + SLOPE_BITS + MARGIN_BITS;
  subtype edge_cut_word_t is std_ulogic_vector(EDGE_CUT_BITS - 1 downto 0);
  type edge_cuts_t is array (0 to 2) of edge_cut_t;
  subtype edge_cuts_word_t is std_ulogic_vector(3 * EDGE_CUT_BITS - 1 downto 0);

  -- a triangle with its edges, or the end of a pencil
  type cut_triangle_t is record
    last     : std_ulogic;                                 -- end of the pencil: only bank counts
    bank     : bank_t;
    triangle : std_ulogic_vector(ID_BITS - 1 downto 0);
    z        : depth_t;
    rows     : line_mask_t;
    columns  : line_mask_t;
    whole    : std_ulogic;                                 -- all columns of a row: cuts don't count
    cuts     : edge_cuts_t;
  end record;
  constant CUT_TRIANGLE_BITS : positive :=
    1 + BANK_BITS + ID_BITS + DEPTH_BITS + 2 * NUM_LINES + 1 + 3 * EDGE_CUT_BITS;
  subtype cut_triangle_word_t is std_ulogic_vector(CUT_TRIANGLE_BITS - 1 downto 0);

  -- the rays of one row that are to be tested against a triangle, or the end of a pencil
  type queued_row_t is record
    last     : std_ulogic;                                 -- end of the pencil: only bank counts
    bank     : bank_t;
    triangle : std_ulogic_vector(ID_BITS - 1 downto 0);
    z        : depth_t;
    row      : line_t;
    columns  : line_mask_t;
  end record;
  constant QUEUED_ROW_BITS : positive :=
    1 + BANK_BITS + ID_BITS + DEPTH_BITS + LINE_BITS + NUM_LINES;
  subtype queued_row_word_t is std_ulogic_vector(QUEUED_ROW_BITS - 1 downto 0);

  function unpack_queued_triangle(word : queued_triangle_word_t) return queued_triangle_t;
  function pack_queued_triangle(fields : queued_triangle_t) return queued_triangle_word_t;
  function unpack_edge_cuts(word : edge_cuts_word_t) return edge_cuts_t;
  function unpack_cut_triangle(word : cut_triangle_word_t) return cut_triangle_t;
  function pack_cut_triangle(fields : cut_triangle_t) return cut_triangle_word_t;
  function unpack_queued_row(word : queued_row_word_t) return queued_row_t;
  function pack_queued_row(fields : queued_row_t) return queued_row_word_t;

  -- number of the lowest bit that is 1; 0 if there is none
  function lowest(mask : line_mask_t) return line_t;
  function without_lowest(mask : line_mask_t) return line_mask_t;
  -- the lines to whose bound something at depth z matters
  function lines_beyond(z : depth_t; bounds : line_bounds_t) return line_mask_t;

  -- entry i: 2^RECIPROCAL_BITS / (1 + (i + 1/2) / 2^DEPTH_FRACTION_BITS), to the nearest integer
  subtype reciprocal_t is std_ulogic_vector(RECIPROCAL_BITS - 1 downto 0);
  type reciprocals_t is array (natural range 0 to 2 ** DEPTH_FRACTION_BITS - 1) of reciprocal_t;
  function reciprocals return reciprocals_t;

end package pair_selection_pkg;

package body pair_selection_pkg is

  function unpack_queued_triangle(word : queued_triangle_word_t) return queued_triangle_t is
    constant COLUMNS_LSB  : natural := 3 * GRID_POINT_BITS;
    constant ROWS_LSB     : natural := COLUMNS_LSB + NUM_LINES;
    constant Z_LSB        : natural := ROWS_LSB + NUM_LINES;
    constant TRIANGLE_LSB : natural := Z_LSB + DEPTH_BITS;
    constant BANK_LSB     : natural := TRIANGLE_LSB + ID_BITS;
    variable fields_v : queued_triangle_t;
    variable point_v  : std_ulogic_vector(GRID_POINT_BITS - 1 downto 0);
  begin
    fields_v.last     := word(BANK_LSB + BANK_BITS);
    fields_v.bank     := word(BANK_LSB + BANK_BITS - 1 downto BANK_LSB);
    fields_v.triangle := word(BANK_LSB - 1 downto TRIANGLE_LSB);
    fields_v.z        := word(TRIANGLE_LSB - 1 downto Z_LSB);
    fields_v.rows     := word(Z_LSB - 1 downto ROWS_LSB);
    fields_v.columns  := word(ROWS_LSB - 1 downto COLUMNS_LSB);
    for k in grid_points_t'range loop
      point_v := word((3 - k) * GRID_POINT_BITS - 1 downto (2 - k) * GRID_POINT_BITS);
      fields_v.points(k).known  := point_v(2 * GRID_BITS);
      fields_v.points(k).aside  := point_v(2 * GRID_BITS - 1 downto GRID_BITS);
      fields_v.points(k).down   := point_v(GRID_BITS - 1 downto 0);
    end loop;
    return fields_v;
  end function unpack_queued_triangle;

  function pack_queued_triangle(fields : queued_triangle_t) return queued_triangle_word_t is
    variable points_v : std_ulogic_vector(3 * GRID_POINT_BITS - 1 downto 0);
  begin
    for k in grid_points_t'range loop
      points_v((3 - k) * GRID_POINT_BITS - 1 downto (2 - k) * GRID_POINT_BITS) :=
        fields.points(k).known & fields.points(k).aside & fields.points(k).down;
    end loop;
    return fields.last & fields.bank & fields.triangle & fields.z & fields.rows & fields.columns
      & points_v;
  end function pack_queued_triangle;

  function unpack_edge_cuts(word : edge_cuts_word_t) return edge_cuts_t is
    constant SLOPE_LSB : natural := MARGIN_BITS;
    constant AT_LSB    : natural := SLOPE_LSB + SLOPE_BITS;
    constant LAST_LSB  : natural := AT_LSB + CUT_BITS;
    constant FIRST_LSB : natural := LAST_LSB + CUT_LINE_BITS;
    variable cuts_v : edge_cuts_t;
    variable cut_v  : std_ulogic_vector(EDGE_CUT_BITS - 1 downto 0);
  begin
    for k in edge_cuts_t'range loop
      cut_v := word((3 - k) * EDGE_CUT_BITS - 1 downto (2 - k) * EDGE_CUT_BITS);
      cuts_v(k).open_cut := cut_v(EDGE_CUT_BITS - 1);
      cuts_v(k).first    := cut_v(EDGE_CUT_BITS - 2 downto FIRST_LSB);
      cuts_v(k).last     := cut_v(FIRST_LSB - 1 downto LAST_LSB);
      cuts_v(k).at       := cut_v(LAST_LSB - 1 downto AT_LSB);
      cuts_v(k).slope    := cut_v(AT_LSB - 1 downto SLOPE_LSB);
      cuts_v(k).margin   := cut_v(SLOPE_LSB - 1 downto 0);
    end loop;
    return cuts_v;
  end function unpack_edge_cuts;

  function unpack_cut_triangle(word : cut_triangle_word_t) return cut_triangle_t is
    constant WHOLE_LSB    : natural := 3 * EDGE_CUT_BITS;
    constant COLUMNS_LSB  : natural := WHOLE_LSB + 1;
    constant ROWS_LSB     : natural := COLUMNS_LSB + NUM_LINES;
    constant Z_LSB        : natural := ROWS_LSB + NUM_LINES;
    constant TRIANGLE_LSB : natural := Z_LSB + DEPTH_BITS;
    constant BANK_LSB     : natural := TRIANGLE_LSB + ID_BITS;
    variable fields_v : cut_triangle_t;
  begin
    fields_v.last     := word(BANK_LSB + BANK_BITS);
    fields_v.bank     := word(BANK_LSB + BANK_BITS - 1 downto BANK_LSB);
    fields_v.triangle := word(BANK_LSB - 1 downto TRIANGLE_LSB);
    fields_v.z        := word(TRIANGLE_LSB - 1 downto Z_LSB);
    fields_v.rows     := word(Z_LSB - 1 downto ROWS_LSB);
    fields_v.columns  := word(ROWS_LSB - 1 downto COLUMNS_LSB);
    fields_v.whole    := word(WHOLE_LSB);
    fields_v.cuts     := unpack_edge_cuts(word(WHOLE_LSB - 1 downto 0));
    return fields_v;
  end function unpack_cut_triangle;

  function pack_cut_triangle(fields : cut_triangle_t) return cut_triangle_word_t is
    variable cuts_v : std_ulogic_vector(3 * EDGE_CUT_BITS - 1 downto 0);
  begin
    for k in edge_cuts_t'range loop
      cuts_v((3 - k) * EDGE_CUT_BITS - 1 downto (2 - k) * EDGE_CUT_BITS) :=
        fields.cuts(k).open_cut & fields.cuts(k).first & fields.cuts(k).last & fields.cuts(k).at
        & fields.cuts(k).slope & fields.cuts(k).margin;
    end loop;
    return fields.last & fields.bank & fields.triangle & fields.z & fields.rows & fields.columns
      & fields.whole & cuts_v;
  end function pack_cut_triangle;

  function unpack_queued_row(word : queued_row_word_t) return queued_row_t is
    constant ROW_LSB      : natural := NUM_LINES;
    constant Z_LSB        : natural := ROW_LSB + LINE_BITS;
    constant TRIANGLE_LSB : natural := Z_LSB + DEPTH_BITS;
    constant BANK_LSB     : natural := TRIANGLE_LSB + ID_BITS;
    variable fields_v : queued_row_t;
  begin
    fields_v.last     := word(BANK_LSB + BANK_BITS);
    fields_v.bank     := word(BANK_LSB + BANK_BITS - 1 downto BANK_LSB);
    fields_v.triangle := word(BANK_LSB - 1 downto TRIANGLE_LSB);
    fields_v.z        := word(TRIANGLE_LSB - 1 downto Z_LSB);
    fields_v.row      := word(Z_LSB - 1 downto ROW_LSB);
    fields_v.columns  := word(ROW_LSB - 1 downto 0);
    return fields_v;
  end function unpack_queued_row;

  function pack_queued_row(fields : queued_row_t) return queued_row_word_t is
  begin
    return fields.last & fields.bank & fields.triangle & fields.z & fields.row & fields.columns;
  end function pack_queued_row;

  function lowest(mask : line_mask_t) return line_t is
    variable lowest_v : line_t;
  begin
    lowest_v := (others => '0');
    for k in mask'high downto mask'low loop
      if mask(k) = '1' then
        lowest_v := std_ulogic_vector(to_unsigned(k, LINE_BITS));
      end if;
    end loop;
    return lowest_v;
  end function lowest;

  function without_lowest(mask : line_mask_t) return line_mask_t is
  begin
    return mask and std_ulogic_vector(unsigned(mask) - 1);
  end function without_lowest;

  function lines_beyond(z : depth_t; bounds : line_bounds_t) return line_mask_t is
    variable lines_v : line_mask_t;
  begin
    for k in line_mask_t'range loop
      lines_v(k) := '0';
      if unsigned(z) < unsigned(bounds((k + 1) * DEPTH_BITS - 1 downto k * DEPTH_BITS)) then
        lines_v(k) := '1';
      end if;
    end loop;
    return lines_v;
  end function lines_beyond;

  function reciprocals return reciprocals_t is
    constant ONE     : natural := 2 ** (DEPTH_FRACTION_BITS + 1);
    variable table_v : reciprocals_t;
  begin
    for i in table_v'range loop
      table_v(i) := std_ulogic_vector(to_unsigned(
        (2 ** (RECIPROCAL_BITS + 1) * ONE / (ONE + 2 * i + 1) + 1) / 2, RECIPROCAL_BITS));
    end loop;
    return table_v;
  end function reciprocals;

end package body pair_selection_pkg;
