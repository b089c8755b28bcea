// The number format of the accelerator as one template, and its two instances Fp24 and Fp24Paper.
//
// A word is sign, exponent, fraction. Exponent field 0 is zero (the fraction is ignored, and written as 0
// with sign +); every other field is a normal number, significand * 2^(exponent - bias - fraction bits).
// No infinity, NaN or subnormal: underflow gives +0, overflow the largest finite number of that sign.
#pragma once

#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "raplas/constants.hpp"

namespace raplas {

/// What the adder keeps of the aligned smaller operand below the last bit of the larger one.
enum class Guard : int {
  none = 0,   ///< nothing: the paper's 18-bit datapath
  one = 1,    ///< one guard bit
  exact = 2,  ///< one guard bit and a sticky bit: the exact sum is rounded
};

/// How a result is brought to the significand's width.
enum class Rounding : int {
  toward_zero,   ///< truncate magnitudes: the hardware
  nearest_even,  ///< IEEE 754's default; needs Guard::exact
};

/// Parameters of a floating-point format.
struct Format {
  int exponent_bits;
  int fraction_bits;
  Guard guard;
  Rounding rounding;
};

/// A number of one format. Every operation is total: no traps, no special values.
template <Format kFormat>
class Float {
 public:
  static constexpr int kExponentBits = kFormat.exponent_bits;
  static constexpr int kFractionBits = kFormat.fraction_bits;
  static constexpr int kBits = 1 + kExponentBits + kFractionBits;
  static constexpr int kBias = (1 << (kExponentBits - 1)) - 1;
  static constexpr int kMaxExponent = (1 << kExponentBits) - 1;
  static_assert(kExponentBits >= 2 && kExponentBits <= 10 && kFractionBits >= 2 && kFractionBits <= 23);
  static_assert(kFormat.rounding == Rounding::toward_zero || kFormat.guard == Guard::exact);

  /// Zero.
  constexpr Float() noexcept = default;

  /// The number with these bits; bits above kBits must be 0.
  [[nodiscard]] static constexpr Float from_bits(std::uint32_t bits) noexcept { return Float(bits); }
  [[nodiscard]] constexpr std::uint32_t bits() const noexcept { return bits_; }

  [[nodiscard]] constexpr bool sign() const noexcept { return ((bits_ >> (kBits - 1)) & 1U) != 0; }
  [[nodiscard]] constexpr int exponent() const noexcept {
    return static_cast<int>((bits_ >> kFractionBits) & kExponentMask);
  }
  /// Significand with its hidden bit, 0 for zero.
  [[nodiscard]] constexpr std::uint32_t significand() const noexcept {
    return is_zero() ? 0U : ((bits_ & kFractionMask) | kHidden);
  }
  /// Exponent and fraction as one integer: orders magnitudes. A zero's ignored fraction counts here.
  [[nodiscard]] constexpr std::uint32_t magnitude() const noexcept { return bits_ & kMagnitudeMask; }
  [[nodiscard]] constexpr bool is_zero() const noexcept { return exponent() == 0; }

  /// The largest finite number.
  [[nodiscard]] static constexpr Float max() noexcept { return Float(kMagnitudeMask); }
  /// The smallest number above zero.
  [[nodiscard]] static constexpr Float min() noexcept { return Float(kHidden); }

  /// The same magnitude with the sign flipped; zero stays +0.
  [[nodiscard]] constexpr Float negated() const noexcept {
    return is_zero() ? Float() : Float(bits_ ^ kSignMask);
  }

  [[nodiscard]] friend constexpr Float operator+(Float a, Float b) noexcept { return add(a, b); }
  [[nodiscard]] friend constexpr Float operator-(Float a, Float b) noexcept {
    return add(a, Float(b.bits_ ^ kSignMask));
  }

  /// The product, rounded.
  [[nodiscard]] friend constexpr Float operator*(Float a, Float b) noexcept {
    const std::uint64_t product = std::uint64_t{a.significand()} * b.significand();
    return normalised(a.sign() != b.sign(), a.exponent() + b.exponent() - kBias - kFractionBits, product);
  }

  [[nodiscard]] friend constexpr bool operator==(Float a, Float b) noexcept = default;

  /// The value, exactly.
  [[nodiscard]] double to_double() const noexcept {
    constexpr int kDoubleBias = 1023;
    constexpr int kDoubleFractionBits = 52;
    const std::uint64_t sign_bit = static_cast<std::uint64_t>(sign()) << 63;
    if (is_zero()) {
      return std::bit_cast<double>(sign_bit);
    }
    const int biased = exponent() - kBias + kDoubleBias;
    const auto exponent_field = static_cast<std::uint64_t>(biased);
    const std::uint64_t fraction = significand() ^ kHidden;
    return std::bit_cast<double>(sign_bit | (exponent_field << kDoubleFractionBits) |
                                 (fraction << (kDoubleFractionBits - kFractionBits)));
  }

  /// The nearest number (ties to even); magnitudes under the smallest normal go to the nearer of 0 and it.
  /// Throws std::range_error naming `what` and the value when it is NaN or too large.
  [[nodiscard]] static Float from_double(double value, const char* what = "number") {
    return convert(value, what, false);
  }

  /// The smallest number >= value; throws std::range_error for NaN, negative or too large values.
  [[nodiscard]] static Float from_double_up(double value, const char* what = "number") {
    if (value < 0) {
      throw std::range_error(std::string(what) + " " + std::to_string(value) + " is negative");
    }
    return convert(value, what, true);
  }

