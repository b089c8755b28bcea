// fp_mul against MPFR.
#include "operands.hpp"
#include "oracle.hpp"
#include "raplas/constants.hpp"
#include "support/scoreboard.hpp"
#include "support/vectors.hpp"

namespace raplas {
namespace {

constexpr int kRandomPairs = 60'000;
const PortStage kStage{"product_o", kMulStages};

class FpMul : public testing::Test {
 protected:
  void check(std::uint32_t a, std::uint32_t b) {
    dut().set(a_, a);
    dut().set(b_, b);
    if (const auto due = board_.clock(oracle::multiply(a, b))) {
      expect_port(product_, *due, "product_o");
    }
  }
  void TearDown() override {  // the last results leave the pipeline
    for (int k = 1; k < kMulStages; ++k) {
      check(0, 0);
    }
  }

  PortId a_ = dut().port("a_i");
  PortId b_ = dut().port("b_i");
  PortId product_ = dut().port("product_o");
  Scoreboard<std::uint32_t> board_{kMulStages};
};

TEST_F(FpMul, TruncatesTowardZeroOnAllCornerPairs) {
  for (const std::uint32_t a : kCorners) {
    for (const std::uint32_t b : kCorners) {
      ASSERT_NO_FATAL_FAILURE(check(a, b));
    }
  }
}

TEST_F(FpMul, TruncatesTowardZeroOnRandomPairs) {
  OperandPairs pairs(11);
  for (int k = 0; k < kRandomPairs; ++k) {
    const auto [a, b] = pairs();
    ASSERT_NO_FATAL_FAILURE(check(a, b));
  }
}

TEST_F(FpMul, GivesTheRecordedVectors) {
  for (const auto& words : read_vectors("fp_mul")) {
    ASSERT_EQ(oracle::multiply(words.at(0), words.at(1)), words.at(2));
    ASSERT_NO_FATAL_FAILURE(check(words.at(0), words.at(1)));
  }
}

}  // namespace
}  // namespace raplas
