// The whole unit of profile raplas with words, addresses and registers that need every bit of their way.
#include <algorithm>
#include <cstdlib>

#include "integration/raplas_unit/fixture.hpp"
#include "operands.hpp"

namespace raplas {
namespace {

constexpr std::uint32_t kNodeDepth = 1U << 12;  // of the memories
constexpr std::uint32_t kVertexDepth = 1U << 13;
constexpr std::uint32_t kTriangleDepth = 1U << 12;

/// Words of random bits, so that no scene is behind them: spheres and vertices that touch planes or miss them
/// by one unit.
class RandomWords {
 public:
  explicit RandomWords(std::uint32_t seed) : words_(seed) {}

  std::uint32_t bits(unsigned count) { return words_.bits(count); }
  F number() { return F::from_bits(words_.word(63 + words_.between(-2, 2))); }
  Vec3<F> vector() { return {number(), number(), number()}; }

  FixedVec3 point() {
    const auto coordinate = [this] { return static_cast<std::int32_t>(bits(18)) - (1 << 17); };
    return {coordinate(), coordinate(), coordinate()};
  }

  /// A direction of any length up to 1.
  FixedVec3 normal() {
    for (;;) {
      const FixedVec3 n = point();
      if (plane_sum({n, 0}, n) <= std::int64_t{1} << 34) {
        return n;
      }
    }
  }

  /// Through a random one of these points, or `slack` away from it, or a unit more or less.
  FixedPlane plane(const std::vector<VertexWord>& vertices, std::uint32_t slack) {
    FixedPlane plane{normal(), 0};
    const FixedVec3& v = vertices[bits(20) % vertices.size()].point;
    const std::int64_t away = static_cast<std::int64_t>(slack) << 17;
    plane.offset = -plane_sum(plane, v) + static_cast<std::int64_t>(bits(2)) - 1;
    plane.offset += bits(1) == 0 ? away : -away;
    constexpr std::int64_t kMost = (std::int64_t{1} << 35) - 1;
    plane.offset = std::clamp(plane.offset, -kMost - 1, kMost);
    return plane;
  }

  /// Touches the plane, or misses it by one unit.
  std::uint32_t radius(const FixedPlane& plane, const FixedVec3& centre, std::uint32_t slack) {
    const std::int64_t distance = std::abs(plane_sum(plane, centre));
    const std::int64_t least = ((distance + (1 << 17) - 1) >> 17) - slack;  // that meets
    const std::int64_t most = (1 << 18) - 1 - std::int64_t{slack};
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(least - bits(1), 0, most));
  }

