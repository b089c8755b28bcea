// nearest_hit: t'/d against best.t'/best.d by exact integers.
#include <algorithm>
#include <cmath>
#include <optional>

#include "operands.hpp"
#include "oracle.hpp"
#include "raplas/ray_triangle.hpp"
#include "support/depth_place.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kCases = 40'000;
const PortStage kStage{"nearer_o", kMulStages};

/// a * b of two positive words as an integer with a common exponent of 254: exact in MPFR's 400 bits.
class Product {
 public:
  Product(std::uint32_t a, std::uint32_t b) {
    mpfr_init2(value_, 400);
    mpfr_set_ui_2exp(value_, (a & 0xffff) | 0x10000, static_cast<long>(a >> 16), MPFR_RNDN);
    mpfr_t other;
    mpfr_init2(other, 400);
    mpfr_set_ui_2exp(other, (b & 0xffff) | 0x10000, static_cast<long>(b >> 16), MPFR_RNDN);
    mpfr_mul(value_, value_, other, MPFR_RNDN);
    mpfr_clear(other);
  }
  Product(const Product&) = delete;
  Product& operator=(const Product&) = delete;
  ~Product() { mpfr_clear(value_); }
  [[nodiscard]] int compare(const Product& other) const { return mpfr_cmp(value_, other.value_); }

 private:
  mpfr_t value_;
};

TEST(NearestHit, OrdersExactQuotientsAndTiesByTheLowerTriangle) {
  OperandPairs pairs(91);
  Scoreboard<std::array<bool, 5>> board(kMulStages);
  std::array<int, 3> orders{};
  std::array<int, 2> ties{};
  for (int k = 0; k < kCases && !testing::Test::HasFailure(); ++k) {
    const auto positive = [&pairs] { return pairs.word(pairs.between(1, 127)) & 0x7fffffU; };
    std::uint32_t t = positive();
    std::uint32_t d = positive();
    ResultWord<Fp24> best{
        pairs.bits(3) != 0, pairs.bits(2), Fp24::from_bits(positive()), Fp24::from_bits(positive()), {}, {}};
    if (k % 2 == 0) {  // equal, or an ulp apart, or scaled by a power of two
      const std::uint32_t scale = (t >> 16) < 120 && (d >> 16) < 120 ? 0x010000U * pairs.bits(2) : 0U;
      best.t = Fp24::from_bits(t + scale + (k % 8 == 0 && (t & 0xffff) != 0xffff ? 1U : 0U));
      best.d = Fp24::from_bits(d + scale);
    }
    if (k % 4 == 1) {  // products that differ by 1 in all their 34 bits: x * x against (x - 1) * (x + 1)
      const std::uint32_t x = 0x400000U | (1 + pairs.bits(16) % 0xfffe);
      const bool farther = pairs.bits(1) != 0;
      best.hit = true;
      t = farther ? x : x - 1;
      best.d = Fp24::from_bits(farther ? x : x + 1);
      best.t = Fp24::from_bits(farther ? x - 1 : x);
      d = farther ? x + 1 : x;
    }
    const std::uint32_t triangle = pairs.bits(2);
    const int order = Product(t, best.d.bits()).compare(Product(best.t.bits(), d));
    const bool near = !best.hit || order < 0 || (order == 0 && triangle < best.triangle);
    ++orders[static_cast<std::size_t>(1 + (order > 0) - (order < 0))];
    ASSERT_EQ(near, nearer(Fp24::from_bits(t), Fp24::from_bits(d), triangle, best));
    const bool tie = tied(t, d, best.t.bits(), best.d.bits());
    ++ties[tie ? 1 : 0];
    const bool rough_tie = tied(t, d, best.t.bits(), best.d.bits(), true);
    const DepthOrder by_model = depth_order(Fp24::from_bits(t), Fp24::from_bits(d), triangle, best);
    ASSERT_EQ(tie, by_model.tie);
    ASSERT_EQ(rough_tie, by_model.rough_tie);
    dut().set(dut().port("t_i"), t);
    dut().set(dut().port("d_i"), d);
    dut().set(dut().port("triangle_i"), triangle);
    dut().set(dut().port("best_i"), best.pack());
    if (const auto due = board.clock({near, !best.hit, best.hit, tie, rough_tie})) {
      expect_port(dut().port("nearer_o"), (*due)[0] ? 1 : 0, "nearer_o");
      expect_port(dut().port("first_o"), (*due)[1] ? 1 : 0, "first_o");
      if ((*due)[2]) {
        expect_port(dut().port("tie_o"), (*due)[3] ? 1 : 0, "tie_o");
        expect_port(dut().port("rough_tie_o"), (*due)[4] ? 1 : 0, "rough_tie_o");
      }
    }
  }
  EXPECT_GT(*std::min_element(ties.begin(), ties.end()), kCases / 10)
      << "ties are hardly tested, or nothing else";
  EXPECT_GT(*std::min_element(orders.begin(), orders.end()), kCases / 50) << "an order is hardly tested";
}

