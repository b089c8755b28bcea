-- ============================================================================
-- nearest_hit - is a hit nearer than the best one of its ray?
-- ----------------------------------------------------------------------------
--   @2  t' * best.d and best.t' * d              fp_product
--   @3  compared
-- t'/d < best.t'/best.d without dividing. The two products are compared in all
-- their 34 bits, neither rounded nor saturated, so that "nearer" is a total
-- order and the nearest hit doesn't depend on the order of the tests. Equal:
-- the lower triangle ID is nearer. No best hit yet: nearer. A tie: they are less
-- than 3 * 2^-TIE_SHIFT of their power of two apart; a rough one: 2^-ROUGH_TIE_SHIFT.
-- Four DSP48, two with EXPONENT_DSP = false.
-- model: cmodel/include/raplas/ray_triangle.hpp     tests: tb/unit/nearest_hit
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

entity nearest_hit is
  generic (
    EXPONENT_DSP : boolean := true   -- false: exponents are added in fabric
  );
  port (
    clk_i      : in  std_ulogic;
    t_i        : in  fp24_t;                                  -- t' > 0
    d_i        : in  fp24_t;                                  -- |N.D| > 0
    triangle_i : in  std_ulogic_vector(ID_BITS - 1 downto 0);
    best_i     : in  result_word_t;
    nearer_o   : out std_ulogic;                              -- MUL_STAGES later
    tie_o      : out std_ulogic;  -- of two hits; with nearer_o
    rough_tie_o : out std_ulogic;
    first_o    : out std_ulogic   -- the ray had no hit yet; with nearer_o
  );
end entity nearest_hit;

architecture rtl of nearest_hit is

  constant TOP     : natural := 2 * FRACTION_BITS + 1;
  constant TIE_LSB : natural := TOP - TIE_SHIFT;
  constant ROUGH_TIE_LSB : natural := TOP - ROUGH_TIE_SHIFT;
  subtype exact_t is signed(EXPONENT_BITS + 1 + TOP downto 0);   -- exponent, fraction
  subtype apart_t is signed(EXPONENT_BITS + 2 + TOP downto 0);
  subtype coarse_t is signed(EXPONENT_BITS + 2 + TOP - TIE_LSB downto 0);

  signal best          : result_t;
  signal this_sig      : std_ulogic_vector(TOP downto 0);
  signal this_exponent : std_ulogic_vector(EXPONENT_BITS + 1 downto 0);
  signal best_sig      : std_ulogic_vector(TOP downto 0);
  signal best_exponent : std_ulogic_vector(EXPONENT_BITS + 1 downto 0);
  signal side_s0       : std_ulogic_vector(1 downto 0);
  signal side_s2       : std_ulogic_vector(1 downto 0);          -- best.hit, lower ID

  -- one signed number that orders products of non-zero factors; 2^TOP is a power of two
  function ordered(exponent    : std_ulogic_vector(EXPONENT_BITS + 1 downto 0);
                   significand : std_ulogic_vector(TOP downto 0))
    return exact_t is
    variable exponent_v : signed(EXPONENT_BITS + 1 downto 0);
  begin
    exponent_v := signed(exponent);
    if significand(TOP) = '1' then
      exponent_v := exponent_v + 1;
      return exponent_v & signed(significand(TOP - 1 downto 0));
    end if;
    return exponent_v & signed(significand(TOP - 2 downto 0)) & '0';
  end function ordered;

begin

  best <= unpack_result(best_i);

  this_i : entity raplas.fp_product
    generic map (EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => t_i, b_i => best.d, significand_o => this_sig,
              exponent_o => this_exponent);

  best_product_i : entity raplas.fp_product
    generic map (EXPONENT_DSP => EXPONENT_DSP)
    port map (clk_i => clk_i, a_i => best.t, b_i => d_i, significand_o => best_sig,
              exponent_o => best_exponent);

  side_p : process (best, triangle_i)
  begin
    side_s0 <= best.hit & '0';
    if unsigned(triangle_i) < unsigned(best.triangle) then
      side_s0(0) <= '1';
    end if;
  end process side_p;

  side_i : entity raplas.delay
    generic map (WIDTH => 2, STAGES => MUL_STAGES - 1)
    port map (clk_i => clk_i, rst_i => '0', data_i => side_s0, data_o => side_s2);

  compare_p : process (clk_i)
    variable this_v   : exact_t;
    variable best_v   : exact_t;
    variable apart_v  : apart_t;
    variable coarse_v : coarse_t;
  begin
    if rising_edge(clk_i) then
      this_v   := ordered(this_exponent, this_sig);
      best_v   := ordered(best_exponent, best_sig);
      apart_v  := resize(this_v, apart_t'length) - best_v;
      coarse_v := apart_v(apart_t'left downto TIE_LSB);
      nearer_o <= '0';
      if side_s2(1) = '0' or apart_v(apart_t'left) = '1'
         or (this_v = best_v and side_s2(0) = '1') then
        nearer_o <= '1';
      end if;
      tie_o <= '0';
      if coarse_v >= -3 and coarse_v < 3 then
        tie_o <= '1';
      end if;
      rough_tie_o <= '0';
      if apart_v(apart_t'left downto ROUGH_TIE_LSB) = 0
         or apart_v(apart_t'left downto ROUGH_TIE_LSB) = -1 then
        rough_tie_o <= '1';
      end if;
      first_o <= not side_s2(1);
    end if;
  end process compare_p;

end architecture rtl;