 private:
  static constexpr std::uint32_t kExponentMask = (1U << kExponentBits) - 1;
  static constexpr std::uint32_t kFractionMask = (1U << kFractionBits) - 1;
  static constexpr std::uint32_t kHidden = 1U << kFractionBits;
  static constexpr std::uint32_t kSignMask = 1U << (kBits - 1);
  static constexpr std::uint32_t kMagnitudeMask = kSignMask - 1;

  explicit constexpr Float(std::uint32_t bits) noexcept : bits_(bits) {}

  /// The sum: align the smaller magnitude, add or subtract significands, normalise.
  static constexpr Float add(Float a, Float b) noexcept {
    const bool swap = a.magnitude() < b.magnitude();
    const Float big = swap ? b : a;
    const Float small = swap ? a : b;
    const int distance = big.exponent() - small.exponent();
    constexpr int kGuardBits =
        kFormat.rounding == Rounding::nearest_even ? 3 : static_cast<int>(kFormat.guard);
    const std::uint64_t wide = std::uint64_t{small.significand()} << kGuardBits;
    std::uint64_t aligned = distance > kFractionBits + kGuardBits ? 0 : wide >> distance;
    if constexpr (kFormat.guard == Guard::exact) {
      const bool lost = distance > kFractionBits + kGuardBits ? wide != 0 : (aligned << distance) != wide;
      aligned |= lost ? 1U : 0U;
    }
    const std::uint64_t larger = std::uint64_t{big.significand()} << kGuardBits;
    const std::uint64_t sum = a.sign() == b.sign() ? larger + aligned : larger - aligned;
    return normalised(big.sign(), big.exponent() - kGuardBits, sum);
  }

  /// sign * value * 2^(exponent - kBias - kFractionBits) brought to 1 + kFractionBits significant bits.
  static constexpr Float normalised(bool sign, int exponent, std::uint64_t value) noexcept {
    if (value == 0) {
      return Float();
    }
    const int shift = 63 - std::countl_zero(value) - kFractionBits;
    exponent += shift;
    std::uint64_t significand = shift >= 0 ? value >> shift : value << -shift;
    if constexpr (kFormat.rounding == Rounding::nearest_even) {
      if (shift > 0) {
        const std::uint64_t half = std::uint64_t{1} << (shift - 1);
        const std::uint64_t rest = value & ((half << 1) - 1);
        significand += (rest > half || (rest == half && (significand & 1) != 0)) ? 1U : 0U;
        if (significand >> (kFractionBits + 1) != 0) {
          significand >>= 1;
          exponent += 1;
        }
      }
    }
    const std::uint32_t sign_bit = sign ? kSignMask : 0U;
    if (exponent < 1) {
      return Float();
    }
    if (exponent > kMaxExponent) {
      return Float(sign_bit | kMagnitudeMask);
    }
    return Float(sign_bit | (static_cast<std::uint32_t>(exponent) << kFractionBits) |
                 (static_cast<std::uint32_t>(significand) & kFractionMask));
  }

  static Float convert(double value, const char* what, bool up) {
    const double magnitude = std::abs(value);
    if (!(magnitude <= max().to_double())) {
      throw std::range_error(std::string(what) + " " + std::to_string(value) +
                             " is outside the number format");
    }
    if (magnitude < min().to_double()) {
      const bool to_zero = up ? magnitude == 0 : 2 * magnitude <= min().to_double();
      return to_zero ? Float() : Float((value < 0 ? kSignMask : 0U) | kHidden);
    }
    int exponent = 0;
    const double scaled = std::ldexp(std::frexp(magnitude, &exponent), kFractionBits + 1);
    double significand = up ? std::ceil(scaled) : std::nearbyint(scaled);
    if (significand == std::ldexp(1.0, kFractionBits + 1)) {
      significand /= 2;
      exponent += 1;
    }
    exponent += kBias - 1;
    if (exponent > kMaxExponent) {
      return Float((value < 0 ? kSignMask : 0U) | kMagnitudeMask);
    }
    return Float((value < 0 ? kSignMask : 0U) | (static_cast<std::uint32_t>(exponent) << kFractionBits) |
                 (static_cast<std::uint32_t>(significand) & kFractionMask));
  }

  std::uint32_t bits_ = 0;
};

/// The accelerator's numbers: every add, subtract and multiply is the exact result truncated toward zero.
using Fp24 = Float<Format{raplas::kExponentBits, raplas::kFractionBits, Guard::exact, Rounding::toward_zero}>;
/// The same words with the paper's adder, which has no guard bits.
using Fp24Paper =
    Float<Format{raplas::kExponentBits, raplas::kFractionBits, Guard::none, Rounding::toward_zero}>;

/// An exact product of two magnitudes: significand (up to 2 * (kFractionBits + 1) bits) and exponent sum.
/// Ordering two of them orders the exact real products, since they are normalised.
struct ExactProduct {
  int exponent = 0;
  std::uint64_t significand = 0;

  friend constexpr auto operator<=>(ExactProduct, ExactProduct) noexcept = default;
};

/// |a| * |b|, exactly; zero is {0, 0} and below everything else.
template <Format kFormat>
[[nodiscard]] constexpr ExactProduct exact_product(Float<kFormat> a, Float<kFormat> b) noexcept {
  const std::uint64_t product = std::uint64_t{a.significand()} * b.significand();
  if (product == 0) {
    return {};
  }
  constexpr int kTop = 2 * kFormat.fraction_bits + 1;
  const bool carry = (product >> kTop) != 0;
  return {a.exponent() + b.exponent() + (carry ? 1 : 0), carry ? product : product << 1};
}

}  // namespace raplas
