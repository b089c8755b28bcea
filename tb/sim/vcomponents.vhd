-- ============================================================================
-- vcomponents - the Virtex-4 cells that rtl/prim/xc4v instantiates
-- ----------------------------------------------------------------------------
-- Analysed into library unisim for GHDL only: ISE brings its own package with
-- the same components. Ports and generics have the vendor's names and types.
-- models: tb/sim/dsp48.vhd (GHDL); Yosys' cells_sim.v (Verilator)
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;

package vcomponents is

  -- 18 x 18 bit multiplier, 48-bit adder, and their pipeline registers
  component DSP48 is
    generic (
      AREG          : integer := 1;             -- registers on A: 0, 1 or 2
      B_INPUT       : string  := "DIRECT";      -- or "CASCADE": B comes from BCIN
      BREG          : integer := 1;             -- registers on B: 0, 1 or 2
      CARRYINREG    : integer := 1;
      CARRYINSELREG : integer := 1;
      CREG          : integer := 1;
      LEGACY_MODE   : string  := "MULT18X18S";  -- for the vendor's timing model only
      MREG          : integer := 1;
      OPMODEREG     : integer := 1;
      PREG          : integer := 1;
      SUBTRACTREG   : integer := 1
    );
    port (
      BCOUT      : out std_logic_vector(17 downto 0);
      P          : out std_logic_vector(47 downto 0);
      PCOUT      : out std_logic_vector(47 downto 0);
      A          : in  std_logic_vector(17 downto 0);
      B          : in  std_logic_vector(17 downto 0);
      BCIN       : in  std_logic_vector(17 downto 0);
      C          : in  std_logic_vector(47 downto 0);
      CARRYIN    : in  std_ulogic;
      CARRYINSEL : in  std_logic_vector(1 downto 0);
      CEA        : in  std_ulogic;
      CEB        : in  std_ulogic;
      CEC        : in  std_ulogic;
      CECARRYIN  : in  std_ulogic;
      CECINSUB   : in  std_ulogic;
      CECTRL     : in  std_ulogic;
      CEM        : in  std_ulogic;
      CEP        : in  std_ulogic;
      CLK        : in  std_ulogic;
      OPMODE     : in  std_logic_vector(6 downto 0);
      PCIN       : in  std_logic_vector(47 downto 0);
      RSTA       : in  std_ulogic;
      RSTB       : in  std_ulogic;
      RSTC       : in  std_ulogic;
      RSTCARRYIN : in  std_ulogic;
      RSTCTRL    : in  std_ulogic;
      RSTM       : in  std_ulogic;
      RSTP       : in  std_ulogic;
      SUBTRACT   : in  std_ulogic
    );
  end component DSP48;

end package vcomponents;
