-- ============================================================================
-- traversal - walks the sphere tree: gives sphere addresses to the testers
-- ----------------------------------------------------------------------------
--   @0  sphere address and plane set, one of each a clock
-- Works through a range of spheres; each stays for last_set_i + 1 clocks. The
-- child ranges that the decoder sends back go on a stack; the last one in is
-- the next one out, and goes straight through if the range before it just ends.
-- A flat list is a range without inner nodes.
-- A sphere starts only when the leaf queue has room for it and for all that are
-- under test. From STACK_WATERMARK stacked ranges on, a range is taken only when
-- no sphere is under test: the stack then grows as in a depth-first walk, and
-- cannot overflow for trees whose sum of (inner children - 1) over every path is
-- at most STACK_DEPTH - STACK_WATERMARK - LEAF_FIFO_DEPTH (docs/traversal.md).
-- model: cmodel/include/raplas/traversal.hpp     tests: tb/unit/traversal
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity traversal is
  port (
    clk_i         : in  std_ulogic;
    rst_i         : in  std_ulogic;
    start_i       : in  std_ulogic;                                   -- takes the root range
    root_first_i  : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    root_count_i  : in  std_ulogic_vector(ID_BITS downto 0);
    last_set_i    : in  std_ulogic_vector(LINE_BITS - 1 downto 0);   -- plane sets of the pencil - 1
    push_i        : in  std_ulogic;                                   -- an inner node was met
    push_first_i  : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    push_count_i  : in  std_ulogic_vector(COUNT_BITS - 1 downto 0);   -- 1 .. 127
    decided_i     : in  std_ulogic;                                   -- a sphere leaves the testers
    leaves_i      : in  std_ulogic_vector(LEAF_FIFO_DEPTH_LOG2 downto 0);  -- leaf queue: words
    request_o     : out std_ulogic;                                   -- address and set are valid
    first_o       : out std_ulogic;                                   -- first set of this sphere
    last_o        : out std_ulogic;                                   -- last set of this sphere
    address_o     : out std_ulogic_vector(ID_BITS - 1 downto 0);
    set_o         : out std_ulogic_vector(LINE_BITS - 1 downto 0);
    stack_level_o : out std_ulogic_vector(STACK_DEPTH_LOG2 downto 0);  -- stacked ranges
    idle_o        : out std_ulogic   -- nothing left, nothing under test
  );
end entity traversal;

architecture rtl of traversal is

  subtype id_t is unsigned(ID_BITS - 1 downto 0);
  subtype level_t is unsigned(STACK_DEPTH_LOG2 downto 0);
  subtype tested_t is unsigned(LEAF_FIFO_DEPTH_LOG2 + 1 downto 0);
  subtype range_count_t is unsigned(ID_BITS downto 0);
  subtype entry_t is std_ulogic_vector(ID_BITS + COUNT_BITS - 1 downto 0);
  type stack_t is array (natural range 0 to STACK_DEPTH - 1) of entry_t;

  type reg_t is record
    active     : std_ulogic;             -- a range is being worked through
    address    : id_t;
    left       : range_count_t;          -- spheres of the range, this one included
    set        : unsigned(LINE_BITS - 1 downto 0);
    level      : level_t;        -- stacked ranges
    under_test : tested_t;       -- spheres started and not decided
  end record;

  signal r       : reg_t;
  signal rin     : reg_t;
  signal stack   : stack_t;
  signal top     : entry_t;
  signal write   : std_ulogic;
  signal request : std_ulogic;

begin

  comb_p : process (r, start_i, root_first_i, root_count_i, last_set_i, push_i, push_first_i,
                    push_count_i, decided_i, leaves_i, top)
    variable v         : reg_t;
    variable request_v : std_ulogic;
    variable leaves_v  : tested_t;
    variable ending_v  : boolean;
    variable free_v    : boolean;
    variable relaxed_v : boolean;
    variable alone_v   : boolean;
  begin
    v := r;

    -- the sphere in front: its first set waits for room, the others follow at once
    request_v := r.active;
    leaves_v  := resize(unsigned(leaves_i), tested_t'length);
    if r.set = 0 and r.under_test + leaves_v >= LEAF_FIFO_DEPTH then
      request_v := '0';
    end if;
    ending_v := false;
    if request_v = '1' then
      if r.set = unsigned(last_set_i) then
        v.set     := (others => '0');
        v.address := r.address + 1;
        v.left    := r.left - 1;
        ending_v  := r.left = 1;
      else
        v.set := r.set + 1;
      end if;
    end if;

    -- spheres under test
    if request_v = '1' and r.set = 0 and decided_i = '0' then
      v.under_test := r.under_test + 1;
    elsif decided_i = '1' and not (request_v = '1' and r.set = 0) then
      v.under_test := r.under_test - 1;
    end if;

    -- the next range
    free_v    := ending_v or r.active = '0';
    relaxed_v := r.level < STACK_WATERMARK;
    alone_v   := r.active = '0' and r.under_test = 0;
    write     <= '0';
    if start_i = '1' then
      v.active  := '0';
      v.address := unsigned(root_first_i);
      v.left    := unsigned(root_count_i);
      if unsigned(root_count_i) /= 0 then
        v.active := '1';
      end if;
    elsif free_v and relaxed_v and push_i = '1' then
      v.active  := '1';
      v.address := unsigned(push_first_i);
      v.left    := resize(unsigned(push_count_i), ID_BITS + 1);
    elsif ((free_v and relaxed_v) or alone_v) and r.level /= 0 then
      v.active  := '1';
      v.address := unsigned(top(ID_BITS + COUNT_BITS - 1 downto COUNT_BITS));
      v.left    := resize(unsigned(top(COUNT_BITS - 1 downto 0)), ID_BITS + 1);
      v.level   := r.level - 1;
    else
      if ending_v then
        v.active := '0';
      end if;
      if push_i = '1' then
        write   <= '1';
        v.level := r.level + 1;
      end if;
    end if;

    request <= request_v;
    rin     <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        r.active     <= '0';
        r.set        <= (others => '0');
        r.level      <= (others => '0');
        r.under_test <= (others => '0');
      end if;
    end if;
  end process reg_p;

  stack_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if write = '1' then
        stack(to_integer(r.level(STACK_DEPTH_LOG2 - 1 downto 0))) <= push_first_i & push_count_i;
      end if;
    end if;
  end process stack_p;

  top <= stack(to_integer(r.level(STACK_DEPTH_LOG2 - 1 downto 0) - 1));

  request_o     <= request;
  first_o       <= '1' when r.set = 0 else '0';
  last_o        <= '1' when r.set = unsigned(last_set_i) else '0';
  address_o     <= std_ulogic_vector(r.address);
  set_o         <= std_ulogic_vector(r.set);
  stack_level_o <= std_ulogic_vector(r.level);
  idle_o        <= '1' when r.active = '0' and r.level = 0 and r.under_test = 0 else '0';

end architecture rtl;
