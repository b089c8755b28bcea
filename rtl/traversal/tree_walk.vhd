-- ============================================================================
-- tree_walk - walks the sphere tree, nearest children first, down to the vertices
-- ----------------------------------------------------------------------------
--   @0  an object's address and masks, one each clock
-- Works through a range of spheres or of vertices (leaf). The ranges of the
-- spheres that were met come back and go on a stack: its top SORTED_RANGES
-- entries are registers, in which siblings are sorted by depth, the others
-- LUT RAM. The top entry is compared with the row bounds each clock: a row
-- that its depth is not below leaves its mask, a range without rows is dropped.
-- A vertex goes only when the triangle queue has room for it and for all that
-- are under test. From STACK_WATERMARK stacked ranges on, a range is taken only
-- when nothing is under test, so that the stack cannot overflow for trees
-- within the bound of docs/tree_walk.md.
-- model: cmodel/include/raplas/tree_walk.hpp     tests: tb/unit/tree_walk
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity tree_walk is
  port (
    clk_i          : in  std_ulogic;
    rst_i          : in  std_ulogic;
    start_i        : in  std_ulogic;   -- takes the root range, of spheres; only if idle_o
    root_first_i   : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    root_count_i   : in  std_ulogic_vector(COUNT_BITS - 1 downto 0);   -- 1 .. 127
    rows_i         : in  std_ulogic_vector(MAX_ROWS - 1 downto 0);     -- masks of the root range
    columns_i      : in  std_ulogic_vector(MAX_COLUMNS - 1 downto 0);
    row_bounds_i   : in  std_ulogic_vector(MAX_ROWS * DEPTH_BITS - 1 downto 0);  -- row k at k * 15
    push_i         : in  std_ulogic;   -- the sphere that is decided was met: the range below it
    push_range_i   : in  std_ulogic_vector(COUNT_BITS + ID_BITS + MAX_ROWS + MAX_COLUMNS
                                           + DEPTH_BITS downto 0);  -- leaf count first masks z
    decided_i      : in  std_ulogic;   -- an object leaves the testers
    last_sibling_i : in  std_ulogic;   -- with decided_i: it was the last of its range
    triangles_i    : in  std_ulogic_vector(TRIANGLE_FIFO_DEPTH_LOG2 downto 0);  -- in their queue
    request_o      : out std_ulogic;   -- an object goes to the testers
    vertex_o       : out std_ulogic;   -- address_o is a vertex', else a sphere's
    address_o      : out std_ulogic_vector(ID_BITS - 1 downto 0);
    rows_o         : out std_ulogic_vector(MAX_ROWS - 1 downto 0);     -- masks of its range
    columns_o      : out std_ulogic_vector(MAX_COLUMNS - 1 downto 0);
    last_o         : out std_ulogic;   -- it is the last of its range
    stack_level_o  : out std_ulogic_vector(STACK_DEPTH_LOG2 downto 0);  -- stacked ranges
    spent_o        : out std_ulogic;   -- no object goes to the testers any more
    idle_o         : out std_ulogic    -- and none is under test
  );
end entity tree_walk;

