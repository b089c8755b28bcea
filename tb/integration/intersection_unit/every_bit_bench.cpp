// The whole unit with words, addresses, ranges and counts that need every bit of their way.
#include <algorithm>

#include "integration/intersection_unit/fixture.hpp"
#include "operands.hpp"

namespace raplas {
namespace {

constexpr std::uint32_t kDepth = 1U << 12;  // of Sphere and Triangle memory

TEST_F(IntersectionUnitBench, NeedsEveryBitOfEveryWord) {
  OperandPairs words(127);
  for (std::uint32_t k = 0; k < (kSlow ? 1 : 8); ++k) {
    const auto number = [&words, spread = k % 4 == 3 ? 16 : 2] {
      return F::from_bits(words.word(63 + words.between(-spread, spread)));
    };
    const auto vector = [&number] { return Vec3<F>{number(), number(), number()}; };
    PencilMemory<F> pencil;
    pencil.pencil = {16, 16, vector()};
    for (std::size_t line = 0; line < kMaxRows; ++line) {
      pencil.rows[line] = {vector(), number()};
      pencil.columns[line] = {vector(), number()};
    }
    std::generate(pencil.rays.begin(), pencil.rays.end(), vector);
    SceneMemory<F> scene;
    scene.triangles.resize(kSlow ? 64 : kDepth);
    for (TriangleWord<F>& triangle : scene.triangles) {
      triangle = {vector(), vector(), vector(), vector()};
    }
    const std::uint32_t spheres = kSlow ? 40 : 128;
    for (std::uint32_t s = 0; s < spheres; ++s) {
      const std::size_t line = s / 2 % kMaxRows;
      const PlaneWord<F>& plane = s % 2 == 0 ? pencil.rows[line] : pencil.columns[line];
      // touches one plane exactly, or misses it by an ulp; a few leaves, with one triangle or many
      SphereWord<F> sphere{vector(), F(), s % 8 == 0, 1, spheres};
      const std::uint32_t distance = plane_distance(plane, sphere.centre).magnitude();
      sphere.radius = F::from_bits(distance - (distance > 0x010000U ? words.bits(1) : 0U));
      if (sphere.leaf) {
        sphere.count = s % 64 == 0 ? 1 + words.bits(kSlow ? 3 : 6) : 1;
        sphere.first = words.bits(12) % (static_cast<std::uint32_t>(scene.triangles.size()) - sphere.count);
      }
      scene.spheres.push_back(sphere);
    }
    scene.spheres.emplace_back();  // the only child: a point
    scene.scene = {words.bits(21), spheres, 0};
    load(scene);
    load(pencil, k % 2);
    ASSERT_NO_FATAL_FAILURE(run(k % 2));
    ASSERT_NO_FATAL_FAILURE(check(scene, pencil, k % 2));
  }
  EXPECT_GT(total_[static_cast<std::size_t>(Counter::hits)], 0U);
}

TEST_F(IntersectionUnitBench, TakesIdentifiersOfAllTheirBits) {  // the memories take them modulo their depth
  Scenes<F> scenes(128);
  for (int bit = 0; bit < kIdBits; bit += kSlow ? 19 : 1) {
    const std::size_t bank = bit % 2 == 0 ? 0 : 1;
    SceneMemory<F> scene = scenes.scene(1, 3, bank == 0 ? 1U << bit : ~(1U << bit) & 0xffdffU);
    scene.scene.spheres = bit % 4 == 0 ? 0 : scenes.below(2U << kIdBits);  // from 0 it counts beyond
    load(scene);
    const PencilMemory<F> pencil = scenes.pencil(1 + scenes.below(8), 1 + scenes.below(8));
    load(pencil, bank);
    ASSERT_NO_FATAL_FAILURE(run(bank));
    ASSERT_NO_FATAL_FAILURE(check(scene, pencil, bank));
  }
}

TEST_F(IntersectionUnitBench, ReadsSpheresAndTrianglesToTheLastWord) {
  Scenes<F> scenes(129);
  constexpr std::uint32_t kSpheres = 24;
  constexpr std::uint32_t kFirst = kDepth - kSpheres;
  SceneMemory<F> scene = scenes.scene(0, kSpheres, kFirst);
  const auto beyond = static_cast<std::uint32_t>(scene.triangles.size() - kDepth);
  scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + beyond);
  for (std::uint32_t k = kFirst; k < kDepth; ++k) {
    scene.spheres[k].first -= beyond;
    scene.spheres[k].radius = F::from_double(2);  // all are met
  }
  const PencilMemory<F> pencil = scenes.pencil(3, 4);
  load(scene);
  for (std::uint32_t k = kFirst - beyond; k < kFirst; ++k) {
    write(Target::triangle, k, scene.triangles[k].pack());
  }
  load(pencil, 1);
  ASSERT_NO_FATAL_FAILURE(run(1));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 1));
}

