// What the tests of the fixed-point encoding share: random vectors, a scene of one leaf, vertices by
// triangle.
#pragma once

#include <array>
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
