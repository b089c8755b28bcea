-- ============================================================================
-- pair_issue - lets pairs go to the ray-triangle subunit, a ray never too soon
-- ----------------------------------------------------------------------------
--   @0  pair issued: addresses of the Ray and Triangle memories
-- The nearest hit of a ray is read and written back within HAZARD_CLOCKS: until
-- then the next pair of the same ray waits, and those behind it.
-- model: cmodel/include/raplas/selector.hpp     tests: tb/unit/pair_issue
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library raplas;
use raplas.raplas_constants.all;

entity pair_issue is
  generic (
    RAY_BITS : positive := 2 * LINE_BITS
  );
  port (
    clk_i   : in  std_ulogic;
    rst_i   : in  std_ulogic;
    valid_i : in  std_ulogic;                                    -- a pair waits
    ray_i   : in  std_ulogic_vector(RAY_BITS - 1 downto 0);
    issue_o : out std_ulogic;                                    -- it goes in this clock
    stall_o : out std_ulogic                                     -- it is held back in this clock
  );
end entity pair_issue;

architecture rtl of pair_issue is

  -- from the clock in which the best hit is requested to the one in which a result is visible there
  constant HAZARD_CLOCKS : positive := MEMORY_STAGES + MUL_STAGES + 1;

  type recent_t is record
    valid : std_ulogic;
    ray   : std_ulogic_vector(RAY_BITS - 1 downto 0);
  end record;
  type history_t is array (1 to HAZARD_CLOCKS - 1) of recent_t;   -- pair of k clocks ago

  signal history : history_t;
  signal blocked : std_ulogic;
  signal issue   : std_ulogic;

begin

  blocked_p : process (history, ray_i)
  begin
    blocked <= '0';
    for k in history'range loop
      if history(k).valid = '1' and history(k).ray = ray_i then
        blocked <= '1';
      end if;
    end loop;
  end process blocked_p;

  issue   <= valid_i and not blocked;
  issue_o <= issue;
  stall_o <= valid_i and blocked;

  history_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      history(1).valid <= issue;
      history(1).ray   <= ray_i;
      for k in 2 to HAZARD_CLOCKS - 1 loop
        history(k) <= history(k - 1);
      end loop;
      if rst_i = '1' then
        for k in history'range loop
          history(k).valid <= '0';
        end loop;
      end if;
    end if;
  end process history_p;

end architecture rtl;
