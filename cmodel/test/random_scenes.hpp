// Random scenes and pencils in the memories' own words.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "raplas/intersection_unit.hpp"

namespace raplas {

/// Scenes of small triangles in the unit cube, and pencils that look into it.
template <typename F>
class Scenes {
 public:
  explicit Scenes(std::uint32_t seed) : random_(seed) {}

  /// A tree of `depth` levels of inner nodes, up to 4 children each, over random triangles; depth 0: a flat
  /// list.
  /// Spheres and triangles start at address `first`.
  SceneMemory<F> scene(int depth, std::uint32_t root_nodes, std::uint32_t first = 0) {
    SceneMemory<F> memory;
    memory.spheres.resize(first + root_nodes);
    memory.triangles.resize(first);
    std::size_t begin = first;
    for (int level = 0; level <= depth; ++level) {
      const std::size_t end = memory.spheres.size();
      for (std::size_t k = begin; k < end; ++k) {
        const double radius = level == depth ? 0.15 : 0.5;
        SphereWord<F> node{point(), F::from_double(radius * real(0.3, 1)),
                           level == depth || random_() % 5 == 0, 0, 0};
        node.count = node.leaf && random_() % 32 == 0 ? 127 : 1 + static_cast<std::uint32_t>(random_() % 4);
        if (node.leaf) {
          node.first = static_cast<std::uint32_t>(memory.triangles.size());
          for (std::uint32_t t = 0; t < node.count; ++t) {
            memory.triangles.push_back(triangle(node.centre));
          }
        } else {
          node.first = static_cast<std::uint32_t>(memory.spheres.size());
          memory.spheres.resize(memory.spheres.size() + node.count);
        }
        memory.spheres[k] = node;
      }
      begin = end;
    }
    memory.scene = {static_cast<std::uint32_t>(memory.spheres.size()), root_nodes, first};
    return memory;
  }

  PencilMemory<F> pencil(std::uint32_t rows, std::uint32_t columns) {
    PencilMemory<F> memory;
    const double ox = real(-0.2, 0.2);
    const double oy = real(-0.2, 0.2);
    const double oz = -2;
    const double width = real(0.02, 0.8);
    memory.pencil = {rows, columns, {F::from_double(ox), F::from_double(oy), F::from_double(oz)}};
    const auto at = [width](std::uint32_t k, std::uint32_t count) {
      return width * ((k + 0.5) / count - 0.5);
    };
    for (std::uint32_t r = 0; r < rows; ++r) {  // the plane y = at(r) * z through O
      const double length = std::hypot(1, at(r, rows));
      memory.rows[r] = {{F(), F::from_double(1 / length), F::from_double(-at(r, rows) / length)},
                        F::from_double((-oy + at(r, rows) * oz) / length)};
      for (std::uint32_t c = 0; c < columns; ++c) {
        const double x = at(c, columns);
        const double y = at(r, rows);
        const double norm = std::sqrt(x * x + y * y + 1);
        memory.rays[r * kMaxColumns + c] = {F::from_double(x / norm), F::from_double(y / norm),
                                            F::from_double(1 / norm)};
      }
    }
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double length = std::hypot(1, at(c, columns));
      memory.columns[c] = {{F::from_double(1 / length), F(), F::from_double(-at(c, columns) / length)},
                           F::from_double((-ox + at(c, columns) * oz) / length)};
    }
    return memory;
  }

  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(random_() % limit); }

 private:
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3<F> point() { return vector(-0.5, 0.5); }
  Vec3<F> vector(double low, double high) {
    return {F::from_double(real(low, high)), F::from_double(real(low, high)),
            F::from_double(real(low, high))};
  }
  TriangleWord<F> triangle(const Vec3<F>& centre) {
    TriangleWord<F> t{centre - vector(-0.1, 0.1), vector(-0.2, 0.2), vector(-0.2, 0.2), {}};
    t.n = cross(t.e1, t.e2);
    return t;
  }

  std::mt19937 random_;
};

}  // namespace raplas
