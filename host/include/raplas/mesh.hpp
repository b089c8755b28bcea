// Triangle meshes: reading files, smooth normals.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

namespace raplas {

/// Indexed triangles with a diffuse colour each, in the file's own coordinates.
struct Mesh {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
  std::vector<std::uint32_t> colour_of;                 ///< by triangle: index of colours
  std::vector<glm::dvec3> colours;                      ///< linear RGB, 0 .. 1
};

/// Reads an OBJ, PLY, STL, glTF or GLB file by assimp; polygons become triangles, the nodes' transforms are
/// applied. Throws std::runtime_error, one line naming the file and the cause: missing, not a mesh, a vertex
/// that is NaN or infinite, a face index out of range, no triangles.
[[nodiscard]] Mesh load_mesh(const std::filesystem::path& file);

/// Three unit normals a triangle: the area-weighted mean of the faces around a corner whose normals are
/// within `crease_degrees` of this face's. Corners at the same position are one corner. Triangles of no area
/// get the zero vector.
[[nodiscard]] std::vector<std::array<glm::dvec3, 3>> smooth_normals(const Mesh& mesh, double crease_degrees);

}  // namespace raplas
