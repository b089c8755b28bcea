// Large triangles in pieces.
#pragma once

#include <span>
#include <vector>

#include "raplas/sphere_tree.hpp"

namespace raplas {

/// Halves the piece with the longest edge, at the middle of this edge, until no edge is longer than
/// TreeOptions::longest_edge or TreeOptions::extra_pieces are added. Returns the pieces in the order of the
/// triangles; none if no triangle is cut.
[[nodiscard]] std::vector<Piece> cut_large(std::span<const Triangle> triangles, const TreeOptions& options);

}  // namespace raplas