 private:
  OperandPairs words_;
};

TEST_F(RaplasUnitBench, NeedsEveryBitOfEveryWord) {
  constexpr std::uint32_t kStrip = 8;
  RandomWords words(227);
  for (std::uint32_t k = 0; k < (kSlow ? 1 : 24); ++k) {
    const std::uint32_t slack = words.bits(k % 3 == 0 ? 3 : k % 3 == 1 ? 12 : 16);
    FixedSceneMemory<F> scene;
    scene.triangles.resize(kSlow ? 32 : kTriangleDepth);
    for (TriangleWord<F>& triangle : scene.triangles) {
      triangle = {words.vector(), words.vector(), words.vector(), words.vector()};
    }
    for (std::uint32_t v = 0; v < (kSlow ? 60 : 1200); ++v) {
      const auto triangle = static_cast<std::uint32_t>(words.bits(12) % scene.triangles.size());
      const std::uint32_t place = v % kStrip;  // the first three fill the slots
      const std::uint32_t slot = place < 3 ? place : words.bits(20) % 3;
      scene.vertices.push_back({words.point(), slot, place > 1 && words.bits(1) != 0, triangle});
    }
    FixedPencilMemory<F> pencil;
    pencil.pencil = {kSlow ? 5U : 16U, kSlow ? 5U : 16U, words.vector()};
    pencil.limits.band = k % 2 == 0 ? 0 : words.number().magnitude();
    pencil.limits.any_hit = words.bits(2) == 0;
    pencil.limits.slack = slack;
    pencil.limits.far = words.bits(1) == 0 ? kNoBound : 0x5000 + words.bits(13);
    for (std::size_t line = 0; line < kMaxRows; ++line) {
      pencil.planes.rows[line] = words.plane(scene.vertices, slack);
      pencil.planes.columns[line] = words.plane(scene.vertices, slack);
    }
    pencil.planes.near = words.plane(scene.vertices, slack);
    pencil.planes.depth = words.plane(scene.vertices, slack);
    std::generate(pencil.rays.begin(), pencil.rays.end(), [&words] { return words.vector(); });
    const std::uint32_t roots = kSlow ? 20 : 127;
    const std::uint32_t below = kSlow ? 20 : 1000;
    for (std::uint32_t n = 0; n < roots + below; ++n) {
      NodeWord node;
      node.centre = words.point();
      const std::size_t line = words.bits(4) % pencil.pencil.rows;
      const std::uint32_t kind = words.bits(3);
      const FixedPlane& plane = kind == 0       ? pencil.planes.near
                                : kind % 2 == 0 ? pencil.planes.rows[line]
                                                : pencil.planes.columns[line];
      node.radius = words.radius(plane, node.centre, slack);
      node.leaf = n >= roots || words.bits(2) == 0;
      node.count = node.leaf ? 3 + words.bits(3) : 1 + words.bits(1);
      const auto strips = static_cast<std::uint32_t>(scene.vertices.size()) / kStrip - 1;
      node.first =
          node.leaf ? words.bits(20) % strips * kStrip : roots + words.bits(20) % (below - node.count);
      scene.nodes.push_back(node);
    }
    scene.scene = {words.bits(21), roots, 0};
    pencil.planes.down = words.plane(scene.vertices, slack);
    pencil.planes.across = words.plane(scene.vertices, slack);
    pencil.limits.scale = words.bits(kGridExponentBits);
    pencil.limits.least = words.bits(kGridExponentBits);
    pencil.limits.error = words.bits(kGridErrorBits);
    load(scene);
    ASSERT_NO_FATAL_FAILURE(stream({pencil}, 1, Oracle::model));
  }
  EXPECT_GT(model_.counters()[static_cast<std::size_t>(Counter::pairs_tested)], kSlow ? 50U : 50'000U);
  EXPECT_GE(hits_, kSlow ? 0U : 200U);
}

TEST_F(RaplasUnitBench, TakesIdentifiersOfAllTheirBits) {  // the memories take them modulo their depth
  FixedScenes<F> scenes(228);
  for (int bit = 0; bit < kIdBits; bit += kSlow ? 19 : 1) {
    const std::uint32_t one = 1U << bit;
    const std::uint32_t others = ~one & 0xffdffU;
    const FixedPlaces places = bit % 3 == 0   ? FixedPlaces{one, others, one}
                               : bit % 3 == 1 ? FixedPlaces{others, one, others}
                                              : FixedPlaces{one, one, others};
    FixedSceneMemory<F> scene = moved(scenes.scene(1 + scenes.below(8), 3), places);
    scene.scene.spheres = bit % 4 == 0 ? 0 : scenes.below(2U << kIdBits);  // from 0 it counts below
    load(scene, places);
    std::vector<FixedPencilMemory<F>> pencils;
    for (int k = 0; k < (kSlow ? 1 : 4); ++k) {
      pencils.push_back(scenes.pencil(1 + scenes.below(8), 1 + scenes.below(8)));
    }
    ASSERT_NO_FATAL_FAILURE(stream(pencils));
  }
}

TEST_F(RaplasUnitBench, ReadsAllMemoriesToTheLastWord) {
  FixedScenes<F> scenes(229);
  const FixedSceneMemory<F> low = scenes.scene(kSlow ? 8 : 100, 5);
  const auto size = [](const auto& memory) { return static_cast<std::uint32_t>(memory.size()); };
  const FixedPlaces places{kNodeDepth - size(low.nodes), kVertexDepth - size(low.vertices),
                           kTriangleDepth - size(low.triangles)};
  const FixedSceneMemory<F> scene = moved(low, places);
  load(scene, places);
  std::vector<FixedPencilMemory<F>> pencils;
  for (int k = 0; k < (kSlow ? 1 : 8); ++k) {
    pencils.push_back(scenes.pencil(kSlow ? 3 : 16, kSlow ? 4 : 16));
  }
  ASSERT_NO_FATAL_FAILURE(stream(pencils));
}

TEST_F(RaplasUnitBench, TakesARootRangeOfAnyLength) {
  FixedScenes<F> scenes(230);
  const FixedSceneMemory<F> base = scenes.scene(1);
  for (std::uint32_t count = 1; count < (1U << kCountBits); count += kSlow ? 63 : count < 10 ? 1 : 9) {
    FixedSceneMemory<F> scene = base;
    scene.nodes.assign(count, base.nodes.front());  // many spheres around the same triangles
    if (kSlow) {
      std::fill(scene.nodes.begin() + 1, scene.nodes.end(), NodeWord{{0x1ffff, 0x1ffff, 0}, 0, true, 3, 0});
    }
    scene.scene = {count, count, 0};
    load(scene);
    ASSERT_NO_FATAL_FAILURE(stream({scenes.pencil(2, 2), scenes.pencil(3, 1)}));
  }
}

}  // namespace
}  // namespace raplas
