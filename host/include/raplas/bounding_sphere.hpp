// Small balls around points.
#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace raplas {

struct Ball {
  glm::dvec3 centre{0};
  double radius = -1;  ///< negative: holds nothing
};

/// A ball around the points: the smallest one (to rounding) for up to 16 points, otherwise within a few per
/// cent of it. Sources: E. Welzl 1991 with move-to-front; J. Ritter 1990, then steps after M. Badoiu and K.
/// Clarkson 2003. The radius is the largest computed distance; see enclosing_radius() for a proven one.
[[nodiscard]] Ball bounding_ball(std::span<const glm::dvec3> points);

/// A radius around `centre` that encloses every point in exact arithmetic: the largest computed distance
/// (each at most 4 roundings of 2^-53 off) times 1 + 2^-48, plus 2^-500 against underflow of the squares.
[[nodiscard]] double enclosing_radius(std::span<const glm::dvec3> points, const glm::dvec3& centre);

}  // namespace raplas
