#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

#include "raplas/device.hpp"
#include "raplas/pencil.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

std::uint64_t count(const IntersectionDevice& device, Counter counter) {
  return device.counters()[static_cast<std::size_t>(counter)];
}

Pencil one_ray(const glm::dvec3& origin, const glm::dvec3& towards) {
  return make_pencil(origin, {towards, {0, 0.1, 0}, {0.1, 0, 0}, 1, 1});
}

TEST(ReferenceDevice, GivesDistanceAndBarycentricsOfBothFacings) {
  const Triangle front{{0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}};
  const Triangle back{{0, 0, 0.5}, {0, 1, 0}, {1, 0, 0}};
  for (const Triangle& triangle : {front, back}) {
    const auto device = make_device("reference", {});
    device->load(build_tree(std::vector<Triangle>{triangle}).scene);
    const Hit hit = device->trace(one_ray({0.25, 0.5, 0}, {0.25, 0.5, 1})).at(0);
    ASSERT_TRUE(hit.hit);
    EXPECT_GT(hit.d, 0);
    EXPECT_NEAR(hit.t(), 0.5, 1e-15);
    const glm::dvec3 p = triangle.v0 + (hit.u_scaled * triangle.e1 + hit.v_scaled * triangle.e2) / hit.d;
    EXPECT_LT(glm::distance(p, glm::dvec3(0.25, 0.5, 0.5)), 1e-15);
    EXPECT_FALSE(device->trace(one_ray({0.25, 0.5, 0}, {0.25, 0.5, -1})).at(0).hit) << "behind the origin";
    EXPECT_FALSE(device->trace(one_ray({0.6, 0.6, 0}, {0.6, 0.6, 1})).at(0).hit) << "outside";
  }
}

TEST(ReferenceDevice, LowerIdWinsATie) {
  std::vector<Triangle> twins(2, Triangle{{0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}});
  const auto device = make_device("reference", {});
  device->load(build_tree(twins).scene);
  EXPECT_EQ(device->trace(one_ray({0.2, 0.2, 0}, {0.2, 0.2, 1})).at(0).triangle, 0U);
}

glm::dvec3 random_vector(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random);
  const double y = uniform(random);
  return {x, y, uniform(random)};
}

std::vector<Triangle> random_triangles(std::mt19937_64& random, int count) {
  std::vector<Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const glm::dvec3 v0 = random_vector(random) * 0.5;
    const glm::dvec3 e1 = random_vector(random) * 0.1;
    triangles.push_back({v0, e1, random_vector(random) * 0.1});
  }
  return triangles;
}

/// A list of spheres of which each ray meets all, 100 triangles in each: every triangle is tested.
DeviceScene brute_force(const std::vector<Triangle>& triangles) {
  DeviceScene scene{triangles, {}, 0, 0, 0};
  const auto count = static_cast<std::uint32_t>(triangles.size());
  for (std::uint32_t first = 0; first < count; first += 100) {
    scene.nodes.push_back({{0, 0, 0}, 4, true, first, std::min(100U, count - first)});
  }
  scene.root_count = static_cast<std::uint32_t>(scene.nodes.size());
  return scene;
}

Pencil random_pencil(std::mt19937_64& random) {
  const glm::dvec3 origin = random_vector(random) * 0.9;
  const glm::dvec3 first = random_vector(random);
  const glm::dvec3 row_step = random_vector(random) * 0.1;
  return make_pencil(origin, {first, row_step, random_vector(random) * 0.1, 8, 8});
}

TEST(ReferenceDevice, TreeFindsWhatTestingEveryTriangleFinds) {
  std::mt19937_64 random(11);
  const SphereTree tree = build_tree(random_triangles(random, 1500));
  const auto with_tree = make_device("reference", {});
  const auto without = make_device("reference", {});
  with_tree->load(tree.scene);
  without->load(brute_force(tree.scene.triangles));
  std::size_t rays = 0;
  for (int k = 0; k < 100; ++k) {
    const Pencil pencil = random_pencil(random);
    EXPECT_EQ(with_tree->trace(pencil), without->trace(pencil));
    rays += pencil.directions.size();
  }
  fmt::print("reference.rays_checked {}, hits {}\n", rays, count(*with_tree, Counter::hits));
  EXPECT_GT(count(*with_tree, Counter::hits), 100U);
  EXPECT_EQ(count(*without, Counter::pairs_tested), rays * 1500);
  EXPECT_LT(count(*with_tree, Counter::pairs_tested), rays * 300);
}

TEST(ReferenceDevice, FarAndAnyHitLeaveOutWhatDoesNotMatter) {
  std::mt19937_64 random(12);
  const SphereTree tree = build_tree(random_triangles(random, 1500));
  const auto every = make_device("reference", {});
  const auto before_far = make_device("reference", {});
  const auto any = make_device("reference", {});
  every->load(brute_force(tree.scene.triangles));
  before_far->load(tree.scene);
  any->load(tree.scene);
  std::size_t far_hits = 0;
  for (int k = 0; k < 100; ++k) {
    Pencil pencil = random_pencil(random);
    const std::vector<Hit> nearest = every->trace(pencil);
    pencil.far = std::uniform_real_distribution<double>(0, 1)(random);
    const std::vector<Hit> before = before_far->trace(pencil);
    pencil.any_hit = true;
    const std::vector<Hit> some = any->trace(pencil);
    for (std::size_t ray = 0; ray < nearest.size(); ++ray) {
      const auto depth = [&](const Hit& hit) {
        return hit.t() * glm::dot(pencil.axis, pencil.directions[ray]);
      };
      const bool is_far = nearest[ray].hit && depth(nearest[ray]) >= pencil.far;
      far_hits += is_far ? 1U : 0U;
      EXPECT_EQ(before[ray], is_far ? Hit() : nearest[ray]);
      EXPECT_EQ(some[ray].hit, before[ray].hit);
      EXPECT_TRUE(!some[ray].hit || depth(some[ray]) < pencil.far);
    }
  }
  EXPECT_GT(far_hits, 100U);
  EXPECT_GT(count(*any, Counter::hits), 100U);
  EXPECT_EQ(count(*any, Counter::hits), count(*before_far, Counter::hits));
  EXPECT_LT(count(*any, Counter::pairs_tested), count(*before_far, Counter::pairs_tested));
}

TEST(Devices, UnknownNameListsTheKnownOnes) {
  try {
    (void)make_device("abacus", {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("reference, model, rtl"), std::string::npos);
  }
}

}  // namespace
}  // namespace raplas
