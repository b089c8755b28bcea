-- ============================================================================
-- depth_code - a distance as a depth code, and a lower bound of it
-- ----------------------------------------------------------------------------
-- code_o: d < 2^14 gives 0; else e.f, where 2^(e + 13) is d's top bit and f are the 10
-- bits below it. Floor: it never stands for more than d. Codes have the order of the
-- distances. z_o: the code less DEPTH_MARGIN, or 0.
--   @1  top group of 4 bits that isn't 0, with the 10 bits below it
--   @2  top bit in the group, f, margin
-- model: cmodel/include/raplas/fixed_point.hpp     tests: tb/unit/depth_code
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity depth_code is
  port (
    clk_i  : in  std_ulogic;
    d_i    : in  std_ulogic_vector(47 downto 0);  -- signed, LSB 2^-34, below 2^40
    code_o : out std_ulogic_vector(DEPTH_BITS - 1 downto 0);  -- both DEPTH_CODE_STAGES later
    z_o    : out std_ulogic_vector(DEPTH_BITS - 1 downto 0)
  );
end entity depth_code;

architecture rtl of depth_code is
  constant F      : natural := DEPTH_FRACTION_BITS;
  constant LOW    : natural := 2 * COORDINATE_FRACTION - DEPTH_BIAS - 1;  -- lowest bit of group 0
  constant GROUPS : natural := 7;
  -- (group, bit in it) is the exponent + 1; the margin goes with that 1
  constant TAKEN  : natural := 2 ** F + DEPTH_MARGIN;
  constant LEAST  : natural := 2;  -- (group, bit) of the least d that isn't 0

  type s1_t is record
    positive : std_ulogic;                         -- a group isn't 0
    group_no : unsigned(2 downto 0);
    window   : std_ulogic_vector(F + 3 downto 0);  -- the group, and F bits below
  end record;
  signal s1 : s1_t;
begin

  group_p : process (clk_i)
    variable v : s1_t;
  begin
    if rising_edge(clk_i) then
      v.positive := '0';
      v.group_no := (others => '0');
      v.window   := d_i(LOW + 3 downto LOW - F);
      for g in 0 to GROUPS - 1 loop
        if unsigned(d_i(LOW + 4 * g + 3 downto LOW + 4 * g)) /= 0 then
          v.positive := not d_i(47);
          v.group_no := to_unsigned(g, 3);
          v.window   := d_i(LOW + 4 * g + 3 downto LOW + 4 * g - F);
        end if;
      end loop;
      s1 <= v;
    end if;
  end process group_p;

  code_p : process (clk_i)
    variable bit_v      : unsigned(1 downto 0);
    variable fraction_v : std_ulogic_vector(F - 1 downto 0);
    variable top_v      : unsigned(DEPTH_EXPONENT_BITS - 1 downto 0);
    variable scaled_v   : unsigned(DEPTH_BITS - 1 downto 0);  -- the code of twice d
  begin
    if rising_edge(clk_i) then
      bit_v      := "00";
      fraction_v := s1.window(F - 1 downto 0);
      for k in 1 to 3 loop
        if s1.window(F + k) = '1' then
          bit_v      := to_unsigned(k, 2);
          fraction_v := s1.window(F + k - 1 downto k);
        end if;
      end loop;
      top_v    := s1.group_no & bit_v;
      scaled_v := top_v & unsigned(fraction_v);
      if s1.positive = '0' or top_v < LEAST then
        code_o <= (others => '0');
        z_o    <= (others => '0');
      else
        code_o <= std_ulogic_vector(scaled_v - 2 ** F);
        z_o    <= std_ulogic_vector(scaled_v - TAKEN);
      end if;
    end if;
  end process code_p;

end architecture rtl;
