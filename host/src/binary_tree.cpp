// Cuts ranges of triangles in two: at the median, or where the sum of sizes times numbers is least.
#include "binary_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace raplas {
namespace {

constexpr std::size_t kBins = 32;        ///< planes to cut at, along each axis
constexpr std::size_t kSweepLimit = 48;  ///< no more triangles than these are cut between any two of them

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

struct Item {
  Box box;
  glm::dvec3 centre;  ///< what decides on which side of a cut it lies
  std::uint32_t triangle;
};

using Items = std::span<Item>;

struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;          ///< negative: none
  std::size_t first = 0;  ///< first bin, or first item in the order along the axis, of the right side
};

class Divider {
 public:
  Divider(std::span<const Triangle> triangles, const TreeOptions& options)
      : triangles_(triangles), options_(options), leaf_size_(static_cast<std::size_t>(options.leaf_size)) {
    items_.reserve(triangles.size());
    for (const Triangle& t : triangles) {
      Item item;
      item.box.add(t.v0);
      item.box.add(t.v0 + t.e1);
      item.box.add(t.v0 + t.e2);
      item.centre = options.builder == TreeBuilder::median ? t.v0 + (t.e1 + t.e2) / 3.0
                                                           : (item.box.low + item.box.high) * 0.5;
      item.triangle = static_cast<std::uint32_t>(items_.size());
      items_.push_back(item);
    }
  }

  BinaryTree run() {
    divide(0, items_.size(), 0);
    BinaryTree tree;
    tree.nodes = std::move(nodes_);
    tree.order.reserve(items_.size());
    for (const Item& item : items_) {
      tree.order.push_back(item.triangle);
    }
    return tree;
  }

