// The smallest ball around points.
#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace raplas {

struct Ball {
  glm::dvec3 centre{0};
  double radius = -1;  ///< negative: holds nothing
};

/// The smallest ball around any number of points, to rounding. Up to 4 points are kept on the surface; each
/// step adds the point farthest outside and takes the smallest ball around these 5 at most, so that the
/// radius grows until nothing is outside. About ten passes over the points. Source: B. Gaertner 1999
/// (pivoting). The radius is the largest computed distance; see enclosing_radius() for a proven one.
[[nodiscard]] Ball bounding_ball(std::span<const glm::dvec3> points);

/// A radius around `centre` that encloses every point in exact arithmetic: the largest computed distance
/// (each at most 4 roundings of 2^-53 off) times 1 + 2^-48, plus 2^-500 against underflow of the squares.
[[nodiscard]] double enclosing_radius(std::span<const glm::dvec3> points, const glm::dvec3& centre);

}  // namespace raplas
