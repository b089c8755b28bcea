// depth_quotient against the exact quotient in integers, and the model bit by bit.
#include "operands.hpp"
#include "raplas/ray_triangle.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kPairs = 60'000;
constexpr int kMostError = 3;
const PortStage kStage{"q_o", kAddStages};

/// Code of |t| / |d| rounded down, by long division; codes end at 0 and at the last but one.
int floor_code(std::uint32_t t, std::uint32_t d) {
  const int last = (1 << kDepthBits) - 2;
  std::uint64_t rest = (t & 0xffff) | 0x10000;
  const std::uint64_t divisor = (d & 0xffff) | 0x10000;
  int exponent = static_cast<int>(t >> 16 & 127) - static_cast<int>(d >> 16 & 127) + kDepthBias;
  if (rest < divisor) {
    rest *= 2;
    --exponent;
  }
  int code = exponent;
  rest -= divisor;
  for (int k = 0; k < kDepthFractionBits; ++k) {
    rest *= 2;
    code *= 2;
    if (rest >= divisor) {
      rest -= divisor;
      ++code;
    }
  }
  return code < 0 ? 0 : (code > last ? last : code);
}

class DepthQuotient : public testing::Test {
 protected:
  void check(std::uint32_t t, std::uint32_t d) {
    dut().set(t_, t);
    dut().set(d_, d);
    const std::uint32_t model = depth_quotient(Fp24::from_bits(t), Fp24::from_bits(d));
    const int exact = floor_code(t, d);
    ASSERT_LE(static_cast<int>(model), exact);
    ASSERT_LE(exact - static_cast<int>(model), kMostError);
    if (const auto due = board_.clock(model)) {
      expect_port(q_, *due, "q_o");
    }
  }
  void TearDown() override {  // the last results leave the pipeline
    for (int k = 1; k < kAddStages; ++k) {
      check(0x3f0000, 0x3f0000);
    }
  }

  PortId t_ = dut().port("t_i");
  PortId d_ = dut().port("d_i");
  PortId q_ = dut().port("q_o");
  Scoreboard<std::uint32_t> board_{kAddStages};
};

TEST_F(DepthQuotient, IsAtMostThreeCodesTooLowOnCorners) {
  for (const std::uint32_t t : kCorners) {
    for (const std::uint32_t d : kCorners) {
      ASSERT_NO_FATAL_FAILURE(check(t, d));
    }
  }
}

TEST_F(DepthQuotient, IsAtMostThreeCodesTooLowOnRandomWords) {
  OperandPairs pairs(121);
  for (int k = 0; k < kPairs; ++k) {
    const std::uint32_t d = pairs.word(pairs.between(0, 127));
    const int difference =
        k % 2 == 0 ? pairs.between(-24, 14) : pairs.between(-1, 1) * 16 + pairs.between(-6, 0);
    ASSERT_NO_FATAL_FAILURE(check(pairs.word(static_cast<int>(d >> 16 & 127) + difference), d));
  }
}

TEST_F(DepthQuotient, KnowsEveryReciprocal) {
  OperandPairs pairs(122);
  for (std::uint32_t top = 0; top < 1024; ++top) {
    for (const std::uint32_t t : {0x3fffffU, 0x3f0000U, 0x3f0000U | pairs.bits(16)}) {
      ASSERT_NO_FATAL_FAILURE(check(t, 0x3f0000U | top << 6 | pairs.bits(6)));
    }
  }
}

TEST_F(DepthQuotient, EndsAtZeroAndAtTheLastCodeButOne) {
  for (int difference = -126; difference <= 126; ++difference) {
    const auto exponent = static_cast<std::uint32_t>(difference < 0 ? 127 : 1);
    const auto other = static_cast<std::uint32_t>(static_cast<int>(exponent) + difference);
    for (const std::uint32_t fraction : {0U, 1U, 0xffbfU, 0xffffU}) {
      ASSERT_NO_FATAL_FAILURE(check(other << 16 | fraction, exponent << 16));
      ASSERT_NO_FATAL_FAILURE(check(other << 16 | fraction, exponent << 16 | 0xffff));
    }
  }
}

}  // namespace
}  // namespace raplas