architecture rtl of tree_walk is

  constant COLUMNS_LSB : natural := DEPTH_BITS;
  constant ROWS_LSB    : natural := COLUMNS_LSB + MAX_COLUMNS;
  constant FIRST_LSB   : natural := ROWS_LSB + MAX_ROWS;
  constant COUNT_LSB   : natural := FIRST_LSB + ID_BITS;
  constant LEAF_BIT    : natural := COUNT_LSB + COUNT_BITS;

  subtype entry_t is std_ulogic_vector(LEAF_BIT downto 0);
  type top_t is array (natural range 0 to SORTED_RANGES - 1) of entry_t;  -- 0 is the top
  type stack_t is array (natural range 0 to STACK_DEPTH - 1) of entry_t;
  subtype rows_t is std_ulogic_vector(MAX_ROWS - 1 downto 0);

  type reg_t is record
    active     : std_ulogic;   -- a range is being worked through
    leaf       : std_ulogic;   -- it is one of vertices
    address    : unsigned(ID_BITS - 1 downto 0);
    left       : unsigned(COUNT_BITS - 1 downto 0);  -- objects of the range, this one included
    rows       : rows_t;
    columns    : std_ulogic_vector(MAX_COLUMNS - 1 downto 0);
    level      : unsigned(STACK_DEPTH_LOG2 downto 0);  -- stacked ranges
    under_test : unsigned(TRIANGLE_FIFO_DEPTH_LOG2 downto 0);  -- requested and not decided
    vertices   : unsigned(3 downto 0);  -- requested behind the last sphere; 15: or more
    siblings   : unsigned(1 downto 0);  -- entries among which the next one pushed is sorted
  end record;

  signal r       : reg_t;
  signal rin     : reg_t;
  signal top     : top_t;
  signal top_in  : top_t;
  signal stack   : stack_t;   -- an entry that leaves `top` below lies at the level of that clock;
                              -- a push that needs no room below writes where nothing lies
  signal refill  : entry_t;
  signal request : std_ulogic;
  signal live    : rows_t;    -- rows to which the top range matters
  signal stays   : std_ulogic_vector(SORTED_RANGES - 2 downto 0);  -- above the range that is pushed
  signal pop     : std_ulogic;

