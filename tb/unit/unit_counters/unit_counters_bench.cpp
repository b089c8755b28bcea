// unit_counters: sums by plain arithmetic modulo 2^BITS, of random events and of one input at a time.
// Counters of 32 bits would take hours to wrap, those of 12 do it here.
#include <array>
#include <random>

#include "raplas/constants.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const int kClocks = Dut::simulator() == "ghdl" ? 5'000 : 20'000;

struct Events {
  std::uint32_t spheres;
  std::uint32_t rows;
  std::uint32_t columns;
  bool walk;
  bool busy;
  bool request;
  bool vertex;
  bool issue;
  bool first_hit;
  bool stall;
};

class UnitCountersBench : public testing::Test {
 protected:
  void SetUp() override {
    apply({});
    reset_dut();
  }

  void clock(const Events& e) {
    apply(e);
    dut().settle();
    compare();  // nothing goes through within a clock
    dut().clock();
    at(Counter::cycles) += e.busy ? 1 : 0;
    at(Counter::spheres_tested) += e.request && !e.vertex ? 1 : 0;
    at(Counter::vertices_tested) += e.request && e.vertex ? 1 : 0;
    at(Counter::plane_tests) += e.request ? e.rows + e.columns : 0;
    at(Counter::pairs_tested) += e.issue ? 1 : 0;
    at(Counter::hits) += e.first_hit ? 1 : 0;
    at(Counter::stall_cycles) += e.stall ? 1 : 0;
    at(Counter::spheres_skipped) += (e.walk ? e.spheres : 0) - (e.request && !e.vertex ? 1 : 0);
    compare();
  }

  Events any(unsigned percent) {
    const auto chance = [this, percent] { return random_() % 100 < percent; };
    return {static_cast<std::uint32_t>(random_() % (1U << (kIdBits + 1))),
            static_cast<std::uint32_t>(random_() % (1U << (kLineBits + 1))),
            static_cast<std::uint32_t>(random_() % (1U << (kLineBits + 1))),
            chance(),
            chance(),
            chance(),
            chance(),
            chance(),
            chance(),
            chance()};
  }

  std::uint32_t& at(Counter counter) { return counters_[static_cast<std::size_t>(counter)]; }

  void apply(const Events& e) {
    const auto set = [](const char* name, std::uint64_t value) { dut().set(dut().port(name), value); };
    set("spheres_i", e.spheres);
    set("rows_i", e.rows);
    set("columns_i", e.columns);
    set("walk_i", e.walk ? 1 : 0);
    set("busy_i", e.busy ? 1 : 0);
    set("request_i", e.request ? 1 : 0);
    set("vertex_i", e.vertex ? 1 : 0);
    set("issue_i", e.issue ? 1 : 0);
    set("first_hit_i", e.first_hit ? 1 : 0);
    set("stall_i", e.stall ? 1 : 0);
  }

  void compare() {
    std::array<std::uint32_t, (kNumCounters * BITS + 31) / 32> packed{};
    for (std::size_t k = 0; k < kNumCounters * BITS; ++k) {
      packed[k / 32] |= (counters_[k / BITS] >> (k % BITS) & 1U) << (k % 32);
    }
    expect_port(dut().port("counters_o"), packed, "counters_o");
  }

  std::mt19937 random_{312};
  std::array<std::uint32_t, kNumCounters> counters_{};
};

TEST_F(UnitCountersBench, CountsEveryEvent) {
  for (const unsigned percent : {100U, 50U, 5U}) {
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      clock(any(percent));
    }
  }
}

TEST_F(UnitCountersBench, CountsOneEventAtATime) {
  for (int k = 0; k < 200 && !HasFailure(); ++k) {
    Events e = any(0);
    bool* const events[]{&e.walk, &e.busy, &e.request, &e.vertex, &e.issue, &e.first_hit, &e.stall};
    *events[static_cast<std::size_t>(k) % std::size(events)] = true;
    clock(e);
  }
}

TEST_F(UnitCountersBench, SkippedSpheresGoBelowZeroAndWrap) {
  clock({1, 1, 1, true, true, true, false, false, false, false});
  clock({0, 16, 16, false, false, true, false, false, false, false});  // 0 - 1
  EXPECT_EQ(at(Counter::spheres_skipped), ~std::uint32_t{0});
  const std::uint32_t most = (1U << (kIdBits + 1)) - 1;
  for (int k = 0; k < 4'100 && !HasFailure(); ++k) {  // twice 2^31: over every carry to the top
    clock({most, 31, 31, true, false, false, true, false, false, false});
  }
  EXPECT_EQ(at(Counter::spheres_skipped), 4'100U * most - 1);
}

TEST_F(UnitCountersBench, ResetClearsAll) {
  for (int k = 0; k < 40 && !HasFailure(); ++k) {
    clock(any(90));
  }
  apply(any(100));
  dut().set(dut().port("rst_i"), 1);
  dut().clock();
  dut().set(dut().port("rst_i"), 0);
  counters_ = {};
  compare();
  clock(any(100));
}

}  // namespace
}  // namespace raplas
