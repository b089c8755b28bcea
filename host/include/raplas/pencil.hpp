// Pencils: rays from one origin through the points of a rectangular grid, with their planes.
#pragma once

#include <glm/vec3.hpp>

#include "raplas/device.hpp"
#include "raplas/scene_file.hpp"

namespace raplas {

/// Points first + r * row_step + c * column_step, 0 <= r < rows, 0 <= c < columns (each 1 .. 16).
struct Grid {
  glm::dvec3 first;
  glm::dvec3 row_step;
  glm::dvec3 column_step;
  int rows;
  int columns;
};

/// The pencil through a grid. Row plane r goes through the origin and the grid line of row r (its direction
/// is column_step), column plane c through that of column c; normals have unit length. Each ray lies in its
/// two planes. Throws std::invalid_argument for a size out of range, an origin on one of the grid lines or in
/// the grid's plane, and a grid without area.
[[nodiscard]] Pencil make_pencil(const glm::dvec3& origin, const Grid& grid);

/// Makes the pencils of a camera's image.
class CameraFrame {
 public:
  /// Image of width x height square pixels (each 1 .. 16384).
  CameraFrame(const Camera& camera, int width, int height);

  /// Rays through the centres of the pixels x .. x + columns - 1, y .. y + rows - 1; pixel (0, 0) is top
  /// left.
  [[nodiscard]] Pencil pencil(int x, int y, int columns, int rows) const;

 private:
  glm::dvec3 eye_;
  glm::dvec3 first_;  ///< centre of pixel (0, 0)
  glm::dvec3 right_;  ///< one pixel
  glm::dvec3 down_;   ///< one pixel
};

/// The grid of size x size points (1 .. 16) in the centres of equal cells of the light, moved by (shift_u,
/// shift_v) in units of a cell, each within -0.5 .. 0.5. Row r is at edge_v's (r + 0.5 + shift_v) / size.
[[nodiscard]] Grid light_grid(const AreaLight& light, int size, double shift_u, double shift_v);

}  // namespace raplas
