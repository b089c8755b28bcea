// Verifies a sphere tree.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>

#include "raplas/sphere_tree.hpp"
#include "triangle_points.hpp"

namespace raplas {
namespace {

struct Range {
  std::size_t begin;
  std::size_t end;
};

/// Twice the area of a, b, c in squares of 1 / kPieceUnit, negative if they go round clockwise.
std::int64_t area(const Piece::Corner& a, const Piece::Corner& b, const Piece::Corner& c) {
  return std::int64_t{b.a - a.a} * (c.b - a.b) - std::int64_t{b.b - a.b} * (c.a - a.a);
}

std::int64_t area(const Piece& piece) {
  return std::abs(area(piece.corners[0], piece.corners[1], piece.corners[2]));
}

/// Has `piece` an edge with all of `other` on its outer side?
bool has_beside(const Piece& piece, const Piece& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Piece::Corner& from = piece.corners[k];
    const Piece::Corner& to = piece.corners[(k + 1) % 3];
    const bool left = area(from, to, piece.corners[(k + 2) % 3]) > 0;
    if (std::all_of(other.corners.begin(), other.corners.end(), [&](const Piece::Corner& corner) {
          const std::int64_t side = area(from, to, corner);
          return left ? side <= 0 : side >= 0;
        })) {
      return true;
    }
  }
  return false;
}

/// Are the pieces parts of the triangle, of which no two overlap, and as large as it together?
bool make_whole(std::span<const Piece> pieces) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (const Piece::Corner& corner : pieces[k].corners) {
      if (corner.a + corner.b > kPieceUnit) {
        return false;
      }
    }
    for (std::size_t other = 0; other < k; ++other) {
      if (!has_beside(pieces[k], pieces[other]) && !has_beside(pieces[other], pieces[k])) {
        return false;
      }
    }
    sum += area(pieces[k]);
  }
  return sum == std::int64_t{kPieceUnit} * kPieceUnit;
}

class Checker {
 public:
  explicit Checker(const DeviceScene& scene)
      : scene_(scene), node_seen_(scene.nodes.size()), piece_seen_(scene.piece_count()) {}

  void run() {
    constexpr std::size_t kMaxIds = std::size_t{1} << kIdBits;
    if (scene_.nodes.size() > kMaxIds || scene_.triangles.size() > kMaxIds) {
      throw std::runtime_error(fmt::format("sphere tree: more than {} spheres or triangles", kMaxIds));
    }
    if (scene_.root_count < 1 || scene_.root_first + std::size_t{scene_.root_count} > scene_.nodes.size()) {
      throw std::runtime_error("sphere tree: the root range is empty or outside the list");
    }
    check_pieces();
    points_.reserve(scene_.piece_count());
    for (std::uint32_t k = 0; k < scene_.piece_count(); ++k) {
      const Piece piece = scene_.piece(k);
      points_.push_back(points_of(scene_.triangles[piece.triangle], piece));
    }
    check_children(scene_.root_first, scene_.root_count, 0);
    require_all(node_seen_, "sphere");
    require_all(piece_seen_, "piece");
  }