begin

  compare_p : process (r, top, row_bounds_i, push_range_i)
    variable z_v : unsigned(DEPTH_BITS - 1 downto 0);
  begin
    z_v := unsigned(top(0)(DEPTH_BITS - 1 downto 0));
    for k in rows_t'range loop
      live(k) <= '0';
      if z_v < unsigned(row_bounds_i(k * DEPTH_BITS + DEPTH_BITS - 1 downto k * DEPTH_BITS)) then
        live(k) <= top(0)(ROWS_LSB + k);
      end if;
    end loop;
    for k in stays'range loop
      stays(k) <= '0';
      if k < r.siblings and unsigned(top(k)(DEPTH_BITS - 1 downto 0))
                            <= unsigned(push_range_i(DEPTH_BITS - 1 downto 0)) then
        stays(k) <= '1';
      end if;
    end loop;
  end process compare_p;

  comb_p : process (r, top, live, start_i, root_first_i, root_count_i, rows_i, columns_i, push_i,
                    decided_i, last_sibling_i, triangles_i)
    variable v         : reg_t;
    variable sum_v     : unsigned(TRIANGLE_FIFO_DEPTH_LOG2 + 1 downto 0);
    variable request_v : std_ulogic;
    variable pop_v     : std_ulogic;
    variable ending_v  : boolean;
    variable free_v    : boolean;
    variable relaxed_v : boolean;
    variable alone_v   : boolean;
    variable dead_v    : boolean;
  begin
    v := r;

    -- the object in front: a vertex waits for room
    request_v := r.active;
    sum_v     := resize(r.under_test, sum_v'length) + resize(unsigned(triangles_i), sum_v'length);
    if r.leaf = '1' and sum_v >= 2 ** TRIANGLE_FIFO_DEPTH_LOG2 then
      request_v := '0';
    end if;
    ending_v := false;
    if request_v = '1' then
      v.address := r.address + 1;
      v.left    := r.left - 1;
      ending_v  := r.left = 1;
    end if;
    if request_v = '1' and decided_i = '0' then
      v.under_test := r.under_test + 1;
    elsif request_v = '0' and decided_i = '1' then
      v.under_test := r.under_test - 1;
    end if;

    if request_v = '1' and r.leaf = '0' then
      v.vertices := (others => '0');
    elsif request_v = '1' and r.vertices /= 15 then
      v.vertices := r.vertices + 1;
    end if;

    -- the next range
    free_v    := ending_v or r.active = '0';
    relaxed_v := r.level < STACK_WATERMARK;
    alone_v   := r.active = '0' and r.under_test = 0;
    dead_v    := unsigned(live) = 0;
    pop_v     := '0';
    if r.level /= 0 and (dead_v or (free_v and relaxed_v) or alone_v) then
      pop_v := '1';
    end if;
    if ending_v then
      v.active := '0';
    end if;
    if start_i = '1' then
      v.active  := '1';
      v.leaf    := '0';
      v.address := unsigned(root_first_i);
      v.left    := unsigned(root_count_i);
      v.rows    := rows_i;
      v.columns := columns_i;
    elsif pop_v = '1' and not dead_v then
      v.active  := '1';
      v.leaf    := top(0)(LEAF_BIT);
      v.address := unsigned(top(0)(COUNT_LSB - 1 downto FIRST_LSB));
      v.left    := unsigned(top(0)(LEAF_BIT - 1 downto COUNT_LSB));
      v.rows    := live;
      v.columns := top(0)(ROWS_LSB - 1 downto COLUMNS_LSB);
    end if;

    -- the stack
    if pop_v = '1' then
      v.level := v.level - 1;
      if r.siblings /= 0 then
        v.siblings := r.siblings - 1;
      end if;
    end if;
    if push_i = '1' then
      v.level := v.level + 1;
      if v.siblings /= SORTED_RANGES - 1 then
        v.siblings := v.siblings + 1;
      end if;
    end if;
    if decided_i = '1' and last_sibling_i = '1' then
      v.siblings := (others => '0');
    end if;

    request <= request_v;
    pop     <= pop_v;
    rin     <= v;
  end process comb_p;

  top_p : process (top, refill, stays, pop, push_i, push_range_i)
    variable left_v  : top_t;   -- what the pop leaves
    variable stays_v : std_ulogic_vector(SORTED_RANGES - 1 downto 0);
  begin
    left_v  := top;
    stays_v := '0' & stays;
    if pop = '1' then
      left_v(0 to SORTED_RANGES - 2) := top(1 to SORTED_RANGES - 1);
      left_v(SORTED_RANGES - 1)      := refill;
      stays_v := "00" & stays(SORTED_RANGES - 2 downto 1);
    end if;
    top_in <= left_v;
    if push_i = '1' then
      for k in top_t'range loop
        if stays_v(k) = '0' then
          top_in(k) <= push_range_i;
          if k > 0 then
            if stays_v(k - 1) = '0' then
              top_in(k) <= left_v(k - 1);
            end if;
          end if;
        end if;
      end loop;
    end if;
  end process top_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r   <= rin;
      top <= top_in;
      if rst_i = '1' then
        r.active     <= '0';
        r.level      <= (others => '0');
        r.under_test <= (others => '0');
        r.siblings   <= (others => '0');
        r.vertices   <= (others => '0');
      end if;
    end if;
  end process reg_p;

  stack_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if push_i = '1' then
        stack(to_integer(r.level(STACK_DEPTH_LOG2 - 1 downto 0))) <= top(SORTED_RANGES - 1);
      end if;
    end if;
  end process stack_p;

  refill <= stack(to_integer(r.level(STACK_DEPTH_LOG2 - 1 downto 0) - 1));

  request_o     <= request;
  vertex_o      <= r.leaf;
  address_o     <= std_ulogic_vector(r.address);
  rows_o        <= r.rows;
  columns_o     <= r.columns;
  last_o        <= '1' when r.left = 1 else '0';
  stack_level_o <= std_ulogic_vector(r.level);
  -- spheres bring ranges: none is under test if all that are there came behind the last one
  spent_o       <= '1' when r.active = '0' and r.level = 0 and r.under_test <= r.vertices else '0';
  idle_o        <= '1' when r.active = '0' and r.level = 0 and r.under_test = 0 else '0';

end architecture rtl;
