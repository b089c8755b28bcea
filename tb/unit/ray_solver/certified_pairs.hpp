// Certified hits of ray_solver: their rule by MPFR, pairs and bands at the edges of its comparisons, and how
// often each of them decided.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "support/ray_triangle_pairs.hpp"

namespace raplas {

inline constexpr std::uint32_t kSignBit = 0x800000;
inline constexpr std::uint32_t kMagnitudeBits = 0x7fffff;
inline constexpr std::uint32_t kLeastNumber = 0x010000;  ///< 2^-62

inline int exponent_of(std::uint32_t word) { return static_cast<int>(word >> 16 & 127); }
/// The number `steps` numbers of its sign farther from zero.
inline std::uint32_t farther(std::uint32_t word, int steps) {
  const int magnitude = static_cast<int>(word & kMagnitudeBits) + steps;
  const int clamped = std::clamp(magnitude, int{kLeastNumber}, int{kMagnitudeBits});
  return (word & kSignBit) | static_cast<std::uint32_t>(clamped);
}

/// The comparisons of the rule.
enum Check : std::size_t {
  kAnyPlace,     ///< d is so far below what it is compared with that nothing else matters
  kUInside,      ///< -band <= u'
  kVInside,      ///< -band <= v'
  kSumInside,    ///< u' + v' <= d + band
  kBefore,       ///< 0 < t'
  kAnyDepth,     ///< t' is so far below that its sign doesn't matter
  kNotParallel,  ///< 0 < d
  kRoughD,       ///< d is somewhat below what it is compared with
  kRoughT,       ///< t' is
  kUnsureD,      ///< d is far below
  kUnsureT,      ///< t' is
  kChecks,
};
using Checks = std::array<bool, kChecks>;

/// What they say of a pair, and which of them are within one step of saying the opposite.
struct Verdict {
  Solution<F> solution;
  Checks says{};
  Checks close{};
  bool negative_sum = false;  ///< u' + v' < -(d + band)
  int band_at = 0;            ///< the band below, at or above that of rays whose length is 1: < 0, 0, > 0
};

inline bool hit_of(const Checks& says) {
  return says[kAnyPlace] || (says[kUInside] && says[kVInside] && says[kSumInside] &&
                             (says[kBefore] || says[kAnyDepth]) && says[kNotParallel]);
}
inline bool rough_of(const Checks& says) { return says[kRoughD] || says[kRoughT]; }
inline bool unsure_of(const Checks& says) { return says[kUnsureD] || says[kUnsureT]; }

/// The power of two that a number begins with; a zero counts as 2^-63.
inline oracle::Real power_of(std::uint32_t word) {
  oracle::Real power(word);
  const bool zero = mpfr_zero_p(power.get()) != 0;
  mpfr_set_ui_2exp(power.get(), 1, zero ? -63 : mpfr_get_exp(power.get()) - 1, MPFR_RNDN);
  return power;
}
/// That of N's largest component: what t' is compared with.
inline oracle::Real power_of(const Vector& n) {
  oracle::Real largest = power_of(n[0]);
  mpfr_max(largest.get(), largest.get(), power_of(n[1]).get(), MPFR_RNDN);
  mpfr_max(largest.get(), largest.get(), power_of(n[2]).get(), MPFR_RNDN);
  return largest;
}
/// What d is compared with: that times the band's, in units of 2^-14, the band of rays whose length is 1.
inline oracle::Real power_of(const Vector& n, std::uint32_t band) {
  static_assert(kBandExponent - kExponentBias == -14);
  oracle::Real power = power_of(n);
  mpfr_mul(power.get(), power.get(), power_of(band).get(), MPFR_RNDN);
  mpfr_mul_2si(power.get(), power.get(), 14, MPFR_RNDN);
  return power;
}
/// The power of two of x is more than `shift` places below `power`.
inline bool is_below(F x, int shift, const oracle::Real& power) {
  oracle::Real raised = power_of(x.bits());
  mpfr_mul_2si(raised.get(), raised.get(), shift, MPFR_RNDN);
  return mpfr_less_p(raised.get(), power.get()) != 0;
}

/// The solution of a pair with certified hits; `band` isn't 0.
inline Verdict certify_by_oracle(const Pair& pair, std::uint32_t band) {
  const auto real = [](std::uint32_t x) { return oracle::Real(x); };
  const auto steps = [](std::uint32_t a, std::uint32_t b) {
    return std::abs(static_cast<int>(a & kMagnitudeBits) - static_cast<int>(b & kMagnitudeBits));
  };
  Verdict verdict{solve_by_oracle(pair)};
  Solution<F>& s = verdict.solution;
  const std::uint32_t sum = add(s.u.bits(), s.v.bits());
  const std::uint32_t most = add(s.d.bits(), band);
  const auto inside = [&](F x) {
    return mpfr_cmp(real(x.bits()).get(), real(oracle::negate(band)).get()) >= 0;
  };
  const oracle::Real normal = power_of(pair.n);
  const oracle::Real normal_d = power_of(pair.n, band);
  verdict.says = {is_below(s.d, kBlindShift, normal_d),
                  inside(s.u),
                  inside(s.v),
                  mpfr_cmp(real(sum).get(), real(most).get()) <= 0,
                  mpfr_sgn(real(s.t.bits()).get()) > 0,
                  is_below(s.t, kBlindShift, normal),
                  mpfr_sgn(real(s.d.bits()).get()) > 0,
                  is_below(s.d, kRoughShift, normal_d),
                  is_below(s.t, kRoughShift, normal),
                  is_below(s.d, kUnsureShift, normal_d),
                  is_below(s.t, kUnsureShift, normal)};
  s.hit = hit_of(verdict.says);
  s.rough = rough_of(verdict.says);
  s.unsure = unsure_of(verdict.says);

  const auto edge = [](F x, int shift, const oracle::Real& power) {
    return is_below(x, shift - 1, power) && !is_below(x, shift + 1, power);
  };
  verdict.close = {edge(s.d, kBlindShift, normal_d),
                   s.u.sign() && steps(s.u.bits(), band) <= 1,
                   s.v.sign() && steps(s.v.bits(), band) <= 1,
                   sum < kSignBit && steps(sum, most) <= 1,
                   true,
                   edge(s.t, kBlindShift, normal),
                   true,
                   edge(s.d, kRoughShift, normal_d),
                   edge(s.t, kRoughShift, normal),
                   edge(s.d, kUnsureShift, normal_d),
                   edge(s.t, kUnsureShift, normal)};
  verdict.band_at = mpfr_cmp(normal_d.get(), normal.get());
  verdict.negative_sum = mpfr_cmp(real(oracle::negate(sum)).get(), real(most).get()) > 0;
  return verdict;
}

/// How often a comparison, close to its edge, decided: had it said the opposite, so had hit_o or, of a hit,
/// rough_o or unsure_o. Those of d: with bands of rays shorter and of rays longer than 1.
class Decisions {
 public:
  void count(const Verdict& verdict) {
    for (std::size_t k = 0; k < kChecks; ++k) {
      Checks other = verdict.says;
      other[k] = !other[k];
      const bool hit = hit_of(verdict.says);
      const bool decides =
          hit_of(other) != hit ||
          (hit && (rough_of(other) != rough_of(verdict.says) || unsure_of(other) != unsure_of(verdict.says)));
      const auto said = static_cast<std::size_t>(verdict.says[k] ? 1 : 0);
      if (decides && verdict.close[k]) {
        ++numbers_[k][said];
        shorter_[k][said] += verdict.band_at < 0 ? 1 : 0;
        longer_[k][said] += verdict.band_at > 0 ? 1 : 0;
      }
      negative_sums_ += k == kSumInside && decides && verdict.negative_sum ? 1 : 0;
    }
  }

