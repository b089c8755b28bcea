// The model's arithmetic against MPFR and exact integers.
#include "raplas/float.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "operands.hpp"
#include "oracle.hpp"

namespace raplas {
namespace {

constexpr int kRandomPairs = 400'000;

Fp24 fp(std::uint32_t bits) { return Fp24::from_bits(bits); }
Fp24Paper paper(std::uint32_t bits) { return Fp24Paper::from_bits(bits); }

/// Calls check(a, b) for all pairs of corners and many random ones.
template <typename Check>
void for_pairs(Check check) {
  for (const std::uint32_t a : kCorners) {
    for (const std::uint32_t b : kCorners) {
      check(a, b);
    }
  }
  OperandPairs pairs(1);
  for (int k = 0; k < kRandomPairs && !testing::Test::HasFailure(); ++k) {
    const auto [a, b] = pairs();
    check(a, b);
  }
}

TEST(Float, AddIsTheExactSumTruncated) {
  for_pairs([](std::uint32_t a, std::uint32_t b) {
    EXPECT_EQ((fp(a) + fp(b)).bits(), oracle::add(a, b)) << std::hex << a << " + " << b;
  });
}

TEST(Float, SubtractIsTheExactDifferenceTruncated) {
  for_pairs([](std::uint32_t a, std::uint32_t b) {
    EXPECT_EQ((fp(a) - fp(b)).bits(), oracle::add(a, oracle::negate(b))) << std::hex << a << " - " << b;
  });
}

TEST(Float, PaperAddCutsTheSmallerOperandFirst) {
  for_pairs([](std::uint32_t a, std::uint32_t b) {
    EXPECT_EQ((paper(a) + paper(b)).bits(), oracle::add_cut(a, b, 0)) << std::hex << a << " + " << b;
  });
}

TEST(Float, OneGuardBitCutsABitLower) {
  using F = Float<Format{kExponentBits, kFractionBits, Guard::one, Rounding::toward_zero}>;
  for_pairs([](std::uint32_t a, std::uint32_t b) {
    EXPECT_EQ((F::from_bits(a) + F::from_bits(b)).bits(), oracle::add_cut(a, b, 1))
        << std::hex << a << " + " << b;
  });
}

TEST(Float, PaperAddWithoutGuardBitsCanBeWrongByFarMoreThanAnUlp) {
  // 1 - (1 - 2^-17) is 2^-17; the paper's datapath gives twice that
  EXPECT_EQ((paper(0x3f0000) - paper(0x3effff)).bits(), 0x2f0000U);
  EXPECT_EQ((fp(0x3f0000) - fp(0x3effff)).bits(), 0x2e0000U);
}

TEST(Float, MultiplyIsTheExactProductTruncated) {
  for_pairs([](std::uint32_t a, std::uint32_t b) {
    EXPECT_EQ((fp(a) * fp(b)).bits(), oracle::multiply(a, b)) << std::hex << a << " * " << b;
    EXPECT_EQ((paper(a) * paper(b)).bits(), oracle::multiply(a, b)) << std::hex << a << " * " << b;
  });
}

TEST(Float, ExactProductsAreOrderedAsTheRealOnes) {
  OperandPairs pairs(2);
  for (int k = 0; k < kRandomPairs; ++k) {
    const auto [a, b] = pairs();
    const auto [c, e] = k % 2 == 0 ? pairs() : std::pair{b, a ^ (k % 4 == 1 ? 1U : 0U)};
    oracle::Real left;
    oracle::Real right;
    mpfr_mul(left.get(), oracle::Real(a).get(), oracle::Real(b).get(), MPFR_RNDN);
    mpfr_mul(right.get(), oracle::Real(c).get(), oracle::Real(e).get(), MPFR_RNDN);
    const int order = mpfr_cmpabs(left.get(), right.get());
    const auto seen = exact_product(fp(a), fp(b)) <=> exact_product(fp(c), fp(e));
    ASSERT_EQ(seen < 0, order < 0) << std::hex << a << " * " << b << " and " << c << " * " << e;
    ASSERT_EQ(seen > 0, order > 0) << std::hex << a << " * " << b << " and " << c << " * " << e;
  }
}

TEST(Float, MagnitudesOfNumbersCompareAsIntegers) {
  OperandPairs pairs(3);
  for (int k = 0; k < kRandomPairs; ++k) {
    const auto [a, b] = pairs();
    const Fp24 x = fp(a).is_zero() ? Fp24() : fp(a);
    const Fp24 y = fp(b).is_zero() ? Fp24() : fp(b);
    ASSERT_EQ(x.magnitude() <= y.magnitude(), std::abs(x.to_double()) <= std::abs(y.to_double()));
  }
}

TEST(Float, NearestEvenRoundsAsIeee754) {
  using F = Float<Format{8, 23, Guard::exact, Rounding::nearest_even}>;  // binary32's fraction, same bias
  std::mt19937 random(4);
  for (int k = 0; k < kRandomPairs; ++k) {
    const auto word = [&random] {
      return static_cast<std::uint32_t>((random() & 0x807fffffU) | ((100 + random() % 50) << 23));
    };
    const std::uint32_t a = word();
    const std::uint32_t b = word();
    const auto x = std::bit_cast<float>(a);
    const auto y = std::bit_cast<float>(b);
    ASSERT_EQ((F::from_bits(a) + F::from_bits(b)).to_double(), static_cast<double>(x + y));
    ASSERT_EQ((F::from_bits(a) * F::from_bits(b)).to_double(), static_cast<double>(x * y));
  }
}

TEST(Float, ConversionFromDoubleIsNearestEven) {
  OperandPairs pairs(5);
  for (int k = 0; k < kRandomPairs; ++k) {
    const Fp24 x = fp(pairs.word(pairs.between(1, 126)));
    const double value = x.to_double();
    ASSERT_EQ(Fp24::from_double(value), x);
    const double ulp = std::ldexp(1.0, x.exponent() - 63 - 16);
    const double direction = std::copysign(1.0, value);
    ASSERT_EQ(Fp24::from_double(value + direction * 0.49 * ulp), x);
    const double tie = Fp24::from_double(value + direction * 0.5 * ulp).to_double();
    ASSERT_EQ(tie, (x.bits() & 1) == 0 ? value : value + direction * ulp);
  }
}

TEST(Float, ConversionUpIsTheSmallestNumberNotBelow) {
  OperandPairs pairs(6);
  for (int k = 0; k < kRandomPairs; ++k) {
    const Fp24 x = fp(pairs.word(pairs.between(1, 126)) & 0x7fffffU);
    const double value = x.to_double();
    const double ulp = std::ldexp(1.0, x.exponent() - 63 - 16);
    ASSERT_EQ(Fp24::from_double_up(value), x);
    ASSERT_EQ(Fp24::from_double_up(value + ulp / 1024).to_double(), value + ulp);
  }
  EXPECT_EQ(Fp24::from_double_up(1e-300), Fp24::min());
  EXPECT_EQ(Fp24::from_double_up(0), Fp24());
}

TEST(Float, ConversionRejectsWhatHasNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)Fp24::from_double(nan), std::range_error);
  EXPECT_THROW((void)Fp24::from_double(infinity), std::range_error);
  EXPECT_THROW((void)Fp24::from_double(-1e30), std::range_error);
  EXPECT_THROW((void)Fp24::from_double_up(-1.0), std::range_error);
  EXPECT_THROW((void)Fp24::from_double_up(nan), std::range_error);
  EXPECT_EQ(Fp24::from_double(1e-30), Fp24());
}

}  // namespace
}  // namespace raplas
