// The two models of DSP48 (ours in GHDL, Yosys' in Verilator): legal random stimulus.
//
// The stimulus is the same in both simulators; with --trace each writes what it saw, and
// a test compares the traces. The bench itself checks identities that hold in every
// register configuration, and that an illegal OPMODE is unknown in our model.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "bridge/dut.hpp"

namespace raplas {
namespace {

constexpr std::uint64_t kMask48 = (std::uint64_t{1} << 48) - 1;
constexpr std::uint32_t kMask18 = (1U << 18) - 1;
constexpr std::uint64_t kAllEnables = 0xFF;
constexpr int kSettled = 5;  // clocks: more than any configuration's registers

struct Probe {
  Dut& unit = dut();
  PortId a = unit.port("a_i"), b = unit.port("b_i"), bcin = unit.port("bcin_i");
  PortId c = unit.port("c_i"), pcin = unit.port("pcin_i"), opmode = unit.port("opmode_i");
  PortId carryinsel = unit.port("carryinsel_i"), carryin = unit.port("carryin_i");
  PortId subtract = unit.port("subtract_i"), enable = unit.port("enable_i"), reset = unit.port("reset_i");
  PortId p = unit.port("p_o"), pcout = unit.port("pcout_o"), bcout = unit.port("bcout_o");

  void hold(unsigned op, std::uint64_t carry, std::uint64_t minus) {
    unit.set(enable, kAllEnables);
    unit.set(reset, 0);
    unit.set(carryinsel, 0);
    unit.set(opmode, op);
    unit.set(carryin, carry);
    unit.set(subtract, minus);
    for (int i = 0; i < kSettled; ++i) unit.clock();
  }
};

std::int64_t sign_extended(std::uint32_t value) {
  return static_cast<std::int64_t>(value ^ 0x20000U) - 0x20000;
}

/// A legal X, Y, Z selection; P only in fed back when `feedback`.
unsigned legal_opmode(std::mt19937_64& random, bool feedback) {
  constexpr std::array kXy{0b0000U, 0b0101U, 0b0011U, 0b1100U, 0b1111U, 0b0010U, 0b1110U};
  constexpr std::array kZ{0b000U, 0b001U, 0b011U, 0b101U, 0b010U, 0b110U};
  const unsigned xy = kXy[random() % (feedback ? 7 : 5)];
  return (kZ[random() % (feedback ? 6 : 4)] << 4) | xy;
}

/// CARRYINSEL that is defined with this OPMODE.
unsigned legal_carryinsel(std::mt19937_64& random, unsigned opmode) {
  const unsigned x = opmode & 3U;
  const unsigned z = opmode >> 4;
  const bool rounds_z = x == 2 || z == 1 || z == 2 || z == 5 || z == 6;
  const bool rounds_xy = x == 1 || x == 3;
  switch (random() % 4) {
    case 1:
      return rounds_z ? 1 : 0;
    case 2:
      return rounds_xy ? 2 : 0;
    case 3:
      return rounds_xy ? 3 : 0;
    default:
      return 0;
  }
}

// The configuration is not known here: without P's register, feedback stays unknown in our model.
TEST(Dsp48, RandomStimulus) {
  Probe probe;
  Dut& unit = probe.unit;
  std::mt19937_64 random(48);
  const char* feedback = std::getenv("RAPLAS_DSP48_FEEDBACK");
  for (int i = 0; i < 20000; ++i) {
    const unsigned op = legal_opmode(random, feedback != nullptr);
    unit.set(probe.opmode, op);
    unit.set(probe.carryinsel, legal_carryinsel(random, op));
    unit.set(probe.a, random() & kMask18);
    unit.set(probe.b, random() & kMask18);
    unit.set(probe.bcin, random() & kMask18);
    unit.set(probe.c, random() & kMask48);
    unit.set(probe.pcin, random() & kMask48);
    unit.set(probe.carryin, random() & 1);
    unit.set(probe.subtract, random() & 1);
    // OPMODE and CARRYINSEL share an enable and a reset: the pair stays legal
    unit.set(probe.enable, (random() | (random() % 4 == 0 ? 0 : kAllEnables)) & kAllEnables);
    unit.set(probe.reset, random() % 8 == 0 ? (std::uint64_t{1} << (random() % 7)) : 0);
    unit.clock();
    ASSERT_FALSE(unit.has_unknown(probe.p)) << "clock " << i;
    ASSERT_EQ(unit.get(probe.p), unit.get(probe.pcout));
    count_checked();
  }
}

TEST(Dsp48, ProductPlusCMinusCarryAfterAllRegisters) {
  Probe probe;
  Dut& unit = probe.unit;
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const auto a = static_cast<std::uint32_t>(random()) & kMask18;
    const auto b = static_cast<std::uint32_t>(random()) & kMask18;
    const std::uint64_t c = random() & kMask48;
    unit.set(probe.a, a);
    unit.set(probe.b, b);
    unit.set(probe.bcin, b);
    unit.set(probe.c, c);
    probe.hold(0b0110101, 1, 1);  // C - (A * B + 1)
    const std::int64_t product = sign_extended(a) * sign_extended(b);
    EXPECT_EQ(unit.get(probe.p), (c - static_cast<std::uint64_t>(product) - 1) & kMask48);
    EXPECT_EQ(unit.get(probe.bcout), b);
    count_checked(2);
  }
}

TEST(Dsp48Illegal, OpmodeGivesUnknownInOurModel) {
  Probe probe;
  for (const unsigned op : {0b0000001U, 0b0000100U, 0b0001000U, 0b1000000U, 0b1110000U}) {
    probe.hold(op, 0, 0);
    EXPECT_EQ(probe.unit.has_unknown(probe.p), Dut::simulator() == "ghdl") << op;
    probe.unit.set(probe.reset, 1);
    probe.unit.clock();
    count_checked();
  }
}

}  // namespace
}  // namespace raplas
