// The distance of a plane and a point, as exactly as long double gives it.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <utility>

#include "raplas/pencil.hpp"

namespace raplas {

/// |n.c + p| and the sum of its terms' magnitudes, each to 2^-61 of that sum.
inline std::pair<long double, long double> exact_distance(const Plane& plane, const glm::dvec3& c) {
  long double sum = plane.offset;
  long double magnitudes = std::abs(plane.offset);
  for (int k = 0; k < 3; ++k) {
    const long double term = static_cast<long double>(plane.normal[k]) * c[k];
    sum += term;
    magnitudes += std::abs(term);
  }
  return {std::abs(sum), magnitudes};
}

}  // namespace raplas
