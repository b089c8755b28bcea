// Bicubic Bezier patches in the .bpt text format.
#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "raplas/mesh.hpp"

namespace raplas {

/// 4 x 4 control points, point (i, j) at 4 * i + j.
using BezierPatch = std::array<glm::dvec3, 16>;

/// Reads a .bpt file: the number of patches, then for each its degrees "3 3" and 16 points "x y z".
/// Throws std::runtime_error, one line naming the file and the cause.
[[nodiscard]] std::vector<BezierPatch> load_patches(const std::filesystem::path& file);

/// The point of a patch at (u, v) in 0 .. 1: sum over i, j of B_i(u) B_j(v) P_ij, B the Bernstein
/// polynomials.
[[nodiscard]] glm::dvec3 evaluate(const BezierPatch& patch, double u, double v);

/// Triangles of subdivisions x subdivisions (1 .. 64) squares a patch. Points of two patches that differ by
/// less than 1e-9 of the patches' size become one, and triangles that lose an edge by it (at poles) are left
/// out.
[[nodiscard]] Mesh tessellate(const std::vector<BezierPatch>& patches, int subdivisions);

}  // namespace raplas
