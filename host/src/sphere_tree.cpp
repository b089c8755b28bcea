// Builds sphere trees by median splits.
#include "raplas/sphere_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "raplas/bounding_sphere.hpp"
#include "triangle_points.hpp"

namespace raplas {
namespace {

struct Range {
  std::size_t begin;
  std::size_t end;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

class Builder {
 public:
  Builder(std::span<const Triangle> triangles, const TreeOptions& options)
      : triangles_(triangles),
        leaf_size_(static_cast<std::size_t>(options.leaf_size)),
        order_(triangles.size()) {
    constexpr int kMaxCount = (1 << kCountBits) - 1;
    if (options.leaf_size < 1 || options.leaf_size > kMaxCount) {
      throw std::runtime_error(fmt::format("leaf size {} is not in 1 to {}", options.leaf_size, kMaxCount));
    }
    if (options.width < 2 || options.width > kMaxCount) {
      throw std::runtime_error(fmt::format("tree width {} is not in 2 to {}", options.width, kMaxCount));
    }
    if (triangles.empty()) {
      throw std::runtime_error("no triangles to put into spheres");
    }
    check_ids(triangles.size(), "triangles");
    std::iota(order_.begin(), order_.end(), 0U);
    centroids_.reserve(triangles.size());
    sizes_.reserve(triangles.size());
    points_.reserve(triangles.size());
    for (const Triangle& t : triangles) {
      centroids_.push_back(t.v0 + (t.e1 + t.e2) / 3.0);
      points_.push_back(points_of(t));
      sizes_.push_back(std::max({glm::length(t.e1), glm::length(t.e2), glm::length(t.e2 - t.e1)}));
    }
  }

  /// Appends the leaves of a range in order.
  void add_leaves(Range range) {
    if (range.size() <= leaf_size_) {
      nodes_.push_back(leaf(range));
      return;
    }
    const std::size_t middle = cut(range);
    add_leaves({range.begin, middle});
    add_leaves({middle, range.end});
  }

  /// Appends the children of a range, then what is below them. Returns the first child and their number.
  std::pair<std::size_t, std::size_t> add_children(Range range, std::size_t width) {
    const std::vector<Range> parts = split(range, width);
    const std::size_t first = nodes_.size();
    nodes_.resize(first + parts.size());
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (parts[k].size() <= leaf_size_) {
        nodes_[first + k] = leaf(parts[k]);
      } else {
        SphereNode node = sphere(parts[k]);
        const auto [child, count] = add_children(parts[k], width);
        node.first = static_cast<std::uint32_t>(child);
        node.count = static_cast<std::uint32_t>(count);
        nodes_[first + k] = node;
      }
    }
    return {first, parts.size()};
  }

  SphereTree finish(std::size_t root_count) {
    check_ids(nodes_.size(), "spheres");
    SphereTree tree;
    tree.scene.triangles.reserve(order_.size());
    for (const std::uint32_t k : order_) {
      tree.scene.triangles.push_back(triangles_[k]);
    }
    tree.scene.nodes = std::move(nodes_);
    tree.scene.root_first = 0;
    tree.scene.root_count = static_cast<std::uint32_t>(root_count);
    tree.source = std::move(order_);
    return tree;
  }

  [[nodiscard]] Range all() const { return {0, order_.size()}; }
  [[nodiscard]] std::size_t node_count() const { return nodes_.size(); }

 private:
  static void check_ids(std::size_t count, const char* what) {
    constexpr std::size_t kMaxIds = std::size_t{1} << kIdBits;
    if (count > kMaxIds) {
      throw std::runtime_error(fmt::format("{} {}, IDs of {} bits allow {}", count, what, kIdBits, kMaxIds));
    }
  }

  /// Reorders a range of more than a leaf into two parts and returns where the second begins. The whole list
  /// is first cut into small and large triangles (walls, floors), which would blow up every sphere they get
  /// into.
  std::size_t cut(Range range) {
    if (range.size() == order_.size()) {
      const std::size_t middle = cut_by_size();
      if (middle < range.end) {
        return middle;
      }
    }
    return halve(range);
  }

  /// Puts the triangles of more than kLarge times the median size last.
  std::size_t cut_by_size() {
    constexpr double kLarge = 4;
    std::vector<double> sizes = sizes_;
    const auto median = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), median, sizes.end());
    const auto large = std::stable_partition(order_.begin(), order_.end(),
                                             [&](std::uint32_t k) { return sizes_[k] <= kLarge * *median; });
    return static_cast<std::size_t>(large - order_.begin());
  }

  /// Cuts a range at its median centroid along the longest axis; all leaves but the last of a range stay
  /// full.
  std::size_t halve(Range range) {
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (std::size_t k = range.begin; k < range.end; ++k) {
      low = glm::min(low, centroids_[order_[k]]);
      high = glm::max(high, centroids_[order_[k]]);
    }
    const glm::dvec3 extent = high - low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const std::size_t leaves = (range.size() + leaf_size_ - 1) / leaf_size_;
    const std::size_t middle = range.begin + leaf_size_ * ((leaves + 1) / 2);
    const auto at = [this](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(range.begin), at(middle), at(range.end), [&](std::uint32_t a, std::uint32_t b) {
      const double ca = centroids_[a][axis];
      const double cb = centroids_[b][axis];
      return ca < cb || (ca == cb && a < b);
    });
    return middle;
  }

  /// Halves the largest part until there are `width` parts or all are leaves.
  std::vector<Range> split(Range range, std::size_t width) {
    std::vector<Range> parts{range};
    while (parts.size() < width) {
      const auto largest =
          std::max_element(parts.begin(), parts.end(), [](Range a, Range b) { return a.size() < b.size(); });
      if (largest->size() <= leaf_size_) {
        break;
      }
      const Range whole = *largest;
      const std::size_t middle = cut(whole);
      *largest = {whole.begin, middle};
      parts.insert(largest + 1, {middle, whole.end});
    }
    return parts;
  }

  SphereNode sphere(Range range) {
    scratch_.clear();
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto& vertices = points_[order_[k]].vertices;
      scratch_.insert(scratch_.end(), vertices.begin(), vertices.end());
    }
    const glm::dvec3 centre = as_stored(bounding_ball(scratch_).centre);
    double radius = enclosing_radius(scratch_, centre);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      radius = std::max(radius, enclosing_radius(points_[order_[k]].stored, centre));
    }
    return {centre, radius, false, 0, 0};
  }

  SphereNode leaf(Range range) {
    SphereNode node = sphere(range);
    node.leaf = true;
    node.first = static_cast<std::uint32_t>(range.begin);
    node.count = static_cast<std::uint32_t>(range.size());
    return node;
  }

  std::span<const Triangle> triangles_;
  std::size_t leaf_size_;
  std::vector<std::uint32_t> order_;
  std::vector<glm::dvec3> centroids_;
  std::vector<double> sizes_;  ///< longest edges
  std::vector<SphereNode> nodes_;
  std::vector<TrianglePoints> points_;
  std::vector<glm::dvec3> scratch_;
};

}  // namespace

SphereTree build_flat(std::span<const Triangle> triangles, const TreeOptions& options) {
  Builder builder(triangles, options);
  builder.add_leaves(builder.all());
  return builder.finish(builder.node_count());
}

SphereTree build_tree(std::span<const Triangle> triangles, const TreeOptions& options) {
  Builder builder(triangles, options);
  const auto [first, count] = builder.add_children(builder.all(), static_cast<std::size_t>(options.width));
  return builder.finish(first + count);
}

}  // namespace raplas
