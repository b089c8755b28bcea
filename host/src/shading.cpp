#include "shading.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace raplas {

SurfacePoint surface_point(const Triangle& triangle, const Surface& surface, const Hit& hit,
                           const glm::dvec3& direction, double longest_edge) {
  const double u = hit.u_scaled / hit.d;
  const double v = hit.v_scaled / hit.d;
  SurfacePoint point{};
  point.position = triangle.v0 + u * triangle.e1 + v * triangle.e2;
  point.facing = glm::normalize(glm::cross(triangle.e1, triangle.e2));
  if (glm::dot(point.facing, direction) > 0) {
    point.facing = -point.facing;
  }
  const glm::dvec3 blend = (1 - u - v) * surface.normals[0] + u * surface.normals[1] + v * surface.normals[2];
  const double length = glm::length(blend);
  point.normal = length > 0 ? blend / length : point.facing;
  if (glm::dot(point.normal, point.facing) < 0) {
    point.normal = -point.normal;
  }
  point.colour = surface.colour;
  point.offset = surface_offset(glm::length(point.position), longest_edge);
  return point;
}

glm::dvec3 shadow_origin(const SurfacePoint& point) { return point.position + point.offset * point.facing; }

glm::dvec3 light_normal(const AreaLight& light) {
  return glm::normalize(glm::cross(light.edge_u, light.edge_v));
}

bool may_be_lit(const SurfacePoint& point, const AreaLight& light) {
  if (glm::dot(light_normal(light), point.position - light.corner) <= 2 * point.offset) {
    return false;
  }
  for (const double u : {0.0, 1.0}) {
    for (const double v : {0.0, 1.0}) {
      if (glm::dot(light.corner + u * light.edge_u + v * light.edge_v - point.position, point.facing) > 0) {
        return true;
      }
    }
  }
  return false;
}

double form_factor(const SurfacePoint& point, const glm::dvec3& to, const glm::dvec3& light_normal,
                   double area) {
  const double at_surface = glm::dot(point.facing, to) > 0 ? std::max(0.0, glm::dot(point.normal, to)) : 0.0;
  const double at_light = std::max(0.0, -glm::dot(light_normal, to));
  const double distance2 = glm::dot(to, to);
  return at_surface * at_light * area / (distance2 * distance2);
}

bool sees_light(const AreaLight& light, const glm::dvec3& origin, const glm::dvec3& direction, double limit) {
  const glm::dvec3 normal = light_normal(light);
  const double towards = -glm::dot(normal, direction);
  if (!(towards > 0)) {
    return false;
  }
  const double t = glm::dot(normal, origin - light.corner) / towards;
  const glm::dvec3 p = origin + t * direction - light.corner;
  const double u = glm::dot(p, light.edge_u) / glm::dot(light.edge_u, light.edge_u);
  const double v = glm::dot(p, light.edge_v) / glm::dot(light.edge_v, light.edge_v);
  return t > 0 && t < limit && u >= 0 && u <= 1 && v >= 0 && v <= 1;
}

}  // namespace raplas
