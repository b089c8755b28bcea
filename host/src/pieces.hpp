// Large triangles in pieces.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "raplas/sphere_tree.hpp"

namespace raplas {

/// At most so many pieces are added: the larger of kMinPieces and triangles / kPieceShare.
inline constexpr std::size_t kMinPieces = 256;
inline constexpr std::size_t kPieceShare = 16;

/// Halves the piece with the longest edge, at the middle of this edge, until no edge is longer than
/// TreeOptions::longest_edge or no more pieces may be added. Returns the pieces in the order of the
/// triangles; none if no triangle is cut.
[[nodiscard]] std::vector<Piece> cut_large(std::span<const Triangle> triangles, const TreeOptions& options);

}  // namespace raplas
