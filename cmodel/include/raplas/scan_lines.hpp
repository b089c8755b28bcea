// Which rays of a row a triangle can reach, value-exact: entities vertex_grid, edge_setup and row_interval.
// Vertices are projected onto the pencil's grid of lines, and each row is cut by the triangle's edges:
// docs/scan_lines.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "raplas/fixed_point.hpp"

namespace raplas {

/// A line's number is taken from the middle: line k is at k - kGridOrigin.
inline constexpr int kGridOrigin = kMaxRows / 2;

/// limits.scale of planes down and across that give the number of a line at a depth of 1; if they give 2^-k
/// of it, it is k more.
inline constexpr int kGridScaleBias = 2;

/// Where a vertex lies on the pencil's grid, in units of 2^-kGridFraction lines.
struct GridPoint {
  bool known = false;  ///< else the others don't count
  std::int32_t across = 0;
  std::int32_t down = 0;

  friend constexpr bool operator==(const GridPoint&, const GridPoint&) noexcept = default;
};

[[nodiscard]] constexpr bool fits(std::int64_t value, int bits) noexcept {
  return value >= -(std::int64_t{1} << (bits - 1)) && value < std::int64_t{1} << (bits - 1);
}

/// 2^kReciprocalBits / (1 + (index + 1/2) / 2^kDepthFractionBits), to the nearest integer.
[[nodiscard]] constexpr std::int64_t reciprocal(std::uint32_t index) noexcept {
  constexpr std::int64_t kOne = std::int64_t{2} << kDepthFractionBits;
  const std::int64_t divisor = kOne + 2 * std::int64_t{index} + 1;
  return ((kOne << (kReciprocalBits + 1)) / divisor + 1) / 2;
}

/// Entity vertex_grid: sums of a vertex over the planes `across` and `down`, divided by its depth.
/// `depth` is its depth code before kDepthMargin is taken off.
[[nodiscard]] constexpr GridPoint project(std::int64_t across, std::int64_t down, std::uint32_t depth,
                                          const LimitsWord& limits) noexcept {
  constexpr int kMaxShift = 15;
  constexpr int kLeastShift = 8;
  constexpr int kDropped = 19;
  const std::uint32_t exponent = depth >> kDepthFractionBits;
  const int shift = static_cast<int>(exponent) - static_cast<int>(limits.scale);
  if (exponent < limits.least || shift < 0 || shift > kMaxShift) {
    return {};
  }
  const std::int64_t a = across >> (kLeastShift + shift);
  const std::int64_t d = down >> (kLeastShift + shift);
  if (!fits(a, kCoordinateBits) || !fits(d, kCoordinateBits)) {
    return {};
  }
  const std::int64_t r = reciprocal(depth & ((1U << kDepthFractionBits) - 1));
  return {true, static_cast<std::int32_t>(a * r >> kDropped), static_cast<std::int32_t>(d * r >> kDropped)};
}

/// The line through an edge: which rows the edge may reach, and where it cuts them.
struct EdgeCut {
  bool open = false;        ///< too flat: it may cut its rows anywhere, and the last three don't count
  std::int32_t first = 0;   ///< the rows, from the middle: -8 .. 8
  std::int32_t last = -9;   ///< -9 .. 7
  std::int32_t at = 0;      ///< the column where it cuts the middle line, units of 2^-kCutFraction
  std::int32_t slope = 0;   ///< columns a row, units of 2^-kSlopeFraction
  std::int32_t margin = 0;  ///< what the cut may be off, units of 2^-kCutFraction

