// What the arithmetic must give, by its definition: MPFR holds exact reals, and rounds to 17 bits toward
// zero. Shares no code with raplas/float.hpp.
#pragma once

#include <mpfr.h>

#include <cstdint>

namespace raplas::oracle {

/// An fp24 word's value as an exact real; -0 and zeros with a fraction are 0.
class Real {
 public:
  Real() {
    mpfr_init2(value_, kPrecision);
    mpfr_set_zero(value_, 1);
  }
  explicit Real(std::uint32_t word) : Real() {
    const int exponent = static_cast<int>((word >> 16) & 127);
    if (exponent != 0) {
      mpfr_set_ui_2exp(value_, (word & 0xffff) | 0x10000, exponent - 63 - 16, MPFR_RNDN);
      mpfr_setsign(value_, value_, (word >> 23) & 1, MPFR_RNDN);
    }
  }
  Real(const Real& other) : Real() { mpfr_set(value_, other.value_, MPFR_RNDN); }
  Real& operator=(const Real& other) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~Real() { mpfr_clear(value_); }

  [[nodiscard]] mpfr_ptr get() { return value_; }
  [[nodiscard]] mpfr_srcptr get() const { return value_; }

  /// Truncated to 17 significant bits; under 2^-62 it is +0, over the largest number that number.
  [[nodiscard]] std::uint32_t word() const {
    mpfr_t rounded;
    mpfr_init2(rounded, 17);
    mpfr_set(rounded, value_, MPFR_RNDZ);
    std::uint32_t bits = 0;
    if (mpfr_zero_p(rounded) == 0) {
      const std::uint32_t sign = mpfr_signbit(rounded) != 0 ? 0x800000U : 0U;
      const long exponent = mpfr_get_exp(rounded) - 1 + 63;  // mpfr's significand is in [1/2, 1)
      if (exponent > 127) {
        bits = sign | 0x7fffff;
      } else if (exponent >= 1) {
        mpfr_abs(rounded, rounded, MPFR_RNDN);
        mpfr_mul_2si(rounded, rounded, 16 + 63 - exponent, MPFR_RNDN);
        bits = sign | (static_cast<std::uint32_t>(exponent) << 16) |
               (static_cast<std::uint32_t>(mpfr_get_ui(rounded, MPFR_RNDN)) & 0xffff);
      }
    }
    mpfr_clear(rounded);
    return bits;
  }

 private:
  // exact for sums of two numbers (126 + 18 bits) and products (34 bits)
  static constexpr mpfr_prec_t kPrecision = 160;
  mpfr_t value_;
};

/// a + b, exact, then truncated.
[[nodiscard]] inline std::uint32_t add(std::uint32_t a, std::uint32_t b) {
  const Real x(a);
  const Real y(b);
  Real sum;
  mpfr_add(sum.get(), x.get(), y.get(), MPFR_RNDN);
  return sum.word();
}

/// a + b of an adder with a few guard bits and no sticky bit: the operand of smaller magnitude is first cut
/// `guard_bits` below the last bit of the larger one. 0 guard bits: the paper's 18-bit datapath.
[[nodiscard]] inline std::uint32_t add_cut(std::uint32_t a, std::uint32_t b, int guard_bits) {
  Real larger(a);
  Real smaller(b);
  std::uint32_t exponent_word = a;
  if (mpfr_cmpabs(larger.get(), smaller.get()) < 0) {
    mpfr_swap(larger.get(), smaller.get());
    exponent_word = b;
  }
  const long ulp = static_cast<long>((exponent_word >> 16) & 127) - 63 - 16 - guard_bits;
  mpfr_mul_2si(smaller.get(), smaller.get(), -ulp, MPFR_RNDN);
  mpfr_trunc(smaller.get(), smaller.get());
  mpfr_mul_2si(smaller.get(), smaller.get(), ulp, MPFR_RNDN);
  Real sum;
  mpfr_add(sum.get(), larger.get(), smaller.get(), MPFR_RNDN);
  return sum.word();
}

/// a * b, exact, then truncated.
[[nodiscard]] inline std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
  const Real x(a);
  const Real y(b);
  Real product;
  mpfr_mul(product.get(), x.get(), y.get(), MPFR_RNDN);
  return product.word();
}

/// The same number with the other sign.
[[nodiscard]] inline std::uint32_t negate(std::uint32_t a) { return a ^ 0x800000U; }

}  // namespace raplas::oracle