 private:
  void divide(std::size_t begin, std::size_t end, int depth) {
    const std::size_t node = nodes_.size();
    const bool median = options_.builder == TreeBuilder::median;
    nodes_.push_back({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), 0});
    if (end - begin <= (median ? leaf_size_ : 1)) {
      return;
    }
    const Items items = Items(items_).subspan(begin, end - begin);
    const std::size_t leaves = (items.size() + leaf_size_ - 1) / leaf_size_;
    std::size_t left = 0;
    if (median) {
      left = depth == 0 ? cut_by_size(items) : halve(items);
    } else if (depth + 1 + ceil_log2(leaves) > kMaxStacked) {
      left = halve(items);
    } else {
      left = items.size() > kSweepLimit ? cut_between_bins(items) : cut_between_items(items);
    }
    divide(begin, begin + left, depth + 1);
    nodes_[node].right = static_cast<std::uint32_t>(nodes_.size());
    divide(begin + left, end, depth + 1);
  }

  /// Puts the triangles of more than kLarge times the median size last; if there are none, halves. Returns,
  /// as all cuts do, the number of triangles on the left.
  std::size_t cut_by_size(Items items) {
    constexpr double kLarge = 4;
    std::vector<double> sizes;
    for (const Triangle& t : triangles_) {
      sizes.push_back(std::max({glm::length(t.e1), glm::length(t.e2), glm::length(t.e2 - t.e1)}));
    }
    std::vector<double> sorted = sizes;
    const auto median = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), median, sorted.end());
    const auto large = std::stable_partition(items.begin(), items.end(), [&](const Item& item) {
      return sizes[item.triangle] <= kLarge * *median;
    });
    return large == items.end() ? halve(items) : static_cast<std::size_t>(large - items.begin());
  }

  static Box centres_of(Items items) {
    Box box;
    for (const Item& item : items) {
      box.add(item.centre);
    }
    return box;
  }

  static void sort_along(Items items, int axis) { std::sort(items.begin(), items.end(), Before{axis}); }

  struct Before {
    int axis;
    bool operator()(const Item& a, const Item& b) const {
      return a.centre[axis] < b.centre[axis] || (a.centre[axis] == b.centre[axis] && a.triangle < b.triangle);
    }
  };

  /// Cuts at the median centre along the longest axis; all leaves but the last of a range stay full.
  std::size_t halve(Items items) const {
    const Box centres = centres_of(items);
    const glm::dvec3 extent = centres.high - centres.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const std::size_t unit = items.size() > leaf_size_ ? leaf_size_ : 1;
    const std::size_t units = (items.size() + unit - 1) / unit;
    const std::size_t left = unit * ((units + 1) / 2);
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left), items.end(),
                     Before{axis});
    return left;
  }

  /// How often a part in this box is looked at.
  [[nodiscard]] double weight(const Box& box) const {
    const glm::dvec3 e = box.high - box.low;
    if (options_.builder == TreeBuilder::surface) {
      return e.x * e.y + e.y * e.z + e.z * e.x;
    }
    const double reach = options_.footprint + 0.5 * glm::length(e);
    return reach * reach;
  }

  [[nodiscard]] double count(std::size_t triangles) const { return static_cast<double>(triangles); }

  std::size_t cut_between_bins(Items items) const {
    struct Bin {
      Box box;
      std::size_t count = 0;
    };
    const Box centres = centres_of(items);
    const glm::dvec3 scale = (kBins * (1 - 1e-9)) / (centres.high - centres.low);
    const auto bin_of = [&](const Item& item, int axis) {
      return static_cast<std::size_t>((item.centre[axis] - centres.low[axis]) * scale[axis]);
    };
    std::array<std::array<Bin, kBins>, 3> bins;
    std::array<bool, 3> usable{};
    for (int axis = 0; axis < 3; ++axis) {
      usable[static_cast<std::size_t>(axis)] = std::isfinite(scale[axis]);
    }
    for (const Item& item : items) {
      for (int axis = 0; axis < 3; ++axis) {
        if (usable[static_cast<std::size_t>(axis)]) {
          Bin& bin = bins[static_cast<std::size_t>(axis)][bin_of(item, axis)];
          bin.box.add(item.box);
          ++bin.count;
        }
      }
    }
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!usable[static_cast<std::size_t>(axis)]) {
        continue;
      }
      const auto& row = bins[static_cast<std::size_t>(axis)];
      std::array<double, kBins> right{};
      Bin sum;
      for (std::size_t k = kBins; k-- > 1;) {
        sum.box.add(row[k].box);
        sum.count += row[k].count;
        right[k] = sum.count == 0 ? 0 : weight(sum.box) * count(sum.count);
      }
      sum = {};
      for (std::size_t k = 0; k + 1 < kBins; ++k) {
        sum.box.add(row[k].box);
        sum.count += row[k].count;
        if (sum.count == 0 || sum.count == items.size()) {
          continue;
        }
        const double cost = weight(sum.box) * count(sum.count) + right[k + 1];
        if (cost < best.cost) {
          best = {cost, axis, k + 1};
        }
      }
    }
    if (best.axis < 0) {
      return halve(items);
    }
    const auto middle = std::partition(
        items.begin(), items.end(), [&](const Item& item) { return bin_of(item, best.axis) < best.first; });
    return static_cast<std::size_t>(middle - items.begin());
  }

  std::size_t cut_between_items(Items items) const {
    Cut best;
    int sorted = -1;
    for (int axis = 0; axis < 3; ++axis) {
      sort_along(items, axis);
      sorted = axis;
      std::array<double, kSweepLimit> right{};
      Box box;
      for (std::size_t k = items.size(); k-- > 1;) {
        box.add(items[k].box);
        right[k] = weight(box) * count(items.size() - k);
      }
      box = {};
      for (std::size_t k = 1; k < items.size(); ++k) {
        box.add(items[k - 1].box);
        const double cost = weight(box) * count(k) + right[k];
        if (cost < best.cost) {
          best = {cost, axis, k};
        }
      }
    }
    if (best.axis < 0) {
      return halve(items);
    }
    if (best.axis != sorted) {
      sort_along(items, best.axis);
    }
    return best.first;
  }

  std::span<const Triangle> triangles_;
  const TreeOptions& options_;
  std::size_t leaf_size_;
  std::vector<Item> items_;
  std::vector<BinaryNode> nodes_;
};

}  // namespace

int ceil_log2(std::size_t count) { return count <= 1 ? 0 : static_cast<int>(std::bit_width(count - 1)); }

BinaryTree build_binary(std::span<const Triangle> triangles, const TreeOptions& options) {
  return Divider(triangles, options).run();
}

}  // namespace raplas
