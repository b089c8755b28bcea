// Closed meshes, random triangles and pencils: what the cases of the stress catalogue are made of.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <span>
#include <vector>

#include "raplas/device.hpp"

namespace raplas {

/// Random numbers, the same on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(random_() % limit); }
  glm::dvec3 in_cube();
  glm::dvec3 on_sphere();
  glm::dvec3 in_ball(double radius);

 private:
  std::mt19937_64 random_;
};

/// Triangles as triples of points, each seen from outside counter-clockwise.
struct ClosedMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

/// Is each edge that of two faces, which go along it in opposite directions?
[[nodiscard]] bool is_closed(const ClosedMesh& mesh);

/// 6 times the volume, above 0 if faces are counter-clockwise seen from outside.
[[nodiscard]] double volume_6(const ClosedMesh& mesh);

/// All vertices are multiples of 2^-20, so that edges, and their ends v0 + e1, are exact in double precision:
/// what is closed stays so in exact arithmetic.
[[nodiscard]] std::vector<Triangle> triangles_of(const ClosedMesh& mesh);

/// Around zero; no vertex is farther than `radius` (to 2^-20).
[[nodiscard]] ClosedMesh tetrahedron(double radius);
[[nodiscard]] ClosedMesh cube(double radius);
/// 20 * 4^subdivisions faces.
[[nodiscard]] ClosedMesh icosphere(double radius, int subdivisions);
/// Fans at both poles, quadrilaterals cut in two between.
[[nodiscard]] ClosedMesh uv_sphere(double radius, int rings, int sectors);
/// A tube of half of the ring's radius around it, z through the hole.
[[nodiscard]] ClosedMesh torus(double radius, int rings, int sectors);

/// Unit vectors across v and each other, turned by a random angle.
[[nodiscard]] std::array<glm::dvec3, 2> any_across(const glm::dvec3& v, Dice& dice);

/// A point of the triangle.
[[nodiscard]] glm::dvec3 point_in(const Triangle& triangle, Dice& dice);

/// `count` triangles with corners at most `size` from a point in the ball of radius 1 - size.
[[nodiscard]] std::vector<Triangle> random_triangles(std::size_t count, double size, Dice& dice);

/// Rays from `origin` around `target`, which the middle of the grid is near: the grid's points are
/// 2 tan(angle / 2) / 15 of the distance apart, turned at random.
[[nodiscard]] Pencil pencil_towards(const glm::dvec3& origin, const glm::dvec3& target, double angle,
                                    int rows, int columns, Dice& dice);

/// 256 rays through points of the triangle's plane that are eighths of its edges apart: row 0 goes along e1,
/// column 0 along e2, row + column = 8 along the third edge, and three rays through the corners.
[[nodiscard]] Pencil aligned_pencil(const glm::dvec3& origin, const Triangle& triangle);

}  // namespace raplas