TEST_F(IntersectionUnitBench, TakesARootRangeOfAnyLength) {
  Scenes<F> scenes(130);
  SceneMemory<F> scene;
  const SphereWord<F> aside{{F::from_double(0.9), F::from_double(0.9), F::from_double(-2)}, F(), true, 1, 0};
  constexpr int kLeast = 19;  // clocks of a range of one
  const int clocks = kSlow ? 2 * kLeast : 300;
  scene.spheres.assign(static_cast<std::size_t>(clocks), aside);
  scene.triangles.resize(1);
  const PencilMemory<F> pencil = scenes.pencil(4, 2);
  load(pencil, 1);
  for (int bit = 0; bit <= kIdBits; bit += kSlow ? 10 : 1) {
    scene.scene = {1U << bit, 1U << bit, 0};
    load(scene);
    ASSERT_NO_FATAL_FAILURE(run(1, clocks));
    EXPECT_EQ(model_.busy(), 1 << bit > clocks - kLeast) << "a range of 2^" << bit;
    reset_dut();  // nobody waits for a million spheres
    model_ = IntersectionUnit<F>(kTesters);
    model_.load(&scene);
    model_.pencil(1) = pencil;
  }
}

TEST_F(IntersectionUnitBench, CountsALongList) {  // the memory modulo its depth: many times the same spheres
  Scenes<F> scenes(132);
  SceneMemory<F> scene;
  SphereWord<F> met{{F(), F(), F()}, F::from_double(2), true, 1, 0};
  const SphereWord<F> aside{{F::from_double(0.9), F::from_double(0.9), F::from_double(-2)}, F(), true, 1, 0};
  const std::uint32_t spheres = kSlow ? 300 : 3 * kDepth;
  for (std::uint32_t k = 0; k < spheres; ++k) {
    met.first = k % 128;
    scene.spheres.push_back(k % kDepth % 3 == 0 ? met : aside);
  }
  const SceneMemory<F> triangles = scenes.scene(0, 100);
  scene.triangles.assign(triangles.triangles.begin(), triangles.triangles.begin() + 128);
  scene.scene = {kSlow ? spheres : kDepth, spheres, 0};
  const PencilMemory<F> pencil = scenes.pencil(2, 1);
  load(scene);
  write(Target::sphere, 0, scene.spheres[0].pack());  // which the word after the last one hit
  load(pencil, 1);
  ASSERT_NO_FATAL_FAILURE(run(1));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 1));
}

TEST_F(IntersectionUnitBench, StacksAsManyRangesAsThereIsRoomFor) {
  Scenes<F> scenes(131);
  const F far = F::from_double(0.9);
  SceneMemory<F> scene;
  constexpr std::uint32_t kRanges = kStackDepth;
  for (std::uint32_t k = 0; k < kRanges; ++k) {  // all met: each gives a range
    scene.spheres.push_back({{F(), F(), F()}, F::from_double(2), false, 1 + k % 2, kRanges + 2 * k});
  }
  for (std::uint32_t k = 0; k < 2 * kRanges; ++k) {
    scene.spheres.push_back({{far, far, F::from_double(-2)}, F(), true, 1, 0});
  }
  scene.triangles.resize(1);
  scene.scene = {3 * kRanges, kRanges, 0};
  const PencilMemory<F> pencil = scenes.pencil(2, 2);
  load(scene);
  load(pencil, 0);
  ASSERT_NO_FATAL_FAILURE(run(0));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 0));
}

}  // namespace
}  // namespace raplas
