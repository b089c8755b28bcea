-- ============================================================================
-- depth_quotient - t'/d as a depth code, a little too low
-- ----------------------------------------------------------------------------
--   @1  reciprocal of d's top fraction bits; exponents subtracted
--   @3  significand of t' times the reciprocal               dsp_mul
--   @4  normalise by one bit, saturate, pack
-- q <= code of t'/d <= q + 3. The reciprocal is floor(2^21 / (1025 + top ten
-- fraction bits of d)): never above that of d. Codes below 2^10 go on downward,
-- exponent 0, and end at 0; the largest is the last but one. Signs are ignored.
-- One DSP48.
-- model: cmodel/include/raplas/ray_triangle.hpp     tests: tb/unit/depth_quotient
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;

entity depth_quotient is
  port (
    clk_i : in  std_ulogic;
    t_i   : in  fp24_t;                                       -- t', not zero
    d_i   : in  fp24_t;                                       -- |N.D|, not zero
    q_o   : out std_ulogic_vector(DEPTH_BITS - 1 downto 0)    -- ADD_STAGES later
  );
end entity depth_quotient;

architecture rtl of depth_quotient is

  constant RECIPROCAL_BITS : natural := DEPTH_FRACTION_BITS + 1;
  constant TOP             : natural := FRACTION_BITS + RECIPROCAL_BITS;   -- of the product: 27
  constant E_BITS          : natural := EXPONENT_BITS + 2;

  subtype reciprocal_t is std_ulogic_vector(RECIPROCAL_BITS - 1 downto 0);
  type reciprocals_t is array (natural range 0 to 2 ** DEPTH_FRACTION_BITS - 1) of reciprocal_t;

  function reciprocals return reciprocals_t is
    variable table_v : reciprocals_t;
  begin
    for i in table_v'range loop
      table_v(i) := std_ulogic_vector(to_unsigned(
        2 ** (2 * DEPTH_FRACTION_BITS + 1) / (2 ** DEPTH_FRACTION_BITS + 1 + i), RECIPROCAL_BITS));
    end loop;
    return table_v;
  end function reciprocals;

  constant RECIPROCAL : reciprocals_t := reciprocals;

  signal reciprocal_s1  : reciprocal_t;
  signal significand_s1 : std_ulogic_vector(FRACTION_BITS downto 0);
  signal exponent_s1    : std_ulogic_vector(E_BITS - 1 downto 0);   -- signed, if the product is < 2
  signal exponent_s3    : std_ulogic_vector(E_BITS - 1 downto 0);
  signal factor_s1      : std_ulogic_vector(FRACTION_BITS downto 0);
  signal product_s3     : std_ulogic_vector(2 * FRACTION_BITS + 1 downto 0);
  signal c              : std_ulogic_vector(47 downto 0);

begin

  operands_p : process (clk_i)
    variable t_v : signed(E_BITS - 1 downto 0);
    variable d_v : signed(E_BITS - 1 downto 0);
  begin
    if rising_edge(clk_i) then
      reciprocal_s1 <= RECIPROCAL(to_integer(unsigned(
        d_i(FRACTION_BITS - 1 downto FRACTION_BITS - DEPTH_FRACTION_BITS))));
      significand_s1 <= '1' & t_i(FRACTION_BITS - 1 downto 0);
      t_v := signed(resize(exponent_of(t_i), E_BITS));
      d_v := signed(resize(exponent_of(d_i), E_BITS));
      exponent_s1 <= std_ulogic_vector(t_v - d_v + (DEPTH_BIAS - 1));
    end if;
  end process operands_p;

  factor_s1 <= std_ulogic_vector(resize(unsigned(reciprocal_s1), FRACTION_BITS + 1));
  c         <= std_ulogic_vector(resize(unsigned(significand_s1), 48));   -- not used

  product_i : entity raplas.dsp_mul
    port map (clk_i => clk_i, c_i => c, a_i => significand_s1, b_i => factor_s1,
              p_o => product_s3);

  exponent_i : entity raplas.delay
    generic map (WIDTH => E_BITS, STAGES => 2)
    port map (clk_i => clk_i, rst_i => '0', data_i => exponent_s1, data_o => exponent_s3);

  pack_p : process (clk_i)
    variable exponent_v : signed(E_BITS - 1 downto 0);
    variable code_v     : unsigned(DEPTH_BITS - 1 downto 0);
    variable last_v     : unsigned(DEPTH_BITS - 1 downto 0);
  begin
    if rising_edge(clk_i) then
      last_v    := (others => '1');
      last_v(0) := '0';
      if product_s3(TOP) = '1' then
        exponent_v := signed(exponent_s3) + 1;
        code_v     := unsigned(exponent_v(DEPTH_EXPONENT_BITS - 1 downto 0))
          & unsigned(product_s3(TOP - 1 downto TOP - DEPTH_FRACTION_BITS));
      else
        exponent_v := signed(exponent_s3);
        code_v     := unsigned(exponent_v(DEPTH_EXPONENT_BITS - 1 downto 0))
          & unsigned(product_s3(TOP - 2 downto TOP - DEPTH_FRACTION_BITS - 1));
      end if;
      if exponent_v < 0 then
        code_v := (others => '0');
      elsif exponent_v >= 2 ** DEPTH_EXPONENT_BITS or code_v > last_v then
        code_v := last_v;
      end if;
      q_o <= std_ulogic_vector(code_v);
    end if;
  end process pack_p;

end architecture rtl;
