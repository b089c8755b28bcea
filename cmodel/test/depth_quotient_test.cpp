// depth_quotient against floor(t / d) in integers. For one reciprocal the code stays, and the true one only
// falls with d: so the smallest and the largest d of each reciprocal show the errors of all. With
// RAPLAS_CASES set every pair of fractions is taken, all 2^32.
#include <gtest/gtest.h>

#include <cstdlib>

#include "raplas/ray_triangle.hpp"

namespace raplas {
namespace {

constexpr std::uint32_t kOne = 1U << kFractionBits;
constexpr std::uint32_t kStep = 1U << (kFractionBits - kDepthFractionBits);  // values of d to a reciprocal
constexpr int kLowest = -12;                                                 // exponent - DEPTH_BIAS
constexpr int kMostError = 3;

/// Code of the exact quotient of two significands, exponents equal: DEPTH_BIAS stands for 1.
int floor_code(std::uint32_t t, std::uint32_t d) {
  const std::uint64_t one = 1U << kDepthFractionBits;
  const bool below = t < d;
  const std::uint64_t scaled = std::uint64_t{t} * one * (below ? 2 : 1) / d;
  return (kDepthBias - (below ? 1 : 0)) * static_cast<int>(one) + static_cast<int>(scaled - one);
}

int error(std::uint32_t t, std::uint32_t d) {
  constexpr std::uint32_t kExponent = 63U << kFractionBits;
  const auto word = [](std::uint32_t significand) {
    return Fp24::from_bits(kExponent | (significand & (kOne - 1)));
  };
  return floor_code(t, d) - static_cast<int>(depth_quotient(word(t), word(d)));
}

TEST(DepthQuotient, IsNeverAboveAndAtMostThreeCodesBelow) {
  int least = kMostError;
  int most = 0;
  const bool all = std::getenv("RAPLAS_CASES") != nullptr;
  for (std::uint32_t d = kOne; d < 2 * kOne; d += all || d % kStep == kStep - 1 ? 1 : kStep - 1) {
    for (std::uint32_t t = kOne; t < 2 * kOne; ++t) {
      const int e = error(t, d);
      least = e < least ? e : least;
      most = e > most ? e : most;
    }
  }
  EXPECT_EQ(least, 0);
  EXPECT_EQ(most, kMostError);
  EXPECT_LT(most, kQuotientError);
}

TEST(DepthQuotient, IsConservativeOverTheWholeRangeOfExponents) {
  constexpr int kCodes = 1 << kDepthFractionBits;
  for (int difference = kLowest - kDepthBias; difference <= 20; ++difference) {
    for (std::uint32_t k = 0; k < 4096; ++k) {
      const std::uint32_t t = kOne + k * 40503U % kOne;
      const std::uint32_t d = kOne + k * 30011U % kOne;
      const auto word = [](int exponent, std::uint32_t significand) {
        return Fp24::from_bits(static_cast<std::uint32_t>(exponent) << kFractionBits |
                               (significand & (kOne - 1)));
      };
      const int code = floor_code(t, d) + difference * kCodes;  // without ends
      const int last = (1 << kDepthBits) - 2;
      const int exact = code < 0 ? 0 : (code > last ? last : code);
      const auto q = static_cast<int>(depth_quotient(word(63 + difference, t), word(63, d)));
      ASSERT_LE(q, exact) << difference << ' ' << t << ' ' << d;
      ASSERT_LE(exact - q, kMostError) << difference << ' ' << t << ' ' << d;
    }
  }
}

}  // namespace
}  // namespace raplas
