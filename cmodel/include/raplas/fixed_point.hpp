// Plane tests in fixed point, value-exact: entities dsp_plane_test, depth_code and fixed_testers.
// A coordinate, a normal's component and a radius are integers in units of 2^-kCoordinateFraction, a distance
// is one in units of its square. Nothing is rounded but the words themselves: docs/fixed_point.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "raplas/words.hpp"

namespace raplas {

/// x, y, z in units of 2^-kCoordinateFraction; each fits kCoordinateBits bits, sign included.
using FixedVec3 = std::array<std::int32_t, 3>;

/// The plane n.x + p = 0, |n| <= 1.
struct FixedPlane {
  FixedVec3 normal{};
  std::int64_t offset = 0;  ///< p, kOffsetBits bits, sign included

  [[nodiscard]] PackedWord<FixedPlaneLayout::kBits> pack() const noexcept {
    PackedWord<FixedPlaneLayout::kBits> word{};
    insert(word, FixedPlaneLayout::nx, static_cast<std::uint32_t>(normal[0]));
    insert(word, FixedPlaneLayout::ny, static_cast<std::uint32_t>(normal[1]));
    insert(word, FixedPlaneLayout::nz, static_cast<std::uint32_t>(normal[2]));
    const auto bits = static_cast<std::uint64_t>(offset);
    constexpr Field kLow{FixedPlaneLayout::p.lsb, kCoordinateBits};
    constexpr Field kHigh{FixedPlaneLayout::p.lsb + kCoordinateBits, kOffsetBits - kCoordinateBits};
    insert(word, kLow, static_cast<std::uint32_t>(bits));
    insert(word, kHigh, static_cast<std::uint32_t>(bits >> kCoordinateBits));
    return word;
  }
};

/// All planes of a pencil. The row side of the Plane Memory holds rows, near and down (kAxisPlane,
/// kGridPlane), the column side columns, depth and across.
struct FixedPlanes {
  std::array<FixedPlane, kMaxRows> rows;
  std::array<FixedPlane, kMaxColumns> columns;
  FixedPlane near;    ///< n is the pencil's axis; objects wholly on its negative side are dropped
  FixedPlane depth;   ///< n is the pencil's axis; n.x + p is the depth of x
  FixedPlane down;    ///< n.x + p grows from row to row
  FixedPlane across;  ///< n.x + p grows from column to column
};

/// What the testers say of an object, a bit for each line.
struct FixedTest {
  std::uint32_t rows_meet = 0;
  std::uint32_t rows_above = 0;
  std::uint32_t columns_meet = 0;
  std::uint32_t columns_above = 0;
  bool near = false;        ///< not wholly behind the near plane
  std::uint32_t z = 0;      ///< depth code: no point of the object is less deep
  std::int64_t down = 0;    ///< distance from the down plane, the reach added
  std::int64_t across = 0;  ///< from the across plane likewise
  std::uint32_t depth = 0;  ///< depth code of the distance from the depth plane, the reach taken off

  friend constexpr bool operator==(const FixedTest&, const FixedTest&) noexcept = default;
};

/// n.x + p, exact.
[[nodiscard]] constexpr std::int64_t plane_sum(const FixedPlane& plane, const FixedVec3& point) noexcept {
  std::int64_t sum = plane.offset;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += std::int64_t{plane.normal[k]} * point[k];
  }
  return sum;
}

/// The depth code of a distance, rounded down: 0 below 2^14, else exponent and fraction of its top bits.
[[nodiscard]] constexpr std::uint32_t depth_code(std::int64_t distance) noexcept {
  constexpr int kLeast =
      2 * kCoordinateFraction - kDepthBias + 1;  // top bit of the least number that isn't 0
  if (distance < std::int64_t{1} << kLeast) {
    return 0;
  }
  const int top = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(distance))) - 1;
  return (static_cast<std::uint32_t>(top - kLeast) << kDepthFractionBits) +
         static_cast<std::uint32_t>(distance >> (top - kDepthFractionBits));
}

