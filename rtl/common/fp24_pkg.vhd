-- ============================================================================
-- fp24_pkg - fields of an fp24 word
-- ----------------------------------------------------------------------------
-- Sign, exponent, fraction. Exponent field 0 is zero, whatever the fraction;
-- 1..127 are normal numbers with a hidden one.
-- model: cmodel/include/raplas/float.hpp     tests: tb/unit/fp_add, tb/unit/fp_mul
-- ============================================================================
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library raplas;
use raplas.raplas_constants.all;

package fp24_pkg is

  constant SIGNIFICAND_BITS : natural := FRACTION_BITS + 1;

  subtype exponent_t is unsigned(EXPONENT_BITS - 1 downto 0);
  subtype significand_t is unsigned(SIGNIFICAND_BITS - 1 downto 0);

  constant FP24_ZERO : fp24_t := (others => '0');

  function sign_of(x : fp24_t) return std_ulogic;
  function exponent_of(x : fp24_t) return exponent_t;
  function is_zero(x : fp24_t) return boolean;
  -- with the hidden bit; 0 for zero
  function significand_of(x : fp24_t) return significand_t;
  -- exponent and fraction as one integer: orders magnitudes
  function magnitude_of(x : fp24_t) return unsigned;
  -- x with its sign flipped where flip = '1'; zero stays +0
  function flip_sign(x : fp24_t; flip : std_ulogic) return fp24_t;
  -- the largest finite number of this sign
  function saturated(sign : std_ulogic) return fp24_t;

end package fp24_pkg;

package body fp24_pkg is

  function sign_of(x : fp24_t) return std_ulogic is
  begin
    return x(FP_BITS - 1);
  end function sign_of;

  function exponent_of(x : fp24_t) return exponent_t is
  begin
    return unsigned(x(FP_BITS - 2 downto FRACTION_BITS));
  end function exponent_of;

  function is_zero(x : fp24_t) return boolean is
  begin
    return exponent_of(x) = 0;
  end function is_zero;

  function significand_of(x : fp24_t) return significand_t is
    variable zero_v : significand_t := (others => '0');
  begin
    if is_zero(x) then
      return zero_v;
    end if;
    return unsigned('1' & x(FRACTION_BITS - 1 downto 0));
  end function significand_of;

  function magnitude_of(x : fp24_t) return unsigned is
  begin
    return unsigned(x(FP_BITS - 2 downto 0));
  end function magnitude_of;

  function flip_sign(x : fp24_t; flip : std_ulogic) return fp24_t is
  begin
    if is_zero(x) then
      return FP24_ZERO;
    end if;
    return (x(FP_BITS - 1) xor flip) & x(FP_BITS - 2 downto 0);
  end function flip_sign;

  function saturated(sign : std_ulogic) return fp24_t is
    variable ones_v : std_ulogic_vector(FP_BITS - 2 downto 0) := (others => '1');
  begin
    return sign & ones_v;
  end function saturated;

end package body fp24_pkg;
