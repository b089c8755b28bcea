// The points that a sphere around a triangle has to hold.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "raplas/device.hpp"
#include "raplas/float.hpp"

namespace raplas {

/// The vector as the devices store it, each coordinate the nearest fp24.
[[nodiscard]] inline glm::dvec3 as_stored(const glm::dvec3& v) {
  return {Fp24::from_double(v.x).to_double(), Fp24::from_double(v.y).to_double(),
          Fp24::from_double(v.z).to_double()};
}

/// What a sphere around a triangle encloses: its vertices, and those of the triangle that the devices store
/// (V0, E1, E2 rounded), which is the one they hit.
struct TrianglePoints {
  std::array<glm::dvec3, 3> vertices;
  std::array<glm::dvec3, 3> stored;
};

[[nodiscard]] inline TrianglePoints points_of(const Triangle& t) {
  const glm::dvec3 v0 = as_stored(t.v0);
  return {{t.v0, t.v0 + t.e1, t.v0 + t.e2}, {v0, v0 + as_stored(t.e1), v0 + as_stored(t.e2)}};
}

}  // namespace raplas
