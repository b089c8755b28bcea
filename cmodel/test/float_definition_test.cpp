// The model's operators against their definition in exact integers: all pairs of small formats, all pairs of
// fractions for the multiplier, and very many biased pairs for the adder. RAPLAS_CASES: pairs for the adder;
// set, it also asks for all 2^32 pairs of fractions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <vector>

#include "figures.hpp"
#include "operands.hpp"
#include "oracle.hpp"
#include "random.hpp"
#include "raplas/float.hpp"

namespace raplas {
namespace {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

constexpr std::uint64_t kAddPairs = 10'000'000;
constexpr std::uint32_t kShortRows = 128;  ///< of 2^16 fractions, in the short run

bool is_long() { return std::getenv("RAPLAS_CASES") != nullptr; }

/// What all tests of this program found.
class Totals : public testing::Environment {
 public:
  static Totals& get() {
    static auto* const totals = static_cast<Totals*>(testing::AddGlobalTestEnvironment(new Totals));
    return *totals;
  }

  void TearDown() override {
    Figures figures;
    for (const auto& [name, value] : values) {
      figures.add("model." + name, value, name == "mismatches" ? "results" : "pairs");
    }
    figures.write();
  }

  std::map<std::string, std::uint64_t> values;
};

const Totals& kRegistered = Totals::get();  // before main()

/// Counts results and prints the first ones that are wrong.
struct Judge {
  std::uint64_t mismatches = 0;

  void check(std::uint32_t seen, std::uint32_t expected, const char* what, std::uint32_t a, std::uint32_t b) {
    if (seen != expected) [[unlikely]] {
      ++mismatches;
      if (mismatches <= 5) {
        ADD_FAILURE() << what << std::hex << " " << a << ", " << b << ": " << seen << ", not " << expected;
      }
    }
  }

  void report(const char* name, std::uint64_t pairs) const {
    std::printf("model.%s %llu mismatches %llu\n", name, static_cast<unsigned long long>(pairs),
                static_cast<unsigned long long>(mismatches));
    Totals::get().values[name] += pairs;
    Totals::get().values["mismatches"] += mismatches;
    EXPECT_EQ(mismatches, 0U);
    EXPECT_GT(pairs, 0U);
  }
};

/// The definition for a format F whose exact sums and products fit an Int128. Numbers are integers in units
/// of 2^-kScale of the smallest number's last place.
template <typename F>
struct Definition {
  static constexpr int kScale = 1;  // one guard bit lies half a unit lower
  static constexpr int kSignificandBits = F::kFractionBits + 1;

  static Int128 value(std::uint32_t word) {
    const auto exponent = static_cast<int>(word >> F::kFractionBits) & F::kMaxExponent;
    if (exponent == 0) {
      return 0;
    }
    const std::uint32_t significand = (word & ((1U << F::kFractionBits) - 1)) | (1U << F::kFractionBits);
    const Int128 magnitude = Int128{significand} << (exponent - 1 + kScale);
    return (word >> (F::kBits - 1)) != 0 ? -magnitude : magnitude;
  }

  /// The word for exact / 2^extra units: as many significant bits as fit, then flush or saturate.
  static std::uint32_t rounded(Int128 exact, int extra, Rounding rounding) {
    const bool negative = exact < 0;
    const Int128 magnitude = negative ? -exact : exact;
    if (magnitude == 0) {
      return 0;
    }
    int exponent = 1 - kScale - extra;  // of the result with `drop` bits dropped, below
    int drop = 0;
    while ((magnitude >> drop) >> kSignificandBits != 0) {
      ++drop;
    }
    Int128 significand = magnitude >> drop;
    const Int128 rest = magnitude - (significand << drop);
    if (rounding == Rounding::nearest_even) {
      const Int128 twice = 2 * rest;
      const Int128 ulp = Int128{1} << drop;
      significand += twice > ulp || (twice == ulp && drop > 0 && significand % 2 != 0) ? 1 : 0;
    }
    exponent += drop;
    while (significand >> F::kFractionBits == 0) {
      significand *= 2;
      --exponent;
    }
    if (significand >> kSignificandBits != 0) {
      significand /= 2;
      ++exponent;
    }
    const std::uint32_t sign = negative ? 1U << (F::kBits - 1) : 0U;
    if (exponent < 1) {
      return 0;
    }
    if (exponent > F::kMaxExponent) {
      return sign | ((1U << (F::kBits - 1)) - 1);
    }
    return sign | (static_cast<std::uint32_t>(exponent) << F::kFractionBits) |
           (static_cast<std::uint32_t>(significand) & ((1U << F::kFractionBits) - 1));
  }

