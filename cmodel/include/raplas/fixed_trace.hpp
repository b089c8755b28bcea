// What profile raplas finds, without clocks: the definition of a hit, and a walk in which every skip can be
// switched off. The clocked unit, the RTL and this walk must give the same hits, whatever is skipped.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raplas/fixed_point.hpp"
#include "raplas/ray_triangle.hpp"
#include "raplas/scan_lines.hpp"

namespace raplas {

/// Sphere, Vertex and Triangle memories and the scene register.
template <typename F>
struct FixedSceneMemory {
  std::vector<NodeWord> nodes;
  std::vector<VertexWord> vertices;
  std::vector<TriangleWord<F>> triangles;
  SceneWord scene;
};

/// One bank of the Plane and Ray memories and its registers. Rays have a depth of 1 along the pencil's axis.
template <typename F>
struct FixedPencilMemory {
  PencilWord<F> pencil;
  LimitsWord limits;
  FixedPlanes planes;
  std::array<Vec3<F>, kMaxRays> rays;  ///< ray (r, c) at r * kMaxColumns + c
};

/// Whether a solved pair of a piece at depth code `z` counts, and what it is to its ray.
template <typename F>
struct CountedHit {
  bool valid = false;
  FoundHit<F> hit;
};

template <typename F>
[[nodiscard]] constexpr CountedHit<F> counted_hit(const Solution<F>& s, std::uint32_t triangle,
                                                  std::uint32_t z, const LimitsWord& limits) noexcept {
  const bool certify = !F::from_bits(limits.band).is_zero();
  const std::uint32_t q = depth_quotient(s.t, s.d);
  const bool valid = s.hit && (s.unsure || ((certify || z <= q) && q < limits.far));
  const bool ends = certify && limits.any_hit;  // whichever hits come first will do
  const bool unsure = s.unsure || ends;
  const int more = !certify ? 0 : s.rough ? kRoughBoundMargin : kBoundMargin;
  const std::uint32_t bound = unsure ? limits.far : limits.any_hit ? 0 : bound_of(q, more);
  return {valid, {{true, triangle, s.t, s.d, s.u, s.v}, bound, certify, s.rough, unsure, ends}};
}

/// What can be skipped. None of it changes a hit.
struct Skips {
  bool tree = true;           ///< off: the spheres of all leaves are tested, no inner node
  bool inherited = true;      ///< off: a child is tested in all rows and columns
  bool behind = true;         ///< near plane: objects wholly behind the origin
  bool hidden = true;         ///< depth: objects beyond the hits that their rays have, or beyond `far`
  bool nearest_first = true;  ///< off: children in the order of the memory
  bool rectangles = true;     ///< off: a triangle goes to all rays that its leaf's sphere meets
  bool scan_lines = true;     ///< off: a triangle goes to all rays of its rectangle
  bool ended = true;          ///< off: rays of an any-hit pencil go on after their first hit
};

/// Counts of one pencil.
struct FixedCounts {
  std::uint64_t spheres = 0;
  std::uint64_t vertices = 0;
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;    ///< rays that hit
  std::uint64_t strays = 0;  ///< pairs that Moeller's test took, outside of the piece's lines or depth
};

/// The walk of one pencil, done by the constructor. Three vertices with a word that emits are a piece of the
/// word's triangle: all of it, or a part of a large one. A ray hits the triangle if for one of its pieces the
/// ray's lines cross it, one of its vertices is near and z <= q < far. What rows, columns and z are those of
/// belongs to the piece; t, d, u and v are the triangle's, whichever piece the ray was tested for.
template <typename F>
class FixedTrace {
 public:
  using Results = std::array<RayHits<F>, kMaxRays>;

  FixedTrace(const FixedSceneMemory<F>& scene, const FixedPencilMemory<F>& pencil, const Skips& skips = {})
      : scene_(scene), pencil_(pencil), limits_(pencil.limits), skips_(skips) {
    limits_.any_hit = limits_.any_hit && skips.ended;
    rows_ = first_lines(pencil.pencil.rows);
    columns_ = first_lines(pencil.pencil.columns);
    bounds_.fill(pencil.limits.far);
    if (skips.tree) {
      stack_.push_back({false, scene.scene.first, scene.scene.count, rows_, columns_, 0});
    } else {
      for (const NodeWord& node : scene.nodes) {
        if (node.leaf) {
          push_if_met(node, rows_, columns_);
        }
      }
    }
    walk();
    for (const RayHits<F>& result : results_) {
      counts_.hits += result.nearest.hit ? 1 : 0;
    }
  }

  /// The nearest hit of each ray; of an any-hit pencil only the hit bits don't depend on what is skipped.
  /// Certified hits hold what the proof in docs/exact.md needs; which of them they are depends on what is
  /// skipped.
  [[nodiscard]] const Results& results() const noexcept { return results_; }
  [[nodiscard]] const FixedCounts& counts() const noexcept { return counts_; }

