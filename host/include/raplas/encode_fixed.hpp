// From the host's doubles to the words of profile raplas: plane tests in fixed point, rays and triangles in
// fp24. What is promised is stated and proved in docs/fixed_encoding.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "raplas/device.hpp"
#include "raplas/fixed_trace.hpp"

namespace raplas {

/// A pencil's slack is at most this, in units of 2^-kCoordinateFraction; a node's radius leaves room for it.
inline constexpr std::uint32_t kMaxSlack = 255;

/// No corner of a piece of a triangle as stored lies farther than this from its vertex word.
inline constexpr double kMaxVertexError = 0x1p-16;

/// A scene's memories.
struct FixedScene {
  FixedSceneMemory<Fp24> memory;
  double vertex_error = 0;  ///< largest distance of a piece's corner as stored from its vertex word; with
                            ///< certified hits: of its corner as it is
  std::vector<std::uint32_t> uncertain;  ///< with certified hits: triangles that they don't hold for
};

/// A pencil's bank.
struct FixedPencil {
  FixedPencilMemory<Fp24> memory;
  std::array<double, kMaxRays> t_scale{};  ///< Hit::t_scale of each ray
};

/// The words of a scene that check_tree() passes. Vertices are those of the pieces as stored, to nearest;
/// corners that were one point before rounding are one vertex. Leaves become strips (strip.hpp) in the order
/// of the tree, radii enclose the vertex words below exactly. Throws std::runtime_error with one line, naming
/// the node where it is one, if a vertex lies outside the unit ball, a centre outside the format, a radius
/// has no room for kMaxSlack, or a leaf or the scene takes too many words.
/// `certify`: triangles are scaled so that one error band fits them all, and their vertices rotated
/// (docs/exact.md).
[[nodiscard]] FixedScene encode_fixed(const DeviceScene& scene, bool certify = false);

/// The words of a pencil for scenes whose vertex_error is at most `vertex_error`. Rays are scaled to axis.D =
/// 1 before they are rounded. Every ray that hits a triangle, both as stored, before `far` and in exact
/// arithmetic, has a row and a column that the tests find crossed by a piece of it; `near` holds for one of
/// the piece's vertices and its z is at most the depth code of t. Throws std::invalid_argument for a pencil
/// without axis or a ray that doesn't go along it, std::range_error for an origin far outside the unit ball.
/// `certify`, of a pencil and scene that it holds for: the ray and the triangle as they are, not as stored;
/// and a triangle that they hit before `far` is a hit of solve() with the band. Throws std::invalid_argument
/// if can_certify() is false.
[[nodiscard]] FixedPencil encode_fixed(const Pencil& pencil, double vertex_error = kMaxVertexError,
                                       bool certify = false);

/// Whether hits of the pencil can be certified: its origin is in the unit ball, and no ray is longer than 64
/// times its depth.
[[nodiscard]] bool can_certify(const Pencil& pencil);

/// A result as the renderer takes it; `ray` as in FixedPencilMemory::rays.
[[nodiscard]] Hit decode_fixed(const ResultWord<Fp24>& word, const FixedPencil& pencil, std::size_t ray);

}  // namespace raplas
