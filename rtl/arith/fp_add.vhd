-- ============================================================================
-- fp_add - fp24 sum or difference, truncated toward zero
-- ----------------------------------------------------------------------------
--   @1  exponents subtracted, magnitudes compared            dsp_addsub
--   @2  operands swapped, the smaller shifted right          dsp_addsub A:B registers
--   @3  significands added or subtracted                     dsp_addsub P register
--   @4  normalise, saturate or flush, pack
-- GUARD_BITS 2 (a guard and a sticky bit): the exact result truncated to 17
-- significant bits. 1: a guard bit. 0: the paper's 18-bit datapath, which cuts
-- the shifted operand at the larger one's last bit before it subtracts.
-- Two DSP48 that share the C port of their tile: the exponent in bits 35..29,
-- the larger significand in the low bits. Neither disturbs the other: under the
-- exponents 0 is subtracted, and over the significands nothing is read. With
-- EXPONENT_DSP = false one DSP48: exponents are subtracted in fabric.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/fp_add
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;
use raplas.fp24_pkg.all;

entity fp_add is
  generic (
    GUARD_BITS   : natural range 0 to 2 := 2;
    SUBTRACT     : boolean := false;   -- true: a - b
    EXPONENT_DSP : boolean := true     -- false: exponents are subtracted in fabric
  );
  port (
    clk_i : in  std_ulogic;
    a_i   : in  fp24_t;
    b_i   : in  fp24_t;
    sum_o : out fp24_t   -- ADD_STAGES clocks after its operands
  );
end entity fp_add;

architecture rtl of fp_add is
  constant ALIGNED_BITS : natural := SIGNIFICAND_BITS + GUARD_BITS;
  constant SUM_BITS     : natural := ALIGNED_BITS + 1;
  constant EXPONENT_LSB : natural := 29;

  subtype aligned_t is unsigned(ALIGNED_BITS - 1 downto 0);

  type s1_t is record
    a    : fp24_t;
    b    : fp24_t;
    swap : boolean;   -- |a| < |b|
  end record;

  type s2_t is record
    sign     : std_ulogic;
    exponent : exponent_t;
    larger   : significand_t;
  end record;

  type s3_t is record
    sign     : std_ulogic;
    exponent : exponent_t;
  end record;

  type reg_t is record
    s1 : s1_t;
    s2 : s2_t;
    s3 : s3_t;
    s4 : fp24_t;
  end record;

  signal r   : reg_t;
  signal rin : reg_t;

  signal c           : std_ulogic_vector(47 downto 0);
  signal exponent_ab : std_ulogic_vector(35 downto 0);
  signal exponent_p  : std_ulogic_vector(47 downto 0);
  signal difference  : unsigned(EXPONENT_BITS - 1 downto 0);
  signal smaller     : std_ulogic_vector(35 downto 0);
  signal opposite    : std_ulogic;
  signal sum         : std_ulogic_vector(47 downto 0);

  -- significand shifted right, cut or with a sticky last bit
  function align(significand : significand_t; distance : unsigned(EXPONENT_BITS - 1 downto 0))
    return aligned_t is
    variable aligned_v : aligned_t;
    variable shifted_v : aligned_t;
    variable lost_v    : std_ulogic;
  begin
    aligned_v := shift_left(resize(significand, ALIGNED_BITS), GUARD_BITS);
    lost_v    := '0';
    for k in 0 to EXPONENT_BITS - 1 loop
      if distance(k) = '1' then
        shifted_v := shift_right(aligned_v, 2 ** k);
        if shift_left(shifted_v, 2 ** k) /= aligned_v then
          lost_v := '1';
        end if;
        aligned_v := shifted_v;
      end if;
    end loop;
    if GUARD_BITS = 2 then
      aligned_v(0) := aligned_v(0) or lost_v;
    end if;
    return aligned_v;
  end function align;

  -- total * 2^exponent brought to 17 bits: zeros are counted and removed together, 16, 8, 4, 2, 1
  function normalise(sign     : std_ulogic;
                     exponent : exponent_t;
                     total    : unsigned(SUM_BITS - 1 downto 0)) return fp24_t is
    variable shifted_v  : unsigned(SUM_BITS - 1 downto 0);
    variable exponent_v : signed(EXPONENT_BITS + 1 downto 0);
    variable zeros_v    : unsigned(4 downto 0);
  begin
    shifted_v := total;
    for k in 4 downto 0 loop
      if shifted_v(SUM_BITS - 1 downto SUM_BITS - 2 ** k) = 0 then
        shifted_v  := shift_left(shifted_v, 2 ** k);
        zeros_v(k) := '1';
      else
        zeros_v(k) := '0';
      end if;
    end loop;
    exponent_v := signed(resize(exponent, EXPONENT_BITS + 2)) + 1
      - signed(resize(zeros_v, EXPONENT_BITS + 2));
    if shifted_v(SUM_BITS - 1) = '0' or exponent_v < 1 then
      return FP24_ZERO;
    elsif exponent_v(EXPONENT_BITS) = '1' then
      return saturated(sign);
    end if;
    return sign & std_ulogic_vector(exponent_v(EXPONENT_BITS - 1 downto 0))
      & std_ulogic_vector(shifted_v(SUM_BITS - 2 downto SUM_BITS - 1 - FRACTION_BITS));
  end function normalise;

