// What to render: the JSON scene description, or one made around a bare mesh.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "raplas/mesh.hpp"

namespace raplas {

/// A pinhole camera; `fov_degrees` is the whole vertical angle, 1 .. 170.
struct Camera {
  glm::dvec3 eye{0};
  glm::dvec3 look_at{0};
  glm::dvec3 up{0, 1, 0};
  double fov_degrees = 40;
};

/// A rectangle that shines to the side of edge_u x edge_v with a radiance (linear RGB) equal in all
/// directions.
struct AreaLight {
  glm::dvec3 corner{0};
  glm::dvec3 edge_u{0};
  glm::dvec3 edge_v{0};
  glm::dvec3 intensity{0};
};

/// A mesh file and its place: scaled, turned about x, then y, then z, moved.
struct MeshPlacement {
  std::filesystem::path file;
  double scale = 1;
  glm::dvec3 rotate_degrees{0};
  glm::dvec3 translate{0};
  std::optional<glm::dvec3> colour;  ///< instead of the file's own
  int subdivisions = 4;              ///< of each patch of a .bpt file
};

struct SceneDescription {
  Camera camera;
  AreaLight light;
  glm::dvec3 background{0};
  glm::dvec3 ambient{0.08};  ///< light from everywhere, in units of a white surface's radiance
  std::vector<MeshPlacement> meshes;
};

/// Reads a scene file. Throws std::runtime_error, one line naming the file, the key and what is wrong with
/// it: unknown or missing keys, wrong types, numbers that aren't finite or are out of range. Mesh paths are
/// relative to the scene file's folder.
[[nodiscard]] SceneDescription load_scene_file(const std::filesystem::path& file);

/// Reads a mesh file of any kind: load_mesh(), or the patches of a .bpt file.
[[nodiscard]] Mesh load_any_mesh(const std::filesystem::path& file, int subdivisions);

/// A view of a bare mesh from the front, to the right and above, with y up, that shows all of it; an area
/// light above it, and `floor`, a square under it.
struct AutoScene {
  Camera camera;
  AreaLight light;
  glm::dvec3 background;
  Mesh floor;
};

/// Throws std::runtime_error if the mesh has no extent.
[[nodiscard]] AutoScene frame_mesh(const Mesh& mesh);

}  // namespace raplas
