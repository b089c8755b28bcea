-- ============================================================================
-- dsp_plane_test - does a plane meet a sphere? Exact, in fixed point
-- ----------------------------------------------------------------------------
-- d = n.c + p, signed integers. MODE 0 tests both sides by one adder:
--   d >= 0: sum_o = d - R * 2^17 - 1, negative when they meet
--   d < 0:  sum_o = d + R * 2^17, not negative when they meet
-- MODE 1: sum_o = d + R * 2^17. MODE 2: sum_o = d - R * 2^17.
--   @1  x                                        DSP48 1: A register
--   @2  nx*x; y                                  1: M; 2: A
--   @3  nx*x + p; ny*y; z                        1: P; 2: M; 3: A
--   @4  ... + ny*y; nz*z                         2: P; 3: M
--   @5  ... + nz*z = d; R                        3: P; 4: A:B
--   @6  sum_o                                    4: P
-- A clock's x_i meets the nx that is loaded up to then; y_i and z_i likewise, and p is
-- the one that is loaded up to the clock of y_i.
-- Four DSP48, a cascade through PCOUT and PCIN; the plane stays in their B registers and
-- in C of the first. The two of a tile share C and its register: 2 gets that of 1.
-- model: cmodel/include/raplas/fixed_point.hpp     tests: tb/unit/dsp_plane_test
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
library unisim;
use unisim.vcomponents.all;

entity dsp_plane_test is
  generic (
    MODE : natural range 0 to 2 := 0  -- 0: |d| <= R * 2^17, 1: d + R * 2^17, 2: d - R * 2^17
  );
  port (
    clk_i   : in  std_ulogic;
    load_i  : in  std_ulogic;                      -- takes nx_i, ny_i, nz_i and p_i
    nx_i    : in  std_ulogic_vector(17 downto 0);  -- plane n.x + p = 0, LSB 2^-17
    ny_i    : in  std_ulogic_vector(17 downto 0);
    nz_i    : in  std_ulogic_vector(17 downto 0);
    p_i     : in  std_ulogic_vector(35 downto 0);  -- LSB 2^-34
    x_i     : in  std_ulogic_vector(17 downto 0);  -- centre, LSB 2^-17
    y_i     : in  std_ulogic_vector(17 downto 0);  -- a clock after x_i
    z_i     : in  std_ulogic_vector(17 downto 0);  -- two clocks after x_i
    r_i     : in  std_ulogic_vector(17 downto 0);  -- R, not negative; four clocks after x_i
    above_o : out std_ulogic;                      -- d >= 0
    meets_o : out std_ulogic;                      -- MODE 0: |d| <= R * 2^17; else sum_o >= 0
    sum_o   : out std_ulogic_vector(47 downto 0)   -- all outputs PLANE_TEST_STAGES after x_i
  );
end entity dsp_plane_test;

architecture rtl of dsp_plane_test is
  constant OPMODE_C_M     : std_logic_vector(6 downto 0) := "0110101";  -- Z = C, X and Y = M
  constant OPMODE_PCIN_M  : std_logic_vector(6 downto 0) := "0010101";  -- Z = PCIN, X and Y = M
  constant OPMODE_PCIN_AB : std_logic_vector(6 downto 0) := "0010011";  -- Z = PCIN, X = A:B
  constant ZERO_18        : std_logic_vector(17 downto 0) := (others => '0');
  constant ZERO_48        : std_logic_vector(47 downto 0) := (others => '0');

  type opmodes_t is array (1 to 3) of std_logic_vector(6 downto 0);
  constant OPMODES : opmodes_t := (OPMODE_C_M, OPMODE_PCIN_M, OPMODE_PCIN_M);
  type words_18_t is array (1 to 3) of std_logic_vector(17 downto 0);
  type words_48_t is array (0 to 3) of std_logic_vector(47 downto 0);
  signal n       : words_18_t;
  signal c       : words_18_t;
  signal p       : words_48_t;  -- C port of DSP48 k: that of the first tile, that of the second
  signal cascade : words_48_t;  -- PCOUT of DSP48 k
  signal sums    : words_48_t;  -- P of DSP48 k
  signal r_high  : std_logic_vector(17 downto 0);
  signal r_low   : std_logic_vector(17 downto 0);
  signal minus   : std_ulogic;
  signal carry   : std_ulogic;
  signal above   : std_ulogic;
  signal sum     : std_logic_vector(47 downto 0);
begin

  n(1) <= std_logic_vector(nx_i);
  n(2) <= std_logic_vector(ny_i);
  n(3) <= std_logic_vector(nz_i);
  c(1) <= std_logic_vector(x_i);
  c(2) <= std_logic_vector(y_i);
  c(3) <= std_logic_vector(z_i);
  p(0) <= ZERO_48;
  p(1)(35 downto 0)  <= std_logic_vector(p_i);
  p(1)(47 downto 36) <= (others => p_i(35));
  p(2) <= p(1);
  p(3) <= ZERO_48;
  cascade(0) <= ZERO_48;
  sums(0)    <= ZERO_48;

  terms_g : for k in 1 to 3 generate
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
        A          => c(k),
        B          => n(k),
        C          => p(k),
        BCIN       => ZERO_18,
        PCIN       => cascade(k - 1),
        CARRYIN    => '0',
        OPMODE     => OPMODES(k),
        SUBTRACT   => '0',
        CARRYINSEL => "00",
        P          => sums(k),
        BCOUT      => open,
        PCOUT      => cascade(k),
        CLK        => clk_i,
        CEA        => '1',
        CEB        => load_i,
        CEC        => load_i,
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
  end generate terms_g;

  -- A:B = R * 2^17; not negative
  r_high <= '0' & std_logic_vector(r_i(17 downto 1));
  r_low  <= r_i(0) & ZERO_18(16 downto 0);
  minus  <= '1' when MODE = 2 or (MODE = 0 and sums(3)(47) = '0') else '0';
  carry  <= minus when MODE = 0 else '0';

  radius_i : DSP48
    generic map (
      AREG          => 1,
      BREG          => 1,
      CREG          => 1,
      MREG          => 0,
      PREG          => 1,
      CARRYINREG    => 0,
      CARRYINSELREG => 0,
      OPMODEREG     => 0,
      SUBTRACTREG   => 0,
      B_INPUT       => "DIRECT",
      LEGACY_MODE   => "NONE"
    )
    port map (
      A          => r_high,
      B          => r_low,
      C          => p(3),
      BCIN       => ZERO_18,
      PCIN       => cascade(3),
      CARRYIN    => carry,
      OPMODE     => OPMODE_PCIN_AB,
      SUBTRACT   => minus,
      CARRYINSEL => "00",
      P          => sum,
      BCOUT      => open,
      PCOUT      => open,
      CLK        => clk_i,
      CEA        => '1',
      CEB        => '1',
      CEC        => load_i,
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

  above_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      above <= not sums(3)(47);
    end if;
  end process above_p;

  above_o <= above;
  meets_o <= not (above xor sum(47)) when MODE = 0 else not sum(47);
  sum_o   <= std_ulogic_vector(sum);

end architecture rtl;