  friend constexpr bool operator==(const EdgeCut&, const EdgeCut&) noexcept = default;
};

/// Entity edge_setup: the edge between two known points. `error`: of limits.
[[nodiscard]] constexpr EdgeCut edge_cut(GridPoint a, GridPoint b, std::uint32_t error) noexcept {
  if (b.down < a.down) {
    std::swap(a, b);
  }
  // bits of an error: larger for points far from the middle
  constexpr int kNearBits = 11;
  constexpr int kMiddleBits = 13;
  const auto within = [&](int bits) {
    return fits(a.across, bits) && fits(a.down, bits) && fits(b.across, bits) && fits(b.down, bits);
  };
  const int error_log2 = 2 + static_cast<int>(error) + (within(kNearBits) ? 0 : within(kMiddleBits) ? 2 : 4);
  const int off = 1 << error_log2;
  constexpr int kLine = 1 << kGridFraction;
  EdgeCut cut;
  cut.first = std::clamp((a.down - off + kLine - 1) >> kGridFraction, -kGridOrigin, kGridOrigin);
  cut.last = std::clamp((b.down + off) >> kGridFraction, -kGridOrigin - 1, kGridOrigin - 1);

  const int across = b.across - a.across;
  const int down = b.down - a.down;
  if (down == 0) {
    cut.open = true;
    return cut;
  }
  const int top = static_cast<int>(std::bit_width(static_cast<unsigned>(down))) - 1;  // 0 .. 15
  const auto normalised = static_cast<std::uint32_t>(down) << (kGridBits - 1 - top);
  const std::uint32_t index =
      normalised >> (kGridBits - 1 - kDepthFractionBits) & ((1U << kDepthFractionBits) - 1);
  const std::int64_t slope = (across * reciprocal(index)) >> (kReciprocalBits - kSlopeFraction + top);
  constexpr int kDropped = kSlopeFraction + kGridFraction - kCutFraction;
  const std::int64_t at = ((std::int64_t{a.across} << kSlopeFraction) - a.down * slope) >> kDropped;
  if (!fits(slope, kSlopeBits) || !fits(at, kCutBits)) {
    cut.open = true;
    return cut;
  }
  cut.slope = static_cast<std::int32_t>(slope);
  cut.at = static_cast<std::int32_t>(at);
  // error (1 + |slope|), and 2 units for what is rounded here and in row_interval
  cut.margin = (((1 << kSlopeFraction) + std::abs(cut.slope)) >> (kDropped - error_log2)) + 2;
  return cut;
}

/// The edges between slots 0 and 1, 1 and 2, 2 and 0.
using EdgeCuts = std::array<EdgeCut, 3>;

[[nodiscard]] constexpr EdgeCuts edge_cuts(const std::array<GridPoint, 3>& points,
                                           std::uint32_t error) noexcept {
  return {edge_cut(points[0], points[1], error), edge_cut(points[1], points[2], error),
          edge_cut(points[2], points[0], error)};
}

/// Entity row_interval: the columns of a row between the outermost cuts of its edges.
[[nodiscard]] constexpr LineMask row_columns(const EdgeCuts& cuts, std::uint32_t row) noexcept {
  constexpr int kNever = 1 << (kCutBits + 2);
  const int line = static_cast<int>(row) - kGridOrigin;
  int low = kNever;
  int high = -kNever;
  for (const EdgeCut& cut : cuts) {
    if (line < cut.first || line > cut.last) {
      continue;
    }
    const int at = cut.at + (line * cut.slope >> (kSlopeFraction - kCutFraction));
    low = std::min(low, cut.open ? -kNever : at - cut.margin);
    high = std::max(high, cut.open ? kNever : at + cut.margin);
  }
  constexpr int kColumn = 1 << kCutFraction;
  const int first = std::clamp((low + kColumn - 1) >> kCutFraction, -kGridOrigin, kGridOrigin) + kGridOrigin;
  const int end = std::clamp((high >> kCutFraction) + 1, -kGridOrigin, kGridOrigin) + kGridOrigin;
  return first_lines(static_cast<std::uint32_t>(end)) & ~first_lines(static_cast<std::uint32_t>(first));
}

/// By row: the columns that a triangle can reach.
using ReachedColumns = std::array<LineMask, kMaxRows>;

/// Of a triangle as the testers leave its vertices; all columns if one has no place on the grid.
[[nodiscard]] constexpr ReachedColumns reached_columns(const std::array<FixedTest, 3>& vertices,
                                                       const LimitsWord& limits) noexcept {
  ReachedColumns reached{};
  reached.fill(first_lines(kMaxColumns));
  std::array<GridPoint, 3> points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k] = project(vertices[k].across, vertices[k].down, vertices[k].depth, limits);
    if (!points[k].known) {
      return reached;
    }
  }
  const EdgeCuts cuts = edge_cuts(points, limits.error);
  for (std::uint32_t row = 0; row < kMaxRows; ++row) {
    reached[row] = row_columns(cuts, row);
  }
  return reached;
}

}  // namespace raplas
