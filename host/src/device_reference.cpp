// The double-precision device: the sphere tree is walked for each ray, nearest spheres first.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "device_factories.hpp"

namespace raplas {
namespace {

/// Spheres are taken this much larger, so that rounding in the test below loses none.
constexpr double kSlack = 1e-9;

class ReferenceDevice final : public IntersectionDevice {
 public:
  void load(const DeviceScene& scene) override {
    scene_ = scene;
    counters_ = {};
    normals_.clear();
    for (const Triangle& t : scene.triangles) {
      normals_.push_back(glm::cross(t.e1, t.e2));
    }
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> all;
    all.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      std::vector<Hit>& hits = all.emplace_back();
      hits.reserve(pencil.directions.size());
      for (const glm::dvec3& direction : pencil.directions) {
        hits.push_back(trace_ray(pencil, direction));
        count(Counter::hits) += hits.back().hit ? 1U : 0U;
      }
    }
    return all;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }

 private:
  /// Children of a sphere that the ray meets, or triangles of one without.
  struct Waiting {
    double entry;  ///< t at which the ray enters the sphere
    bool leaf;
    std::uint32_t first;
    std::uint32_t count;
  };

  std::uint64_t& count(Counter counter) { return counters_[static_cast<std::size_t>(counter)]; }

  /// Nearest spheres first, none beyond Pencil::far or the nearest hit so far; of a pencil with any_hit the
  /// first hit is the result.
  Hit trace_ray(const Pencil& pencil, const glm::dvec3& direction) {
    const double along = glm::dot(pencil.axis, direction);
    double limit = pencil.far / along;  // no hit beyond this t matters
    Hit best;
    stack_.assign(1, {0, false, scene_.root_first, scene_.root_count});
    while (!stack_.empty()) {
      const Waiting range = stack_.back();
      stack_.pop_back();
      if (range.entry > limit * (1 + kSlack)) {
        continue;
      }
      if (!range.leaf) {
        push_met(range, pencil.origin, direction, limit);
        continue;
      }
      for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
        count(Counter::pairs_tested)++;
        const Hit hit = intersect(scene_.piece(k).triangle, pencil.origin, direction);
        if (!hit.hit || hit.t() * along >= pencil.far || !nearer(hit, best)) {
          continue;
        }
        best = hit;
        limit = hit.t();
        if (pencil.any_hit) {
          return best;
        }
      }
    }
    return best;
  }

  /// Pushes the children that the ray meets in front of its origin and within `limit`, the nearest last.
  void push_met(const Waiting& range, const glm::dvec3& origin, const glm::dvec3& direction, double limit) {
    const std::size_t siblings = stack_.size();
    count(Counter::spheres_tested) += range.count;
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      const SphereNode& node = scene_.nodes[k];
      const glm::dvec3 to_centre = node.centre - origin;
      const double middle = glm::dot(to_centre, direction);
      const glm::dvec3 across = to_centre - middle * direction;
      const double radius = node.radius * (1 + kSlack) + kSlack;
      const double half2 = radius * radius - glm::dot(across, across);
      if (half2 < 0) {
        continue;
      }
      const double half = std::sqrt(half2);
      if (middle + half >= 0 && middle - half <= limit * (1 + kSlack)) {
        stack_.push_back({middle - half, node.leaf, node.first, node.count});
      }
    }
    std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(siblings), stack_.end(),
              [](const Waiting& a, const Waiting& b) { return a.entry > b.entry; });
  }

  /// Moeller-Trumbore multiplied through by N.D (equations 5 and 6 of the paper), with the sign of N.D
  /// carried into every term.
  [[nodiscard]] Hit intersect(std::uint32_t id, const glm::dvec3& origin, const glm::dvec3& direction) const {
    const Triangle& triangle = scene_.triangles[id];
    const glm::dvec3& normal = normals_[id];
    const double n_dot_d = glm::dot(normal, direction);
    const double sign = n_dot_d < 0 ? -1 : 1;
    const glm::dvec3 t = triangle.v0 - origin;
    const glm::dvec3 d_cross_t = glm::cross(direction, t);
    const Hit hit{true,
                  id,
                  sign * glm::dot(normal, t),
                  sign * n_dot_d,
                  -sign * glm::dot(d_cross_t, triangle.e2),
                  sign * glm::dot(d_cross_t, triangle.e1)};
    const bool inside = hit.d > 0 && hit.t_scaled > 0 && hit.u_scaled >= 0 && hit.v_scaled >= 0 &&
                        hit.u_scaled + hit.v_scaled <= hit.d;
    return inside ? hit : Hit{};
  }

  /// Nearest by t1' d2 < t2' d1; the lower triangle ID wins a tie.
  static bool nearer(const Hit& hit, const Hit& best) {
    const double mine = hit.t_scaled * best.d;
    const double theirs = best.t_scaled * hit.d;
    return !best.hit || mine < theirs || (mine == theirs && hit.triangle < best.triangle);
  }

  DeviceScene scene_;
  std::vector<glm::dvec3> normals_;
  Counters counters_{};
  std::vector<Waiting> stack_;
};

}  // namespace

std::unique_ptr<IntersectionDevice> make_reference_device() { return std::make_unique<ReferenceDevice>(); }

}  // namespace raplas
