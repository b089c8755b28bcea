// Where a ray hit, and how much light arrives there.
#pragma once

#include <glm/vec3.hpp>

#include "raplas/device.hpp"
#include "raplas/scene.hpp"

namespace raplas {

struct SurfacePoint {
  glm::dvec3 position;
  glm::dvec3 facing;  ///< the triangle's unit normal, towards the viewer
  glm::dvec3 normal;  ///< smoothed, on the same side
  glm::dvec3 colour;
  double offset;  ///< how far off the surface its shadow pencil starts
};

/// The hit point from its barycentric coordinates u'/d and v'/d, which keeps it in the triangle's plane.
/// `longest_edge` is the scene's.
[[nodiscard]] SurfacePoint surface_point(const Triangle& triangle, const Surface& surface, const Hit& hit,
                                         const glm::dvec3& direction, double longest_edge);

/// Where the surface's shadow pencil starts.
[[nodiscard]] glm::dvec3 shadow_origin(const SurfacePoint& point);

/// Unit normal of the light's shining side.
[[nodiscard]] glm::dvec3 light_normal(const AreaLight& light);

/// Does the light's front see the point, farther off its plane than twice the point's offset, and may the
/// surface face some of the light? Points that don't need no shadow pencil.
[[nodiscard]] bool may_be_lit(const SurfacePoint& point, const AreaLight& light);

/// The share of the light's radiance that a sample of `area` at `to` from the point adds to the irradiance:
/// cos(surface) cos(light) area / distance^2; 0 where either faces away.
[[nodiscard]] double form_factor(const SurfacePoint& point, const glm::dvec3& to,
                                 const glm::dvec3& light_normal, double area);

/// Does a camera ray see the light's front before it has gone `limit`?
[[nodiscard]] bool sees_light(const AreaLight& light, const glm::dvec3& origin, const glm::dvec3& direction,
                              double limit);

}  // namespace raplas
