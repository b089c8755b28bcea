// Rays one by one, in the scalar's precision: the sphere tree is walked for each, nearest spheres first.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <type_traits>
#include <vector>

#include "raplas/device.hpp"

namespace raplas {

template <typename Scalar>
class ReferenceDevice final : public IntersectionDevice {
 public:
  void load(const DeviceScene& scene) override {
    counters_ = {};
    root_ = {0, false, scene.root_first, scene.root_count};
    spheres_.clear();
    for (const SphereNode& node : scene.nodes) {
      const auto radius = static_cast<Scalar>(node.radius);
      spheres_.push_back(
          {Vector(node.centre), radius * (1 + kSlack) + kSlack, node.leaf, node.first, node.count});
    }
    triangles_.clear();
    for (const Triangle& t : scene.triangles) {
      const Vector e1(t.e1);
      const Vector e2(t.e2);
      triangles_.push_back({Vector(t.v0), e1, e2, glm::cross(e1, e2)});
    }
    leaves_.clear();
    for (std::uint32_t k = 0; k < scene.piece_count(); ++k) {
      leaves_.push_back(scene.piece(k).triangle);
    }
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> all;
    all.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      std::vector<Hit>& hits = all.emplace_back();
      hits.reserve(pencil.directions.size());
      const Start start{Vector(pencil.origin), Vector(pencil.axis), static_cast<Scalar>(pencil.far),
                        pencil.any_hit};
      for (const glm::dvec3& direction : pencil.directions) {
        hits.push_back(hit_of(trace_ray(start, Vector(direction))));
        count(Counter::hits) += hits.back().hit ? 1U : 0U;
      }
    }
    return all;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }

 private:
  using Vector = glm::vec<3, Scalar>;

  /// Spheres are taken this much larger, so that rounding in the test below loses none.
  static constexpr Scalar kSlack = std::is_same_v<Scalar, double> ? Scalar(1e-9) : Scalar(1e-5);

  struct Sphere {
    Vector centre;
    Scalar radius;
    bool leaf;
    std::uint32_t first;
    std::uint32_t count;
  };
  struct Edges {
    Vector v0;
    Vector e1;
    Vector e2;
    Vector normal;
  };
  /// What the rays of a pencil share.
  struct Start {
    Vector origin;
    Vector axis;
    Scalar far;
    bool any_hit;
  };
  /// As Hit, in this precision.
  struct Found {
    bool hit = false;
    std::uint32_t triangle = 0;
    Scalar t = 0;
    Scalar d = 0;
    Scalar u = 0;
    Scalar v = 0;
  };

  /// Children of a sphere that the ray meets, or triangles of one without.
  struct Waiting {
    Scalar entry;  ///< t at which the ray enters the sphere
    bool leaf;
    std::uint32_t first;
    std::uint32_t count;
  };

  std::uint64_t& count(Counter counter) { return counters_[static_cast<std::size_t>(counter)]; }

  static Hit hit_of(const Found& f) { return f.hit ? Hit{true, f.triangle, f.t, f.d, f.u, f.v} : Hit{}; }

  /// Nearest spheres first, none beyond Pencil::far or the nearest hit so far; of a pencil with any_hit the
  /// first hit is the result.
  Found trace_ray(const Start& start, const Vector& direction) {
    const Scalar along = glm::dot(start.axis, direction);
    Scalar limit = start.far / along;  // no hit beyond this t matters
    Found best;
    stack_.assign(1, root_);
    while (!stack_.empty()) {
      const Waiting range = stack_.back();
      stack_.pop_back();
      if (range.entry > limit * (1 + kSlack)) {
        continue;
      }
      if (!range.leaf) {
        push_met(range, start.origin, direction, limit);
        continue;
      }
      for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
        count(Counter::pairs_tested)++;
        const Found hit = intersect(leaves_[k], start.origin, direction);
        if (!hit.hit || hit.t / hit.d * along >= start.far || !nearer(hit, best)) {
          continue;
        }
        best = hit;
        limit = hit.t / hit.d;
        if (start.any_hit) {
          return best;
        }
      }
    }
    return best;
  }

  /// Pushes the children that the ray meets in front of its origin and within `limit`, the nearest last.
  void push_met(const Waiting& range, const Vector& origin, const Vector& direction, Scalar limit) {
    const std::size_t siblings = stack_.size();
    count(Counter::spheres_tested) += range.count;
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      const Sphere& sphere = spheres_[k];
      const Vector to_centre = sphere.centre - origin;
      const Scalar middle = glm::dot(to_centre, direction);
      const Vector across = to_centre - middle * direction;
      const Scalar half2 = sphere.radius * sphere.radius - glm::dot(across, across);
      if (half2 < 0) {
        continue;
      }
      const Scalar half = std::sqrt(half2);
      if (middle + half >= 0 && middle - half <= limit * (1 + kSlack)) {
        stack_.push_back({middle - half, sphere.leaf, sphere.first, sphere.count});
      }
    }
    std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(siblings), stack_.end(),
              [](const Waiting& a, const Waiting& b) { return a.entry > b.entry; });
  }

  /// Moeller-Trumbore multiplied through by N.D (equations 5 and 6 of the paper), with the sign of N.D
  /// carried into every term.
  [[nodiscard]] Found intersect(std::uint32_t id, const Vector& origin, const Vector& direction) const {
    const Edges& triangle = triangles_[id];
    const Scalar n_dot_d = glm::dot(triangle.normal, direction);
    const Scalar sign = n_dot_d < 0 ? -1 : 1;
    const Vector t = triangle.v0 - origin;
    const Vector d_cross_t = glm::cross(direction, t);
    const Found hit{true,
                    id,
                    sign * glm::dot(triangle.normal, t),
                    sign * n_dot_d,
                    -sign * glm::dot(d_cross_t, triangle.e2),
                    sign * glm::dot(d_cross_t, triangle.e1)};
    const bool inside = hit.d > 0 && hit.t > 0 && hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= hit.d;
    return inside ? hit : Found{};
  }

  /// Nearest by t1' d2 < t2' d1; the lower triangle ID wins a tie.
  static bool nearer(const Found& hit, const Found& best) {
    const Scalar mine = hit.t * best.d;
    const Scalar theirs = best.t * hit.d;
    return !best.hit || mine < theirs || (mine == theirs && hit.triangle < best.triangle);
  }

  Waiting root_{};
  std::vector<Sphere> spheres_;
  std::vector<Edges> triangles_;
  std::vector<std::uint32_t> leaves_;  ///< what leaves are ranges of: triangles
  Counters counters_{};
  std::vector<Waiting> stack_;
};

}  // namespace raplas
