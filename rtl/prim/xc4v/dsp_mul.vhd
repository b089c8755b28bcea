-- ============================================================================
-- dsp_mul - registered unsigned 17 x 17 multiplier
-- ----------------------------------------------------------------------------
--   @1  product                                  DSP48 M register
--   @2  output register                          DSP48 P register
-- One DSP48. Exact: the 18-bit ports are signed, bit 17 is 0. The two DSP48s of a
-- Virtex-4 tile share one C port and its register (CREG = 1 here): to share a tile
-- with a dsp_addsub this one gets the same c_i, and ignores it.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/dsp_mul
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library unisim;
use unisim.vcomponents.all;

entity dsp_mul is
  port (
    clk_i : in  std_ulogic;
    c_i   : in  std_ulogic_vector(47 downto 0);  -- C port of the tile: not used, see above
    a_i   : in  std_ulogic_vector(16 downto 0);
    b_i   : in  std_ulogic_vector(16 downto 0);
    p_o   : out std_ulogic_vector(33 downto 0)
  );
end entity dsp_mul;

architecture rtl of dsp_mul is
  constant OPMODE_M : std_logic_vector(6 downto 0) := "0000101";  -- Z = 0, X and Y = M
  constant ZERO_18  : std_logic_vector(17 downto 0) := (others => '0');
  constant ZERO_48  : std_logic_vector(47 downto 0) := (others => '0');
  signal a : std_logic_vector(17 downto 0);
  signal b : std_logic_vector(17 downto 0);
  signal c : std_logic_vector(47 downto 0);
  signal p : std_logic_vector(47 downto 0);
begin

  a <= '0' & std_logic_vector(a_i);
  b <= '0' & std_logic_vector(b_i);
  c <= std_logic_vector(c_i);

  dsp_i : DSP48
    generic map (
      AREG          => 0,
      BREG          => 0,
      CREG          => 1,
      MREG          => 1,
      PREG          => 1,
      CARRYINREG    => 0,
      CARRYINSELREG => 0,
      OPMODEREG     => 0,
      SUBTRACTREG   => 0,
      B_INPUT       => "DIRECT",
      LEGACY_MODE   => "MULT18X18S"
    )
    port map (
      A          => a,
      B          => b,
      C          => c,
      BCIN       => ZERO_18,
      PCIN       => ZERO_48,
      CARRYIN    => '0',
      OPMODE     => OPMODE_M,
      SUBTRACT   => '0',
      CARRYINSEL => "00",
      P          => p,
      BCOUT      => open,
      PCOUT      => open,
      CLK        => clk_i,
      CEA        => '1',
      CEB        => '1',
      CEC        => '1',
      CEM        => '1',
      CECARRYIN  => '1',
      CECINSUB   => '1',
      CECTRL     => '1',
      CEP        => '1',
      RSTA       => '0',
      RSTB       => '0',
      RSTC       => '0',
      RSTM       => '0',
      RSTCARRYIN => '0',
      RSTCTRL    => '0',
      RSTP       => '0'
    );

  p_o <= std_ulogic_vector(p(33 downto 0));

end architecture rtl;
