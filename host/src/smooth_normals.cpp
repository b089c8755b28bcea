// Normals for shading, from the faces around each corner.
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <unordered_map>

#include "raplas/mesh.hpp"

namespace raplas {
namespace {

struct Hash {
  std::size_t operator()(const glm::dvec3& p) const noexcept {
    std::size_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      hash = hash * 0x9e3779b97f4a7c15U + std::hash<double>{}(p[k]);
    }
    return hash;
  }
};

}  // namespace

std::vector<std::array<glm::dvec3, 3>> smooth_normals(const Mesh& mesh, double crease_degrees) {
  std::vector<glm::dvec3> face_normals;  // length: twice the area
  std::unordered_map<glm::dvec3, std::vector<std::uint32_t>, Hash> faces_at;
  face_normals.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3& origin = mesh.vertices[a];
    const auto face = static_cast<std::uint32_t>(face_normals.size());
    face_normals.push_back(glm::cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin));
    for (const std::uint32_t corner : {a, b, c}) {
      faces_at[mesh.vertices[corner]].push_back(face);
    }
  }
  const double crease = std::cos(glm::radians(crease_degrees));
  std::vector<std::array<glm::dvec3, 3>> normals(mesh.triangles.size());
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    const glm::dvec3& own = face_normals[face];
    for (std::size_t k = 0; k < 3; ++k) {
      glm::dvec3 sum(0);
      for (const std::uint32_t other : faces_at[mesh.vertices[mesh.triangles[face][k]]]) {
        const glm::dvec3& n = face_normals[other];
        // Neighbours of opposite winding count as the same surface.
        const double cosine = glm::dot(own, n);
        if (std::abs(cosine) >= crease * glm::length(own) * glm::length(n)) {
          sum += cosine < 0 ? -n : n;
        }
      }
      const double length = glm::length(sum);
      normals[face][k] = length > 0 ? sum / length : glm::dvec3(0);
    }
  }
  return normals;
}

}  // namespace raplas
