// The scene's words in fixed point.
#include "raplas/encode_fixed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "certified_band.hpp"
#include "raplas/encode.hpp"
#include "raplas/strip.hpp"
#include "triangle_points.hpp"

namespace raplas {
namespace {

constexpr double kUnit = 1.0 / (1 << kCoordinateFraction);

/// Corners this near each other in double precision are one point of the mesh.
constexpr double kSamePoint = 0x1p-36;

FixedVec3 quantised(const glm::dvec3& p) {
  const auto nearest = [](double x) { return static_cast<std::int32_t>(std::lrint(x / kUnit)); };
  return {nearest(p.x), nearest(p.y), nearest(p.z)};
}

glm::dvec3 value_of(const FixedVec3& p) { return glm::dvec3(p[0], p[1], p[2]) * kUnit; }

/// |a - b|^2 in units of 2^-2 kCoordinateFraction.
std::int64_t squared_distance(const FixedVec3& a, const FixedVec3& b) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t difference = std::int64_t{a[k]} - b[k];
    sum += difference * difference;
  }
  return sum;
}

/// The least integer whose square is at least `square` (< 2^50).
std::uint32_t root_up(std::int64_t square) {
  auto root = static_cast<std::int64_t>(std::sqrt(static_cast<double>(square)));
  while (root * root < square) {
    ++root;
  }
  while (root > 0 && (root - 1) * (root - 1) >= square) {
    --root;
  }
  return static_cast<std::uint32_t>(root);
}

/// What a triangle's edges and normal are multiplied by, so that the error of its u' and v' is what the
/// pencils' bands are made for: certified_band.hpp.
double certified_scale(const glm::dvec3& v0, const glm::dvec3& e1, const glm::dvec3& e2) {
  const double longest = std::max(glm::length(e1), glm::length(e2));
  const double coefficient = kOriginError * (glm::length(v0) + 1) + kEdgeError * longest;
  return kBandError / (longest * coefficient);
}

/// The triangle with V0 opposite its shortest edge, scaled; N is that of the triangle before it is rounded.
TriangleWord<Fp24> certified_word(const Triangle& t) {
  const std::array<glm::dvec3, 3> corners{t.v0, t.v0 + t.e1, t.v0 + t.e2};
  const std::array<double, 3> opposite{glm::distance(t.e1, t.e2), glm::length(t.e2), glm::length(t.e1)};
  const auto first =
      static_cast<std::size_t>(std::min_element(opposite.begin(), opposite.end()) - opposite.begin());
  const glm::dvec3 v0 = corners[first];
  const glm::dvec3 e1 = corners[(first + 1) % 3] - v0;
  const glm::dvec3 e2 = corners[(first + 2) % 3] - v0;
  const double scale = certified_scale(v0, e1, e2);
  return {encode<Fp24>(v0, "vertex coordinate"), encode<Fp24>(scale * e1, "edge"),
          encode<Fp24>(scale * e2, "edge"), encode<Fp24>(scale * glm::cross(e1, e2), "normal")};
}

class SceneEncoder {
 public:
  SceneEncoder(const DeviceScene& scene, bool certify) : scene_(scene), certify_(certify) {}

  FixedScene run() {
    memory_.nodes.resize(scene_.nodes.size());
    memory_.vertices.reserve(2 * scene_.piece_count());
    encode_range(scene_.root_first, scene_.root_count);
    constexpr std::size_t kMaxWords = std::size_t{1} << kIdBits;
    if (memory_.vertices.size() > kMaxWords) {
      throw std::runtime_error(
          fmt::format("{} vertex words, addresses reach {}", memory_.vertices.size(), kMaxWords));
    }
    memory_.triangles.reserve(scene_.triangles.size());
    std::vector<std::uint32_t> uncertain;
    for (const Triangle& t : scene_.triangles) {
      memory_.triangles.push_back(certify_ ? certified_word(t) : encode<Fp24>(t));
      const glm::dvec3 n = glm::abs(decode(memory_.triangles.back().n));
      if (certify_ && std::max({n.x, n.y, n.z}) < kLeastNormal) {
        uncertain.push_back(static_cast<std::uint32_t>(memory_.triangles.size() - 1));
      }
    }
    memory_.scene = {static_cast<std::uint32_t>(scene_.nodes.size()), scene_.root_count, scene_.root_first};
    return {std::move(memory_), vertex_error_, std::move(uncertain)};
  }

