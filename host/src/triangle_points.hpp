// The points that a sphere around a piece of a triangle has to hold.
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

/// A piece's corner on its triangle.
[[nodiscard]] inline glm::dvec3 point_at(const Triangle& t, const Piece::Corner& corner) {
  constexpr double kStep = 1.0 / kPieceUnit;
  return t.v0 + ((corner.a * kStep) * t.e1 + (corner.b * kStep) * t.e2);
}

/// What a sphere around a piece encloses: its corners, and those on the triangle that the devices store
/// (V0, E1, E2 rounded), which is the one they hit.
struct PiecePoints {
  std::array<glm::dvec3, 3> vertices;
  std::array<glm::dvec3, 3> stored;
};

[[nodiscard]] inline PiecePoints points_of(const Triangle& t, const Piece& piece) {
  const Triangle stored{as_stored(t.v0), as_stored(t.e1), as_stored(t.e2)};
  PiecePoints points;
  for (std::size_t k = 0; k < 3; ++k) {
    points.vertices[k] = point_at(t, piece.corners[k]);
    points.stored[k] = point_at(stored, piece.corners[k]);
  }
  return points;
}

}  // namespace raplas
