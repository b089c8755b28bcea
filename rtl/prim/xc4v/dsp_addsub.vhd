-- ============================================================================
-- dsp_addsub - registered 48-bit adder/subtracter: p = c +- (ab + carry)
-- ----------------------------------------------------------------------------
--   @1  (AB_REG = 1: ab, subtract, carry; C_REG = 1: c) input registers
--   @1 + inputs  sum                             DSP48 P register
-- One DSP48. The two DSP48s of a Virtex-4 tile share one C port and its
-- register: two instances that are to share a tile get the same c_i and C_REG.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/dsp_addsub
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library unisim;
use unisim.vcomponents.all;

entity dsp_addsub is
  generic (
    AB_REG : natural := 0;  -- 1: ab_i, subtract_i and carry_i are registered first
    C_REG  : natural := 0   -- 1: c_i is registered first
  );
  port (
    clk_i      : in  std_ulogic;
    subtract_i : in  std_ulogic;                      -- 1: c - (ab + carry)
    carry_i    : in  std_ulogic;
    c_i        : in  std_ulogic_vector(47 downto 0);
    ab_i       : in  std_ulogic_vector(35 downto 0);  -- sign-extended to 48 bits
    p_o        : out std_ulogic_vector(47 downto 0)
  );
end entity dsp_addsub;

architecture rtl of dsp_addsub is
  constant OPMODE_C_AB : std_logic_vector(6 downto 0) := "0110011";  -- Z = C, Y = 0, X = A:B
  constant ZERO_18     : std_logic_vector(17 downto 0) := (others => '0');
  constant ZERO_48     : std_logic_vector(47 downto 0) := (others => '0');
  signal a : std_logic_vector(17 downto 0);
  signal b : std_logic_vector(17 downto 0);
  signal c : std_logic_vector(47 downto 0);
  signal p : std_logic_vector(47 downto 0);
begin

  a <= std_logic_vector(ab_i(35 downto 18));
  b <= std_logic_vector(ab_i(17 downto 0));
  c <= std_logic_vector(c_i);

  dsp_i : DSP48
    generic map (
      AREG          => AB_REG,
      BREG          => AB_REG,
      CREG          => C_REG,
      MREG          => 0,
      PREG          => 1,
      CARRYINREG    => AB_REG,
      CARRYINSELREG => 0,
      OPMODEREG     => 0,
      SUBTRACTREG   => AB_REG,
      B_INPUT       => "DIRECT",
      LEGACY_MODE   => "NONE"
    )
    port map (
      A          => a,
      B          => b,
      C          => c,
      BCIN       => ZERO_18,
      PCIN       => ZERO_48,
      CARRYIN    => carry_i,
      OPMODE     => OPMODE_C_AB,
      SUBTRACT   => subtract_i,
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
