// Pencils from grids of points.
#include "raplas/pencil.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <stdexcept>

namespace raplas {
namespace {

/// The plane through the origin and the line through `point` along `direction`.
Plane plane_through(const glm::dvec3& origin, const glm::dvec3& point, const glm::dvec3& direction) {
  const glm::dvec3 normal = glm::cross(direction, point - origin);
  const double length = glm::length(normal);
  if (!(length > 0)) {
    throw std::invalid_argument("the pencil's origin lies on a grid line");
  }
  const glm::dvec3 unit = normal / length;
  return {unit, -glm::dot(unit, origin)};
}

/// The unit normal of the grid's plane that points away from the origin.
glm::dvec3 axis_towards(const Grid& grid, const glm::dvec3& origin) {
  const glm::dvec3 normal = glm::cross(grid.row_step, grid.column_step);
  const double towards = glm::dot(normal, grid.first - origin);
  if (!(std::abs(towards) > 0)) {
    throw std::invalid_argument("the pencil's origin lies in the grid's plane");
  }
  return (towards > 0 ? normal : -normal) / glm::length(normal);
}

}  // namespace

Pencil make_pencil(const glm::dvec3& origin, const Grid& grid) {
  if (grid.rows < 1 || grid.rows > kMaxRows || grid.columns < 1 || grid.columns > kMaxColumns) {
    throw std::invalid_argument("a pencil has 1 to 16 rows and columns");
  }
  Pencil pencil;
  pencil.origin = origin;
  pencil.rows = grid.rows;
  pencil.columns = grid.columns;
  for (int r = 0; r < grid.rows; ++r) {
    pencil.row_planes.push_back(
        plane_through(origin, grid.first + double(r) * grid.row_step, grid.column_step));
  }
  for (int c = 0; c < grid.columns; ++c) {
    pencil.column_planes.push_back(
        plane_through(origin, grid.first + double(c) * grid.column_step, grid.row_step));
  }
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c) {
      const glm::dvec3 point = grid.first + double(r) * grid.row_step + double(c) * grid.column_step;
      pencil.directions.push_back(glm::normalize(point - origin));
    }
  }
  pencil.axis = axis_towards(grid, origin);
  return pencil;
}

CameraFrame::CameraFrame(const Camera& camera, int width, int height) : eye_(camera.eye) {
  const glm::dvec3 forward = glm::normalize(camera.look_at - camera.eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const double pixel = 2 * std::tan(glm::radians(camera.fov_degrees) / 2) / height;
  right_ = right * pixel;
  down_ = up * -pixel;
  first_ = eye_ + forward - right_ * ((width - 1) / 2.0) - down_ * ((height - 1) / 2.0);
}

Pencil CameraFrame::pencil(int x, int y, int columns, int rows) const {
  return make_pencil(eye_, {first_ + double(x) * right_ + double(y) * down_, down_, right_, rows, columns});
}

Grid light_grid(const AreaLight& light, int size, double shift_u, double shift_v) {
  const glm::dvec3 step_u = light.edge_u / double(size);
  const glm::dvec3 step_v = light.edge_v / double(size);
  return {light.corner + (0.5 + shift_u) * step_u + (0.5 + shift_v) * step_v, step_v, step_u, size, size};
}

}  // namespace raplas
