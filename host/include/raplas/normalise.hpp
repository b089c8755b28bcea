// Into the coordinates of the devices: what load_scene() does with points and triangles.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "raplas/device.hpp"

namespace raplas {

/// Maps x to (x - centre) * scale.
struct Placement {
  glm::dvec3 centre{0};
  double scale = 1;

  [[nodiscard]] glm::dvec3 point(const glm::dvec3& p) const { return (p - centre) * scale; }
  [[nodiscard]] Triangle triangle(const Triangle& t) const {
    return {point(t.v0), t.e1 * scale, t.e2 * scale};
  }
};

/// Maps all points into the ball of radius 1 - 2^-6 around zero. Throws std::runtime_error if they have no
/// extent, or none that is finite.
[[nodiscard]] Placement place_in_ball(std::span<const glm::dvec3> points);

/// N is zero?
[[nodiscard]] bool has_no_area(const Triangle& triangle);

/// No area, or a normal that is zero as the devices compute and store it? Such triangles are dropped.
[[nodiscard]] bool is_degenerate(const Triangle& triangle);

}  // namespace raplas
