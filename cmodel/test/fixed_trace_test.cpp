// Nothing that is skipped changes a hit.
#include "raplas/fixed_trace.hpp"

#include <gtest/gtest.h>

#include "possible_hits.hpp"
#include "random_fixed_scenes.hpp"

namespace raplas {
namespace {

using F = Fp24;

/// The hit definition, ray by ray and piece by piece of triangles.
FixedTrace<F>::Results brute_force(const FixedSceneMemory<F>& scene, const FixedPencilMemory<F>& pencil) {
  FixedTrace<F>::Results results{};
  std::array<FixedTest, 3> slots;
  for (const VertexWord& vertex : scene.vertices) {
    slots[vertex.slot] = test_object(pencil.planes, vertex.point, 0, pencil.limits.slack);
    if (!vertex.emit) {
      continue;
    }
    const CrossedLines lines = crossed_lines(slots);
    const ReachedColumns reached = reached_columns(slots, pencil.limits);
    for (std::uint32_t row = 0; row < pencil.pencil.rows; ++row) {
      for (std::uint32_t column = 0; column < pencil.pencil.columns; ++column) {
        const std::uint32_t ray = row * kMaxColumns + column;
        const auto s = solve(scene.triangles[vertex.triangle], pencil.pencil.origin, pencil.rays[ray]);
        const bool crossed = (lines.rows >> row & (lines.columns & reached[row]) >> column & 1U) != 0;
        if (!s.hit || !crossed || !lines.near) {
          continue;
        }
        const std::uint32_t q = depth_quotient(s.t, s.d);
        if (q >= lines.z && q < pencil.limits.far &&
            nearer(s.t, s.d, vertex.triangle, results[ray].nearest)) {
          results[ray].nearest = {true, vertex.triangle, s.t, s.d, s.u, s.v};
        }
      }
    }
  }
  return results;
}

/// The vertex words of triangle k, odd, become another piece of triangle k - 1.
void join_pieces(FixedSceneMemory<F>& scene) {
  for (VertexWord& vertex : scene.vertices) {
    vertex.triangle &= ~1U;
  }
}

void expect_same_hits(const FixedTrace<F>::Results& expected, const FixedTrace<F>::Results& seen,
                      bool any_hit) {
  for (std::size_t ray = 0; ray < expected.size(); ++ray) {
    ASSERT_EQ(seen[ray].nearest.hit, expected[ray].nearest.hit) << "ray " << ray;
    if (!any_hit) {
      ASSERT_EQ(seen[ray], expected[ray]) << "ray " << ray;
    }
  }
}

TEST(FixedTrace, SkippingChangesNoHit) {
  FixedScenes<F> scenes(31);
  std::uint64_t hits = 0;
  FixedCounts all;
  FixedCounts none;
  for (int k = 0; k < 400; ++k) {
    FixedSceneMemory<F> scene = scenes.scene(1 + scenes.below(120), 2 + scenes.below(5));
    if (k % 4 == 3) {
      join_pieces(scene);
    }
    const FixedPencilMemory<F> pencil = scenes.pencil(1 + scenes.below(16), 1 + scenes.below(16));
    const auto expected = brute_force(scene, pencil);
    for (int off = -1; off < 10; ++off) {  // everything skipped, each skip off, a random half off, all off
      SCOPED_TRACE(testing::Message() << "scene " << k << ", off " << off);
      const std::uint32_t random = off == 8 ? scenes.below(256) : off == 9 ? 255 : off < 0 ? 0 : 1U << off;
      const auto on = [random](int skip) { return (random >> skip & 1U) == 0; };
      const Skips skips{on(0), on(1), on(2), on(3), on(4), on(5), on(6), on(7)};
      const FixedTrace<F> trace(scene, pencil, skips);
      ASSERT_NO_FATAL_FAILURE(expect_same_hits(expected, trace.results(), pencil.limits.any_hit));
      FixedCounts& sum = off < 0 ? all : none;
      if (off < 0 || off == 9) {
        sum.pairs += trace.counts().pairs;
        sum.spheres += trace.counts().spheres;
        sum.strays += trace.counts().strays;
        hits += trace.counts().hits;
      }
    }
  }
  EXPECT_GT(hits, 10'000U);
  EXPECT_LT(all.pairs * 4, none.pairs) << "nothing is skipped";
  EXPECT_GT(none.strays, 0U) << "no case in which only the lines and depths of the triangle reject a hit";
}

TEST(FixedTrace, KeepsWhatMayBeNearestOfCertifiedHitsWhateverIsSkipped) {
  FixedScenes<F> scenes(32);
  std::uint64_t hits = 0;
  std::uint64_t unsure = 0;
  std::uint64_t rivals = 0;
  std::uint64_t crowds = 0;
  std::uint64_t hidden = 0;
  for (int k = 0; k < 300; ++k) {
    FixedSceneMemory<F> scene = scenes.scene(1 + scenes.below(120), 2 + scenes.below(5));
    if (k % 4 == 3) {
      join_pieces(scene);
    }
    const FixedPencilMemory<F> pencil =
        scenes.certified(scenes.pencil(1 + scenes.below(16), 1 + scenes.below(16)));
    const PossibleHits<F> expected(scene, pencil);
    FixedPencilMemory<F> nearest = pencil;  // what an any-hit pencil is whose rays go on
    nearest.limits.any_hit = false;
    const PossibleHits<F> of_nearest(scene, nearest);
    for (int off = -1; off < 10; ++off) {
      const std::uint32_t random = off == 8 ? scenes.below(256) : off == 9 ? 255 : off < 0 ? 0 : 1U << off;
      const auto on = [random](int skip) { return (random >> skip & 1U) == 0; };
      const Skips skips{on(0), on(1), on(2), on(3), on(4), on(5), on(6), on(7)};
      const auto results = FixedTrace<F>(scene, pencil, skips).results();
      for (std::uint32_t ray = 0; ray < results.size(); ++ray) {
        ASSERT_EQ((skips.ended ? expected : of_nearest).wrong(ray, results[ray]), "")
            << "scene " << k << ", off " << off << ", ray " << ray;
        hits += results[ray].nearest.hit ? 1U : 0U;
        unsure += results[ray].unsure ? 1U : 0U;
        rivals += results[ray].rival ? 1U : 0U;
        crowds += results[ray].crowd ? 1U : 0U;
      }
    }
    hidden += expected.hidden();
  }
  EXPECT_GT(hits, 50'000U);
  EXPECT_GT(unsure, 5'000U);
  EXPECT_GT(rivals, 5'000U);
  EXPECT_GT(crowds, 1'000U);
  EXPECT_LT(hidden * 5, hits) << "most are taken as hidden";
}

}  // namespace
}  // namespace raplas
