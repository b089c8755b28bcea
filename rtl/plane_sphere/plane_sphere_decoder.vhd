-- ============================================================================
-- plane_sphere_decoder - which rows and columns of the pencil does a sphere meet?
-- ----------------------------------------------------------------------------
--   @1  masks of all plane sets joined, decision taken
-- A sphere stays at the testers while the plane sets of the pencil pass by; set
-- k holds rows k*NUM_ROWS .. and columns k*NUM_COLUMNS .. . With the last set
-- the sphere is decided: it is dropped if no row or no column meets it, else it
-- is a leaf for the selector or its children are pushed on the stack.
-- model: cmodel/include/raplas/plane_sphere.hpp     tests: tb/unit/plane_sphere_decoder
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity plane_sphere_decoder is
  generic (
    NUM_ROWS    : positive := 4;
    NUM_COLUMNS : positive := 4
  );
  port (
    clk_i          : in  std_ulogic;
    rst_i          : in  std_ulogic;
    rows_i         : in  std_ulogic_vector(LINE_BITS downto 0);  -- planes of the pencil, 1..16
    columns_i      : in  std_ulogic_vector(LINE_BITS downto 0);
    valid_i        : in  std_ulogic;
    set_i          : in  std_ulogic_vector(LINE_BITS - 1 downto 0);
    last_i         : in  std_ulogic;                             -- last set of this sphere
    leaf_i         : in  std_ulogic;
    row_flags_i    : in  std_ulogic_vector(NUM_ROWS - 1 downto 0);
    column_flags_i : in  std_ulogic_vector(NUM_COLUMNS - 1 downto 0);
    decided_o      : out std_ulogic;                             -- a sphere leaves the testers ...
    leaf_o         : out std_ulogic;                             -- ... and is a leaf that is met
    push_o         : out std_ulogic;                             -- ... or an inner node that is met
    row_mask_o     : out std_ulogic_vector(MAX_ROWS - 1 downto 0);
    column_mask_o  : out std_ulogic_vector(MAX_COLUMNS - 1 downto 0)
  );
end entity plane_sphere_decoder;

architecture rtl of plane_sphere_decoder is

  subtype row_mask_t is std_ulogic_vector(MAX_ROWS - 1 downto 0);
  subtype column_mask_t is std_ulogic_vector(MAX_COLUMNS - 1 downto 0);

  type reg_t is record
    decided     : std_ulogic;
    leaf        : std_ulogic;
    push        : std_ulogic;
    row_mask    : row_mask_t;
    column_mask : column_mask_t;
  end record;

  signal r   : reg_t;
  signal rin : reg_t;

begin

  comb_p : process (r, rows_i, columns_i, valid_i, set_i, last_i, leaf_i, row_flags_i,
                    column_flags_i)
    constant NO_ROWS    : row_mask_t    := (others => '0');
    constant NO_COLUMNS : column_mask_t := (others => '0');
    variable v      : reg_t;
    variable meet_v : std_ulogic;
  begin
    v := r;
    if valid_i = '1' and unsigned(set_i) = 0 then
      v.row_mask    := NO_ROWS;
      v.column_mask := NO_COLUMNS;
    end if;
    for k in 0 to MAX_ROWS - 1 loop
      if valid_i = '1' and unsigned(set_i) = k / NUM_ROWS and unsigned(rows_i) > k then
        v.row_mask(k) := row_flags_i(k mod NUM_ROWS);
      end if;
    end loop;
    for k in 0 to MAX_COLUMNS - 1 loop
      if valid_i = '1' and unsigned(set_i) = k / NUM_COLUMNS and unsigned(columns_i) > k then
        v.column_mask(k) := column_flags_i(k mod NUM_COLUMNS);
      end if;
    end loop;
    meet_v := '1';
    if v.row_mask = NO_ROWS or v.column_mask = NO_COLUMNS then
      meet_v := '0';
    end if;
    v.decided := valid_i and last_i;
    v.leaf    := v.decided and meet_v and leaf_i;
    v.push    := v.decided and meet_v and not leaf_i;
    rin       <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.decided <= '0';
        r.leaf    <= '0';
        r.push    <= '0';
      end if;
    end if;
  end process reg_p;

  decided_o     <= r.decided;
  leaf_o        <= r.leaf;
  push_o        <= r.push;
  row_mask_o    <= r.row_mask;
  column_mask_o <= r.column_mask;

end architecture rtl;
