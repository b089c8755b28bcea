// The double-precision device: the sphere tree is walked for each ray.
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
        hits.push_back(trace_ray(pencil.origin, direction));
        count(Counter::hits) += hits.back().hit ? 1U : 0U;
      }
      drop_far_hits(pencil, hits);
    }
    return all;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }

 private:
  std::uint64_t& count(Counter counter) { return counters_[static_cast<std::size_t>(counter)]; }

  Hit trace_ray(const glm::dvec3& origin, const glm::dvec3& direction) {
    Hit best;
    stack_.assign(1, {scene_.root_first, scene_.root_count});
    while (!stack_.empty()) {
      const auto [first, number] = stack_.back();
      stack_.pop_back();
      count(Counter::spheres_tested) += number;
      for (std::uint32_t k = first; k < first + number; ++k) {
        const SphereNode& node = scene_.nodes[k];
        if (!meets(node, origin, direction, best)) {
          continue;
        }
        if (!node.leaf) {
          stack_.emplace_back(node.first, node.count);
          continue;
        }
        count(Counter::pairs_tested) += node.count;
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
          intersect(t, origin, direction, best);
        }
      }
    }
    return best;
  }

  /// Does the ray meet the sphere, in front of the origin and no farther than the best hit?
  static bool meets(const SphereNode& node, const glm::dvec3& origin, const glm::dvec3& direction,
                    const Hit& best) {
    const glm::dvec3 to_centre = node.centre - origin;
    const double along = glm::dot(to_centre, direction);
    const glm::dvec3 across = to_centre - along * direction;
    const double radius = node.radius * (1 + kSlack) + kSlack;
    const double half2 = radius * radius - glm::dot(across, across);
    if (half2 < 0) {
      return false;
    }
    const double half = std::sqrt(half2);
    return along + half >= 0 && (!best.hit || (along - half) * best.d <= best.t_scaled * (1 + kSlack));
  }

  /// Moeller-Trumbore multiplied through by N.D (equations 5 and 6 of the paper), with the sign of N.D
  /// carried into every term. Nearest by t1' d2 < t2' d1; the lower triangle ID wins a tie.
  void intersect(std::uint32_t id, const glm::dvec3& origin, const glm::dvec3& direction, Hit& best) const {
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
    if (!(hit.d > 0 && hit.t_scaled > 0 && hit.u_scaled >= 0 && hit.v_scaled >= 0 &&
          hit.u_scaled + hit.v_scaled <= hit.d)) {
      return;
    }
    const double mine = hit.t_scaled * best.d;
    const double theirs = best.t_scaled * hit.d;
    if (!best.hit || mine < theirs || (mine == theirs && id < best.triangle)) {
      best = hit;
    }
  }

  DeviceScene scene_;
  std::vector<glm::dvec3> normals_;
  Counters counters_{};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack_;
};

}  // namespace

std::unique_ptr<IntersectionDevice> make_reference_device() { return std::make_unique<ReferenceDevice>(); }

}  // namespace raplas
