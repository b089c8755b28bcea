-- ============================================================================
-- dsp_multiply_add - c + a * b, signed integers
-- ----------------------------------------------------------------------------
--   @1  a, b                                     DSP48 A, B registers
--   @2  product; c                               DSP48 M, C registers
--   @3  p_o                                      DSP48 P register
-- c_i comes a clock after its a_i and b_i. Exact, modulo 2^48.
-- One DSP48. The two of a Virtex-4 tile share one C port and its register: only units whose
-- c_i is the same (0, for two products) share a tile.
-- model: plain integers     tests: tb/unit/dsp_multiply_add
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library unisim;
use unisim.vcomponents.all;

entity dsp_multiply_add is
  port (
    clk_i : in  std_ulogic;
    a_i   : in  std_ulogic_vector(17 downto 0);  -- signed
    b_i   : in  std_ulogic_vector(17 downto 0);  -- signed
    c_i   : in  std_ulogic_vector(47 downto 0);  -- signed; a clock after a_i and b_i
    p_o   : out std_ulogic_vector(47 downto 0)   -- MULTIPLY_ADD_STAGES after a_i and b_i
  );
end entity dsp_multiply_add;

architecture rtl of dsp_multiply_add is
  constant OPMODE_C_M : std_logic_vector(6 downto 0) := "0110101";  -- Z = C, X and Y = M
  constant ZERO_18    : std_logic_vector(17 downto 0) := (others => '0');
  constant ZERO_48    : std_logic_vector(47 downto 0) := (others => '0');
  signal a : std_logic_vector(17 downto 0);
  signal b : std_logic_vector(17 downto 0);
  signal c : std_logic_vector(47 downto 0);
  signal p : std_logic_vector(47 downto 0);
begin

  a <= std_logic_vector(a_i);
  b <= std_logic_vector(b_i);
  c <= std_logic_vector(c_i);

  dsp_i : DSP48
    generic map (
      AREG          => 1,
      BREG          => 1,
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
      OPMODE     => OPMODE_C_M,
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

  p_o <= std_ulogic_vector(p);

end architecture rtl;
