// What the tests of the fixed-point encoding share: random vectors, a scene of one leaf, vertices by
// triangle, the most that slack and vertex_error can be.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "random.hpp"
#include "raplas/encode_fixed.hpp"

namespace raplas {

inline constexpr double kUnit = 0x1p-17;

/// Random numbers and vectors.
class Source {
 public:
  explicit Source(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  std::uint32_t below(std::uint32_t limit) { return random_.below(limit); }
  glm::dvec3 in_cube() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  glm::dvec3 on_sphere() {
    for (;;) {
      const glm::dvec3 v = in_cube();
      const double length = glm::length(v);
      if (length > 0.1 && length <= 1) {
        return v / length;
      }
    }
  }

 private:
  Xoshiro random_;
};

/// The vertex words of each triangle's pieces, as the slots hold them.
inline std::vector<std::vector<std::array<FixedVec3, 3>>> slots_of(const FixedScene& scene,
                                                                   std::size_t triangles) {
  std::vector<std::vector<std::array<FixedVec3, 3>>> result(triangles);
  std::array<FixedVec3, 3> slots{};
  for (const VertexWord& word : scene.memory.vertices) {
    slots.at(word.slot) = word.point;
    if (word.emit) {
      result.at(word.triangle).push_back(slots);
    }
  }
  return result;
}

/// A unit vector across v.
inline glm::dvec3 any_across(const glm::dvec3& v) {
  return glm::normalize(glm::cross(v, std::abs(v.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
}

// The claim of docs/fixed_encoding.md on how large slack and vertex_error are, in units.
inline const double kHalfDiagonal = std::sqrt(3.0) / 2;  // a vector's rounding to the lattice
inline constexpr double kSpare = 0x1p-10;

inline double most_slack(const Pencil& pencil, double vertex_error) {
  return std::ceil((kHalfDiagonal + 1) * (1 + glm::length(pencil.origin)) + vertex_error / kUnit + kSpare);
}

inline double most_vertex_error(const std::vector<Triangle>& triangles) {
  double corner = 0;
  double edge = 0;
  for (const Triangle& t : triangles) {
    corner = std::max(corner, glm::length(t.v0));
    edge = std::max({edge, glm::length(t.e1), glm::length(t.e2)});
  }
  return kHalfDiagonal + corner + edge + kSpare;
}

/// A scene of one leaf.
inline DeviceScene one_leaf(const std::vector<Triangle>& triangles) {
  DeviceScene scene;
  scene.triangles = triangles;
  scene.nodes.push_back({glm::dvec3(0), 1, true, 0, static_cast<std::uint32_t>(triangles.size())});
  scene.root_count = 1;
  return scene;
}

/// What a call throws; empty if it doesn't.
inline std::string complaint(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace raplas
