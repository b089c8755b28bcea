-- ============================================================================
-- unit_counters - what pencils cost, since reset
-- ----------------------------------------------------------------------------
-- BITS each, wrapping. spheres_skipped grows by the number of spheres with
-- each pencil and loses one for each tested.
-- model: cmodel/include/raplas/raplas_unit.hpp     tests: tb/unit/unit_counters
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity unit_counters is
  generic (
    BITS        : positive := COUNTER_BITS
  );
  port (
    clk_i       : in  std_ulogic;
    rst_i       : in  std_ulogic;
    spheres_i   : in  std_ulogic_vector(ID_BITS downto 0);     -- in the scene
    rows_i      : in  std_ulogic_vector(LINE_BITS downto 0);   -- of the pencil that is walked
    columns_i   : in  std_ulogic_vector(LINE_BITS downto 0);
    walk_i      : in  std_ulogic;                              -- a walk begins
    busy_i      : in  std_ulogic;                              -- a bank is busy
    request_i   : in  std_ulogic;                              -- an object goes to the testers ...
    vertex_i    : in  std_ulogic;                              -- ... and is a vertex
    issue_i     : in  std_ulogic;                              -- a pair goes to ray_solver
    first_hit_i : in  std_ulogic;                              -- a ray is hit for the first time
    stall_i     : in  std_ulogic;                              -- no pair may go
    counters_o  : out std_ulogic_vector(NUM_COUNTERS * BITS - 1 downto 0)
  );
end entity unit_counters;

architecture rtl of unit_counters is
  subtype counter_t is unsigned(BITS - 1 downto 0);
  type counters_t is array (0 to NUM_COUNTERS - 1) of counter_t;
  signal r   : counters_t;
  signal rin : counters_t;
begin

  comb_p : process (r, spheres_i, rows_i, columns_i, walk_i, busy_i, request_i, vertex_i, issue_i,
                    first_hit_i, stall_i)
    variable v       : counters_t;
    variable skipped_v : counter_t;
  begin
    v         := r;
    skipped_v := r(COUNTER_SPHERES_SKIPPED);
    if walk_i = '1' then
      skipped_v := skipped_v + resize(unsigned(spheres_i), BITS);
    end if;
    if busy_i = '1' then
      v(COUNTER_CYCLES) := v(COUNTER_CYCLES) + 1;
    end if;
    if request_i = '1' then
      v(COUNTER_PLANE_TESTS) := v(COUNTER_PLANE_TESTS) + unsigned(rows_i) + unsigned(columns_i);
      if vertex_i = '1' then
        v(COUNTER_VERTICES_TESTED) := v(COUNTER_VERTICES_TESTED) + 1;
      else
        v(COUNTER_SPHERES_TESTED) := v(COUNTER_SPHERES_TESTED) + 1;
        skipped_v                 := skipped_v - 1;
      end if;
    end if;
    if issue_i = '1' then
      v(COUNTER_PAIRS_TESTED) := v(COUNTER_PAIRS_TESTED) + 1;
    end if;
    if first_hit_i = '1' then
      v(COUNTER_HITS) := v(COUNTER_HITS) + 1;
    end if;
    if stall_i = '1' then
      v(COUNTER_STALL_CYCLES) := v(COUNTER_STALL_CYCLES) + 1;
    end if;
    v(COUNTER_SPHERES_SKIPPED) := skipped_v;
    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
      if rst_i = '1' then
        for k in r'range loop
          r(k) <= (others => '0');
        end loop;
      end if;
    end if;
  end process reg_p;

  bus_g : for k in 0 to NUM_COUNTERS - 1 generate
    counters_o((k + 1) * BITS - 1 downto k * BITS) <= std_ulogic_vector(r(k));
  end generate bus_g;

end architecture rtl;
