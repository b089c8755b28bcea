// dsp_multiply_add against exact integers: every pair of extreme factors with extreme summands, then random
// words.
#include <array>
#include <random>

#include "raplas/constants.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const int kClocks = Dut::simulator() == "ghdl" ? 20'000 : 100'000;
const PortStage kStage{"p_o", kMultiplyAddStages};

constexpr int kFactorBits = 18;
constexpr int kSumBits = 48;
constexpr std::int64_t kFactorLimit = std::int64_t{1} << (kFactorBits - 1);
constexpr std::int64_t kSumLimit = std::int64_t{1} << (kSumBits - 1);
constexpr std::array<std::int64_t, 8> kFactors{-kFactorLimit,    1 - kFactorLimit, -2, -1, 0, 1,
                                               kFactorLimit - 2, kFactorLimit - 1};
// with the largest products: sums that carry through all bits, that change sign, that wrap
constexpr std::array<std::int64_t, 8> kSummands{
    -kSumLimit,   -kFactorLimit* kFactorLimit, -1, 0, 1, kFactorLimit*(kFactorLimit - 1), kSumLimit - 1,
    kSumLimit / 3};

/// The bits of a signed number.
std::uint64_t bits_of(std::int64_t value, int bits) {
  return static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << bits) - 1);
}

class DspMultiplyAdd : public testing::Test {
 protected:
  /// Factors; their summand comes to the port in the next clock.
  void check(std::int64_t a, std::int64_t b, std::int64_t c) {
    dut().set(a_, bits_of(a, kFactorBits));
    dut().set(b_, bits_of(b, kFactorBits));
    dut().set(c_, bits_of(summand_, kSumBits));
    summand_ = c;
    if (const auto due = board_.clock(bits_of(c + a * b, kSumBits))) {
      expect_port(p_, *due, "p_o");
    }
  }
  void TearDown() override {  // the last results leave the pipeline
    for (int k = 1; k < kMultiplyAddStages; ++k) {
      check(0, 0, 0);
    }
  }

  PortId a_ = dut().port("a_i");
  PortId b_ = dut().port("b_i");
  PortId c_ = dut().port("c_i");
  PortId p_ = dut().port("p_o");
  std::int64_t summand_ = 0;
  Scoreboard<std::uint64_t> board_{kMultiplyAddStages};
};

TEST_F(DspMultiplyAdd, IsExactOnExtremeWords) {
  for (const std::int64_t a : kFactors) {
    for (const std::int64_t b : kFactors) {
      for (const std::int64_t c : kSummands) {
        ASSERT_NO_FATAL_FAILURE(check(a, b, c));
      }
    }
  }
}

TEST_F(DspMultiplyAdd, IsExactOnRandomWords) {
  std::mt19937_64 random(161);
  const auto word = [&random](std::int64_t limit) {
    const unsigned shift = random() % 4 == 0 ? static_cast<unsigned>(random() % kFactorBits) : 0;
    return std::uniform_int_distribution<std::int64_t>(-limit, limit - 1)(random) >> shift;
  };
  for (int k = 0; k < kClocks; ++k) {
    ASSERT_NO_FATAL_FAILURE(check(word(kFactorLimit), word(kFactorLimit), word(kSumLimit)));
  }
}

}  // namespace
}  // namespace raplas