begin

  -- the C port that both DSP48s of the tile see
  c_p : process (a_i, r.s2.larger)
  begin
    c <= (others => '0');
    if EXPONENT_DSP then
      c(EXPONENT_LSB + EXPONENT_BITS - 1 downto EXPONENT_LSB)
        <= std_ulogic_vector(exponent_of(a_i));
    end if;
    c(ALIGNED_BITS - 1 downto GUARD_BITS) <= std_ulogic_vector(r.s2.larger);
  end process c_p;

  exponent_dsp_g : if EXPONENT_DSP generate
    exponent_ab <= std_ulogic_vector(exponent_of(b_i))
      & std_ulogic_vector(to_unsigned(0, EXPONENT_LSB));

    exponent_i : entity raplas.dsp_addsub
      generic map (AB_REG => 0, C_REG => 0)
      port map (
        clk_i      => clk_i,
        subtract_i => '1',
        carry_i    => '0',
        c_i        => c,
        ab_i       => exponent_ab,
        p_o        => exponent_p
      );

    difference <= unsigned(exponent_p(EXPONENT_LSB + EXPONENT_BITS - 1 downto EXPONENT_LSB));
  end generate exponent_dsp_g;

  exponent_fabric_g : if not EXPONENT_DSP generate
    difference_p : process (clk_i)
    begin
      if rising_edge(clk_i) then
        difference <= exponent_of(a_i) - exponent_of(b_i);
      end if;
    end process difference_p;
  end generate exponent_fabric_g;

  significand_i : entity raplas.dsp_addsub
    generic map (AB_REG => 1, C_REG => 0)
    port map (
      clk_i      => clk_i,
      subtract_i => opposite,
      carry_i    => '0',
      c_i        => c,
      ab_i       => smaller,
      p_o        => sum
    );

  comb_p : process (r, a_i, b_i, difference, sum)
    variable v          : reg_t;
    variable distance_v : unsigned(EXPONENT_BITS - 1 downto 0);
    variable smaller_v  : fp24_t;
    variable larger_v   : fp24_t;
  begin
    -- s1
    v.s1.a := a_i;
    v.s1.b := b_i;
    if SUBTRACT then
      v.s1.b(FP_BITS - 1) := not b_i(FP_BITS - 1);
    end if;
    v.s1.swap := magnitude_of(a_i) < magnitude_of(b_i);

    -- s2: the difference is valid with s1
    distance_v := difference;
    if r.s1.swap then
      larger_v   := r.s1.b;
      smaller_v  := r.s1.a;
      distance_v := 0 - distance_v;
    else
      larger_v  := r.s1.a;
      smaller_v := r.s1.b;
    end if;
    v.s2.sign     := sign_of(larger_v);
    v.s2.exponent := exponent_of(larger_v);
    v.s2.larger   := significand_of(larger_v);
    smaller  <= std_ulogic_vector(resize(align(significand_of(smaller_v), distance_v), 36));
    opposite <= sign_of(r.s1.a) xor sign_of(r.s1.b);

    -- s3: the sum is valid with s3
    v.s3.sign     := r.s2.sign;
    v.s3.exponent := r.s2.exponent;

    -- s4
    v.s4 := normalise(r.s3.sign, r.s3.exponent, unsigned(sum(SUM_BITS - 1 downto 0)));

    rin <= v;
  end process comb_p;

  reg_p : process (clk_i)
  begin
    if rising_edge(clk_i) then
      r <= rin;
    end if;
  end process reg_p;

  sum_o <= r.s4;

end architecture rtl;
