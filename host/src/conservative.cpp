#include "raplas/conservative.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace raplas {

double conservative_radius(const glm::dvec3& stored_centre, double radius, double max_origin) {
  constexpr double kU = 1.0 / 65536;  // one truncation to 17 significant bits
  constexpr double kG4 = 4 * kU / (1 - 4 * kU);
  const double distance = glm::length(stored_centre);
  const double norm1 = std::abs(stored_centre.x) + std::abs(stored_centre.y) + std::abs(stored_centre.z);
  const double offset = std::min(max_origin, radius + distance);
  return radius + kG4 * (distance + offset) + (8 + norm1) * std::ldexp(1.0, -62);
}

}  // namespace raplas
