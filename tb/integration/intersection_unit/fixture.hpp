// Drives the whole unit beside its clocked model: every edge between the units on every clock, and the
// value-exact walk at the end of each pencil. GUARD_BITS, ROWS and COLUMNS are the unit's generics.
#pragma once

#include <algorithm>
#include <limits>
#include <random>

#include "random_scenes.hpp"
#include "raplas/intersection_unit.hpp"
#include "support/scoreboard.hpp"

namespace raplas {

using F = std::conditional_t<GUARD_BITS == 0, Fp24Paper, Fp24>;
constexpr Testers kTesters{ROWS, COLUMNS};
inline const bool kSlow = Dut::simulator() == "ghdl";

class IntersectionUnitBench : public testing::Test {
 protected:
  void SetUp() override {
    dut().set(dut().port("write_i"), 0);
    dut().set(dut().port("start_i"), 0);
    reset_dut();
  }

  template <std::size_t kWords>
  void write(Target target, std::size_t address, const std::array<std::uint32_t, kWords>& word) {
    std::array<std::uint32_t, TriangleLayout::kBits / 32> data{};
    std::copy(word.begin(), word.end(), data.begin());
    dut().set(dut().port("write_i"), 1);
    dut().set(dut().port("target_i"), static_cast<std::uint64_t>(target));
    dut().set(dut().port("address_i"), address);
    dut().set(dut().port("data_i"), data);
    dut().clock();
    dut().set(dut().port("write_i"), 0);
  }

  void load(const SceneMemory<F>& scene) {
    // what idle units read (address 0, and the sphere after the last) must be known: see load() of pencils
    write(Target::sphere, 0, SphereWord<F>{}.pack());
    write(Target::triangle, 0, TriangleWord<F>{}.pack());
    for (std::size_t k = scene.scene.first; k < scene.spheres.size(); ++k) {
      write(Target::sphere, k, scene.spheres[k].pack());
    }
    write(Target::sphere, scene.spheres.size(),
          SphereWord<F>{}.pack());  // read, not tested: known all the same
    for (std::size_t k = scene.scene.first; k < scene.triangles.size(); ++k) {
      write(Target::triangle, k, scene.triangles[k].pack());
    }
    write(Target::scene, 0, scene.scene.pack());
    model_.load(&scene);
  }

  /// Loads a bank, unused planes and rays too: in GHDL an unknown operand spoils its neighbour in the shared
  /// C port.
  void load(const PencilMemory<F>& pencil, std::size_t bank) {
    write(Target::pencil, bank, pencil.pencil.pack());
    for (std::size_t r = 0; r < kMaxRows; ++r) {
      write(Target::plane, bank * 32 + r, pencil.rows[r].pack());
      write(Target::plane, bank * 32 + 16 + r, pencil.columns[r].pack());
    }
    for (std::size_t ray = 0; ray < kMaxRays; ++ray) {
      write(Target::ray, bank * kMaxRays + ray, pack_ray(pencil.rays[ray]));
    }
    model_.pencil(bank) = pencil;
  }

  /// Starts the pencil of a bank and compares every edge on every clock until the unit is idle, or for
  /// `clocks`.
  void run(std::size_t bank, int clocks = std::numeric_limits<int>::max()) {
    int clock = 0;
    for (bool first = true; (first || model_.busy()) && clock < clocks; first = false, ++clock) {
      write_nowhere();
      const bool disturb = !first && random_() % 4 == 0;  // start_i while busy: ignored
      const bool start = first || disturb;
      dut().set(dut().port("start_i"), start ? 1 : 0);
      dut().set(dut().port("bank_i"), disturb ? 1 - bank : bank);
      dut().settle();
      ASSERT_NO_FATAL_FAILURE(compare(model_.edges()));
      dut().clock();
      model_.clock(start, disturb ? 1 - bank : bank);
    }
    dut().set(dut().port("start_i"), 0);
    dut().set(dut().port("write_i"), 0);
    dut().set(dut().port("bank_i"), bank);
    dut().settle();
    ASSERT_NO_FATAL_FAILURE(expect("busy_o", model_.busy() ? 1 : 0));
  }

