// Halves long triangles at the middle of their longest edges.
#include "pieces.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <queue>

#include "triangle_points.hpp"

namespace raplas {
namespace {

/// A piece that may be cut, across the edge from corner `edge` to the next.
struct Candidate {
  double length = 0;  ///< of the longest edge
  std::size_t piece = 0;
  std::size_t edge = 0;

  friend bool operator<(const Candidate& a, const Candidate& b) {
    return a.length < b.length || (a.length == b.length && a.piece > b.piece);
  }
};

Candidate candidate(const Triangle& t, const Piece& piece, std::size_t index) {
  Candidate found{0, index, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const double length =
        glm::distance(point_at(t, piece.corners[k]), point_at(t, piece.corners[(k + 1) % 3]));
    if (length > found.length) {
      found.length = length;
      found.edge = k;
    }
  }
  return found;
}

/// Does the middle have coordinates in whole units?
bool divides(const Piece::Corner& a, const Piece::Corner& b) {
  return (a.a + b.a) % 2 == 0 && (a.b + b.b) % 2 == 0;
}

}  // namespace

std::vector<Piece> cut_large(std::span<const Triangle> triangles, const TreeOptions& options) {
  std::vector<Piece> pieces;
  std::priority_queue<Candidate> waiting;
  const auto consider = [&](const Piece& piece, std::size_t index) {
    const Candidate c = candidate(triangles[piece.triangle], piece, index);
    if (c.length > options.longest_edge && divides(piece.corners[c.edge], piece.corners[(c.edge + 1) % 3])) {
      waiting.push(c);
    }
  };
  pieces.reserve(triangles.size());
  for (std::uint32_t k = 0; k < triangles.size(); ++k) {
    pieces.push_back({k});
    consider(pieces.back(), k);
  }
  const auto extra = static_cast<std::size_t>(options.extra_pieces * static_cast<double>(triangles.size()));
  if (waiting.empty() || extra == 0) {
    return {};
  }
  const std::size_t most = triangles.size() + extra;
  while (!waiting.empty() && pieces.size() < most) {
    const Candidate c = waiting.top();
    waiting.pop();
    const std::size_t next = (c.edge + 1) % 3;
    Piece& first = pieces[c.piece];
    Piece second = first;
    const Piece::Corner& p = first.corners[c.edge];
    const Piece::Corner& q = first.corners[next];
    const Piece::Corner middle{static_cast<std::uint16_t>((p.a + q.a) / 2),
                               static_cast<std::uint16_t>((p.b + q.b) / 2)};
    first.corners[next] = middle;
    second.corners[c.edge] = middle;
    consider(first, c.piece);
    consider(second, pieces.size());
    pieces.push_back(second);
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.triangle < b.triangle; });
  return pieces;
}

}  // namespace raplas