TEST(NearestHit, SeesASingleBitOfTheProducts) {
  // (1 + 2^-i) * (1 + 2^-j) against 1 * (1 + 2^-i + 2^-j): they differ by 2^-(i+j)
  OperandPairs pairs(93);
  Scoreboard<bool> board(kMulStages);
  for (unsigned i = 0; i < 16; ++i) {
    for (unsigned j = 0; j < 16; ++j) {
      for (unsigned k = 0; k < 4 && !testing::Test::HasFailure(); ++k) {
        if (i == j) {
          continue;
        }
        const auto exponent = [&pairs, k] {
          return static_cast<std::uint32_t>(k < 2 ? 1 : pairs.between(1, 127)) << 16;
        };
        const std::uint32_t one = exponent();
        const std::uint32_t other = exponent();
        const std::uint32_t a = one | 1U << i;
        const std::uint32_t b = other | 1U << j;
        const std::uint32_t c = one;
        const std::uint32_t d = other | 1U << i | 1U << j;
        const bool nearer = k % 2 != 0;  // the smaller product is that of c and d
        const ResultWord<Fp24> best{
            true, nearer ? 0U : 1U, Fp24::from_bits(nearer ? a : c), Fp24::from_bits(nearer ? d : b), {}, {}};
        dut().set(dut().port("t_i"), nearer ? c : a);
        dut().set(dut().port("d_i"), nearer ? b : d);
        dut().set(dut().port("triangle_i"), nearer ? 1 : 0);  // a tie would be decided the other way
        dut().set(dut().port("best_i"), best.pack());
        if (const auto due = board.clock(nearer)) {
          expect_port(dut().port("nearer_o"), *due ? 1 : 0, "nearer_o");
        }
      }
    }
  }
}

/// Two words above 0 whose product is that of `significand`, 2^32 .. 2^34 - 1, and 2^exponent.
std::optional<std::array<std::uint32_t, 2>> factors(OperandPairs& pairs, std::int64_t significand,
                                                    int exponent) {
  constexpr std::int64_t kOne = 1 << kFractionBits;
  const std::int64_t least = std::max(kOne, significand / (2 * kOne) + 1);
  const std::int64_t most = std::llround(std::floor(std::sqrt(static_cast<double>(significand))));
  const std::int64_t start = pairs.bits(kFractionBits);
  for (std::int64_t k = 0; k <= most - least; ++k) {
    const std::int64_t a = least + (start + k) % (most - least + 1);
    if (significand % a == 0) {
      const int of_a = pairs.between(std::max(1, exponent - 127), std::min(127, exponent - 1));
      const auto word = [](int e, std::int64_t s) {
        return static_cast<std::uint32_t>(e) << kFractionBits | static_cast<std::uint32_t>(s - kOne);
      };
      const std::array words{word(of_a, a), word(exponent - of_a, significand / a)};
      return pairs.bits(1) != 0 ? words : std::array{words[1], words[0]};
    }
  }
  return std::nullopt;  // not every number is such a product
}