  void expect_at_least(int number) const {
    for (std::size_t k = 0; k < kChecks; ++k) {
      EXPECT_GE(numbers_[k][0], number) << "comparison " << k << ", which says no, hardly ever decides";
      EXPECT_GE(numbers_[k][1], number) << "comparison " << k << ", which says yes, hardly ever decides";
    }
    for (const Check k : {kAnyPlace, kRoughD, kUnsureD}) {
      for (const std::size_t said : {0U, 1U}) {
        EXPECT_GE(shorter_[k][said], number) << "comparison " << k << " hardly ever decides of short rays";
        EXPECT_GE(longer_[k][said], number) << "comparison " << k << " hardly ever decides of long rays";
      }
    }
    EXPECT_GE(negative_sums_, number) << "hardly any sum below -(d + band)";
  }

 private:
  using Numbers = std::array<std::array<int, 2>, kChecks>;  // of each comparison, by what it said
  Numbers numbers_{};
  Numbers shorter_{};  // of them those of short rays
  Numbers longer_{};
  int negative_sums_ = 0;
};

/// A band of the size of what it is compared with, or at an end of the range.
inline std::uint32_t band_near(OperandPairs& pairs, const Solution<F>& s) {
  const std::uint32_t sum = add(s.u.bits(), s.v.bits());
  const std::array<std::uint32_t, 6> sizes{
      s.u.bits(),   s.v.bits(),    subtract(sum, s.d.bits()), pairs.word(pairs.between(1, 127)),
      kLeastNumber, kMagnitudeBits};
  const auto which = static_cast<std::size_t>(pairs.between(0, 5));
  return farther(sizes[which] & kMagnitudeBits, pairs.between(-1, 1));
}

/// A pair and its band.
struct BandedPair {
  Pair pair;
  std::uint32_t band = 0;
};

/// x * 2^power, if the range has it.
inline std::uint32_t scaled(std::uint32_t x, int power) {
  const int exponent = exponent_of(x);
  if (exponent == 0) {
    return x;
  }
  const auto to = static_cast<std::uint32_t>(std::clamp(exponent + power, 1, 127));
  return (x & ~std::uint32_t{0x7f0000}) | to << 16;
}

/// D along an axis, as long as the band says, and T along another, of length 1, so that each of t', d, u' and
/// v' is a word of the triangle, d and u', v' times that length: d and t' at the edges of being far below
/// what they are compared with, u', v' and their sum at those of the band.
inline BandedPair aimed_pair(OperandPairs& pairs) {
  const auto positive = [&](int exponent) { return pairs.word(exponent) & kMagnitudeBits; };
  const auto number = [&](int exponent) { return positive(std::clamp(exponent, 1, 127)); };
  const auto fall = [&] {
    constexpr std::array kFalls{0, 0, 1, 2, 2, 3, 3, 4, 5, 10, 11};
    return kFalls[static_cast<std::size_t>(pairs.between(0, 10))];
  };

  // d's exponent is top + the band's - kBandExponent - fall_d. So d is of the band's size only if top is
  // near kBandExponent; at the ends of the range, or where d is far too large, it isn't
  const int kind = pairs.between(0, 4);
  const int fall_d = pairs.between(0, 15) == 0 ? pairs.between(-60, 60) : fall();
  const int over_d = kind == 4 ? pairs.between(1, 4) : pairs.between(-8, 2);  // the band's exponent over d's
  const int range = pairs.between(0, 7);
  const int top = range == 0   ? pairs.between(1, 14)
                  : range == 1 ? pairs.between(118, 127)
                  : range == 2 ? pairs.between(1, 127)
                               : std::clamp(kBandExponent + fall_d - over_d, 1, 127);
  const int length = pairs.bits(1) != 0   ? pairs.between(-4, 4)
                     : pairs.bits(2) == 0 ? pairs.between(-kBandExponent + 1, 127 - kBandExponent)
                                          : pairs.between(-30, 30);  // the ray's, as an exponent
  const std::uint32_t band = number(kBandExponent + length);
  const std::uint32_t d = positive(top + length - fall_d);
  const int side = pairs.between(0, 7);
  const std::uint32_t t = side == 0 ? 0 : positive(top - fall()) | (side < 3 ? kSignBit : 0);

  const int size = exponent_of(d);
  const std::uint32_t edge = farther(band, pairs.between(-1, 1));
  std::uint32_t u = oracle::negate(edge);
  std::uint32_t v = number(size - pairs.between(1, 4));
  if (kind == 1) {
    std::swap(u, v);
  } else if (kind == 2 || kind == 3) {  // the sum; one addend negative, or neither
    v = kind == 2 ? v : oracle::negate(number(exponent_of(band) - pairs.between(1, 4)));
    u = subtract(farther(add(d, band), pairs.between(-1, 1)), v);
    if (pairs.bits(1) != 0) {
      std::swap(u, v);
    }
  } else if (kind == 4) {  // both negative
    v = oracle::negate(farther(band, -pairs.between(0, 3)));
  }

  // D = (a 2^power, 0, 0), T = (0, b, 0), D x T = (0, 0, a b 2^power), and s is the sign of N.D
  const int power = std::clamp(std::max(length, length - fall_d), -62, 64);
  const std::uint32_t a = pairs.bits(1) << 23;
  const std::uint32_t b = pairs.bits(1) << 23;
  const std::uint32_t s = exponent_of(d) == 0 ? 0 : pairs.bits(1) << 23;
  constexpr std::uint32_t kOne = 0x3f0000;
  const auto anything = [&] { return pairs.word(pairs.between(0, 127)); };
  const auto apart = [power](std::uint32_t x) { return scaled(x, -power); };
  const Vector n{apart(d) ^ s ^ a, t ^ s ^ b,
                 pairs.word(pairs.bits(2) == 0 ? top - pairs.between(1, 12) : top)};
  const Vector e1{anything(), anything(), apart(v) ^ s ^ a ^ b};
  const Vector e2{anything(), anything(), apart(u) ^ s ^ a ^ b ^ kSignBit};
  const std::uint32_t here = anything();
  const Vector v0{here, kOne | b, 0};
  const Vector o{here, 0, 0};
  const Vector ray{scaled(kOne, power) | a, 0, 0};

  const int turn = pairs.between(0, 2);
  const auto turned = [turn](Vector vector) {
    std::rotate(vector.begin(), vector.begin() + turn, vector.end());
    return vector;
  };
  return {{turned(v0), turned(e1), turned(e2), turned(n), turned(o), turned(ray)}, band};
}

}  // namespace raplas
