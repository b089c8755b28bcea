// Where a scene is put, and which triangles are left out.
#include "raplas/normalise.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "raplas/bounding_sphere.hpp"
#include "triangle_points.hpp"

namespace raplas {

Placement place_in_ball(std::span<const glm::dvec3> points) {
  const Ball ball = bounding_ball(points);
  if (!(ball.radius > 0) || !std::isfinite(ball.radius)) {
    throw std::runtime_error("the scene has no extent, or none that is finite");
  }
  return {ball.centre, (1 - 1.0 / 64) / ball.radius};
}

bool has_no_area(const Triangle& triangle) { return glm::cross(triangle.e1, triangle.e2) == glm::dvec3(0); }

bool is_degenerate(const Triangle& triangle) {
  return has_no_area(triangle) ||
         as_stored(glm::cross(as_stored(triangle.e1), as_stored(triangle.e2))) == glm::dvec3(0);
}

}  // namespace raplas