TEST(NearestHit, KnowsATieToTheLastBitOfTheProducts) {
  // places of products: octaves of 2^33 units each; one of a random product, and one some units from it
  constexpr std::int64_t kOctave = std::int64_t{1} << (2 * kFractionBits + 1);
  constexpr std::int64_t kEnd = 3 * (kOctave >> kTieShift);
  constexpr std::int64_t kRoughEnd = kOctave >> kRoughTieShift;
  OperandPairs pairs(94);
  Scoreboard<std::array<bool, 3>> board(kMulStages);
  std::array<int, 20> tested{};  // of each distance
  std::array<int, 2> octaves{};  // the same, different ones
  std::array<int, 2> spelled{};  // a significand from 2^33 on: no, yes
  for (int k = 0; k < 12'000 && !testing::Test::HasFailure(); ++k) {
    constexpr std::array<std::int64_t, 20> kApart{-kEnd - 2,
                                                  -kEnd - 1,
                                                  -kEnd,
                                                  -kEnd + 1,
                                                  -1,
                                                  0,
                                                  1,
                                                  kEnd - 2,
                                                  kEnd - 1,
                                                  kEnd,
                                                  kEnd + 1,
                                                  kEnd + 2,
                                                  -kRoughEnd - 2,
                                                  -kRoughEnd - 1,
                                                  -kRoughEnd,
                                                  -kRoughEnd + 1,
                                                  kRoughEnd - 2,
                                                  kRoughEnd - 1,
                                                  kRoughEnd,
                                                  kRoughEnd + 1};
    const std::size_t which = static_cast<std::size_t>(k) % kApart.size();
    const std::int64_t apart = kApart[which];
    const std::int64_t c = 0x10000 + pairs.bits(kFractionBits);
    std::int64_t d = 0x10000 + pairs.bits(kFractionBits);
    if (pairs.bits(1) != 0) {  // near a power of two
      d = std::clamp<std::int64_t>((kOctave + pairs.between(-0x4000000, 0x4000000)) / c, 0x10000, 0x1ffff);
    }
    const int exponent = pairs.between(4, 250);
    const auto from = [kOctave](std::int64_t significand) {  // the start of the exponent's octave
      return significand >= kOctave ? significand : 2 * significand - kOctave;
    };
    const std::int64_t place = from(c * d) + apart;
    const std::int64_t octave = place >= 0 ? place / kOctave : -1;
    const std::int64_t fraction = place - octave * kOctave;
    // fraction above a power of two: a significand from 2^33 on, or half of it with the exponent above
    const bool low = fraction % 2 == 0 && pairs.bits(1) != 0;
    const auto best = factors(pairs, c * d, exponent);
    const auto here = factors(pairs, low ? (fraction + kOctave) / 2 : fraction + kOctave,
                              exponent + static_cast<int>(octave) - (low ? 0 : 1));
    if (!here || !best) {
      continue;
    }
    const bool tie = apart >= -kEnd && apart < kEnd;
    const bool rough_tie = apart >= -kRoughEnd && apart < kRoughEnd;
    const bool near = apart < 0;
    const std::array<std::uint32_t, 4> words{(*here)[0], (*best)[1], (*best)[0],
                                             (*here)[1]};  // t d, of the best
    ASSERT_EQ(tied(words[0], words[1], words[2], words[3]), tie);
    ASSERT_EQ(tied(words[0], words[1], words[2], words[3], true), rough_tie);
    const ResultWord<Fp24> stored{true, 0, Fp24::from_bits(words[2]), Fp24::from_bits(words[3]), {}, {}};
    const DepthOrder order = depth_order(Fp24::from_bits(words[0]), Fp24::from_bits(words[1]), 0, stored);
    ASSERT_EQ(order.tie, tie);
    ASSERT_EQ(order.rough_tie, rough_tie);
    ASSERT_EQ(order.nearer, near);
    ++tested[which];
    ++octaves[octave == from(c * d) / kOctave ? 0 : 1];
    ++spelled[low ? 0 : 1];
    dut().set(dut().port("t_i"), words[0]);
    dut().set(dut().port("d_i"), words[1]);
    dut().set(dut().port("triangle_i"), 0);
    dut().set(dut().port("best_i"), stored.pack());
    if (const auto due = board.clock({near, tie, rough_tie})) {
      expect_port(dut().port("nearer_o"), (*due)[0] ? 1 : 0, "nearer_o");
      expect_port(dut().port("tie_o"), (*due)[1] ? 1 : 0, "tie_o");
      expect_port(dut().port("rough_tie_o"), (*due)[2] ? 1 : 0, "rough_tie_o");
    }
  }
  EXPECT_GT(*std::min_element(tested.begin(), tested.end()), 10) << "a distance is hardly tested";
  EXPECT_GT(*std::min_element(octaves.begin(), octaves.end()), 100) << "hardly any across a power of two";
  EXPECT_GT(*std::min_element(spelled.begin(), spelled.end()), 100) << "a spelling is hardly tested";
}

TEST(NearestHit, ComparesAllBitsOfBothTrianglesInATie) {
  OperandPairs pairs(92);
  Scoreboard<bool> board(kMulStages);
  for (unsigned bit = 0; bit < kIdBits; ++bit) {  // equal above the bit, and anything below it
    for (int k = 0; k < 32 && !testing::Test::HasFailure(); ++k) {
      const std::uint32_t one = 1U << bit;
      const std::uint32_t above = pairs.bits(kIdBits) & ~(2 * one - 1);
      const bool nearer = k % 2 == 0;
      const std::uint32_t low = k < 8 ? one - 1 : pairs.bits(bit);
      const std::uint32_t other = k < 8 ? 0 : pairs.bits(bit);
      const std::uint32_t triangle = above | (nearer ? low : one | other);
      const std::uint32_t best_triangle = above | (nearer ? one | other : low);
      const std::uint32_t t = pairs.word(pairs.between(1, 127)) & 0x7fffffU;
      const std::uint32_t d = pairs.word(pairs.between(1, 127)) & 0x7fffffU;
      const ResultWord<Fp24> best{true, best_triangle, Fp24::from_bits(t), Fp24::from_bits(d), {}, {}};
      dut().set(dut().port("t_i"), t);
      dut().set(dut().port("d_i"), d);
      dut().set(dut().port("triangle_i"), triangle);
      dut().set(dut().port("best_i"), best.pack());
      if (const auto due = board.clock(nearer)) {
        expect_port(dut().port("nearer_o"), *due ? 1 : 0, "nearer_o");
      }
    }
  }
}

}  // namespace
}  // namespace raplas
