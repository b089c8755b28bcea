// A scene in the coordinates of the devices: everything within the ball of radius 1 around zero.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "raplas/device.hpp"
#include "raplas/scene_file.hpp"

namespace raplas {

/// What shading needs of a triangle.
struct Surface {
  std::array<glm::dvec3, 3> normals;  ///< unit length, at V0, V0 + E1, V0 + E2
  glm::dvec3 colour;                  ///< diffuse reflectance, linear RGB
};

struct Scene {
  Camera camera;
  AreaLight light;
  glm::dvec3 background{0};
  glm::dvec3 ambient{0};
  std::vector<Triangle> triangles;
  std::vector<Surface> surfaces;       ///< by triangle
  std::size_t degenerate_dropped = 0;  ///< triangles without area, or whose normal is zero as fp24
  double longest_edge = 0;             ///< of all triangles
  double max_origin = 0;               ///< bound of all pencils' origins, see pencil.hpp
};

/// Reads a .json scene file or a bare mesh file and normalises it: one uniform scale and a translation put
/// every vertex, the eye and the light's corners into the ball of radius 1 - 2^-6 around zero. Throws
/// std::runtime_error, one line naming the file and the cause.
[[nodiscard]] Scene load_scene(const std::filesystem::path& file);

/// How far off a surface rays have to start so as not to hit it again, in units of normalised scenes:
/// 2^-16 max(2.5 + |O| / 2, 3 |O| + 9 L), of an origin at a distance of |O| from zero and a scene whose
/// longest edge is L. Derivation: docs/host.md.
[[nodiscard]] double surface_offset(double origin_length, double longest_edge);

}  // namespace raplas