 private:
  [[noreturn]] static void fail(std::size_t node, const std::string& what) {
    throw std::runtime_error(fmt::format("node {}: {}", node, what));
  }

  void encode_range(std::size_t first, std::size_t count) {
    for (std::size_t k = first; k < first + count; ++k) {
      encode_node(k);
    }
  }

  void encode_node(std::size_t k) {
    const SphereNode& node = scene_.nodes[k];
    const std::size_t begin = memory_.vertices.size();
    if (node.leaf) {
      encode_leaf(k);
    } else {
      encode_range(node.first, node.count);
    }
    NodeWord word;
    word.leaf = node.leaf;
    word.count = node.leaf ? static_cast<std::uint32_t>(memory_.vertices.size() - begin) : node.count;
    word.first = node.leaf ? static_cast<std::uint32_t>(begin) : node.first;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(node.centre[axis]) < 1 - kUnit)) {
        fail(k, "its centre is outside the format");
      }
    }
    word.centre = quantised(node.centre);
    std::int64_t farthest = 0;
    for (std::size_t v = begin; v < memory_.vertices.size(); ++v) {
      farthest = std::max(farthest, squared_distance(memory_.vertices[v].point, word.centre));
    }
    word.radius = root_up(farthest);
    if (word.radius + kMaxSlack >= 1U << kCoordinateBits) {
      fail(k, "its radius leaves no room for a pencil's slack");
    }
    memory_.nodes[k] = word;
  }

  void encode_leaf(std::size_t k) {
    const SphereNode& node = scene_.nodes[k];
    points_.clear();
    triangles_.clear();
    for (std::uint32_t p = node.first; p < node.first + node.count; ++p) {
      const Piece piece = scene_.piece(p);
      const PiecePoints points = points_of(scene_.triangles[piece.triangle], piece);
      FixedTriangle& triangle = triangles_.emplace_back();
      triangle.id = piece.triangle;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        triangle.corners[corner] = vertex_at(k, points.vertices[corner], points.stored[corner]);
      }
    }
    const std::vector<VertexWord> strip = make_strip(triangles_);
    if (strip.size() >= 1U << kCountBits) {
      fail(k, fmt::format("{} vertex words, a leaf holds {}", strip.size(), (1U << kCountBits) - 1));
    }
    memory_.vertices.insert(memory_.vertices.end(), strip.begin(), strip.end());
  }

  /// The vertex word of a point of the mesh: the same in all triangles of the leaf.
  FixedVec3 vertex_at(std::size_t node, const glm::dvec3& point, const glm::dvec3& stored) {
    auto same = std::find_if(points_.begin(), points_.end(), [&point](const Point& p) {
      const glm::dvec3 apart = glm::abs(p.exact - point);
      return std::max({apart.x, apart.y, apart.z}) <= kSamePoint;
    });
    if (same == points_.end()) {
      if (!(glm::length(point) < 1 - 2 * kMaxVertexError)) {
        fail(node, "a vertex lies outside the unit ball");
      }
      same = points_.insert(points_.end(), {point, quantised(point)});
    }
    const double error = glm::distance(value_of(same->vertex), certify_ ? point : stored);
    if (!(error < kMaxVertexError)) {
      fail(node, "a corner as stored lies far from its vertex");
    }
    // more than the roundings of `stored` and of the distance
    vertex_error_ = std::max(vertex_error_, error + 0x1p-48);
    return same->vertex;
  }

  /// A point of the mesh and its word.
  struct Point {
    glm::dvec3 exact;
    FixedVec3 vertex;
  };

  const DeviceScene& scene_;
  bool certify_;
  FixedSceneMemory<Fp24> memory_;
  double vertex_error_ = 0;
  std::vector<Point> points_;             ///< of one leaf
  std::vector<FixedTriangle> triangles_;  ///< of one leaf
};

}  // namespace

FixedScene encode_fixed(const DeviceScene& scene, bool certify) { return SceneEncoder(scene, certify).run(); }

}  // namespace raplas
