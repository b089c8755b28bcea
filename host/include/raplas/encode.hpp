// From the host's doubles to the accelerator's memory words; the only place where numbers are converted.
#pragma once

#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "raplas/conservative.hpp"
#include "raplas/device.hpp"
#include "raplas/intersection_unit.hpp"

namespace raplas {

/// A vector rounded to nearest; throws std::range_error naming `what` for a number outside the format.
template <typename F>
[[nodiscard]] Vec3<F> encode(const glm::dvec3& v, const char* what) {
  return {F::from_double(v.x, what), F::from_double(v.y, what), F::from_double(v.z, what)};
}

/// A vector of the accelerator's numbers, exactly.
template <typename F>
[[nodiscard]] glm::dvec3 decode(const Vec3<F>& v) {
  return {v.x.to_double(), v.y.to_double(), v.z.to_double()};
}

/// A word of the Triangle Memory: vertex and edges rounded to nearest, N = E1 x E2 made of the rounded edges.
template <typename F>
[[nodiscard]] TriangleWord<F> encode(const Triangle& t) {
  TriangleWord<F> word{
      encode<F>(t.v0, "vertex coordinate"), encode<F>(t.e1, "edge"), encode<F>(t.e2, "edge"), {}};
  word.n = encode<F>(glm::cross(decode(word.e1), decode(word.e2)), "normal");
  return word;
}

/// The words of the Sphere and Triangle memories. Radii are enlarged by the error bound of the plane-sphere
/// test and rounded up. Throws std::runtime_error if the memories are too small, or for pieces: leaves hold
/// whole triangles here.
template <typename F>
[[nodiscard]] SceneMemory<F> encode(const DeviceScene& scene, const DeviceOptions& options) {
  const auto check = [](const char* what, std::size_t size, std::size_t depth) {
    if (size > depth) {
      throw std::runtime_error(std::to_string(size) + what + std::to_string(depth));
    }
  };
  if (!scene.pieces.empty()) {
    throw std::runtime_error("profile paper holds whole triangles, not pieces");
  }
  check(" triangles, the Triangle Memory holds ", scene.triangles.size(), options.triangle_depth);
  check(" spheres, the Sphere Memory holds ", scene.nodes.size(), options.sphere_depth);
  SceneMemory<F> memory;
  memory.triangles.reserve(scene.triangles.size());
  for (const Triangle& t : scene.triangles) {
    memory.triangles.push_back(encode<F>(t));
  }
  memory.spheres.reserve(scene.nodes.size());
  for (const SphereNode& node : scene.nodes) {
    const Vec3<F> centre = encode<F>(node.centre, "sphere centre");
    const double radius = conservative_radius(decode(centre), node.radius, scene.max_origin);
    memory.spheres.push_back(
        {centre, F::from_double_up(radius, "sphere radius"), node.leaf, node.count, node.first});
  }
  memory.scene = {static_cast<std::uint32_t>(scene.nodes.size()), scene.root_count, scene.root_first};
  return memory;
}

/// The words of one bank of the Plane and Ray memories, and the pencil register.
template <typename F>
[[nodiscard]] PencilMemory<F> encode(const Pencil& pencil) {
  PencilMemory<F> memory;
  memory.pencil = {static_cast<std::uint32_t>(pencil.rows), static_cast<std::uint32_t>(pencil.columns),
                   encode<F>(pencil.origin, "pencil origin")};
  const auto plane = [](const Plane& p) {
    return PlaneWord<F>{encode<F>(p.normal, "plane normal"), F::from_double(p.offset, "plane offset")};
  };
  for (std::size_t r = 0; r < static_cast<std::size_t>(pencil.rows); ++r) {
    memory.rows[r] = plane(pencil.row_planes[r]);
    for (std::size_t c = 0; c < static_cast<std::size_t>(pencil.columns); ++c) {
      memory.rays[r * kMaxColumns + c] =
          encode<F>(pencil.directions[r * static_cast<std::size_t>(pencil.columns) + c], "ray direction");
    }
  }
  for (std::size_t c = 0; c < static_cast<std::size_t>(pencil.columns); ++c) {
    memory.columns[c] = plane(pencil.column_planes[c]);
  }
  return memory;
}

/// A word of the Result Memory as the renderer takes it.
template <typename F>
[[nodiscard]] Hit decode(const ResultWord<F>& word) {
  if (!word.hit) {
    return {};
  }
  return {
      true, word.triangle, word.t.to_double(), word.d.to_double(), word.u.to_double(), word.v.to_double()};
}

}  // namespace raplas
