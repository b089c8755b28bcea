// Verifies a sphere tree.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

class Checker {
 public:
  explicit Checker(const DeviceScene& scene)
      : scene_(scene), node_seen_(scene.nodes.size()), triangle_seen_(scene.triangles.size()) {
    points_.reserve(scene.triangles.size());
    for (const Triangle& t : scene.triangles) {
      points_.push_back(points_of(t));
    }
  }

  void run() {
    constexpr std::size_t kMaxIds = std::size_t{1} << kIdBits;
    if (scene_.nodes.size() > kMaxIds || scene_.triangles.size() > kMaxIds) {
      throw std::runtime_error(fmt::format("sphere tree: more than {} spheres or triangles", kMaxIds));
    }
    if (scene_.root_count < 1 || scene_.root_first + std::size_t{scene_.root_count} > scene_.nodes.size()) {
      throw std::runtime_error("sphere tree: the root range is empty or outside the list");
    }
    check_children(scene_.root_first, scene_.root_count, 0);
    require_all(node_seen_, "sphere");
    require_all(triangle_seen_, "triangle");
  }

 private:
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

  /// Returns the triangles below the nodes first .. first + count - 1, which must lie next to each other.
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
        fail(k, "its triangles don't follow its sibling's");
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
    const std::size_t limit = node.leaf ? scene_.triangles.size() : scene_.nodes.size();
    if (std::size_t{node.first} + node.count > limit) {
      fail(k, "its children are outside the list");
    }
    Range below{node.first, std::size_t{node.first} + node.count};
    if (node.leaf) {
      mark_triangles(k, below);
    } else {
      below = check_children(node.first, node.count, stacked);
    }
    check_sphere(k, below);
    return below;
  }

  void mark_triangles(std::size_t k, Range range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      if (triangle_seen_[t]) {
        fail(k, fmt::format("triangle {} is in two leaves", t));
      }
      triangle_seen_[t] = true;
    }
  }

  void check_sphere(std::size_t k, Range below) {
    const SphereNode& node = scene_.nodes[k];
    if (as_stored(node.centre) != node.centre || !std::isfinite(node.radius)) {
      fail(k, "its centre is not a number of the devices' format, or its radius not finite");
    }
    for (std::size_t t = below.begin; t < below.end; ++t) {
      const TrianglePoints& points = points_[t];
      for (const auto& corners : {points.vertices, points.stored}) {
        for (const glm::dvec3& p : corners) {
          if (!encloses(node, p)) {
            fail(k, fmt::format("its sphere does not enclose triangle {}", t));
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
  std::vector<bool> triangle_seen_;
  std::vector<TrianglePoints> points_;
};

}  // namespace

void check_tree(const DeviceScene& scene) { Checker(scene).run(); }

}  // namespace raplas
