// Camera, light and floor for a mesh that comes without a scene file.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <stdexcept>

#include "raplas/scene_file.hpp"

namespace raplas {
namespace {

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

Box bounds(const Mesh& mesh) {
  Box box;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      box.low = glm::min(box.low, mesh.vertices[index]);
      box.high = glm::max(box.high, mesh.vertices[index]);
    }
  }
  return box;
}

/// The smallest distance from `centre`, against `forward`, from which a square view shows every vertex.
double fitting_distance(const Mesh& mesh, const glm::dvec3& centre, const glm::dvec3& forward,
                        double fov_degrees) {
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
  const glm::dvec3 up = glm::cross(right, forward);
  const double tangent = std::tan(glm::radians(fov_degrees) / 2);
  double distance = 0;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      const glm::dvec3 p = mesh.vertices[index] - centre;
      const double aside = std::max(std::abs(glm::dot(p, right)), std::abs(glm::dot(p, up)));
      distance = std::max(distance, aside / tangent - glm::dot(p, forward));
    }
  }
  return distance;
}

Mesh square_floor(const glm::dvec3& centre, double half) {
  Mesh floor;
  const glm::dvec3 x(half, 0, 0);
  const glm::dvec3 z(0, 0, half);
  floor.vertices = {centre - x - z, centre - x + z, centre + x + z, centre + x - z};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  floor.colour_of = {0, 0};
  floor.colours = {glm::dvec3(0.55, 0.55, 0.56)};
  return floor;
}

}  // namespace

AutoScene frame_mesh(const Mesh& mesh) {
  const Box box = bounds(mesh);
  const glm::dvec3 centre = (box.low + box.high) * 0.5;
  const double radius = glm::distance(box.low, box.high) / 2;
  if (!(radius > 0)) {
    throw std::runtime_error("all vertices are at one point");
  }
  AutoScene scene;
  const glm::dvec3 forward = -glm::normalize(glm::dvec3(0.25, 0.35, 1.0));
  scene.camera.fov_degrees = 30;
  scene.camera.look_at = centre;
  scene.camera.eye =
      centre - forward * (1.12 * fitting_distance(mesh, centre, forward, scene.camera.fov_degrees));
  // Above, to the left and in front of the mesh, shining at its centre.
  const glm::dvec3 middle = centre + radius * glm::dvec3(-1.3, 2.6, 1.4);
  const glm::dvec3 towards = glm::normalize(centre - middle);
  const glm::dvec3 edge_u = glm::normalize(glm::cross(towards, glm::dvec3(0, 0, 1))) * (1.2 * radius);
  const glm::dvec3 edge_v = glm::normalize(glm::cross(towards, edge_u)) * (1.2 * radius);
  scene.light = {middle - edge_u * 0.5 - edge_v * 0.5, edge_u, edge_v, glm::dvec3(19.0, 18.4, 17.4)};
  scene.background = glm::dvec3(0.18, 0.2, 0.24);
  scene.floor = square_floor({centre.x, box.low.y, centre.z}, 3.2 * radius);
  return scene;
}

}  // namespace raplas
