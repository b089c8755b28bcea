// The clocked unit against the value-exact walk, for several numbers of testers; the order of tests must not
// matter.
#include "raplas/intersection_unit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "random_scenes.hpp"

namespace raplas {
namespace {

constexpr int kPencils = 200;
constexpr int kMostClocks = 10'000'000;

template <typename F>
void run(IntersectionUnit<F>& unit, std::size_t bank) {
  unit.clock(true, bank);
  for (int k = 0; unit.busy(); ++k) {
    ASSERT_LT(k, kMostClocks);
    unit.clock(false, bank);
  }
}

template <typename F>
void compare_with_the_walk(Testers testers, std::uint32_t seed) {
  Scenes<F> scenes(seed);
  IntersectionUnit<F> unit(testers);
  std::uint64_t hits = 0;
  for (int k = 0; k < kPencils; ++k) {
    const SceneMemory<F> scene = scenes.scene(k % 4, 1 + scenes.below(6), scenes.below(3000));
    const auto bank = static_cast<std::size_t>(k % 2);
    const PencilMemory<F> pencil = scenes.pencil(1 + scenes.below(16), 1 + scenes.below(16));
    unit.load(&scene);
    unit.pencil(bank) = pencil;
    ASSERT_NO_FATAL_FAILURE(run(unit, bank));
    ResultMemory<F> results;
    EventCounters exact{};
    trace_pencil(scene, pencil, results, exact);
    EXPECT_EQ(unit.results(bank), results);
    const auto count = [](const EventCounters& counters, Counter c) {
      return counters[static_cast<std::size_t>(c)];
    };
    for (const Counter c : {Counter::spheres_tested, Counter::spheres_skipped, Counter::plane_tests,
                            Counter::pairs_tested, Counter::hits}) {
      EXPECT_EQ(count(unit.counters(), c), count(exact, c)) << kCounterNames[static_cast<std::size_t>(c)];
    }
    EXPECT_GE(count(unit.counters(), Counter::cycles), count(exact, Counter::pairs_tested));
    hits += count(exact, Counter::hits);
  }
  EXPECT_GT(hits, 100U) << "hardly a hit is tested";
}

TEST(IntersectionUnit, AgreesWithTheWalkForAnyNumberOfTesters) {
  for (const Testers testers :
       {Testers{4, 4}, Testers{16, 16}, Testers{1, 1}, Testers{8, 2}, Testers{16, 1}}) {
    SCOPED_TRACE(testing::Message() << testers.rows << " + " << testers.columns << " testers");
    ASSERT_NO_FATAL_FAILURE(compare_with_the_walk<Fp24>(testers, 7));
  }
}

TEST(IntersectionUnit, AgreesWithTheWalkWithoutGuardBits) {
  ASSERT_NO_FATAL_FAILURE(compare_with_the_walk<Fp24Paper>({4, 4}, 8));
}

TEST(IntersectionUnit, FindsTheSameHitsInAnyOrderOfTheSpheres) {
  using F = Fp24;
  Scenes<F> scenes(9);
  std::mt19937 random(10);
  for (int k = 0; k < kPencils; ++k) {
    SceneMemory<F> scene = scenes.scene(0, 40);
    scene.triangles[scene.triangles.size() / 2] =
        scene.triangles[0];  // a tie: the lower ID must win in any order
    const PencilMemory<F> pencil = scenes.pencil(16, 16);
    ResultMemory<F> results;
    EventCounters counters{};
    trace_pencil(scene, pencil, results, counters);
    std::shuffle(scene.spheres.begin(), scene.spheres.end(), random);
    IntersectionUnit<F> unit;
    unit.load(&scene);
    unit.pencil(0) = pencil;
    ASSERT_NO_FATAL_FAILURE(run(unit, 0));
    ASSERT_EQ(unit.results(0), results);
  }
}

}  // namespace
}  // namespace raplas
