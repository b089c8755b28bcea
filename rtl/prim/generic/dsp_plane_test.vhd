-- ============================================================================
-- dsp_plane_test - does a plane meet a sphere? Exact, in fixed point
-- ----------------------------------------------------------------------------
-- d = n.c + p, signed integers. MODE 0 tests both sides by one adder:
--   d >= 0: sum_o = d - R * 2^17 - 1, negative when they meet
--   d < 0:  sum_o = d + R * 2^17, not negative when they meet
-- MODE 1: sum_o = d + R * 2^17. MODE 2: sum_o = d - R * 2^17.
--   @1  x              @2  nx*x; y
--   @3  nx*x + p; ny*y; z                        sum (1)
--   @4  sum (1) + ny*y; nz*z                     sum (2)
--   @5  sum (2) + nz*z = d; R
--   @6  sum_o
-- A clock's x_i meets the nx that is loaded up to then; y_i and z_i likewise, and p is
-- the one that is loaded up to the clock of y_i.
-- plain VHDL twin of prim/xc4v/dsp_plane_test.
-- model: cmodel/include/raplas/fixed_point.hpp     tests: tb/unit/dsp_plane_test
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

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
  type coordinates_t is array (0 to 2) of signed(17 downto 0);
  type products_t is array (0 to 2) of signed(35 downto 0);
  type sums_t is array (0 to 2) of signed(47 downto 0);
  signal n     : coordinates_t;
  signal p     : signed(35 downto 0);
  signal c     : coordinates_t;
  signal m     : products_t;
  signal s     : sums_t;          -- s(2) = d
  signal r     : signed(47 downto 0);
  signal minus : std_ulogic;
  signal above : std_ulogic;
  signal sum   : signed(47 downto 0);
begin

  plane_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if load_i = '1' then
        n(0) <= signed(nx_i);
        n(1) <= signed(ny_i);
        n(2) <= signed(nz_i);
        p    <= signed(p_i);
      end if;
    end if;
  end process plane_p;

  distance_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      c(0) <= signed(x_i);
      c(1) <= signed(y_i);
      c(2) <= signed(z_i);
      for k in 0 to 2 loop
        m(k) <= c(k) * n(k);
      end loop;
      s(0) <= resize(p, 48) + resize(m(0), 48);
      s(1) <= s(0) + resize(m(1), 48);
      s(2) <= s(1) + resize(m(2), 48);
      r              <= (others => '0');
      r(34 downto 17) <= signed(r_i);
    end if;
  end process distance_p;

  minus <= '1' when MODE = 2 or (MODE = 0 and s(2)(47) = '0') else '0';

  sum_p : process (clk_i)
    variable carry_v : signed(1 downto 0);
  begin
    if rising_edge(clk_i) then
      above   <= not s(2)(47);
      carry_v := "00";
      if MODE = 0 then
        carry_v(0) := minus;
      end if;
      if minus = '1' then
        sum <= s(2) - (r + carry_v);
      else
        sum <= s(2) + (r + carry_v);
      end if;
    end if;
  end process sum_p;

  above_o <= above;
  meets_o <= not (above xor sum(47)) when MODE = 0 else not sum(47);
  sum_o   <= std_ulogic_vector(sum);

end architecture rtl;
