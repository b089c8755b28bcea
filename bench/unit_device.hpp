// Entity intersection_unit with a number format and testers of choice: its hits without clocks, and its
// clocks on a sample.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "device_factories.hpp"
#include "parallel.hpp"
#include "raplas/encode.hpp"
#include "raplas/intersection_unit.hpp"

namespace raplas {

/// The memory of a flat list with spheres above it, so that not all of the list need be tested: each is so
/// large that a plane which meets one of the spheres below meets it too, in the tester's arithmetic. A tree
/// is returned as it is. trace_pencil() gives the same hits for both.
template <typename F>
[[nodiscard]] SceneMemory<F> with_groups(SceneMemory<F> memory) {
  constexpr std::uint32_t kGroup = 4;
  // More than twice the tester's error for |c| + |p| <= 2 (docs/radius.md) and the rounding of the centre.
  constexpr double kTesterError = 0x1p-11;
  const auto all_leaves = [&] {
    return std::all_of(memory.spheres.begin(), memory.spheres.end(),
                       [](const SphereWord<F>& s) { return s.leaf; });
  };
  if (!all_leaves()) {
    return memory;
  }
  std::uint32_t first = 0;
  auto count = static_cast<std::uint32_t>(memory.spheres.size());
  while (count > kGroup) {
    const auto next = static_cast<std::uint32_t>(memory.spheres.size());
    for (std::uint32_t k = first; k < first + count; k += kGroup) {
      const std::uint32_t below = std::min(kGroup, first + count - k);
      glm::dvec3 middle(0);
      for (std::uint32_t s = k; s < k + below; ++s) {
        middle += decode(memory.spheres[s].centre) / double(below);
      }
      double radius = 0;
      for (std::uint32_t s = k; s < k + below; ++s) {
        const SphereWord<F>& sphere = memory.spheres[s];
        radius = std::max(radius, glm::distance(middle, decode(sphere.centre)) + sphere.radius.to_double());
      }
      memory.spheres.push_back({encode<F>(middle, "sphere centre"),
                                F::from_double_up(radius + kTesterError, "sphere radius"), false, below, k});
    }
    first = next;
    count = static_cast<std::uint32_t>(memory.spheres.size()) - next;
  }
  memory.scene = {static_cast<std::uint32_t>(memory.spheres.size()), count, first};
  return memory;
}

/// The unit's hits, on all of the machine's threads. Counters stay 0: what is tested is not what the unit
/// would test.
template <typename F>
class UnitDevice final : public IntersectionDevice {
 public:
  void load(const DeviceScene& scene) override { memory_ = with_groups(encode<F>(scene, {})); }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> hits(pencils.size());
    const auto work = [&](std::size_t k) { hits[k] = trace_one(pencils[k]); };
    for_each_parallel(pencils.size(), work, [](double /*share*/) {});
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return {}; }

 private:
  [[nodiscard]] std::vector<Hit> trace_one(const Pencil& pencil) const {
    ResultMemory<F> results;
    EventCounters counters;
    trace_pencil(memory_, encode<F>(pencil), results, counters);
    std::vector<Hit> hits;
    hits.reserve(pencil.directions.size());
    for (std::size_t r = 0; r < static_cast<std::size_t>(pencil.rows); ++r) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(pencil.columns); ++c) {
        hits.push_back(decode(results[r * kMaxColumns + c]));
      }
    }
    drop_far_hits(pencil, hits);
    return hits;
  }

  SceneMemory<F> memory_;
};

/// Rays and the clocks that a unit was busy with them.
struct RayClocks {
  std::uint64_t rays = 0;
  std::uint64_t clocks = 0;

  [[nodiscard]] double per_ray() const {
    return rays == 0 ? 0 : static_cast<double>(clocks) / static_cast<double>(rays);
  }
};

/// Clocks of the unit for these pencils, one after the other.
template <typename F>
[[nodiscard]] RayClocks unit_clocks(const DeviceScene& scene, Testers testers,
                                    std::span<const Pencil> pencils) {
  const SceneMemory<F> memory = encode<F>(scene, {});
  const auto unit = std::make_unique<IntersectionUnit<F>>(testers);
  unit->load(&memory);
  RayClocks sum;
  std::size_t bank = 0;
  for (const Pencil& pencil : pencils) {
    unit->pencil(bank) = encode<F>(pencil);
    unit->clock(true, bank);
    while (unit->busy()) {
      unit->clock(false, bank);
    }
    sum.rays += pencil.directions.size();
    sum.clocks += unit->counters()[static_cast<std::size_t>(Counter::cycles)];
    bank ^= 1U;
  }
  return sum;
}

}  // namespace raplas
