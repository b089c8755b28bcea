// Scenes in fixed point: nodes, vertices and triangles, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "encode_fixed_source.hpp"
#include "raplas/encode.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

/// Walks the nodes; checks that each encloses the vertex words of its leaves.
void check_below(const FixedScene& scene, std::uint32_t first, std::uint32_t count,
                 const std::vector<NodeWord>& path, std::uint64_t& checked) {
  for (std::uint32_t k = first; k < first + count; ++k) {
    const NodeWord& node = scene.memory.nodes.at(k);
    std::vector<NodeWord> here = path;
    here.push_back(node);
    if (!node.leaf) {
      check_below(scene, node.first, node.count, here, checked);
      continue;
    }
    for (std::uint32_t v = node.first; v < node.first + node.count; ++v) {
      for (const NodeWord& above : here) {
        std::int64_t square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::int64_t d = scene.memory.vertices.at(v).point[axis] - above.centre[axis];
          square += d * d;
        }
        ASSERT_LE(square, std::int64_t{above.radius} * above.radius);
        ++checked;
      }
    }
  }
}

/// A closed surface: a sphere of rings x sectors quadrilaterals.
std::vector<Triangle> globe(int rings, int sectors) {
  const auto at = [&](int ring, int sector) {
    const double a = 3.14159265358979 * ring / rings;
    const double b = 6.28318530717959 * (sector % sectors) / sectors;
    return glm::dvec3(0.1, -0.1, 0.05) +
           0.8 * glm::dvec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
  };
  std::vector<Triangle> triangles;
  const auto add = [&triangles](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    if (glm::length(glm::cross(b - a, c - a)) > 1e-12) {
      triangles.push_back({a, b - a, c - a});
    }
  };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      add(at(r, s), at(r + 1, s), at(r + 1, s + 1));
      add(at(r, s), at(r + 1, s + 1), at(r, s + 1));
    }
  }
  return triangles;
}

TEST(EncodeFixed, NodesHoldEveryVertexBelow) {
  const SphereTree tree = build_tree(globe(40, 60));
  check_tree(tree.scene);
  const FixedScene words = encode_fixed(tree.scene);
  std::uint64_t checked = 0;
  check_below(words, words.memory.scene.first, words.memory.scene.count, {}, checked);
  EXPECT_GT(checked, 0U);
  EXPECT_EQ(words.memory.nodes.size(), tree.scene.nodes.size());
  for (std::size_t k = 0; k < words.memory.nodes.size(); ++k) {
    EXPECT_EQ(words.memory.nodes[k].leaf, tree.scene.nodes[k].leaf);
    // no more than the rounding of centre, vertices and radius
    EXPECT_LE(words.memory.nodes[k].radius * kUnit, tree.scene.nodes[k].radius + 4 * kUnit);
  }
  const auto slots = slots_of(words, tree.scene.triangles.size());
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const Triangle& t = tree.scene.triangles[k];
    std::array<glm::dvec3, 3> corners{t.v0, t.v0 + t.e1, t.v0 + t.e2};
    ASSERT_EQ(slots[k].size(), 1U);
    for (const FixedVec3& word : slots[k][0]) {
      const glm::dvec3 v = glm::dvec3(word[0], word[1], word[2]) * kUnit;
      EXPECT_TRUE(std::any_of(corners.begin(), corners.end(),
                              [&v](const glm::dvec3& p) { return glm::distance(p, v) < kUnit; }));
    }
    const TriangleWord<Fp24> expected = encode<Fp24>(t);
    EXPECT_EQ(words.memory.triangles[k].pack(), expected.pack());
  }
  EXPECT_LE(words.vertex_error, kMaxVertexError);
  EXPECT_LT(double(words.memory.vertices.size()), 1.8 * double(slots.size()));
}

TEST(EncodeFixed, PiecesHaveTheirCornersAndOneTriangleWord) {
  TreeOptions options;
  options.longest_edge = 0.1;
  options.extra_pieces = 8;
  const SphereTree tree = build_tree(globe(4, 6), options);
  check_tree(tree.scene);
  const FixedScene words = encode_fixed(tree.scene);
  EXPECT_EQ(words.memory.triangles.size(), tree.scene.triangles.size());
  EXPECT_LE(words.vertex_error, kMaxVertexError);
  std::uint64_t checked = 0;
  check_below(words, words.memory.scene.first, words.memory.scene.count, {}, checked);
  const auto slots = slots_of(words, tree.scene.triangles.size());
  std::size_t pieces = 0;
  for (const auto& of_triangle : slots) {
    pieces += of_triangle.size();
  }
  EXPECT_EQ(pieces, tree.scene.pieces.size());
  EXPECT_GT(pieces, 4 * tree.scene.triangles.size());
  for (const Piece& piece : tree.scene.pieces) {
    const TriangleWord<Fp24>& t = words.memory.triangles[piece.triangle];
    const auto holds = [&](const std::array<FixedVec3, 3>& of) {
      return std::all_of(piece.corners.begin(), piece.corners.end(), [&](const Piece::Corner& corner) {
        const glm::dvec3 p =
            decode(t.v0) +
            (double(corner.a) * decode(t.e1) + double(corner.b) * decode(t.e2)) / double(kPieceUnit);
        return std::any_of(of.begin(), of.end(), [&](const FixedVec3& word) {
          return glm::distance(p, glm::dvec3(word[0], word[1], word[2]) * kUnit) <= words.vertex_error;
        });
      });
    };
    const auto& candidates = slots[piece.triangle];
    EXPECT_TRUE(std::any_of(candidates.begin(), candidates.end(), holds));
  }
}

TEST(EncodeFixed, RefusesScenesThatDoNotFit) {
  const Triangle small{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
  EXPECT_EQ(complaint([&] { (void)encode_fixed(one_leaf({small})); }), "");
  EXPECT_NE(complaint([&] {
              (void)encode_fixed(one_leaf({{{0.9, 0.9, 0}, {0.1, 0, 0}, {0, 0.1, 0}}}));
            }).find("node 0: a vertex lies outside"),
            std::string::npos);
  DeviceScene far_centre = one_leaf({small});
  far_centre.nodes[0].centre = {0, 1, 0};
  EXPECT_NE(complaint([&] { (void)encode_fixed(far_centre); }).find("node 0: its centre"), std::string::npos);
  std::vector<Triangle> apart;
  apart.reserve(43);
  Source random(3);
  for (int k = 0; k < 43; ++k) {
    apart.push_back({random.in_cube() * 0.5, random.in_cube() * 0.1, random.in_cube() * 0.1});
  }
  EXPECT_NE(complaint([&] { (void)encode_fixed(one_leaf(apart)); }).find("node 0: 129 vertex words"),
            std::string::npos);
  DeviceScene wide = one_leaf({{{-0.57, -0.57, -0.57}, {0.1, 0, 0}, {0, 0.1, 0}}});
  wide.nodes[0].centre = glm::dvec3(0.99);
  EXPECT_NE(complaint([&] { (void)encode_fixed(wide); }).find("node 0: its radius"), std::string::npos);
}

}  // namespace
}  // namespace raplas