  /// Counters and results against the clocked model and the value-exact walk.
  void check(const SceneMemory<F>& scene, const PencilMemory<F>& pencil, std::size_t bank) {
    ResultMemory<F> results;
    EventCounters exact{};
    trace_pencil(scene, pencil, results, exact);
    EventCounters counters{};
    dut().get(dut().port("counters_o"), counters);
    for (std::size_t k = 0; k < counters.size(); ++k) {
      ASSERT_EQ(counters[k], model_.counters()[k]) << kCounterNames[k];
      const auto counter = static_cast<Counter>(k);
      if (counter != Counter::cycles && counter != Counter::stall_cycles) {
        ASSERT_EQ(counters[k], exact[k]) << kCounterNames[k];
      }
      total_[k] += counters[k];
    }
    // a ray each clock, those outside the pencil too: they are never hit
    for (std::size_t clock = 0; clock < kMaxRays + kMemoryStages; ++clock) {
      dut().set(dut().port("result_ray_i"), bank * kMaxRays + clock % kMaxRays);
      dut().clock();
      if (clock + 1 < kMemoryStages) {
        continue;
      }
      const std::size_t ray = (clock + 1 - kMemoryStages) % kMaxRays;
      PackedWord<ResultLayout::kBits> word{};
      dut().get(dut().port("result_o"), word);
      const auto seen = ResultWord<F>::unpack(word);
      ASSERT_EQ(seen.hit, results[ray].hit) << "ray " << ray;
      if (seen.hit) {
        ASSERT_EQ(seen, results[ray]) << "ray " << ray;
      }
      ASSERT_EQ(model_.results(bank)[ray], results[ray]) << "ray " << ray;
      count_checked();
    }
  }

  IntersectionUnit<F> model_{kTesters};
  std::mt19937 random_{5};
  std::array<std::uint64_t, kNumCounters> total_{};

 private:
  /// What the write port must not take: words without write_i, and targets that there are not.
  void write_nowhere() {
    const bool write = random_() % 2 == 0;
    PackedWord<TriangleLayout::kBits> data{};
    std::generate(data.begin(), data.end(), [this] { return static_cast<std::uint32_t>(random_()); });
    dut().set(dut().port("write_i"), write ? 1 : 0);
    dut().set(dut().port("target_i"), write ? 6 + random_() % 2 : random_() % 8);
    dut().set(dut().port("address_i"), random_() & kLastId);
    dut().set(dut().port("data_i"), data);
  }

  static void expect(const char* name, std::uint64_t value) { expect_port(dut().port(name), value, name); }

  void compare(const UnitEdges<F>& e) {
    ASSERT_NO_FATAL_FAILURE(expect("busy_o", model_.busy() ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("request_o", e.request.valid ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stack_level_o", static_cast<std::uint64_t>(e.stack_level)));
    if (e.request.valid) {
      ASSERT_NO_FATAL_FAILURE(expect("sphere_o", e.request.address));
      ASSERT_NO_FATAL_FAILURE(expect("set_o", static_cast<std::uint64_t>(e.request.set)));
    }
    ASSERT_NO_FATAL_FAILURE(expect("decided_o", e.decision.decided ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("leaf_o", e.decision.leaf ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("push_o", e.decision.push ? 1 : 0));
    if (e.decision.decided) {
      ASSERT_NO_FATAL_FAILURE(expect("row_mask_o", e.decision.row_mask));
      ASSERT_NO_FATAL_FAILURE(expect("column_mask_o", e.decision.column_mask));
    }
    ASSERT_NO_FATAL_FAILURE(expect("issue_o", e.issue ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stall_o", e.stall ? 1 : 0));
    if (e.pair_waits) {
      ASSERT_NO_FATAL_FAILURE(expect("ray_o", e.pair.ray));
      ASSERT_NO_FATAL_FAILURE(expect("triangle_o", e.pair.triangle));
    }
    ASSERT_NO_FATAL_FAILURE(expect("pair_done_o", e.pair_done ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("hit_o", e.hit ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stored_o", e.stored ? 1 : 0));
    if (e.pair_done) {
      ASSERT_NO_FATAL_FAILURE(expect("stored_ray_o", e.stored_ray));
      ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("stored_result_o"), e.result.pack(), "stored_result_o"));
    }
  }
};

}  // namespace raplas
