#include "raplas/sphere_tree.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>
#include <string>

#include "raplas/bounding_sphere.hpp"

namespace raplas {
namespace {

/// Triangles of widely different sizes in clusters within the unit ball.
std::vector<Triangle> random_triangles(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<Triangle> triangles;
  glm::dvec3 cluster(0);
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 50 == 0) {
      cluster = vector() * 0.4;
    }
    const double size = std::exp2(5 * uniform(random) - 7);
    triangles.push_back({cluster + vector() * 0.1, vector() * size, vector() * size});
  }
  return triangles;
}

/// Every triangle of the list is in the tree once, unchanged.
void check_source(const SphereTree& tree, const std::vector<Triangle>& triangles) {
  ASSERT_EQ(tree.source.size(), triangles.size());
  std::vector<bool> seen(triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Triangle& expected = triangles[tree.source[k]];
    EXPECT_EQ(tree.scene.triangles[k].v0, expected.v0);
    EXPECT_EQ(tree.scene.triangles[k].e1, expected.e1);
    EXPECT_EQ(tree.scene.triangles[k].e2, expected.e2);
    EXPECT_FALSE(seen[tree.source[k]]);
    seen[tree.source[k]] = true;
  }
}

TEST(SphereTree, FlatAndTreeHoldEveryTriangleOnceInsideTheirSpheres) {
  int trees = 0;
  for (const std::size_t count : {1U, 2U, 4U, 5U, 7U, 16U, 17U, 64U, 65U, 333U, 3000U}) {
    const auto triangles = random_triangles(count, count);
    for (const int leaf : {1, 2, 3, 4, 16, 127}) {
      for (const int width : {2, 3, 4, 8}) {
        const TreeOptions options{leaf, width};
        for (const SphereTree& tree : {build_flat(triangles, options), build_tree(triangles, options)}) {
          EXPECT_NO_THROW(check_tree(tree.scene))
              << count << " triangles, leaf " << leaf << ", width " << width;
          check_source(tree, triangles);
          ++trees;
        }
      }
    }
  }
  fmt::print("sphere_tree.trees_checked {}\n", trees);
}

TEST(SphereTree, FlatListIsOneLevelOfFullLeaves) {
  const auto triangles = random_triangles(1000, 1);
  const SphereTree flat = build_flat(triangles, {4, 4});
  EXPECT_EQ(flat.scene.root_count, flat.scene.nodes.size());
  EXPECT_LE(flat.scene.nodes.size(), 252U);  // 250 full leaves, one more where large triangles begin
  EXPECT_TRUE(std::all_of(flat.scene.nodes.begin(), flat.scene.nodes.end(),
                          [](const SphereNode& n) { return n.leaf; }));
}

TEST(SphereTree, InnerNodesHaveAtMostWidthChildren) {
  const SphereTree tree = build_tree(random_triangles(5000, 2), {4, 4});
  EXPECT_LE(tree.scene.root_count, 4U);
  for (const SphereNode& node : tree.scene.nodes) {
    EXPECT_LE(node.count, 4U);
  }
}

TEST(SphereTree, EqualTrianglesStillMakeABalancedTree) {
  const std::vector<Triangle> same(5000, random_triangles(1, 9)[0]);
  EXPECT_NO_THROW(check_tree(build_tree(same).scene));
}

TEST(SphereTree, AMillionTrianglesKeepTheStackBound) {
  const std::size_t count = 1'000'000;
  const SphereTree tree = build_tree(random_triangles(count, 4));
  EXPECT_NO_THROW(check_tree(tree.scene));
  EXPECT_EQ(tree.scene.triangles.size(), count);
}

TEST(SphereTree, RefusesWhatTheFormatCannotHold) {
  const auto triangles = random_triangles(4, 5);
  EXPECT_THROW((void)build_tree({}), std::runtime_error);
  EXPECT_THROW((void)build_tree(triangles, {0, 4}), std::runtime_error);
  EXPECT_THROW((void)build_tree(triangles, {128, 4}), std::runtime_error);
  EXPECT_THROW((void)build_tree(triangles, {4, 1}), std::runtime_error);
  const std::vector<Triangle> many((std::size_t{1} << kIdBits) + 1, triangles[0]);
  EXPECT_THROW((void)build_flat(many), std::runtime_error);
}

