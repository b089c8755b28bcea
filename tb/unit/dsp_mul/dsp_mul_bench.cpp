// dsp_mul against integers.
#include <random>

#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kClocks = 20'000;
constexpr int kStages = 2;
const PortStage kStage{"p_o", kStages};

TEST(DspMul, MultipliesUnsignedEveryClock) {
  Dut& unit = dut();
  const PortId a = unit.port("a_i");
  const PortId b = unit.port("b_i");
  const PortId p = unit.port("p_o");
  std::mt19937_64 random(1);
  Scoreboard<std::uint64_t> board(kStages);
  for (int k = 0; k < kClocks && !testing::Test::HasFailure(); ++k) {
    const auto word = [&random] { return random() % 8 == 0 ? 0x1ffff - random() % 2 : random() & 0x1ffff; };
    const std::uint64_t x = word();
    const std::uint64_t y = word();
    unit.set(unit.port("c_i"), random() & 0xffffffffffff);  // shared, not used
    unit.set(a, x);
    unit.set(b, y);
    if (const auto due = board.clock(x * y)) {
      expect_port(p, *due, "p_o");
    }
  }
}

}  // namespace
}  // namespace raplas