/// What depth_code (the entity) gives as z_o: the code less DEPTH_MARGIN, at least 0.
[[nodiscard]] constexpr std::uint32_t depth_lower(std::int64_t distance) noexcept {
  constexpr std::uint32_t kMargin{kDepthMargin};
  const std::uint32_t code = depth_code(distance);
  return code > kMargin ? code - kMargin : 0;
}

/// The tests of a sphere, or of a vertex as a sphere of radius 0, whose radius grows by the pencil's slack.
[[nodiscard]] constexpr FixedTest test_object(const FixedPlanes& planes, const FixedVec3& centre,
                                              std::uint32_t radius, std::uint32_t slack) noexcept {
  const std::int64_t reach = std::int64_t{radius + slack} << kCoordinateFraction;
  FixedTest test;
  const auto lines = [&](const auto& family, std::uint32_t& meet, std::uint32_t& above) {
    for (std::size_t k = 0; k < family.size(); ++k) {
      const std::int64_t d = plane_sum(family[k], centre);
      meet |= ((d < 0 ? -d : d) <= reach ? 1U : 0U) << k;
      above |= (d >= 0 ? 1U : 0U) << k;
    }
  };
  lines(planes.rows, test.rows_meet, test.rows_above);
  lines(planes.columns, test.columns_meet, test.columns_above);
  test.near = plane_sum(planes.near, centre) + reach >= 0;
  const std::int64_t depth = plane_sum(planes.depth, centre) - reach;
  test.z = depth_lower(depth);
  test.down = plane_sum(planes.down, centre) + reach;
  test.across = plane_sum(planes.across, centre) + reach;
  test.depth = depth_code(depth);
  return test;
}

/// A bit for each row, or each column, of a pencil.
using LineMask = std::uint32_t;

/// The first `count` lines.
[[nodiscard]] constexpr LineMask first_lines(std::uint32_t count) noexcept {
  return (LineMask{1} << count) - 1;
}

/// A triangle as the plane tests of its vertices leave it: which rays may hit it, and how deep it begins.
struct CrossedLines {
  LineMask rows = 0;     ///< row planes that it crosses or comes near
  LineMask columns = 0;  ///< column planes likewise
  bool near = false;     ///< not wholly behind
  std::uint32_t z = 0;   ///< depth code: no point of it is less deep
};

/// A line is crossed if a vertex meets its plane or the vertices are not all on one side.
[[nodiscard]] constexpr CrossedLines crossed_lines(const std::array<FixedTest, 3>& vertices) noexcept {
  const auto& [a, b, c] = vertices;
  return {
      a.rows_meet | b.rows_meet | c.rows_meet | (a.rows_above ^ b.rows_above) | (b.rows_above ^ c.rows_above),
      a.columns_meet | b.columns_meet | c.columns_meet | (a.columns_above ^ b.columns_above) |
          (b.columns_above ^ c.columns_above),
      a.near || b.near || c.near, std::min({a.z, b.z, c.z})};
}

/// No hit bounds the ray: more than any depth_lower().
inline constexpr std::uint32_t kNoBound = (1U << kDepthBits) - 1;

/// What a hit with quotient code `q` leaves of its ray: objects at this depth code or beyond are hidden.
/// `more`: of certified hits, depth codes beyond that.
[[nodiscard]] constexpr std::uint32_t bound_of(std::uint32_t q, int more = 0) noexcept {
  return std::min(q + static_cast<std::uint32_t>(kQuotientError + more), kNoBound);
}

/// The bounds of 16 rays, or of 16 rows: only objects with a smaller depth code matter.
using LineBounds = std::array<std::uint32_t, kMaxRows>;

