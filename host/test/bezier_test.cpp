#include "raplas/bezier.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <set>

namespace raplas {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// How often each edge is used.
std::map<Edge, int> edges(const Mesh& mesh) {
  std::map<Edge, int> uses;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) {
      uses[std::minmax(from, to)] += 1;
    }
  }
  return uses;
}

std::vector<BezierPatch> teapot() { return load_patches(RAPLAS_SCENES "/teapot.bpt"); }

TEST(Bezier, TeapotHas32PatchesOfThePublishedSize) {
  const auto patches = teapot();
  ASSERT_EQ(patches.size(), 32U);
  const Mesh mesh = tessellate(patches, 16);
  glm::dvec3 low(1e9);
  glm::dvec3 high(-1e9);
  for (const glm::dvec3& p : mesh.vertices) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  // Handle to spout, width of the body, height.
  EXPECT_NEAR(low.x, -3.0, 0.01);
  EXPECT_NEAR(high.x, 3.434, 0.01);
  EXPECT_NEAR(low.y, -2.0, 0.01);
  EXPECT_NEAR(high.y, 2.0, 0.01);
  EXPECT_NEAR(low.z, 0.0, 0.01);
  EXPECT_NEAR(high.z, 3.15, 0.01);
}

TEST(Bezier, TeapotLosesExactlyThePolesTriangles) {
  // 8 patches have a pole: the knob's top and the bottom's middle.
  for (const int n : {1, 2, 4, 6}) {
    const Mesh mesh = tessellate(teapot(), n);
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(32 * 2 * n * n - 8 * n))
        << n << " subdivisions";
  }
}

TEST(Bezier, NeighbouringPatchesShareTheirBoundaries) {
  const auto patches = teapot();
  const Mesh mesh = tessellate(patches, 4);
  std::size_t open = 0;
  for (const auto& [edge, uses] : edges(mesh)) {
    EXPECT_LE(uses, 2);
    open += uses == 1 ? 1U : 0U;
  }
  // Open are, with 16 edges a circle: the body's inner rim, the lid's rim, both ends of the handle (8 edges
  // each: two patches around), and both of the spout.
  EXPECT_EQ(open, 16U + 16U + 2 * 8U + 2 * 8U);
  fmt::print("teapot.edges_open {}\n", open);
}

TEST(Bezier, BodyAndBottomTogetherAreClosedUpToTheRim) {
  const auto patches = teapot();
  std::vector<BezierPatch> body(patches.begin(), patches.begin() + 12);  // rim and body
  body.insert(body.end(), patches.begin() + 28, patches.end());          // bottom
  const Mesh mesh = tessellate(body, 4);
  for (const auto& [edge, uses] : edges(mesh)) {
    const double rim = 2.4;
    const bool at_rim = std::abs(mesh.vertices[edge.first].z - rim) < 1e-9 &&
                        std::abs(mesh.vertices[edge.second].z - rim) < 1e-9 && uses == 1;
    EXPECT_TRUE(uses == 2 || at_rim);
  }
}

TEST(Bezier, PatchGoesThroughItsCornersAndIsLinearWhereItsPointsAre) {
  BezierPatch patch;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      patch[4 * i + j] = glm::dvec3(static_cast<double>(i) / 3, static_cast<double>(j) / 3, 0.5);
    }
  }
  EXPECT_EQ(evaluate(patch, 0, 0), patch[0]);
  EXPECT_EQ(evaluate(patch, 1, 1), patch[15]);
  EXPECT_LT(glm::distance(evaluate(patch, 0.3, 0.7), glm::dvec3(0.3, 0.7, 0.5)), 1e-15);
}

}  // namespace
}  // namespace raplas
