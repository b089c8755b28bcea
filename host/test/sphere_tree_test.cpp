#include "raplas/sphere_tree.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>
#include <string>

namespace raplas {
namespace {

constexpr std::array kBuilders{TreeBuilder::median, TreeBuilder::surface, TreeBuilder::pencil};

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
        std::vector<SphereTree> built{build_flat(triangles, {leaf, width})};
        for (const TreeBuilder builder : kBuilders) {
          built.push_back(build_tree(triangles, {leaf, width, builder}));
        }
        for (const SphereTree& tree : built) {
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

TEST(SphereTree, InnerNodesHaveAtMostWidthChildrenAndTheRootItsOwnWidth) {
  const auto triangles = random_triangles(5000, 2);
  for (const TreeBuilder builder : kBuilders) {
    const SphereTree tree = build_tree(triangles, {4, 4, builder});
    EXPECT_GE(tree.scene.root_count, 8U);  // root_width
    EXPECT_LE(tree.scene.root_count, 8U + 3U);
    for (const SphereNode& node : tree.scene.nodes) {
      EXPECT_LE(node.count, 4U);
    }
  }
}

/// A wall of two large triangles behind small ones.
std::vector<Triangle> wall_and_crumbs(std::size_t crumbs) {
  std::vector<Triangle> triangles = random_triangles(crumbs, 12);
  for (Triangle& t : triangles) {
    t.e1 *= 0.02 / glm::length(t.e1);
    t.e2 *= 0.02 / glm::length(t.e2);
  }
  triangles.push_back({{-0.5, -0.5, -0.3}, {1, 0, 0}, {1, 1, 0}});
  triangles.push_back({{-0.5, -0.5, -0.3}, {1, 1, 0}, {0, 1, 0}});
  return triangles;
}

glm::dvec3 corner_of(const DeviceScene& scene, const Piece& piece, std::size_t k) {
  const Triangle& t = scene.triangles[piece.triangle];
  const Piece::Corner& corner = piece.corners.at(k);
  return t.v0 + (double(corner.a) * t.e1 + double(corner.b) * t.e2) / double(kPieceUnit);
}

TEST(SphereTree, LargeTrianglesAreCutSmallOnesAreNot) {
  const auto triangles = wall_and_crumbs(300);
  for (const TreeBuilder builder : kBuilders) {
    for (const double longest : {1.0, 0.7, 0.3, 0.13}) {
      TreeOptions options;
      options.builder = builder;
      options.longest_edge = longest;
      options.extra_pieces = 1;
      const SphereTree tree = build_tree(triangles, options);
      EXPECT_NO_THROW(check_tree(tree.scene));
      check_source(tree, triangles);
      std::vector<int> pieces(triangles.size());
      for (const Piece& piece : tree.scene.pieces) {
        ++pieces.at(tree.source[piece.triangle]);
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_LE(glm::distance(corner_of(tree.scene, piece, k), corner_of(tree.scene, piece, (k + 1) % 3)),
                    longest * (1 + 1e-12));
        }
      }
      // each cut of a right-angled one with equal sides halves it into two of these
      const int expected = 1 << static_cast<int>(std::ceil(2 * std::log2(std::sqrt(2.0) / longest) - 1e-9));
      EXPECT_EQ(pieces[300], expected);
      EXPECT_EQ(pieces[301], expected);
      EXPECT_TRUE(std::all_of(pieces.begin(), pieces.begin() + 300, [](int count) { return count == 1; }));
      const SphereTree again = build_tree(triangles, options);
      EXPECT_EQ(again.source, tree.source);
      EXPECT_EQ(again.scene.nodes.size(), tree.scene.nodes.size());
    }
  }
  TreeOptions whole;
  whole.longest_edge = kWholeTriangles;
  EXPECT_TRUE(build_tree(triangles, whole).scene.pieces.empty());
  EXPECT_TRUE(build_tree(wall_and_crumbs(9), whole).scene.pieces.empty());
  EXPECT_TRUE(build_flat(triangles).scene.pieces.empty());
}

TEST(SphereTree, PiecesAreFew) {
  for (const std::size_t crumbs : {0U, 300U, 8000U}) {
    const auto triangles = wall_and_crumbs(crumbs);
    TreeOptions options;
    options.longest_edge = 1e-5;  // shorter than pieces can get
    const SphereTree tree = build_tree(triangles, options);
    EXPECT_NO_THROW(check_tree(tree.scene));
    EXPECT_EQ(tree.scene.pieces.size(), crumbs == 0 ? 0 : triangles.size() + triangles.size() / 32);
  }
}

TEST(SphereTree, EqualTrianglesStillMakeABalancedTree) {
  const std::vector<Triangle> same(5000, random_triangles(1, 9)[0]);
  for (const TreeBuilder builder : kBuilders) {
    EXPECT_NO_THROW(check_tree(build_tree(same, {4, 4, builder}).scene));
  }
}

/// Triangles that double in size and distance from one to the next: each cut by cost leaves one of them
/// alone.
std::vector<Triangle> growing_triangles(int count) {
  std::vector<Triangle> triangles;
  for (int k = 0; k < count; ++k) {
    const double size = std::exp2(-0.5 * k);
    triangles.push_back({{size, 0, 0}, {0, size / 4, 0}, {0, 0, size / 4}});
  }
  return triangles;
}

/// Largest sum of (count - 1) over the ranges with inner nodes on a way down from this range.
int stacked(const DeviceScene& scene, std::uint32_t first, std::uint32_t count) {
  int most = -1;
  for (std::uint32_t k = first; k < first + count; ++k) {
    const SphereNode& node = scene.nodes[k];
    if (!node.leaf) {
      most = std::max(most, stacked(scene, node.first, node.count));
    }
  }
  return most < 0 ? 0 : most + static_cast<int>(count) - 1;
}

TEST(SphereTree, AChainFallsBackToBalancedCuts) {
  int deepest = 0;
  for (const int count : {30, 55, 100, 110}) {
    const auto triangles = growing_triangles(count);
    for (const TreeBuilder builder : kBuilders) {
      for (const int width : {2, 3, 4, 8, 16}) {
        for (const int leaf : {1, 2, 4}) {
          const SphereTree tree = build_tree(triangles, {leaf, width, builder});
          EXPECT_NO_THROW(check_tree(tree.scene)) << count << ' ' << width << ' ' << leaf;
          check_source(tree, triangles);
          deepest = std::max(deepest, stacked(tree.scene, tree.scene.root_first, tree.scene.root_count));
        }
      }
    }
  }
  EXPECT_GE(deepest, kMaxStacked - 2) << "no tree comes near the bound: the test is too easy";
}

TEST(SphereTree, AMillionTrianglesKeepTheStackBoundAndTheIds) {
  // Far apart, so that single triangles would be the cheapest leaves, of which there are too many.
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

TEST(CheckTree, FindsPiecesThatAreNotTheTriangle) {
  TreeOptions options;
  options.extra_pieces = 1;
  const DeviceScene good = build_tree(wall_and_crumbs(20), options).scene;
  ASSERT_EQ(complaint(good), "");
  const auto cut = static_cast<std::size_t>(
      std::find_if(good.pieces.begin(), good.pieces.end(),
                   [](const Piece& piece) { return piece.corners != Piece{}.corners; }) -
      good.pieces.begin());
  ASSERT_LT(cut, good.pieces.size());
  const auto damaged = [&](auto&& damage) {
    DeviceScene scene = good;
    for (SphereNode& node : scene.nodes) {
      node.radius = 4;  // so that only the pieces are wrong
    }
    EXPECT_EQ(complaint(scene), "");
    damage(scene.pieces);
    return complaint(scene);
  };
  const std::string text = fmt::format("the pieces of triangle {}", good.pieces[cut].triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    for (const int step : {-1, 1}) {
      const auto moved = [step](std::uint16_t x) { return static_cast<std::uint16_t>(x + step); };
      EXPECT_NE(damaged([&](auto& pieces) {
                  pieces[cut].corners[k].a = moved(pieces[cut].corners[k].a);
                }).find(text),
                std::string::npos);
      EXPECT_NE(damaged([&](auto& pieces) {
                  pieces[cut].corners[k].b = moved(pieces[cut].corners[k].b);
                }).find(text),
                std::string::npos);
    }
  }
  const auto other = static_cast<std::size_t>(
      std::find_if(good.pieces.begin() + static_cast<std::ptrdiff_t>(cut) + 1, good.pieces.end(),
                   [&](const Piece& piece) { return piece.triangle == good.pieces[cut].triangle; }) -
      good.pieces.begin());
  // twice the same half: as large as the whole
  EXPECT_NE(damaged([&](auto& pieces) { pieces[cut].corners = pieces[other].corners; }).find(text),
            std::string::npos);
  EXPECT_NE(damaged([&](auto& pieces) { pieces[cut].triangle = 22; }), "");
  EXPECT_NE(damaged([&](auto& pieces) { pieces[cut].triangle = (pieces[cut].triangle + 1) % 22; }), "");
  EXPECT_NE(damaged([&](auto& pieces) { pieces.pop_back(); }), "");
  EXPECT_NE(damaged([&](auto& pieces) { pieces.push_back(pieces[cut]); }), "");
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

}  // namespace
}  // namespace raplas
