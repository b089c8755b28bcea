// dsp_addsub against integers. AB_REG and C_REG are the unit's generics.
#include <random>

#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kClocks = 20'000;
constexpr std::uint64_t kMask48 = (std::uint64_t{1} << 48) - 1;
const PortStage kStage{"p_o", 1 + (AB_REG > C_REG ? AB_REG : C_REG)};

std::uint64_t result(std::uint64_t c, std::uint64_t ab, std::uint64_t subtract, std::uint64_t carry) {
  const std::uint64_t extended = (ab >> 35) != 0 ? ab | (kMask48 & ~((std::uint64_t{1} << 36) - 1)) : ab;
  return (subtract != 0 ? c - extended - carry : c + extended + carry) & kMask48;
}

TEST(DspAddsub, AddsAndSubtractsEveryClock) {
  Dut& unit = dut();
  const PortId subtract = unit.port("subtract_i");
  const PortId carry = unit.port("carry_i");
  const PortId c = unit.port("c_i");
  const PortId ab = unit.port("ab_i");
  const PortId p = unit.port("p_o");
  std::mt19937_64 random(1);
  std::deque<std::uint64_t> cs;
  std::deque<std::array<std::uint64_t, 3>> abs;
  for (int k = 0; k < kClocks && !testing::Test::HasFailure(); ++k) {
    const auto word = [&random](unsigned bits) -> std::uint64_t {
      const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
      if (bits > 1 && random() % 4 == 0) {  // ones up to a bit, and none or noise above: long carries
        const std::uint64_t ones = (std::uint64_t{2} << (random() % bits)) - 1;
        return (ones | (random() % 2 == 0 ? random() & ~ones : 0)) & mask;
      }
      return random() % 8 == 0 ? (random() % 2 == 0 ? mask : 0)
                               : random() & mask & ((random() % 4 == 0) ? random() : ~0ULL);
    };
    cs.push_back(word(48));
    abs.push_back({word(36), word(1), word(1)});
    unit.set(c, cs.back());
    unit.set(ab, abs.back()[0]);
    unit.set(subtract, abs.back()[1]);
    unit.set(carry, abs.back()[2]);
    unit.clock();
    const auto age = [k](int registers) { return static_cast<std::size_t>(k - registers); };
    if (k >= 1) {
      const auto& [x, s, i] = abs[age(AB_REG)];
      expect_port(p, result(cs[age(C_REG)], x, s, i), "p_o");
    }
  }
}

}  // namespace
}  // namespace raplas
