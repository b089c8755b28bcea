#include "exact_truth.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "exact_hit.hpp"
#include "raplas/sphere_tree.hpp"
#include "reference_pairs.hpp"

namespace raplas {
namespace {

/// What exact_hit() counts depths in.
constexpr double kDepthUnit = 0x1p-34;

/// A hit, with t off by at most t_error.
struct Found {
  std::uint32_t triangle;
  double t;
  double t_error;
};

std::optional<Found> found(const Triangle& triangle, std::uint32_t id, const glm::dvec3& origin,
                           const glm::dvec3& direction, std::uint32_t& exact_pairs) {
  const ReferencePair pair = reference_pair(triangle, id, origin, direction);
  if (pair.verdict == Verdict::hit) {
    return Found{id, pair.t, pair.t_error};
  }
  if (pair.verdict == Verdict::miss) {
    return std::nullopt;
  }
  ++exact_pairs;
  const auto depth = exact_hit(origin, direction, triangle.v0, triangle.e1, triangle.e2);
  if (!depth) {
    return std::nullopt;
  }
  return Found{id, static_cast<double>(*depth) * kDepthUnit, kDepthUnit};
}

/// Numerator and denominator (above 0) of the t at which a ray meets the plane of a triangle that it hits.
std::array<ExactReal, 2> exact_depth(const Triangle& triangle, const glm::dvec3& origin,
                                     const glm::dvec3& direction) {
  const ExactVec3 normal = cross(exact(triangle.e1), exact(triangle.e2));
  const ExactReal d = dot(normal, exact(direction));
  const ExactReal sign(d.sign());
  return {sign * dot(normal, exact(triangle.v0) - exact(origin)), sign * d};
}

}  // namespace

ExactTruth::ExactTruth(std::span<const Triangle> triangles) {
  TreeOptions whole;
  whole.longest_edge = kWholeTriangles;
  SphereTree tree = build_tree(triangles, whole);
  scene_ = std::move(tree.scene);
  source_ = std::move(tree.source);
}

TrueHits ExactTruth::hits(const glm::dvec3& origin, const glm::dvec3& direction) const {
  TrueHits truth;
  std::vector<Found> nearest;                                 // all at the same t, by ID in the tree
  const auto sign_of = [&](const Found& a, const Found& b) {  // of a's t minus b's
    if (a.t + a.t_error < b.t - b.t_error) {
      return -1;
    }
    if (b.t + b.t_error < a.t - a.t_error) {
      return 1;
    }
    const auto [ta, da] = exact_depth(scene_.triangles[a.triangle], origin, direction);
    const auto [tb, db] = exact_depth(scene_.triangles[b.triangle], origin, direction);
    return (ta * db - tb * da).sign();
  };
  for (const std::uint32_t id : raplas::candidates(scene_, origin, direction)) {
    truth.candidates.push_back(source_[id]);
    const auto hit = found(scene_.triangles[id], id, origin, direction, truth.exact_pairs);
    if (!hit) {
      continue;
    }
    truth.t_last = std::max(truth.t_last, hit->t);
    const int sign = nearest.empty() ? -1 : sign_of(*hit, nearest.front());
    if (sign < 0) {
      nearest.clear();
    }
    if (sign <= 0) {
      nearest.push_back(*hit);
    }
  }
  for (const Found& hit : nearest) {
    truth.nearest.push_back(source_[hit.triangle]);
    truth.t = hit.t;
  }
  std::sort(truth.nearest.begin(), truth.nearest.end());
  return truth;
}

}  // namespace raplas
