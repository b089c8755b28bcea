-- ============================================================================
-- delay - a word, STAGES clocks later
-- ----------------------------------------------------------------------------
-- For side-band data beside a pipeline. Tie rst_i to '0' for data words (the
-- line then fits SRL16s); connect it for valid bits. STAGES = 0 is a wire.
-- model: cmodel/include/raplas/clocked.hpp     tests: with every unit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;

entity delay is
  generic (
    WIDTH  : positive := 1;
    STAGES : natural  := 1
  );
  port (
    clk_i  : in  std_ulogic;
    rst_i  : in  std_ulogic;                             -- clears the whole line
    data_i : in  std_ulogic_vector(WIDTH - 1 downto 0);
    data_o : out std_ulogic_vector(WIDTH - 1 downto 0)   -- data_i of STAGES clocks ago
  );
end entity delay;

architecture rtl of delay is
  type line_t is array (0 to STAGES) of std_ulogic_vector(WIDTH - 1 downto 0);
  signal line_r : line_t;
begin

  line_r(0) <= data_i;

  stages_g : for k in 1 to STAGES generate
    stage_p : process (clk_i)
    begin
      if rising_edge(clk_i) then
        if rst_i = '1' then
          line_r(k) <= (others => '0');
        else
          line_r(k) <= line_r(k - 1);
        end if;
      end if;
    end process stage_p;
  end generate stages_g;

  data_o <= line_r(STAGES);

end architecture rtl;
