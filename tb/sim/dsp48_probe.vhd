-- ============================================================================
-- dsp48_probe - one DSP48 with all its ports, for the comparison of its models
-- ----------------------------------------------------------------------------
-- Simulation only. The generics choose which registers exist.
-- tests: tb/sim/dsp48_bench.cpp
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library unisim;
use unisim.vcomponents.all;

entity dsp48_probe is
  generic (
    AB_REGS   : integer := 1;        -- AREG and BREG
    C_REGS    : integer := 1;        -- CREG
    M_REGS    : integer := 1;        -- MREG
    P_REGS    : integer := 1;        -- PREG
    CTRL_REGS : integer := 1;        -- OPMODE, CARRYINSEL, SUBTRACT and CARRYIN registers
    SOURCE    : string  := "DIRECT"  -- B_INPUT
  );
  port (
    clk_i        : in  std_ulogic;
    a_i          : in  std_ulogic_vector(17 downto 0);
    b_i          : in  std_ulogic_vector(17 downto 0);
    bcin_i       : in  std_ulogic_vector(17 downto 0);
    c_i          : in  std_ulogic_vector(47 downto 0);
    pcin_i       : in  std_ulogic_vector(47 downto 0);
    opmode_i     : in  std_ulogic_vector(6 downto 0);
    carryinsel_i : in  std_ulogic_vector(1 downto 0);
    carryin_i    : in  std_ulogic;
    subtract_i   : in  std_ulogic;
    enable_i     : in  std_ulogic_vector(7 downto 0);  -- A B C M CARRYIN CINSUB CTRL P
    reset_i      : in  std_ulogic_vector(6 downto 0);  -- A B C M CARRYIN CTRL P
    p_o          : out std_ulogic_vector(47 downto 0);
    pcout_o      : out std_ulogic_vector(47 downto 0);
    bcout_o      : out std_ulogic_vector(17 downto 0)
  );
end entity dsp48_probe;

architecture rtl of dsp48_probe is
  signal p     : std_logic_vector(47 downto 0);
  signal pcout : std_logic_vector(47 downto 0);
  signal bcout : std_logic_vector(17 downto 0);
begin

  dsp_i : DSP48
    generic map (
      AREG => AB_REGS, BREG => AB_REGS, CREG => C_REGS, MREG => M_REGS, PREG => P_REGS,
      OPMODEREG => CTRL_REGS, CARRYINSELREG => CTRL_REGS, SUBTRACTREG => CTRL_REGS,
      CARRYINREG => CTRL_REGS, B_INPUT => SOURCE, LEGACY_MODE => "MULT18X18S"
    )
    port map (
      CLK => clk_i,
      A => std_logic_vector(a_i), B => std_logic_vector(b_i), BCIN => std_logic_vector(bcin_i),
      C => std_logic_vector(c_i), PCIN => std_logic_vector(pcin_i),
      OPMODE => std_logic_vector(opmode_i), CARRYINSEL => std_logic_vector(carryinsel_i),
      CARRYIN => carryin_i, SUBTRACT => subtract_i,
      CEA => enable_i(7), CEB => enable_i(6), CEC => enable_i(5), CEM => enable_i(4),
      CECARRYIN => enable_i(3), CECINSUB => enable_i(2), CECTRL => enable_i(1), CEP => enable_i(0),
      RSTA => reset_i(6), RSTB => reset_i(5), RSTC => reset_i(4), RSTM => reset_i(3),
      RSTCARRYIN => reset_i(2), RSTCTRL => reset_i(1), RSTP => reset_i(0),
      P => p, PCOUT => pcout, BCOUT => bcout
    );

  p_o     <= std_ulogic_vector(p);
  pcout_o <= std_ulogic_vector(pcout);
  bcout_o <= std_ulogic_vector(bcout);

end architecture rtl;
