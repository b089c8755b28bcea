-- ============================================================================
-- selector - forms the (ray, triangle) pairs of a leaf, one a clock
-- ----------------------------------------------------------------------------
--   @1  first pair of a leaf
-- Triangles in the outer loop, rows, then columns in the inner one, lowest
-- number first: the same ray comes again as late as possible. The next leaf is
-- taken in the clock of the last pair, so there is no bubble between leaves.
-- model: cmodel/include/raplas/selector.hpp     tests: tb/unit/selector
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity selector is
  port (
    clk_i         : in  std_ulogic;
    rst_i         : in  std_ulogic;
    valid_i       : in  std_ulogic;
    first_i       : in  std_ulogic_vector(ID_BITS - 1 downto 0);      -- first triangle
    count_i       : in  std_ulogic_vector(COUNT_BITS - 1 downto 0);   -- triangles, 1 .. 127
    row_mask_i    : in  std_ulogic_vector(MAX_ROWS - 1 downto 0);     -- not 0
    column_mask_i : in  std_ulogic_vector(MAX_COLUMNS - 1 downto 0);  -- not 0
    ready_o       : out std_ulogic;                                  -- takes the leaf in this clock
    valid_o       : out std_ulogic;
    ray_o         : out std_ulogic_vector(2 * LINE_BITS - 1 downto 0);
    triangle_o    : out std_ulogic_vector(ID_BITS - 1 downto 0);
    ready_i       : in  std_ulogic                                    -- the pair is taken
  );
end entity selector;

architecture rtl of selector is

  subtype row_mask_t is std_ulogic_vector(MAX_ROWS - 1 downto 0);
  subtype column_mask_t is std_ulogic_vector(MAX_COLUMNS - 1 downto 0);

  type reg_t is record
    active       : std_ulogic;
    triangle     : unsigned(ID_BITS - 1 downto 0);
    left         : unsigned(COUNT_BITS - 1 downto 0);   -- triangles, this one included
    row_mask     : row_mask_t;
    column_mask  : column_mask_t;
    rows_left    : row_mask_t;                          -- of this triangle
    columns_left : column_mask_t;                       -- of this row
  end record;

  signal r     : reg_t;
  signal rin   : reg_t;
  signal ready : std_ulogic;

  function lowest(mask : row_mask_t) return unsigned is
    variable lowest_v : unsigned(LINE_BITS - 1 downto 0);
  begin
    lowest_v := (others => '0');
    for k in mask'high downto mask'low loop
      if mask(k) = '1' then
        lowest_v := to_unsigned(k, LINE_BITS);
      end if;
    end loop;
    return lowest_v;
  end function lowest;

  function without_lowest(mask : row_mask_t) return row_mask_t is
  begin
    return mask and std_ulogic_vector(unsigned(mask) - 1);
  end function without_lowest;

begin

  comb_p : process (r, valid_i, first_i, count_i, row_mask_i, column_mask_i, ready_i)
    variable v         : reg_t;
    variable rows_v    : row_mask_t;
    variable columns_v : column_mask_t;
    variable last_v    : boolean;
  begin
    v         := r;
    columns_v := without_lowest(r.columns_left);
    rows_v    := without_lowest(r.rows_left);
    last_v    := unsigned(columns_v) = 0 and unsigned(rows_v) = 0 and r.left = 1;

    if ready_i = '1' then
      if unsigned(columns_v) /= 0 then
        v.columns_left := columns_v;
      else
        v.columns_left := r.column_mask;
        if unsigned(rows_v) /= 0 then
          v.rows_left := rows_v;
        else
          v.rows_left := r.row_mask;
          v.triangle  := r.triangle + 1;
          v.left      := r.left - 1;
        end if;
      end if;
    end if;

    ready <= '0';
    if r.active = '0' or (ready_i = '1' and last_v) then
      ready          <= '1';
      v.active       := valid_i;
      v.triangle     := unsigned(first_i);
      v.left         := unsigned(count_i);
      v.row_mask     := row_mask_i;
      v.column_mask  := column_mask_i;
      v.rows_left    := row_mask_i;
      v.columns_left := column_mask_i;
    end if;

    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.active <= '0';
      end if;
    end if;
  end process reg_p;

  ready_o    <= ready;
  valid_o    <= r.active;
  ray_o      <= std_ulogic_vector(lowest(r.rows_left) & lowest(r.columns_left));
  triangle_o <= std_ulogic_vector(r.triangle);

end architecture rtl;
