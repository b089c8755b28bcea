// Every hit of a ray as stored is found: decided with 640-bit reals, and what that takes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "encode_fixed_source.hpp"
#include "exact_hit.hpp"
#include "figures.hpp"
#include "raplas/encode.hpp"
#include "raplas/pencil.hpp"
#include "raplas/scan_lines.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

/// From tiny to nearly half of all directions; the axis along a coordinate now and then.
Pencil random_pencil(Source& random) {
  const glm::dvec3 origin = random.on_sphere() * random.uniform(0, 0.98);
  glm::dvec3 axis = random.on_sphere();
  if (random.below(8) == 0) {
    axis = glm::dvec3(0);
    axis[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1 : -1;
  }
  const double distance = std::exp2(random.uniform(-10, 0));
  const double size = distance * std::exp2(random.uniform(-12, 1));
  const double turn = random.uniform(0, 6.3);
  const glm::dvec3 u = any_across(axis);
  const glm::dvec3 v = glm::cross(axis, u);
  const glm::dvec3 row = u * std::cos(turn) + v * std::sin(turn);
  const glm::dvec3 column = glm::cross(axis, row) + random.uniform(-0.5, 0.5) * row;
  const int rows = 1 + static_cast<int>(random.below(16));
  const int columns = 1 + static_cast<int>(random.below(16));
  // now and then far aside, so that the rays hardly go along the axis
  const double aside = random.below(4) == 0 ? 20 * distance : size;
  const glm::dvec3 first =
      origin + axis * distance + (random.uniform(-1, 1) * row + random.uniform(-1, 1) * column) * aside;
  Pencil pencil =
      make_pencil(origin, {first, row * size / double(rows), column * size / double(columns), rows, columns});
  if (random.below(4) == 0) {
    pencil.far = random.uniform(0, 1);
  }
  pencil.any_hit = random.below(2) == 0;
  const std::uint32_t surface = random.below(4);  // some rays go behind it now and then, or nearly so
  if (surface > 0) {
    pencil.front = random.on_sphere();
    if (surface > 1) {
      const glm::dvec3& ray = pencil.directions[random.below(static_cast<std::uint32_t>(rows * columns))];
      pencil.front -= ray * (glm::dot(ray, pencil.front) - std::exp2(random.uniform(-20, 0)));
      pencil.front = glm::normalize(pencil.front);
    }
  }
  return pencil;
}

std::size_t ray_of(const Pencil& pencil, int row, int column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(pencil.columns) +
         static_cast<std::size_t>(column);
}

/// A triangle that the ray from `origin` to `end` hits, or nearly so: inside, at an edge, or at a vertex;
/// there perhaps all on one side of `plane`, so that nothing but the slack finds it. Some lie near the
/// origin, and some across the axis, where near plane and depths are sharpest.
Triangle aimed(Source& random, const glm::dvec3& origin, const glm::dvec3& end, const glm::dvec3& plane,
               const glm::dvec3& axis) {
  for (;;) {
    const double share = random.below(3) == 0 ? std::exp2(random.uniform(-22, 0)) : random.uniform(0, 1);
    const glm::dvec3 point = origin + (end - origin) * share;
    glm::dvec3 e1 = random.on_sphere() * std::exp2(random.uniform(-14, 0));
    glm::dvec3 e2 = random.on_sphere() * std::exp2(random.uniform(-14, 0));
    if (random.below(4) == 0) {
      e2 = e1 * random.uniform(0.3, 3) + random.on_sphere() * std::exp2(random.uniform(-17, -8));  // sliver
    }
    if (random.below(3) == 0) {
      e1 -= axis * glm::dot(axis, e1);
      e2 -= axis * glm::dot(axis, e2);
    }
    const std::uint32_t kind = random.below(4);
    const double u = kind < 2 ? random.uniform(0, 1) : 0;
    const double v = kind < 1 ? random.uniform(0, 1 - u) : 0;
    if (kind == 3) {
      e1 *= glm::dot(e1, plane) < 0 ? -1.0 : 1.0;
      e2 *= glm::dot(e2, plane) < 0 ? -1.0 : 1.0;
    }
    const glm::dvec3 v0 = point - u * e1 - v * e2;
    if (std::max({glm::length(v0), glm::length(v0 + e1), glm::length(v0 + e2)}) < 0.99) {
      return {v0, e1, e2};
    }
  }
}

/// Where a ray leaves the unit ball.
double way_out(const glm::dvec3& origin, const glm::dvec3& unit) {
  const double half = glm::dot(origin, unit);
  return std::sqrt(half * half - glm::dot(origin, origin) + 1) - half;
}

/// What the tests say of a triangle: three vertices of radius 0.
struct TriangleTest {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  bool near = false;
  std::int64_t depth = std::numeric_limits<std::int64_t>::max();  ///< what z is the code of
};

TriangleTest test_triangle(const FixedPencil& pencil, const std::array<FixedVec3, 3>& corners,
                           std::uint32_t slack) {
  TriangleTest result;
  FixedTest any;
  FixedTest all{~0U, ~0U, ~0U, ~0U, true, 0};
  for (const FixedVec3& corner : corners) {
    const FixedTest t = test_object(pencil.memory.planes, corner, 0, slack);
    any.rows_meet |= t.rows_meet;
    any.rows_above |= t.rows_above;
    any.columns_meet |= t.columns_meet;
    any.columns_above |= t.columns_above;
    all.rows_above &= t.rows_above;
    all.columns_above &= t.columns_above;
    result.near = result.near || t.near;
    result.depth = std::min(result.depth, plane_sum(pencil.memory.planes.depth, corner) -
                                              (std::int64_t{slack} << kCoordinateFraction));
  }
  result.rows = any.rows_meet | (any.rows_above & ~all.rows_above);
  result.columns = any.columns_meet | (any.columns_above & ~all.columns_above);
  return result;
}

/// How the scan lines of a triangle treat the rays of a row.
struct ScanLine {
  LineMask reached = 0;
  LineMask reached_without_margin = 0;
  bool on_grid = false;
};

ScanLine scan_line(const FixedPencil& pencil, const std::array<FixedVec3, 3>& corners, int row) {
  const LimitsWord& limits = pencil.memory.limits;
  std::array<GridPoint, 3> points;
  for (std::size_t k = 0; k < 3; ++k) {
    const FixedTest t = test_object(pencil.memory.planes, corners[k], 0, limits.slack);
    points[k] = project(t.across, t.down, t.depth, limits);
    if (!points[k].known) {
      return {first_lines(kMaxColumns), first_lines(kMaxColumns), false};
    }
  }
  EdgeCuts cuts = edge_cuts(points, limits.error);
  const auto line = static_cast<std::uint32_t>(row);
  ScanLine result{row_columns(cuts, line), 0, true};
  for (EdgeCut& cut : cuts) {
    cut.margin = 0;
  }
  result.reached_without_margin = row_columns(cuts, line);
  return result;
}

/// What the planes say of points on rays as stored, within the unit ball and before far.
struct Deviation {
  long double aside = 0;   ///< most distance from a ray's row or column plane
  long double behind = 0;  ///< most distance behind the near plane
  long double deeper = 0;  ///< most that the depth plane's distance is above t
};

Deviation deviation(const FixedPencil& words, double far) {
  using Vector = std::array<long double, 3>;
  const auto vector = [](const glm::dvec3& v) { return Vector{v.x, v.y, v.z}; };
  const auto product = [](const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const Vector origin = vector(decode(words.memory.pencil.origin));
  const auto distance = [&](const FixedPlane& plane, const Vector& point) {
    const Vector normal{plane.normal[0] * 0x1p-17L, plane.normal[1] * 0x1p-17L, plane.normal[2] * 0x1p-17L};
    return product(normal, point) + static_cast<long double>(plane.offset) * 0x1p-34L;
  };
  constexpr long double kNone = -10;
  Deviation most{0, kNone, kNone};
  for (std::size_t r = 0; r < words.memory.pencil.rows; ++r) {
    for (std::size_t c = 0; c < words.memory.pencil.columns; ++c) {
      const Vector direction = vector(decode(words.memory.rays[r * kMaxColumns + c]));
      const long double a = product(direction, direction);
      const long double half = product(origin, direction);
      const long double square = half * half - a * (product(origin, origin) - 1);
      if (square < 0) {
        continue;
      }
      const long double last = std::max(0.0L, std::min<long double>((std::sqrt(square) - half) / a, far));
      for (const long double t : {0.0L, last}) {
        const Vector point{origin[0] + t * direction[0], origin[1] + t * direction[1],
                           origin[2] + t * direction[2]};
        most.aside = std::max({most.aside, std::abs(distance(words.memory.planes.rows[r], point)),
                               std::abs(distance(words.memory.planes.columns[c], point))});
        most.behind = std::max(most.behind, -distance(words.memory.planes.near, point));
        most.deeper = std::max(most.deeper, distance(words.memory.planes.depth, point) - t);
      }
    }
  }
  return most;
}

void expect_ranges(const FixedPlane& plane) {
  std::int64_t square = 0;
  for (const std::int64_t component : plane.normal) {
    EXPECT_LT(component, 1 << kCoordinateFraction);
    EXPECT_GE(component, -(1 << kCoordinateFraction));
    square += component * component;
  }
  EXPECT_LE(square, std::int64_t{1} << (2 * kCoordinateFraction));
  EXPECT_LT(std::abs(plane.offset), std::int64_t{1} << (kOffsetBits - 1));
}

TEST(EncodeFixed, EveryHitOfARayAsStoredIsFoundByItsLines) {
  const std::uint64_t cases = number_of_cases(100'000);
  Source random(1);
  std::uint64_t hits = 0;
  std::uint64_t lost_without_slack = 0;
  std::uint64_t lost_with_half = 0;
  std::uint64_t depths = 0;
  std::uint64_t on_grid = 0;
  std::uint64_t lost_without_margin = 0;
  std::uint64_t in_pieces = 0;
  std::uint32_t largest_slack = 0;
  for (std::uint64_t done = 0; done < cases;) {
    const Pencil pencil = random_pencil(random);
    std::vector<Triangle> triangles;
    std::vector<std::pair<int, int>> rays;
    while (triangles.size() < 32) {
      const int r = static_cast<int>(random.below(static_cast<std::uint32_t>(pencil.rows)));
      const int c = static_cast<int>(random.below(static_cast<std::uint32_t>(pencil.columns)));
      const glm::dvec3& unit = pencil.directions[ray_of(pencil, r, c)];
      const Plane& plane = random.below(2) == 0 ? pencil.row_planes[static_cast<std::size_t>(r)]
                                                : pencil.column_planes[static_cast<std::size_t>(c)];
      const double side = random.below(2) == 0 ? 1 : -1;
      const glm::dvec3 end = pencil.origin + unit * way_out(pencil.origin, unit);
      const bool across_front = pencil.front != glm::dvec3(0) && random.below(2) == 0;
      triangles.push_back(
          aimed(random, pencil.origin, end, side * plane.normal, across_front ? pencil.front : pencil.axis));
      rays.emplace_back(r, c);
    }
    // every second time in pieces, perhaps tiny ones
    SphereTree tree{one_leaf(triangles), std::vector<std::uint32_t>(triangles.size())};
    std::iota(tree.source.begin(), tree.source.end(), 0U);
    if (random.below(2) == 0) {
      TreeOptions options;
      options.longest_edge = std::exp2(random.uniform(-8, 0));
      options.extra_pieces = 8;
      tree = build_tree(triangles, options);
    }
    const FixedScene scene = encode_fixed(tree.scene);
    const FixedPencil words = encode_fixed(pencil, scene.vertex_error);
    ASSERT_LE(scene.vertex_error / kUnit, most_vertex_error(triangles));
    ASSERT_LE(words.memory.limits.slack, most_slack(pencil, scene.vertex_error));
    largest_slack = std::max(largest_slack, words.memory.limits.slack);
    const Deviation most = deviation(words, pencil.far);
    const double spare = words.memory.limits.slack * kUnit - scene.vertex_error;
    ASSERT_LE(most.aside, spare);
    ASSERT_LE(most.behind, spare);
    ASSERT_LE(most.deeper, spare);
    std::for_each(words.memory.planes.rows.begin(), words.memory.planes.rows.end(), expect_ranges);
    std::for_each(words.memory.planes.columns.begin(), words.memory.planes.columns.end(), expect_ranges);
    expect_ranges(words.memory.planes.near);
    expect_ranges(words.memory.planes.depth);
    const auto slots = slots_of(scene, triangles.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const auto [r, c] = rays[tree.source[k]];
      const auto ray = static_cast<std::size_t>(r) * kMaxColumns + static_cast<std::size_t>(c);
      const TriangleWord<Fp24>& stored = scene.memory.triangles[k];
      const auto t = exact_hit(decode(words.memory.pencil.origin), decode(words.memory.rays[ray]),
                               decode(stored.v0), decode(stored.e1), decode(stored.e2));
      if (!t || depth_code(*t) >= words.memory.limits.far) {
        continue;
      }
      const auto crossed = [r = r, c = c](const TriangleTest& of) {
        return (of.rows >> r & of.columns >> c & 1U) != 0;
      };
      const auto some_piece = [&](std::uint32_t slack, const auto& holds) {
        return std::any_of(slots[k].begin(), slots[k].end(),
                           [&](const auto& piece) { return holds(test_triangle(words, piece, slack)); });
      };
      const auto finds = [&](const auto& piece) {
        const TriangleTest test = test_triangle(words, piece, words.memory.limits.slack);
        return crossed(test) && test.near && test.depth <= *t;
      };
      ASSERT_TRUE(std::any_of(slots[k].begin(), slots[k].end(),
                              [&](const auto& piece) {
                                return finds(piece) && (scan_line(words, piece, r).reached >> c & 1U) != 0;
                              }))
          << "pencil of case " << done << ", triangle " << k;
      ++hits;
      bool reached_without_margin = false;
      for (const auto& piece : slots[k]) {
        const ScanLine line = scan_line(words, piece, r);
        if (finds(piece) && (line.reached >> c & 1U) != 0 && line.on_grid) {
          ++on_grid;
        }
        reached_without_margin =
            reached_without_margin || (finds(piece) && (line.reached_without_margin >> c & 1U) != 0);
      }
      lost_without_margin += reached_without_margin ? 0U : 1U;
      in_pieces += slots[k].size() > 1 ? 1U : 0U;
      depths += some_piece(words.memory.limits.slack,
                           [&](const TriangleTest& of) { return crossed(of) && depth_code(of.depth) > 0; })
                    ? 1U
                    : 0U;
      lost_without_slack += some_piece(0, crossed) ? 0U : 1U;
      lost_with_half += some_piece(words.memory.limits.slack / 2, crossed) ? 0U : 1U;
    }
    done += triangles.size();
  }
  fmt::print("encode_fixed.hits_checked {}\n", hits);
  fmt::print("encode_fixed.largest_slack {} units\n", largest_slack);
  fmt::print("encode_fixed.hits_in_pieces {}\n", in_pieces);
  fmt::print("encode_fixed.lost_without_slack {}\n", lost_without_slack);
  fmt::print("encode_fixed.lost_with_half_the_slack {}\n", lost_with_half);
  fmt::print("encode_fixed.hits_on_grid {}\n", on_grid);
  fmt::print("encode_fixed.lost_without_margin {}\n", lost_without_margin);
  EXPECT_GT(hits, cases / 4);
  EXPECT_GT(on_grid, hits / 4);
  EXPECT_GT(lost_without_margin, 0U);
  EXPECT_GT(depths, hits / 2);
  EXPECT_GT(in_pieces, hits / 8);
  EXPECT_GT(lost_without_slack, 0U);
}

}  // namespace
}  // namespace raplas