 private:
  struct Range {
    bool leaf;
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t rows;
    std::uint32_t columns;
    std::uint32_t z;
  };

  void walk() {
    while (!stack_.empty()) {
      Range range = stack_.back();
      stack_.pop_back();
      range.rows &= rows_in_front(range.z);
      if (range.rows == 0) {
        continue;
      }
      if (range.leaf) {
        read_triangles(range);
        continue;
      }
      const std::size_t siblings = stack_.size();
      const auto inherited = [&](std::uint32_t mask, std::uint32_t all) {
        return skips_.inherited ? mask : all;
      };
      for (std::uint32_t k = 0; k < range.count; ++k) {
        push_if_met(scene_.nodes[range.first + k], inherited(range.rows, rows_),
                    inherited(range.columns, columns_));
      }
      const auto first = stack_.begin() + static_cast<std::ptrdiff_t>(siblings);
      if (skips_.nearest_first) {
        std::stable_sort(first, stack_.end(), [](const Range& a, const Range& b) { return a.z > b.z; });
      } else {
        std::reverse(first, stack_.end());
      }
    }
  }

  void push_if_met(const NodeWord& node, std::uint32_t rows, std::uint32_t columns) {
    const FixedTest test = test_object(pencil_.planes, node.centre, node.radius, pencil_.limits.slack);
    ++counts_.spheres;
    rows &= test.rows_meet;
    columns &= test.columns_meet;
    if (rows != 0 && columns != 0 && (test.near || !skips_.behind)) {
      stack_.push_back({node.leaf, node.first, node.count, rows, columns, test.z});
    }
  }

  void read_triangles(const Range& leaf) {
    std::array<FixedTest, 3> slots;
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.count; ++k) {
      const VertexWord& vertex = scene_.vertices[k];
      slots[vertex.slot] = test_object(pencil_.planes, vertex.point, 0, pencil_.limits.slack);
      counts_.vertices += skips_.rectangles || skips_.scan_lines ? 1 : 0;
      if (vertex.emit) {
        test_pairs(leaf, crossed_lines(slots), reached_columns(slots, pencil_.limits), vertex.triangle);
      }
    }
  }

  void test_pairs(const Range& leaf, const CrossedLines& lines, const ReachedColumns& reached,
                  std::uint32_t triangle) {
    if (skips_.rectangles && skips_.behind && !lines.near) {
      return;
    }
    for (std::uint32_t ray = 0; ray < kMaxRays; ++ray) {
      const std::uint32_t row = ray / kMaxColumns;
      const std::uint32_t column = ray % kMaxColumns;
      const auto in = [row, column](std::uint32_t rows, std::uint32_t columns) {
        return (rows >> row & columns >> column & 1U) != 0;
      };
      const bool crossed = in(lines.rows, lines.columns);
      const bool inside = crossed && (reached[row] >> column & 1U) != 0;
      if (!in(leaf.rows, leaf.columns) || (skips_.rectangles && !crossed) || (skips_.scan_lines && !inside) ||
          !in_front(ray, lines.z)) {
        continue;
      }
      ++counts_.pairs;
      const Solution<F> s = solve(scene_.triangles[triangle], pencil_.pencil.origin, pencil_.rays[ray],
                                  F::from_bits(pencil_.limits.band));
      if (!s.hit) {
        continue;
      }
      const CountedHit<F> counted = counted_hit(s, triangle, lines.z, limits_);
      if (!inside || !lines.near || !counted.valid) {
        ++counts_.strays;
        continue;
      }
      const KeptHit<F> kept = keep_hit(counted.hit, results_[ray]);
      if (kept.write) {
        results_[ray] = kept.word;
      }
      if (kept.write && kept.bounds) {
        bounds_[ray] = kept.bound;
      }
    }
  }

  [[nodiscard]] bool in_front(std::uint32_t ray, std::uint32_t z) const noexcept {
    const std::uint32_t bound = bounds_[ray];
    return skips_.hidden ? z < bound : bound != 0;
  }

  /// Rows with a ray for which depth z matters.
  [[nodiscard]] std::uint32_t rows_in_front(std::uint32_t z) const noexcept {
    std::uint32_t rows = 0;
    for (std::uint32_t ray = 0; ray < kMaxRays; ++ray) {
      if ((columns_ >> (ray % kMaxColumns) & 1U) != 0 && in_front(ray, z)) {
        rows |= 1U << (ray / kMaxColumns);
      }
    }
    return rows & rows_;
  }

  const FixedSceneMemory<F>& scene_;
  const FixedPencilMemory<F>& pencil_;
  LimitsWord limits_;  ///< the pencil's, any_hit only if that ends rays
  Skips skips_;
  std::uint32_t rows_ = 0;     ///< of the pencil
  std::uint32_t columns_ = 0;  ///< of the pencil
  std::vector<Range> stack_;
  std::array<std::uint32_t, kMaxRays> bounds_{};
  Results results_{};
  FixedCounts counts_;
};

}  // namespace raplas
