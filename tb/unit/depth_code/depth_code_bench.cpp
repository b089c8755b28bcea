// depth_code against the numbers that its codes stand for, and against the model.
#include <algorithm>
#include <random>

#include "raplas/fixed_point.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kDistanceBits = 40;
const int kRandomCases = Dut::simulator() == "ghdl" ? 20'000 : 200'000;
const PortStage kPortStages[]{{"code_o", kDepthCodeStages}, {"z_o", kDepthCodeStages}};

/// The distance that a code stands for, (1 + f / 2^10) 2^(e - 21) in units of 2^-34.
std::int64_t value(std::int64_t code) {
  constexpr std::int64_t kOne = std::int64_t{1} << kDepthFractionBits;
  const std::int64_t exponent = code / kOne;
  return code == 0 ? 0 : (kOne + code % kOne) << (exponent - kDepthBias + 34 - kDepthFractionBits);
}

/// The greatest code that stands for no more than the distance.
std::int64_t greatest(std::int64_t distance) {
  std::int64_t low = (1 << kDepthFractionBits) - 1;  // codes that are too low, and too high
  std::int64_t high = (kDistanceBits - 13) << kDepthFractionBits;
  while (high - low > 1) {
    const std::int64_t middle = (low + high) / 2;
    (value(middle) <= distance ? low : high) = middle;
  }
  return low < 1 << kDepthFractionBits ? 0 : low;
}

class DepthCode : public testing::Test {
 protected:
  void check(std::int64_t distance) {
    const std::int64_t code = greatest(distance);
    const std::int64_t lower = std::max<std::int64_t>(code - kDepthMargin, 0);
    ASSERT_EQ(depth_code(distance), code) << "the model, of " << distance;
    ASSERT_EQ(depth_lower(distance), lower) << "the model, of " << distance;
    dut().set(d_, static_cast<std::uint64_t>(distance) & ((std::uint64_t{1} << 48) - 1));
    if (const auto due =
            board_.clock({static_cast<std::uint64_t>(code), static_cast<std::uint64_t>(lower)})) {
      expect_port(code_, due->code, "code_o");
      expect_port(z_, due->z, "z_o");
    }
  }
  void TearDown() override {  // the last results leave the pipeline
    for (int k = 1; k < kDepthCodeStages; ++k) {
      check(0);
    }
  }

  struct Expected {
    std::uint64_t code;
    std::uint64_t z;
  };

  PortId d_ = dut().port("d_i");
  PortId code_ = dut().port("code_o");
  PortId z_ = dut().port("z_o");
  Scoreboard<Expected> board_{kDepthCodeStages};
};

TEST_F(DepthCode, IsTheFloorAtEveryCode) {
  const std::int64_t step = Dut::simulator() == "ghdl" ? 7 : 1;
  for (std::int64_t code = 1 << kDepthFractionBits; code < (kDistanceBits - 13) << kDepthFractionBits;
       code += step) {
    for (const std::int64_t off : {-1, 0, 1}) {
      ASSERT_NO_FATAL_FAILURE(check(value(code) + off));
    }
  }
  ASSERT_NO_FATAL_FAILURE(check((std::int64_t{1} << kDistanceBits) - 1));
}

TEST_F(DepthCode, IsZeroForSmallAndNegative) {
  for (int bit = 0; bit < 47; ++bit) {
    for (const std::int64_t off : {-1, 0, 1}) {
      ASSERT_NO_FATAL_FAILURE(check(-(std::int64_t{1} << bit) + (bit == 0 ? 0 : off)));
    }
  }
  for (std::int64_t d = 0; d < 1 << 14; d += 5) {
    ASSERT_NO_FATAL_FAILURE(check(d));
  }
}

TEST_F(DepthCode, IsTheFloorOfRandomDistances) {
  std::mt19937_64 random(41);
  for (int k = 0; k < kRandomCases; ++k) {
    const std::uint64_t bits = random() >> (64 - kDistanceBits);
    const auto distance = static_cast<std::int64_t>(bits >> (random() % kDistanceBits));
    ASSERT_NO_FATAL_FAILURE(check(random() % 8 == 0 ? -distance : distance));
  }
}

}  // namespace
}  // namespace raplas
