// nearest_hit: t'/d against best.t'/best.d by exact integers.
#include <algorithm>

#include "operands.hpp"
#include "oracle.hpp"
#include "raplas/ray_triangle.hpp"
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
  Scoreboard<std::array<bool, 2>> board(kMulStages);
  std::array<int, 3> orders{};
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
    dut().set(dut().port("t_i"), t);
    dut().set(dut().port("d_i"), d);
    dut().set(dut().port("triangle_i"), triangle);
    dut().set(dut().port("best_i"), best.pack());
    if (const auto due = board.clock({near, !best.hit})) {
      expect_port(dut().port("nearer_o"), (*due)[0] ? 1 : 0, "nearer_o");
      expect_port(dut().port("first_o"), (*due)[1] ? 1 : 0, "first_o");
    }
  }
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
