-- ============================================================================
-- event_counters - what a pencil cost
-- ----------------------------------------------------------------------------
-- COUNTER_BITS each, cleared when a pencil starts, kept until the next one does.
-- spheres_skipped starts at the number of spheres and loses one for each tested.
-- model: cmodel/include/raplas/intersection_unit.hpp     tests: tb/integration
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity event_counters is
  port (
    clk_i       : in  std_ulogic;
    clear_i     : in  std_ulogic;                                -- first clock of a pencil
    spheres_i   : in  std_ulogic_vector(ID_BITS downto 0);       -- in the scene
    rows_i      : in  std_ulogic_vector(LINE_BITS downto 0);
    columns_i   : in  std_ulogic_vector(LINE_BITS downto 0);
    busy_i      : in  std_ulogic;
    sphere_i    : in  std_ulogic;                                -- a sphere is at the testers ...
    first_set_i : in  std_ulogic;                                -- ... with its first plane set
    issue_i     : in  std_ulogic;                                -- a pair goes to ray_triangle
    first_hit_i : in  std_ulogic;                                -- a ray is hit for the first time
    stall_i     : in  std_ulogic;                                -- a pair is held back
    counters_o  : out std_ulogic_vector(NUM_COUNTERS * COUNTER_BITS - 1 downto 0)
  );
end entity event_counters;

architecture rtl of event_counters is
  subtype counter_t is unsigned(COUNTER_BITS - 1 downto 0);
  type counters_t is array (0 to NUM_COUNTERS - 1) of counter_t;
  signal r   : counters_t;
  signal rin : counters_t;
begin

  comb_p : process (r, clear_i, spheres_i, rows_i, columns_i, busy_i, sphere_i, first_set_i,
                    issue_i, first_hit_i, stall_i)
    variable v : counters_t;
  begin
    v := r;
    if clear_i = '1' then
      for k in v'range loop
        v(k) := (others => '0');
      end loop;
      v(COUNTER_SPHERES_SKIPPED) := resize(unsigned(spheres_i), COUNTER_BITS);
    end if;
    if busy_i = '1' then
      v(COUNTER_CYCLES) := v(COUNTER_CYCLES) + 1;
    end if;
    if sphere_i = '1' and first_set_i = '1' then
      v(COUNTER_SPHERES_TESTED)  := v(COUNTER_SPHERES_TESTED) + 1;
      v(COUNTER_SPHERES_SKIPPED) := v(COUNTER_SPHERES_SKIPPED) - 1;
      v(COUNTER_PLANE_TESTS)     := v(COUNTER_PLANE_TESTS) + unsigned(rows_i) + unsigned(columns_i);
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
    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
    end if;
  end process reg_p;

  bus_g : for k in 0 to NUM_COUNTERS - 1 generate
    counters_o((k + 1) * COUNTER_BITS - 1 downto k * COUNTER_BITS) <= std_ulogic_vector(r(k));
  end generate bus_g;

end architecture rtl;
