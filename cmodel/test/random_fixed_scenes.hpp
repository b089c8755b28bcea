// Random scenes and pencils in the words of profile raplas.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "raplas/fixed_trace.hpp"

namespace raplas {

/// Addresses of a scene's first node, vertex and triangle.
struct FixedPlaces {
  std::uint32_t nodes = 0;
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
};

/// A scene that starts at addresses 0, moved to these; below them there is nothing.
template <typename F>
FixedSceneMemory<F> moved(const FixedSceneMemory<F>& scene, const FixedPlaces& to) {
  FixedSceneMemory<F> result;
  result.scene = scene.scene;
  result.scene.first += to.nodes;
  result.nodes.resize(to.nodes);
  result.vertices.resize(to.vertices);
  result.triangles.resize(to.triangles);
  for (NodeWord node : scene.nodes) {
    node.first += node.leaf ? to.vertices : to.nodes;
    result.nodes.push_back(node);
  }
  for (VertexWord vertex : scene.vertices) {
    vertex.triangle += vertex.emit ? to.triangles : 0;
    result.vertices.push_back(vertex);
  }
  result.triangles.insert(result.triangles.end(), scene.triangles.begin(), scene.triangles.end());
  return result;
}

/// Trees over small and large triangles, and pencils that look into them or start in their midst.
template <typename F>
class FixedScenes {
 public:
  explicit FixedScenes(std::uint32_t seed) : random_(seed), bands_(seed) {}

  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(random_() % limit); }

  /// A tree over about `triangles` triangles: leaves of 1 .. 4, nodes of 1 .. `width` children. Nodes,
  /// vertices and triangles start at address `first`.
  FixedSceneMemory<F> scene(std::uint32_t triangles, std::uint32_t width = 4, std::uint32_t first = 0) {
    FixedSceneMemory<F> memory;
    memory.nodes.resize(first);
    memory.vertices.resize(first);
    memory.triangles.resize(first);
    std::vector<Subtree> level;
    while (memory.triangles.size() < first + triangles) {
      level.push_back(leaf(memory));
    }
    // neighbours in space become siblings
    std::sort(level.begin(), level.end(),
              [](const Subtree& a, const Subtree& b) { return a.node.centre < b.node.centre; });
    while (level.size() > width) {
      std::vector<Subtree> above;
      for (std::size_t begin = 0; begin < level.size();) {
        const std::size_t count = std::min<std::size_t>(1 + below(width), level.size() - begin);
        above.push_back(parent(memory, level, begin, count));
        begin += count;
      }
      level = std::move(above);
    }
    const auto root = static_cast<std::uint32_t>(memory.nodes.size());
    for (const Subtree& subtree : level) {
      memory.nodes.push_back(subtree.node);
    }
    memory.scene = {static_cast<std::uint32_t>(memory.nodes.size()) - first,
                    static_cast<std::uint32_t>(level.size()), root};
    return memory;
  }

  /// Rays through a grid; its planes are rounded, its slack is anything, as the hits' definition takes them
  /// as they are.
  FixedPencilMemory<F> pencil(std::uint32_t rows, std::uint32_t columns) {
    FixedPencilMemory<F> memory;
    const double width = below(4) == 0 ? real(0.5, 3) : real(0.01, 0.5);
    const std::array<double, 3> o{real(-0.3, 0.3), real(-0.3, 0.3), below(4) == 0 ? real(-0.3, 0.3) : -0.9};
    const double sign = below(2) == 0 ? 1 : -1;  // looks along +z or -z
    const auto at = [width](std::uint32_t k, std::uint32_t count) {
      return width * ((k + 0.5) / count - 0.5);
    };
    memory.pencil = {rows, columns, {number(o[0]), number(o[1]), number(sign * o[2])}};
    const auto plane = [&](double nx, double ny, double nz) {
      const double length = std::sqrt(nx * nx + ny * ny + nz * nz) * (1 + 0x1p-16);
      FixedPlane p{{fixed(nx / length), fixed(ny / length), fixed(nz / length)}, 0};
      p.offset = -plane_sum({p.normal, 0}, {fixed(o[0]), fixed(o[1]), fixed(sign * o[2])});
      return p;
    };
    for (std::uint32_t r = 0; r < kMaxRows; ++r) {  // unused ones are anything
      memory.planes.rows[r] = plane(0, 1, -sign * (r < rows ? at(r, rows) : real(-1, 1)));
      for (std::uint32_t c = 0; c < kMaxColumns; ++c) {
        memory.rays[r * kMaxColumns + c] = {number(at(c, columns)), number(at(r, rows)), number(sign)};
      }
    }
    for (std::uint32_t c = 0; c < kMaxColumns; ++c) {
      memory.planes.columns[c] = plane(1, 0, -sign * (c < columns ? at(c, columns) : real(-1, 1)));
    }
    memory.planes.near = plane(0, 0, sign);
    memory.planes.depth = memory.planes.near;
    // lines at +-width / 2 of a depth of 1, seen from their middle
    const auto grid_plane = [&](std::size_t axis, std::uint32_t count) {
      const double lines = count / width;
      FixedPlane p;
      p.normal[axis] = fixed(std::ldexp(lines, -kGridScale));
      p.normal[2] = fixed(std::ldexp(sign * (0.5 * (count - 1.0) - kGridOrigin), -kGridScale));
      p.offset = -plane_sum({p.normal, 0}, {fixed(o[0]), fixed(o[1]), fixed(sign * o[2])});
      return p;
    };
    memory.planes.across = grid_plane(0, columns);
    memory.planes.down = grid_plane(1, rows);
    memory.limits.scale = below(8) == 0 ? below(kNoGrid + 1) : kGridScale + 2;
    memory.limits.least = below(4) == 0 ? below(kNoGrid + 1) : 14;
    memory.limits.error = below(1U << kGridErrorBits);
    memory.limits.slack = below(4) == 0 ? below(300) : below(6);
    memory.limits.any_hit = below(3) == 0;
    memory.limits.far =
        below(3) != 0 ? kNoBound : depth_code(static_cast<std::int64_t>(real(0.1, 1.5) * 0x1p34));
    return memory;
  }