/// Bounds as the RTL's ports take them: line k at k * kDepthBits.
[[nodiscard]] constexpr PackedWord<kMaxRows * kDepthBits> pack(const LineBounds& bounds) noexcept {
  PackedWord<kMaxRows * kDepthBits> word{};
  for (int k = 0; k < kMaxRows; ++k) {
    insert(word, {k * kDepthBits, kDepthBits}, bounds[static_cast<std::size_t>(k)]);
  }
  return word;
}

/// The lines to whose bound something at depth z matters.
[[nodiscard]] constexpr LineMask lines_beyond(std::uint32_t z, const LineBounds& bounds) noexcept {
  LineMask lines = 0;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    lines |= (z < bounds[k] ? 1U : 0U) << k;
  }
  return lines;
}

/// Sphere Memory in fixed point: a node of the tree.
struct NodeWord {
  FixedVec3 centre{};
  std::uint32_t radius = 0;
  bool leaf = false;
  std::uint32_t count = 0;
  std::uint32_t first = 0;  ///< vertex (leaf) or node

  [[nodiscard]] PackedWord<NodeLayout::kBits> pack() const noexcept {
    PackedWord<NodeLayout::kBits> word{};
    insert(word, NodeLayout::cx, static_cast<std::uint32_t>(centre[0]));
    insert(word, NodeLayout::cy, static_cast<std::uint32_t>(centre[1]));
    insert(word, NodeLayout::cz, static_cast<std::uint32_t>(centre[2]));
    insert(word, NodeLayout::r, radius);
    insert(word, NodeLayout::leaf, leaf ? 1 : 0);
    insert(word, NodeLayout::count, count);
    insert(word, NodeLayout::first, first);
    return word;
  }
};

/// Vertex Memory: a vertex for one of three slots; with `emit` the slots then hold `triangle`.
struct VertexWord {
  FixedVec3 point{};
  std::uint32_t slot = 0;  ///< 0 .. 2
  bool emit = false;
  std::uint32_t triangle = 0;

  [[nodiscard]] PackedWord<VertexLayout::kBits> pack() const noexcept {
    PackedWord<VertexLayout::kBits> word{};
    insert(word, VertexLayout::x, static_cast<std::uint32_t>(point[0]));
    insert(word, VertexLayout::y, static_cast<std::uint32_t>(point[1]));
    insert(word, VertexLayout::z, static_cast<std::uint32_t>(point[2]));
    insert(word, VertexLayout::slot, slot);
    insert(word, VertexLayout::emit, emit ? 1 : 0);
    insert(word, VertexLayout::triangle, triangle);
    return word;
  }
};

/// LimitsWord::least of a pencil without scan lines: no vertex has that depth.
inline constexpr std::uint32_t kNoGrid = (1U << kGridExponentBits) - 1;

/// The register beside the pencil word.
struct LimitsWord {
  std::uint32_t band = 0;         ///< bits of a number: certified hits' error of u', v' and d - u' - v', or 0
  bool any_hit = false;           ///< a ray's first hit ends it
  std::uint32_t slack = 0;        ///< in units of 2^-kCoordinateFraction
  std::uint32_t far = 0;          ///< only hits with a smaller depth code count
  std::uint32_t scale = 0;        ///< the grid of scan lines: how its planes are scaled, see kGridScaleBias
  std::uint32_t least = kNoGrid;  ///< exponent of the least depth code at which vertices have a place on it
  std::uint32_t error = 0;        ///< log2 of its places' error in eighths of a line

  [[nodiscard]] PackedWord<LimitsLayout::kBits> pack() const noexcept {
    PackedWord<LimitsLayout::kBits> word{};
    insert(word, LimitsLayout::band, band);
    insert(word, LimitsLayout::any_hit, any_hit ? 1 : 0);
    insert(word, LimitsLayout::scale, scale);
    insert(word, LimitsLayout::least, least);
    insert(word, LimitsLayout::error, error);
    insert(word, LimitsLayout::slack, slack);
    insert(word, LimitsLayout::far, far);
    return word;
  }
};

}  // namespace raplas
