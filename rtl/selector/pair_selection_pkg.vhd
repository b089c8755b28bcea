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

  -- a range of triangles that a pencil meets, or the end of a pencil
  type queued_triangle_t is record
    last    : std_ulogic;                                  -- end of the pencil: only bank counts
    bank    : bank_t;
    first   : std_ulogic_vector(ID_BITS - 1 downto 0);
    count   : std_ulogic_vector(COUNT_BITS - 1 downto 0);  -- 1 ..
    z       : depth_t;                                     -- none of them is nearer
    rows    : line_mask_t;
    columns : line_mask_t;
  end record;
  constant QUEUED_TRIANGLE_BITS : positive :=
    1 + BANK_BITS + ID_BITS + COUNT_BITS + DEPTH_BITS + 2 * NUM_LINES;
  subtype queued_triangle_word_t is std_ulogic_vector(QUEUED_TRIANGLE_BITS - 1 downto 0);

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
  function unpack_queued_row(word : queued_row_word_t) return queued_row_t;
  function pack_queued_row(fields : queued_row_t) return queued_row_word_t;

  -- number of the lowest bit that is 1; 0 if there is none
  function lowest(mask : line_mask_t) return line_t;
  function without_lowest(mask : line_mask_t) return line_mask_t;
  -- the lines to whose bound something at depth z matters
  function lines_beyond(z : depth_t; bounds : line_bounds_t) return line_mask_t;

end package pair_selection_pkg;

package body pair_selection_pkg is

  function unpack_queued_triangle(word : queued_triangle_word_t) return queued_triangle_t is
    constant Z_LSB     : natural := 2 * NUM_LINES;
    constant COUNT_LSB : natural := Z_LSB + DEPTH_BITS;
    constant FIRST_LSB : natural := COUNT_LSB + COUNT_BITS;
    constant BANK_LSB  : natural := FIRST_LSB + ID_BITS;
    variable fields_v : queued_triangle_t;
  begin
    fields_v.last    := word(BANK_LSB + BANK_BITS);
    fields_v.bank    := word(BANK_LSB + BANK_BITS - 1 downto BANK_LSB);
    fields_v.first   := word(BANK_LSB - 1 downto FIRST_LSB);
    fields_v.count   := word(FIRST_LSB - 1 downto COUNT_LSB);
    fields_v.z       := word(COUNT_LSB - 1 downto Z_LSB);
    fields_v.rows    := word(Z_LSB - 1 downto NUM_LINES);
    fields_v.columns := word(NUM_LINES - 1 downto 0);
    return fields_v;
  end function unpack_queued_triangle;

  function pack_queued_triangle(fields : queued_triangle_t) return queued_triangle_word_t is
  begin
    return fields.last & fields.bank & fields.first & fields.count & fields.z & fields.rows
      & fields.columns;
  end function pack_queued_triangle;

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

end package body pair_selection_pkg;
