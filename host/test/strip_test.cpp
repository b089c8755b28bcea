#include "raplas/strip.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>

#include "random.hpp"

namespace raplas {
namespace {

using Corners = std::array<FixedVec3, 3>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// What the words mean: slots that vertices go to. Returns the triangles that are closed, by ID.
std::map<std::uint32_t, Corners> play(const std::vector<VertexWord>& strip) {
  std::map<std::uint32_t, Corners> triangles;
  // a slot that no word has filled yet holds a point that no triangle has
  constexpr FixedVec3 kNothing{1 << 17, 1 << 17, 1 << 17};
  Corners slots{kNothing, kNothing, kNothing};
  for (const VertexWord& word : strip) {
    slots.at(word.slot) = word.point;
    if (word.emit) {
      EXPECT_TRUE(triangles.emplace(word.triangle, sorted(slots)).second) << "triangle closed twice";
    }
  }
  EXPECT_TRUE(strip.empty() || strip.back().emit);
  return triangles;
}

/// Words of an order of the triangles, by counting the vertices that each does not share with the one before.
std::size_t words_in_order(const std::vector<FixedTriangle>& triangles,
                           const std::vector<std::size_t>& order) {
  std::size_t words = 3;
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Corners before = sorted(triangles[order[k - 1]].corners);
    const Corners now = sorted(triangles[order[k]].corners);
    std::vector<FixedVec3> fresh;
    std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(fresh));
    words += std::max<std::size_t>(1, fresh.size());
  }
  return words;
}

/// Triangles of `points` points, so that some share vertices, edges, or everything, or have equal corners.
std::vector<FixedTriangle> random_leaf(Xoshiro& random, std::size_t count, std::uint32_t points) {
  std::vector<FixedTriangle> triangles;
  for (std::size_t k = 0; k < count; ++k) {
    FixedTriangle& t = triangles.emplace_back();
    t.id = static_cast<std::uint32_t>(7 * k + 1000);
    for (FixedVec3& corner : t.corners) {
      const auto p = static_cast<std::int32_t>(random.below(points));
      corner = {p - 3, 5 * p, -p * p};
    }
  }
  return triangles;
}

TEST(Strip, GivesEachTriangleOnceInAsFewWordsAsAnyOrder) {
  Xoshiro random(1);
  int leaves = 0;
  for (std::size_t count = 1; count <= 6; ++count) {
    for (int trial = 0; trial < 60; ++trial) {
      const auto triangles = random_leaf(random, count, 2 + random.below(12));
      const auto strip = make_strip(triangles);
      const auto closed = play(strip);
      ASSERT_EQ(closed.size(), count);
      for (const FixedTriangle& t : triangles) {
        ASSERT_EQ(closed.at(t.id), sorted(t.corners));
      }
      std::vector<std::size_t> order(count);
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::size_t least = strip.size() + 1;
      do {
        least = std::min(least, words_in_order(triangles, order));
      } while (std::next_permutation(order.begin(), order.end()));
      ASSERT_EQ(strip.size(), least) << count << " triangles";
      ++leaves;
    }
  }
  fmt::print("strip.leaves_against_all_orders {}\n", leaves);
}

TEST(Strip, LargeLeavesHoldEachTriangleOnceToo) {
  Xoshiro random(2);
  for (std::size_t count = 7; count <= 60; ++count) {
    const auto triangles = random_leaf(random, count, 4 + random.below(40));
    const auto strip = make_strip(triangles);
    const auto closed = play(strip);
    ASSERT_EQ(closed.size(), count);
    for (const FixedTriangle& t : triangles) {
      ASSERT_EQ(closed.at(t.id), sorted(t.corners));
    }
    EXPECT_LE(strip.size(), 3 * count);
  }
}

TEST(Strip, AStripOfNeighboursTakesOneWordEach) {
  std::vector<FixedTriangle> fan;
  fan.reserve(20);
  for (std::int32_t k = 0; k < 20; ++k) {
    fan.push_back({{{{0, 0, 0}, {k, 1, k}, {k + 1, 1, k + 1}}}, static_cast<std::uint32_t>(k)});
  }
  EXPECT_EQ(make_strip(fan).size(), 22U);
  EXPECT_TRUE(make_strip({}).empty());
}

}  // namespace
}  // namespace raplas