  /// One that looks along +z from below, takes the nearest hits, and whose rays all meet a small square
  /// around the middle.
  FixedPencilMemory<F> ahead(std::uint32_t rows, std::uint32_t columns) {
    for (;;) {
      const FixedPencilMemory<F> memory = pencil(rows, columns);
      const auto small = [](F x) { return std::abs(x.to_double()) < 0.15; };
      const Vec3<F>& ray = memory.rays[0];
      if (memory.pencil.origin.z.to_double() < -0.8 && ray.z.to_double() > 0 && small(ray.x) &&
          small(ray.y) && memory.limits.far == kNoBound && !memory.limits.any_hit) {
        return memory;
      }
    }
  }

  /// Gives one of `share` pencils a band: its hits are certified.
  FixedPencilMemory<F> certified(FixedPencilMemory<F> pencil, std::uint32_t share = 1) {
    const auto band = std::exp2(std::uniform_real_distribution<double>(-14, -8)(bands_));
    pencil.limits.band = bands_() % share == 0 ? number(band).bits() : 0;
    return pencil;
  }

  static TriangleWord<F> triangle(const std::array<FixedVec3, 3>& corners) {
    const auto vector = [](const FixedVec3& a, const FixedVec3& b) {
      return Vec3<F>{number((a[0] - b[0]) * 0x1p-17), number((a[1] - b[1]) * 0x1p-17),
                     number((a[2] - b[2]) * 0x1p-17)};
    };
    TriangleWord<F> t{
        vector(corners[0], {}), vector(corners[1], corners[0]), vector(corners[2], corners[0]), {}};
    t.n = cross(t.e1, t.e2);
    return t;
  }

 private:
  /// More than the most lines of a grid in a unit, as a power of two.
  static constexpr int kGridScale = 11;

  struct Subtree {
    NodeWord node;
    std::vector<FixedVec3> points;
  };

  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  static F number(double x) { return F::from_double(x); }
  static std::int32_t fixed(double x) { return static_cast<std::int32_t>(std::lround(x * 0x1p17)); }

  static NodeWord enclosing(const std::vector<FixedVec3>& points) {
    NodeWord node;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax_element(
          points.begin(), points.end(), [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
      node.centre[axis] = ((*low)[axis] + (*high)[axis]) / 2;
    }
    std::int64_t most = 0;
    for (const FixedVec3& p : points) {
      std::int64_t square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t d = p[axis] - node.centre[axis];
        square += d * d;
      }
      most = std::max(most, square);
    }
    node.radius = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(most)));
    while (std::int64_t{node.radius} * node.radius < most) {
      ++node.radius;
    }
    return node;
  }

  /// A fan around a corner: each triangle shares an edge with the one before.
  Subtree leaf(FixedSceneMemory<F>& memory) {
    Subtree result;
    const double size = below(16) == 0 ? 0.6 : real(0.01, 0.15);
    const std::array<double, 3> middle{real(-0.4, 0.4), real(-0.4, 0.4), real(-0.4, 0.4)};
    const auto corner = [&] {
      FixedVec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] = fixed(std::clamp(middle[axis] + real(-size, size), -0.99, 0.99));
      }
      return p;
    };
    const std::uint32_t count = 1 + below(4);
    result.node.first = static_cast<std::uint32_t>(memory.vertices.size());
    std::array<FixedVec3, 3> slots{};
    for (std::uint32_t k = 0; k < count + 2; ++k) {
      const std::uint32_t slot = k < 3 ? k : below(3);
      slots[slot] = corner();
      result.points.push_back(slots[slot]);
      const bool emit = k >= 2;
      memory.vertices.push_back(
          {slots[slot], slot, emit, emit ? static_cast<std::uint32_t>(memory.triangles.size()) : 0});
      if (emit) {
        memory.triangles.push_back(triangle(slots));
      }
    }
    result.node = enclosing(result.points);
    result.node.leaf = true;
    result.node.first = static_cast<std::uint32_t>(memory.vertices.size()) - count - 2;
    result.node.count = count + 2;
    return result;
  }

  Subtree parent(FixedSceneMemory<F>& memory, const std::vector<Subtree>& level, std::size_t begin,
                 std::size_t count) {
    Subtree result;
    const auto first = static_cast<std::uint32_t>(memory.nodes.size());
    for (std::size_t k = begin; k < begin + count; ++k) {
      memory.nodes.push_back(level[k].node);
      result.points.insert(result.points.end(), level[k].points.begin(), level[k].points.end());
    }
    result.node = enclosing(result.points);
    result.node.first = first;
    result.node.count = static_cast<std::uint32_t>(count);
    return result;
  }

  std::mt19937 random_;
  std::mt19937 bands_;  // apart, so that the other numbers are the same with and without them
};

}  // namespace raplas