 private:
  void check_pieces() const {
    std::vector<Piece> pieces = scene_.pieces;
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.triangle < b.triangle; });
    auto first = pieces.begin();
    for (std::size_t t = 0; t < scene_.triangles.size() && !pieces.empty(); ++t) {
      const auto last = std::find_if(first, pieces.end(), [&](const Piece& p) { return p.triangle != t; });
      if (!make_whole({first, last})) {
        throw std::runtime_error(
            fmt::format("sphere tree: the pieces of triangle {} are not what it consists of", t));
      }
      first = last;
    }
    if (first != pieces.end()) {
      throw std::runtime_error(
          fmt::format("sphere tree: a piece of triangle {} of {}", first->triangle, scene_.triangles.size()));
    }
  }

  [[noreturn]] static void fail(std::size_t node, const std::string& what) {
    throw std::runtime_error(fmt::format("sphere tree: node {}: {}", node, what));
  }

  static void require_all(const std::vector<bool>& seen, const char* what) {
    const auto missed = std::find(seen.begin(), seen.end(), false);
    if (missed != seen.end()) {
      throw std::runtime_error(
          fmt::format("sphere tree: {} {} is not in the tree", what, missed - seen.begin()));
    }
  }

  /// Returns the pieces below the nodes first .. first + count - 1, which must lie next to each other.
  Range check_children(std::size_t first, std::size_t count, std::size_t stacked) {
    const auto begin = scene_.nodes.begin() + static_cast<std::ptrdiff_t>(first);
    const bool flat_list = first == scene_.root_first && count == scene_.root_count &&
                           std::all_of(begin, begin + static_cast<std::ptrdiff_t>(count),
                                       [](const SphereNode& n) { return n.leaf; });
    if (!flat_list) {  // whose leaves go to the selector, not to the stack
      stacked += count - 1;
    }
    Range all{0, 0};
    for (std::size_t k = first; k < first + count; ++k) {
      const Range below = check_node(k, stacked);
      if (k == first) {
        all = below;
      } else if (below.begin != all.end) {
        fail(k, "its pieces don't follow its sibling's");
      } else {
        all.end = below.end;
      }
    }
    return all;
  }

  Range check_node(std::size_t k, std::size_t stacked) {
    const SphereNode& node = scene_.nodes[k];
    if (node_seen_[k]) {
      fail(k, "is reached twice");
    }
    node_seen_[k] = true;
    if (stacked > static_cast<std::size_t>(kMaxStacked)) {
      fail(k, fmt::format("{} ranges may wait above it, the stack allows {}", stacked, kMaxStacked));
    }
    if (node.count < 1 || node.count >= (1U << kCountBits)) {
      fail(k, fmt::format("{} children, must be 1 to {}", node.count, (1U << kCountBits) - 1));
    }
    const std::size_t limit = node.leaf ? piece_seen_.size() : scene_.nodes.size();
    if (std::size_t{node.first} + node.count > limit) {
      fail(k, "its children are outside the list");
    }
    Range below{node.first, std::size_t{node.first} + node.count};
    if (node.leaf) {
      mark_pieces(k, below);
    } else {
      below = check_children(node.first, node.count, stacked);
    }
    check_sphere(k, below);
    return below;
  }

  void mark_pieces(std::size_t k, Range range) {
    for (std::size_t p = range.begin; p < range.end; ++p) {
      if (piece_seen_[p]) {
        fail(k, fmt::format("piece {} is in two leaves", p));
      }
      piece_seen_[p] = true;
    }
  }

  void check_sphere(std::size_t k, Range below) {
    const SphereNode& node = scene_.nodes[k];
    if (as_stored(node.centre) != node.centre || !std::isfinite(node.radius)) {
      fail(k, "its centre is not a number of the devices' format, or its radius not finite");
    }
    for (std::size_t t = below.begin; t < below.end; ++t) {
      const PiecePoints& points = points_[t];
      for (const auto& corners : {points.vertices, points.stored}) {
        for (const glm::dvec3& p : corners) {
          if (!encloses(node, p)) {
            fail(k, fmt::format("its sphere does not enclose piece {}", t));
          }
        }
      }
    }
  }

  static bool encloses(const SphereNode& node, const glm::dvec3& p) {
    const long double x = static_cast<long double>(p.x) - node.centre.x;
    const long double y = static_cast<long double>(p.y) - node.centre.y;
    const long double z = static_cast<long double>(p.z) - node.centre.z;
    return x * x + y * y + z * z <= static_cast<long double>(node.radius) * node.radius;
  }

  const DeviceScene& scene_;
  std::vector<bool> node_seen_;
  std::vector<bool> piece_seen_;
  std::vector<PiecePoints> points_;  ///< by piece
};

}  // namespace

void check_tree(const DeviceScene& scene) { Checker(scene).run(); }

}  // namespace raplas