  static std::uint32_t add(std::uint32_t a, std::uint32_t b, Guard guard, Rounding rounding) {
    Int128 x = value(a);
    Int128 y = value(b);
    if (guard != Guard::exact) {
      // the smaller operand is cut `guard` bits below the larger one's last place
      const bool swap = (x < 0 ? -x : x) < (y < 0 ? -y : y);
      const std::uint32_t larger = swap ? b : a;
      Int128& smaller = swap ? x : y;
      const auto exponent = static_cast<int>(larger >> F::kFractionBits) & F::kMaxExponent;
      const Int128 place = exponent == 0 ? 1 : Int128{1} << (exponent - 1 + kScale - static_cast<int>(guard));
      smaller -= smaller % place;  // % has the sign of the dividend: toward zero
    }
    return rounded(x + y, 0, rounding);
  }

  static std::uint32_t multiply(std::uint32_t a, std::uint32_t b, Rounding rounding) {
    // the smallest number's last place is 2^(1 - bias - fraction bits)
    const int units = F::kBias + F::kFractionBits - 1;
    return rounded(value(a) * value(b), units + kScale, rounding);
  }
};

template <int kExponent, int kFraction, Guard kGuard, Rounding kRounding>
void check_format(Judge& judge, std::uint64_t& pairs) {
  using F = Float<Format{kExponent, kFraction, kGuard, kRounding}>;
  using D = Definition<F>;
  constexpr std::uint32_t kWords = 1U << F::kBits;
  std::vector<std::pair<Int128, ExactProduct>> products;
  for (std::uint32_t a = 0; a < kWords; ++a) {
    const F x = F::from_bits(a);
    for (std::uint32_t b = 0; b < kWords; ++b) {
      const F y = F::from_bits(b);
      judge.check((x + y).bits(), D::add(a, b, kGuard, kRounding), "add", a, b);
      judge.check((x - y).bits(), D::add(a, b ^ (kWords / 2), kGuard, kRounding), "subtract", a, b);
      judge.check((x * y).bits(), D::multiply(a, b, kRounding), "multiply", a, b);
      const Int128 va = D::value(a);
      const Int128 vb = D::value(b);
      if (!x.is_zero() && !y.is_zero()) {  // words of zeros are written as 0 before they are compared
        const bool less = (va < 0 ? -va : va) <= (vb < 0 ? -vb : vb);
        judge.check(x.magnitude() <= y.magnitude() ? 1 : 0, less ? 1 : 0, "magnitude", a, b);
      }
      if (a < kWords / 2 && b <= a) {
        products.emplace_back(va * vb, exact_product(x, y));
        const ExactProduct swapped = exact_product(y.negated(), x);
        judge.check(swapped == products.back().second ? 1 : 0, 1, "exact product's signs", a, b);
      }
      ++pairs;
    }
  }
  // Exact products are ordered as the real ones if neighbours in the real order are.
  std::sort(products.begin(), products.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
  for (std::size_t k = 1; k < products.size(); ++k) {
    const auto& [real, product] = products[k - 1];
    const auto& [next_real, next] = products[k];
    judge.check(real == next_real ? product == next : product < next, 1, "order of exact products",
                static_cast<std::uint32_t>(k), 0);
  }
}

template <int kExponent, int kFraction>
void check_formats(Judge& judge, std::uint64_t& pairs) {
  check_format<kExponent, kFraction, Guard::none, Rounding::toward_zero>(judge, pairs);
  check_format<kExponent, kFraction, Guard::one, Rounding::toward_zero>(judge, pairs);
  check_format<kExponent, kFraction, Guard::exact, Rounding::toward_zero>(judge, pairs);
  check_format<kExponent, kFraction, Guard::exact, Rounding::nearest_even>(judge, pairs);
}

TEST(FloatDefinition, AllPairsOfSmallFormatsAreByDefinition) {
  Judge judge;
  std::uint64_t pairs = 0;
  check_formats<4, 3>(judge, pairs);
  check_formats<3, 4>(judge, pairs);
  check_formats<4, 5>(judge, pairs);
  check_formats<3, 6>(judge, pairs);
  if (is_long()) {
    check_formats<5, 4>(judge, pairs);
    check_formats<2, 7>(judge, pairs);
    check_formats<5, 5>(judge, pairs);
  }
  judge.report("small_format_pairs", pairs);
}

/// All fractions at exponents 1.0 x 1.0, where a product is 1 to 4: by the inequality that truncation means.
TEST(FloatDefinition, ProductsOfAllFractionsAreTruncated) {
  Judge judge;
  const std::uint32_t step = is_long() ? 1 : 0x10000 / kShortRows + 1;
  std::uint64_t pairs = 0;
  for (std::uint32_t a = 0; a < 0x10000; a += step) {
    const Fp24 x = Fp24::from_bits(0x3f0000 | a);
    std::uint32_t bad = 0;
    for (std::uint32_t b = 0; b < 0x10000; ++b) {
      const Fp24 y = Fp24::from_bits(0x3f0000 | b);
      const std::uint64_t exact = std::uint64_t{0x10000 + a} * (0x10000 + b);  // units of 2^-32
      const std::uint32_t product = (x * y).bits();
      const std::uint32_t exponent = product >> 16;  // with a sign that must be 0
      const std::uint64_t significand = 0x10000 | (product & 0xffff);
      const std::uint64_t ulp = exponent == 0x3f ? 0x10000 : 0x20000;  // of 1 .. 2 or 2 .. 4
      const std::uint64_t rest = exact - significand * ulp;            // 0 .. ulp - 1; wraps if negative
      const ExactProduct whole = exact_product(x, y);
      // all of its 34 bits, left-aligned: value = significand / 2^33 * 2^(exponent - 2 * 63)
      const bool whole_right = (whole.exponent == 126 || whole.exponent == 127) &&
                               whole.significand >> 33 == 1 &&
                               (whole.significand << (whole.exponent - 126)) == 2 * exact;
      bad += (exponent != 0x3f && exponent != 0x40) || rest >= ulp || !whole_right ? 1U : 0U;
    }
    pairs += 0x10000;
    judge.check(bad, 0, "products of fraction", a, 0);
  }
  judge.report("mul_fraction_pairs", pairs);
}

/// Exponents only add: all of them, with fractions on both sides of every carry.
TEST(FloatDefinition, ProductsOfAllExponentsFlushAndSaturate) {
  constexpr std::array<std::uint32_t, 8> kFractions{0, 1, 0x6a09, 0x6a0a, 0x8000, 0xb504, 0xfffe, 0xffff};
  Judge judge;
  std::uint64_t pairs = 0;
  for (std::uint32_t exponents = 0; exponents < 0x4000; ++exponents) {
    for (const std::uint32_t fa : kFractions) {
      for (const std::uint32_t fb : kFractions) {
        for (std::uint32_t signs = 0; signs < 4; ++signs) {
          const std::uint32_t ea = exponents >> 7;
          const std::uint32_t eb = exponents & 127;
          const std::uint32_t a = ((signs & 1) << 23) | (ea << 16) | fa;
          const std::uint32_t b = ((signs >> 1) << 23) | (eb << 16) | fb;
          const std::uint64_t exact = std::uint64_t{0x10000 + fa} * (0x10000 + fb);
          const std::uint32_t carry = exact >> 33 != 0 ? 1 : 0;
          const int exponent = static_cast<int>(ea + eb + carry) - 63;
          const std::uint32_t sign = ((signs & 1) ^ (signs >> 1)) << 23;
          std::uint32_t expected = 0;
          if (ea != 0 && eb != 0 && exponent >= 1) {
            expected =
                sign | (exponent > 127 ? 0x7fffffU
                                       : (static_cast<std::uint32_t>(exponent) << 16) |
                                             (static_cast<std::uint32_t>(exact >> (16 + carry)) & 0xffffU));
          }
          judge.check((Fp24::from_bits(a) * Fp24::from_bits(b)).bits(), expected, "multiply", a, b);
          judge.check((Fp24Paper::from_bits(a) * Fp24Paper::from_bits(b)).bits(), expected, "multiply", a, b);
          ++pairs;
        }
      }
    }
  }
  judge.report("mul_exponent_pairs", pairs);
}

/// larger + smaller, in units of the smaller one's last place; neither is zero. Integer must hold the larger
/// one.
template <typename Integer>
std::uint32_t sum_in(std::uint32_t larger, std::uint32_t smaller, int kept) {
  const std::uint32_t distance = ((larger >> 16) & 127) - ((smaller >> 16) & 127);
  const Integer left = static_cast<Integer>(0x10000 | (larger & 0xffff)) << distance;
  std::uint32_t right = 0x10000 | (smaller & 0xffff);
  if (kept < 2) {  // guard bits, without a sticky bit: cut
    const std::uint32_t lost = distance - std::min(distance, static_cast<std::uint32_t>(kept));
    right = lost > 16 ? 0 : right >> lost << lost;
  }
  const Integer sum = ((larger ^ smaller) >> 23) != 0 ? left - right : left + right;
  if (sum == 0) {
    return 0;
  }
  int length = 0;
  if constexpr (sizeof(Integer) == 8) {
    length = 64 - std::countl_zero(sum);
  } else {
    const auto high = static_cast<std::uint64_t>(sum >> 64);
    length =
        high != 0 ? 128 - std::countl_zero(high) : 64 - std::countl_zero(static_cast<std::uint64_t>(sum));
  }
  const int exponent = static_cast<int>((smaller >> 16) & 127) + length - 17;
  if (exponent < 1) {
    return 0;
  }
  const std::uint32_t sign = larger & 0x800000U;
  if (exponent > 127) {
    return sign | 0x7fffffU;
  }
  const auto significand =
      static_cast<std::uint32_t>(length >= 17 ? sum >> (length - 17) : sum << (17 - length));
  return sign | (static_cast<std::uint32_t>(exponent) << 16) | (significand & 0xffffU);
}

/// a + b by definition. kept: 0 or 1 guard bits, or 2 for the exact sum.
std::uint32_t exact_sum(std::uint32_t a, std::uint32_t b, int kept) {
  const bool swap = (a & 0x7fffffU) < (b & 0x7fffffU);
  const std::uint32_t larger = swap ? b : a;
  const std::uint32_t smaller = swap ? a : b;
  if ((smaller & 0x7f0000U) == 0) {
    return (larger & 0x7f0000U) == 0 ? 0 : larger;
  }
  const std::uint32_t distance = ((larger >> 16) & 127) - ((smaller >> 16) & 127);
  if (distance <= 46) {
    return sum_in<std::uint64_t>(larger, smaller, kept);
  }
  if (distance <= 110) {
    return sum_in<UInt128>(larger, smaller, kept);
  }
  // A change by less than a last place: nothing, or down to the next number if there is any at all.
  return kept < 2 || ((larger ^ smaller) >> 23) == 0 ? larger : larger - 1;
}

/// Pairs that are hard for an adder, from two random words.
std::pair<std::uint32_t, std::uint32_t> biased_pair(std::uint64_t r, std::uint64_t s) {
  auto a = static_cast<std::uint32_t>(r & 0xffffff);
  auto b = static_cast<std::uint32_t>((r >> 24) & 0xffffff);
  const auto shape = static_cast<std::uint32_t>(s & 15);
  switch (s >> 60) {
    case 0:
    case 1:
    case 2:
      break;  // uniform
    case 3:   // near cancellation
      b = ((a ^ 0x800000U) + static_cast<std::uint32_t>((s >> 4) % 5) - 2) & 0xffffffU;
      break;
    case 4:  // one exponent apart with the same fraction
      b = (a ^ 0x800000U) ^ 0x010000U;
      break;
    case 5:  // the ends of the range
      a = (s & 32) != 0 ? a | 0x7c0000U : a & 0x83ffffU;
      b = (s & 32) != 0 ? b | 0x7c0000U : b & 0x83ffffU;
      break;
    default: {  // exponents within 20 of each other
      const int exponent = static_cast<int>((a >> 16) & 127) + static_cast<int>((s >> 8) % 41) - 20;
      b = (b & 0x80ffffU) | (static_cast<std::uint32_t>(std::clamp(exponent, 0, 127)) << 16);
    }
  }
  switch ((s >> 56) & 7) {
    case 0:  // sparse
      b &= 0xff0000U | (0xffffU << shape);
      break;
    case 1:
      b |= 0xffffU >> shape;
      break;
    case 2:
      a &= 0xff0000U | (0xffffU << shape);
      break;
    case 3:
      a |= 0xffffU >> shape;
      break;
    default:
      break;
  }
  return {a, b};
}

TEST(FloatDefinition, SumsOfBiasedPairsAreByDefinition) {
  using One = Float<Format{kExponentBits, kFractionBits, Guard::one, Rounding::toward_zero}>;
  constexpr std::uint64_t kMpfrEvery = 8192;
  const std::uint64_t pairs = number_of_cases(kAddPairs);
  Judge judge;
  Xoshiro random(1);
  std::uint64_t by_mpfr = 0;
  const auto check = [&](std::uint32_t a, std::uint32_t b, bool mpfr) {
    const std::uint32_t exact = exact_sum(a, b, 2);
    const std::uint32_t cut = exact_sum(a, b, 0);
    judge.check((Fp24::from_bits(a) + Fp24::from_bits(b)).bits(), exact, "add", a, b);
    judge.check((Fp24::from_bits(a) - Fp24::from_bits(b ^ 0x800000U)).bits(), exact, "subtract", a, b);
    judge.check((Fp24Paper::from_bits(a) + Fp24Paper::from_bits(b)).bits(), cut, "paper's add", a, b);
    judge.check((One::from_bits(a) + One::from_bits(b)).bits(), exact_sum(a, b, 1), "add, one guard bit", a,
                b);
    if (mpfr) {
      judge.check(exact, oracle::add(a, b), "integers against MPFR", a, b);
      judge.check(cut, oracle::add_cut(a, b, 0), "integers against MPFR, cut", a, b);
      judge.check(exact_sum(a, b, 1), oracle::add_cut(a, b, 1), "integers against MPFR, one guard bit", a, b);
      ++by_mpfr;
    }
  };
  for (const std::uint32_t a : kCorners) {
    for (const std::uint32_t b : kCorners) {
      check(a, b, true);
    }
  }
  for (std::uint64_t k = 0; k < pairs; ++k) {
    const std::uint64_t r = random();
    const auto [a, b] = biased_pair(r, random());
    check(a, b, k % kMpfrEvery == 0);
  }
  EXPECT_GT(by_mpfr, 1000U);
  std::printf("model.add_pairs_by_mpfr %llu\n", static_cast<unsigned long long>(by_mpfr));
  judge.report("add_pairs", pairs);
}

}  // namespace
}  // namespace raplas
