-- ============================================================================
-- triangle_lines - which rows and columns of the pencil does a triangle cross?
-- ----------------------------------------------------------------------------
--   @1  a triangle, if it is not dropped
-- The tests of each vertex go into one of three slots and stay there, so that
-- the next triangle of a strip needs one vertex. A vertex with emit closes the
-- triangle of the three slots. A line is crossed if it meets a vertex, or has
-- vertices on both sides. A triangle that crosses no row or no column, or lies
-- wholly behind the near plane, is dropped; its depth is the least of the three.
-- model: cmodel/include/raplas/pair_selection.hpp     tests: tb/unit/triangle_lines
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.pair_selection_pkg.all;

entity triangle_lines is
  port (
    clk_i           : in  std_ulogic;
    rst_i           : in  std_ulogic;
    valid_i         : in  std_ulogic;                     -- tests of a vertex ...
    slot_i          : in  std_ulogic_vector(1 downto 0);  -- ... go into this slot, 0 .. 2
    emit_i          : in  std_ulogic;                     -- the slots then hold a triangle
    rows_meet_i     : in  line_mask_t;
    rows_above_i    : in  line_mask_t;
    columns_meet_i  : in  line_mask_t;
    columns_above_i : in  line_mask_t;
    near_i          : in  std_ulogic;                     -- not behind the near plane
    z_i             : in  depth_t;
    rows_i          : in  line_mask_t;                    -- that the spheres above it met
    columns_i       : in  line_mask_t;
    triangle_i      : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    valid_o         : out std_ulogic;                     -- a triangle that is not dropped
    rows_o          : out line_mask_t;                    -- not 0
    columns_o       : out line_mask_t;                    -- not 0
    z_o             : out depth_t;
    triangle_o      : out std_ulogic_vector(ID_BITS - 1 downto 0)
  );
end entity triangle_lines;

architecture rtl of triangle_lines is

  type slot_t is record
    rows_meet     : line_mask_t;
    rows_above    : line_mask_t;
    columns_meet  : line_mask_t;
    columns_above : line_mask_t;
    near          : std_ulogic;
    z             : depth_t;
  end record;
  type slots_t is array (0 to 2) of slot_t;

  type s1_t is record
    valid    : std_ulogic;
    rows     : line_mask_t;
    columns  : line_mask_t;
    z        : depth_t;
    triangle : std_ulogic_vector(ID_BITS - 1 downto 0);
  end record;

  type reg_t is record
    slots : slots_t;
    s1    : s1_t;
  end record;

  signal r   : reg_t;
  signal rin : reg_t;

  function nearer(a, b : depth_t) return depth_t is
  begin
    if unsigned(a) < unsigned(b) then
      return a;
    end if;
    return b;
  end function nearer;

begin

  comb_p : process (r, valid_i, slot_i, emit_i, rows_meet_i, rows_above_i, columns_meet_i,
                    columns_above_i, near_i, z_i, rows_i, columns_i, triangle_i)
    constant NO_LINES : line_mask_t := (others => '0');
    variable v         : reg_t;
    variable rows_v    : line_mask_t;
    variable columns_v : line_mask_t;
  begin
    v := r;
    for k in slots_t'range loop
      if valid_i = '1' and unsigned(slot_i) = k then
        v.slots(k) := (rows_meet_i, rows_above_i, columns_meet_i, columns_above_i, near_i, z_i);
      end if;
    end loop;

    -- a vertex meets the line, or two neighbours are on different sides of it
    rows_v    := NO_LINES;
    columns_v := NO_LINES;
    for k in slots_t'range loop
      rows_v    := rows_v or v.slots(k).rows_meet
                   or (v.slots(k).rows_above xor v.slots((k + 1) mod 3).rows_above);
      columns_v := columns_v or v.slots(k).columns_meet
                   or (v.slots(k).columns_above xor v.slots((k + 1) mod 3).columns_above);
    end loop;
    v.s1.rows     := rows_i and rows_v;
    v.s1.columns  := columns_i and columns_v;
    v.s1.z        := nearer(nearer(v.slots(0).z, v.slots(1).z), v.slots(2).z);
    v.s1.triangle := triangle_i;
    v.s1.valid    := valid_i and emit_i
                     and (v.slots(0).near or v.slots(1).near or v.slots(2).near);
    if v.s1.rows = NO_LINES or v.s1.columns = NO_LINES then
      v.s1.valid := '0';
    end if;
    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.s1.valid <= '0';
      end if;
    end if;
  end process reg_p;

  valid_o    <= r.s1.valid;
  rows_o     <= r.s1.rows;
  columns_o  <= r.s1.columns;
  z_o        <= r.s1.z;
  triangle_o <= r.s1.triangle;

end architecture rtl;