/// The message of check_tree(), "" if it finds nothing.
std::string complaint(const DeviceScene& scene) {
  try {
    check_tree(scene);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(CheckTree, FindsEachKindOfDamageAndNamesTheNode) {
  const DeviceScene good = build_tree(random_triangles(200, 6)).scene;
  ASSERT_EQ(complaint(good), "");
  const auto damaged = [&good](auto&& damage) {
    DeviceScene scene = good;
    damage(scene);
    return complaint(scene);
  };
  const auto leaf = static_cast<std::size_t>(
      std::find_if(good.nodes.begin(), good.nodes.end(), [](const SphereNode& n) { return n.leaf; }) -
      good.nodes.begin());
  const std::string name = fmt::format("node {}", leaf);
  EXPECT_NE(damaged([&](DeviceScene& s) { s.nodes[leaf].radius *= 0.5; }).find(name), std::string::npos);
  EXPECT_NE(damaged([&](DeviceScene& s) { s.nodes[leaf].count = 0; }).find(name), std::string::npos);
  EXPECT_NE(damaged([&](DeviceScene& s) { s.nodes[leaf].count = 128; }).find(name), std::string::npos);
  EXPECT_NE(damaged([&](DeviceScene& s) { s.nodes[leaf].first = 1000; }).find(name), std::string::npos);
  EXPECT_NE(damaged([&](DeviceScene& s) { s.nodes[leaf].centre.x += 1e-9; }).find(name), std::string::npos);
  EXPECT_NE(damaged([&](DeviceScene& s) { s.nodes[leaf].count -= 1; }), "");
  EXPECT_NE(damaged([&](DeviceScene& s) { s.nodes[0].first = s.nodes[1].first; }), "");
  EXPECT_NE(damaged([](DeviceScene& s) { s.root_count = 1; }), "");
  EXPECT_NE(damaged([](DeviceScene& s) { s.root_count = 0; }), "");
}

TEST(CheckTree, FindsATreeTooDeepForTheStack) {
  // A chain: each range is one leaf and one inner node, which stacks one range a level.
  const std::vector<Triangle> triangles = random_triangles(60, 7);
  DeviceScene scene;
  scene.triangles = triangles;
  scene.root_count = 2;
  scene.nodes.reserve(2 * triangles.size());
  for (std::uint32_t k = 0; k < triangles.size() - 1; ++k) {
    const bool last = k + 2 == triangles.size();
    scene.nodes.push_back({{0, 0, 0}, 4, true, k, 1});
    scene.nodes.push_back({{0, 0, 0}, 4, last, last ? k + 1 : 2 * k + 2, last ? 1U : 2U});
  }
  EXPECT_NE(complaint(scene).find("ranges may wait"), std::string::npos) << complaint(scene);
}

TEST(BoundingBall, IsTheSmallestForFewPointsAndEnclosesMany) {
  const std::vector<glm::dvec3> pair{{0, 0, 0}, {2, 0, 0}};
  EXPECT_NEAR(bounding_ball(pair).radius, 1, 1e-12);
  const double h = std::sqrt(3.0);
  const std::vector<glm::dvec3> triangle{{-1, 0, 0}, {1, 0, 0}, {0, h, 0}, {0, h / 3, 0.1}};
  EXPECT_NEAR(bounding_ball(triangle).radius, 2 / h, 1e-9);
  const std::vector<glm::dvec3> obtuse{{-2, 0, 0}, {2, 0, 0}, {0, 0.1, 0}};
  EXPECT_NEAR(bounding_ball(obtuse).radius, 2, 1e-9);
  const std::vector<glm::dvec3> tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(bounding_ball(tetrahedron).radius, h, 1e-9);
  EXPECT_NEAR(bounding_ball(std::vector<glm::dvec3>(5, glm::dvec3(1, 2, 3))).radius, 0, 1e-12);

  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    // On a sphere of radius 1: from some points on no ball is much smaller.
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 5 + k; ++i) {
      points.push_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))) + 3.0);
    }
    const Ball ball = bounding_ball(points);
    EXPECT_LE(ball.radius, 1.1);
    const double enclosing = enclosing_radius(points, ball.centre);
    for (const glm::dvec3& p : points) {
      EXPECT_LE(glm::distance(p, ball.centre), enclosing);
    }
  }
}

}  // namespace
}  // namespace raplas
