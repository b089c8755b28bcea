#include <fmt/format.h>
#include <gtest/gtest.h>

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

TEST(ReferenceDevice, TreeFindsWhatTestingEveryTriangleFinds) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<Triangle> triangles;
  triangles.reserve(1500);
  for (int k = 0; k < 1500; ++k) {
    triangles.push_back({vector() * 0.5, vector() * 0.1, vector() * 0.1});
  }
  const SphereTree tree = build_tree(triangles);
  // One sphere around everything, nothing rejected. (127 triangles a leaf: one leaf for each.)
  DeviceScene brute{tree.scene.triangles, {}, 0, 0, 0};
  for (std::uint32_t first = 0; first < 1500; first += 100) {
    brute.nodes.push_back({{0, 0, 0}, 4, true, first, 100});
  }
  brute.root_count = static_cast<std::uint32_t>(brute.nodes.size());
  const auto with_tree = make_device("reference", {});
  const auto without = make_device("reference", {});
  with_tree->load(tree.scene);
  without->load(brute);
  std::size_t rays = 0;
  for (int k = 0; k < 100; ++k) {
    const Pencil pencil = make_pencil(vector() * 0.9, {vector(), vector() * 0.1, vector() * 0.1, 8, 8});
    EXPECT_EQ(with_tree->trace(pencil), without->trace(pencil));
    rays += pencil.directions.size();
  }
  fmt::print("reference.rays_checked {}, hits {}\n", rays, count(*with_tree, Counter::hits));
  EXPECT_GT(count(*with_tree, Counter::hits), 100U);
  EXPECT_EQ(count(*without, Counter::pairs_tested), rays * 1500);
  EXPECT_LT(count(*with_tree, Counter::pairs_tested), rays * 300);
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
