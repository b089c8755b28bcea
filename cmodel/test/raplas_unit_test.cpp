// The clocked unit of profile raplas against the walk without clocks: streams of pencils through all banks.
#include "raplas/raplas_unit.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "possible_hits.hpp"
#include "random_fixed_scenes.hpp"

namespace raplas {
namespace {

using F = Fp24;

/// Runs pencils through the banks, `loaded` at a time; each must give what the walk gives, or, of certified
/// hits, what may be nearest.
void run(const FixedSceneMemory<F>& scene, const std::vector<FixedPencilMemory<F>>& pencils,
         std::uint32_t loaded, std::uint64_t& hits) {
  RaplasUnit<F> unit;
  unit.load(&scene);
  std::size_t started = 0;
  std::size_t checked = 0;
  for (int clock = 0; checked < pencils.size(); ++clock) {
    ASSERT_LT(clock, 10'000'000) << "the unit hangs";
    const std::size_t bank = started % kPencilBanks;
    const bool start = started < pencils.size() && started - checked < loaded;
    if (start) {
      unit.pencil(bank) = pencils[started];
      ++started;
    }
    unit.clock(start, bank);
    while (checked < started && (unit.busy() >> (checked % kPencilBanks) & 1U) == 0) {
      const FixedPencilMemory<F>& pencil = pencils[checked];
      const auto& results = unit.results(checked % kPencilBanks);
      const bool certified = pencil.limits.band != 0;
      const FixedTrace<F> trace(scene, pencil);
      const PossibleHits<F> possible(scene, pencil);
      for (std::size_t ray = 0; ray < results.size(); ++ray) {
        hits += results[ray].nearest.hit ? 1U : 0U;
        if (certified) {
          ASSERT_EQ(possible.wrong(static_cast<std::uint32_t>(ray), results[ray]), "")
              << "pencil " << checked << " ray " << ray;
          continue;
        }
        ASSERT_EQ(results[ray].nearest.hit, trace.results()[ray].nearest.hit)
            << "pencil " << checked << " ray " << ray;
        if (!pencil.limits.any_hit) {
          ASSERT_EQ(results[ray], trace.results()[ray]) << "pencil " << checked << " ray " << ray;
        }
      }
      ++checked;
    }
  }
  EXPECT_EQ(unit.counters()[static_cast<std::size_t>(Counter::hits)], hits);
}

TEST(RaplasUnit, GivesWhatTheWalkGivesWhateverOverlaps) {
  FixedScenes<F> scenes(41);
  std::uint64_t all = 0;
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(k);
    const FixedSceneMemory<F> scene = scenes.scene(1 + scenes.below(200), 2 + scenes.below(5));
    std::vector<FixedPencilMemory<F>> pencils;
    for (int p = 0; p < 12; ++p) {
      pencils.push_back(scenes.certified(scenes.pencil(1 + scenes.below(16), 1 + scenes.below(16)), 3));
    }
    std::uint64_t hits = 0;
    ASSERT_NO_FATAL_FAILURE(run(scene, pencils, 1 + scenes.below(kPencilBanks), hits));
    all += hits;
  }
  EXPECT_GT(all, 3000U);
}

}  // namespace
}  // namespace raplas
