// Rays one by one, in the scalar's precision: the sphere tree is walked for each, nearest spheres first.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <type_traits>
#include <vector>

#include "raplas/device.hpp"

namespace raplas {

template <typename Scalar>
class TreeTracer {
 public:
  using Vector = glm::vec<3, Scalar>;

  /// What the rays of a pencil share.
  struct Start {
    explicit Start(const Pencil& pencil)
        : origin(pencil.origin),
          axis(pencil.axis),
          far(static_cast<Scalar>(pencil.far)),
          any_hit(pencil.any_hit) {}

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

  [[nodiscard]] static Hit hit_of(const Found& f) {
    return f.hit ? Hit{true, f.triangle, f.t, f.d, f.u, f.v} : Hit{};
  }

  void load(const DeviceScene& scene) {
    spheres_tested_ = 0;
    pairs_tested_ = 0;
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
      triangles_.push_back(
          {Vector(t.v0), e1, e2, glm::cross(e1, e2), kBorder * norm1(e1), kBorder * norm1(e2)});
    }
    leaves_.clear();
    for (std::uint32_t k = 0; k < scene.piece_count(); ++k) {
      leaves_.push_back(scene.piece(k).triangle);
    }
  }

  /// The nearest hit of a ray, `direction` of unit length: nearest spheres first, none beyond the pencil's
  /// far or the nearest hit so far; of an any-hit pencil the first hit is the result.
  [[nodiscard]] Found trace(const Start& start, const Vector& direction) {
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
        ++pairs_tested_;
        const Found hit = test(leaves_[k], start, direction);
        if (!hit.hit || !nearer(hit, best)) {
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

  /// One triangle: a hit if it lies before the pencil's far.
  [[nodiscard]] Found test(std::uint32_t triangle, const Start& start, const Vector& direction) const {
    const Found hit = intersect(triangle, start.origin, direction);
    return hit.hit && hit.t / hit.d * glm::dot(start.axis, direction) < start.far ? hit : Found{};
  }

  /// Nearest by t1' d2 < t2' d1; the lower triangle ID wins a tie.
  [[nodiscard]] static bool nearer(const Found& hit, const Found& best) {
    const Scalar mine = hit.t * best.d;
    const Scalar theirs = best.t * hit.d;
    return !best.hit || mine < theirs || (mine == theirs && hit.triangle < best.triangle);
  }

  /// Tests since load().
  [[nodiscard]] std::uint64_t spheres_tested() const { return spheres_tested_; }
  [[nodiscard]] std::uint64_t pairs_tested() const { return pairs_tested_; }

 private:
  /// Spheres are taken this much larger, so that rounding in the test below loses none.
  static constexpr Scalar kSlack = std::is_same_v<Scalar, double> ? Scalar(1e-9) : Scalar(1e-5);

  /// More than what rounding makes of u', v' or d - u' - v', as a share of the sums of their factors'
  /// magnitudes: 7 roundings of half an epsilon. A border belongs to the triangle, so none is lost between
  /// two triangles.
  static constexpr Scalar kBorder = 8 * std::numeric_limits<Scalar>::epsilon();

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
    Scalar border1;  ///< kBorder times the sum of e1's magnitudes
    Scalar border2;  ///< of e2's
  };

  /// Children of a sphere that the ray meets, or triangles of one without.
  struct Waiting {
    Scalar entry;  ///< t at which the ray enters the sphere
    bool leaf;
    std::uint32_t first;
    std::uint32_t count;
  };

  static Scalar norm1(const Vector& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

  /// Pushes the children that the ray meets in front of its origin and within `limit`, the nearest last.
  void push_met(const Waiting& range, const Vector& origin, const Vector& direction, Scalar limit) {
    const std::size_t siblings = stack_.size();
    spheres_tested_ += range.count;
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
  /// carried into every term. Borders are as wide as their rounding; no hit if rounding decides N.D's sign.
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
    const Scalar away = norm1(t);
    const Scalar u_border = away * triangle.border2;
    const Scalar v_border = away * triangle.border1;
    const Scalar d_border = triangle.border1 * triangle.border2 / kBorder;
    const Scalar w_border = u_border + v_border + d_border;
    const bool inside = hit.d > d_border && hit.t > 0 && hit.u >= -u_border && hit.v >= -v_border &&
                        hit.u + hit.v <= hit.d + w_border;
    return inside ? hit : Found{};
  }

  Waiting root_{};
  std::vector<Sphere> spheres_;
  std::vector<Edges> triangles_;
  std::vector<std::uint32_t> leaves_;  ///< what leaves are ranges of: triangles
  std::vector<Waiting> stack_;
  std::uint64_t spheres_tested_ = 0;
  std::uint64_t pairs_tested_ = 0;
};

}  // namespace raplas
