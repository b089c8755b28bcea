// fp_add against MPFR. GUARD_BITS (0, 1 or 2) and SUBTRACT (0 or 1) are the unit's generics.
#include "operands.hpp"
#include "oracle.hpp"
#include "raplas/constants.hpp"
#include "support/scoreboard.hpp"
#include "support/vectors.hpp"

namespace raplas {
namespace {

constexpr int kRandomPairs = 60'000;
const PortStage kStage{"sum_o", kAddStages};

std::uint32_t expected(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t addend = SUBTRACT != 0 ? oracle::negate(b) : b;
  return GUARD_BITS < 2 ? oracle::add_cut(a, addend, GUARD_BITS) : oracle::add(a, addend);
}

class FpAdd : public testing::Test {
 protected:
  void SetUp() override {  // in GHDL the shared C port is unknown until the first operands have passed
    dut().set(a_, 0);
    dut().set(b_, 0);
    for (int k = 0; k < kAddStages; ++k) {
      dut().clock();
    }
  }

  void check(std::uint32_t a, std::uint32_t b) {
    dut().set(a_, a);
    dut().set(b_, b);
    if (const auto due = board_.clock(expected(a, b))) {
      expect_port(sum_, *due, "sum_o");
    }
  }
  void TearDown() override {  // the last results leave the pipeline
    for (int k = 1; k < kAddStages; ++k) {
      check(0, 0);
    }
  }

  PortId a_ = dut().port("a_i");
  PortId b_ = dut().port("b_i");
  PortId sum_ = dut().port("sum_o");
  Scoreboard<std::uint32_t> board_{kAddStages};
};

TEST_F(FpAdd, IsRightOnAllCornerPairs) {
  for (const std::uint32_t a : kCorners) {
    for (const std::uint32_t b : kCorners) {
      ASSERT_NO_FATAL_FAILURE(check(a, b));
    }
  }
}

TEST_F(FpAdd, IsRightOnRandomPairs) {
  OperandPairs pairs(12);
  for (int k = 0; k < kRandomPairs; ++k) {
    const auto [a, b] = pairs();
    ASSERT_NO_FATAL_FAILURE(check(a, b));
  }
}

TEST_F(FpAdd, GivesTheRecordedVectors) {
  for (const auto& words : read_vectors("fp_add")) {
    ASSERT_EQ(oracle::add(words.at(0), words.at(1)), words.at(2));
    ASSERT_NO_FATAL_FAILURE(check(words.at(0), SUBTRACT != 0 ? oracle::negate(words.at(1)) : words.at(1)));
  }
}

TEST_F(FpAdd, AlignsOverEveryDistance) {
  OperandPairs pairs(13);
  for (int larger = 1; larger <= 127; ++larger) {
    for (int smaller = 0; smaller <= larger; ++smaller) {
      const std::uint32_t a = pairs.word(larger);
      const std::uint32_t b = pairs.word(smaller);
      ASSERT_NO_FATAL_FAILURE(check(a, b));
      ASSERT_NO_FATAL_FAILURE(check(b, a));
    }
  }
}

}  // namespace
}  // namespace raplas
