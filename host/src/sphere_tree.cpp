// Builds sphere trees: a binary tree of ranges, nodes of it grouped into wide ones, a ball around each.
#include "raplas/sphere_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "binary_tree.hpp"
#include "grouping.hpp"
#include "pieces.hpp"
#include "raplas/bounding_sphere.hpp"
#include "triangle_points.hpp"

namespace raplas {
namespace {

constexpr std::size_t kMaxIds = std::size_t{1} << kIdBits;

void check_ids(std::size_t count, const char* what) {
  if (count > kMaxIds) {
    throw std::runtime_error(fmt::format("{} {}, IDs of {} bits allow {}", count, what, kIdBits, kMaxIds));
  }
}

void check_input(std::size_t triangles, const TreeOptions& options) {
  constexpr int kMaxCount = (1 << kCountBits) - 1;
  if (options.leaf_size < 1 || options.leaf_size > kMaxCount) {
    throw std::runtime_error(fmt::format("leaf size {} is not in 1 to {}", options.leaf_size, kMaxCount));
  }
  if (options.width < 2 || options.width > kMaxCount) {
    throw std::runtime_error(fmt::format("tree width {} is not in 2 to {}", options.width, kMaxCount));
  }
  if (triangles == 0) {
    throw std::runtime_error("no triangles to put into spheres");
  }
  check_ids(triangles, "triangles");
}

class Builder {
 public:
  /// `pieces` empty: whole triangles.
  Builder(std::span<const Triangle> triangles, std::vector<Piece> pieces, const TreeOptions& options)
      : triangles_(triangles), pieces_(std::move(pieces)), options_(options) {
    binary_ = build_binary(pieces_.empty() ? triangles : shapes_of(triangles, pieces_), options);
    vertices_.reserve(3 * binary_.order.size());
    stored_.reserve(3 * binary_.order.size());
    for (const std::uint32_t k : binary_.order) {
      const Piece piece = pieces_.empty() ? Piece{k} : pieces_[k];
      const PiecePoints points = points_of(triangles[piece.triangle], piece);
      vertices_.insert(vertices_.end(), points.vertices.begin(), points.vertices.end());
      stored_.insert(stored_.end(), points.stored.begin(), points.stored.end());
    }
    if (options.builder != TreeBuilder::median) {
      group();
    }
    find_levels();
  }

  /// Appends the binary tree's leaves in order.
  void add_leaves() {
    for (const BinaryNode& range : binary_.nodes) {
      if (!range.divided()) {
        nodes_.push_back(leaf(range));
      }
    }
  }

  /// Appends the children of a binary node, then what is below them. Returns their number. On the way from
  /// here down the ranges may have sum of (count - 1) <= room.
  std::size_t add_children(std::uint32_t node, int room) {
    const std::vector<std::uint32_t> parts = children(node, room);
    const std::size_t first = nodes_.size();
    nodes_.resize(first + parts.size());
    const int left = room - static_cast<int>(parts.size() - 1);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const BinaryNode& range = binary_.nodes[parts[k]];
      if (is_leaf(parts[k], left)) {
        nodes_[first + k] = leaf(range);
      } else {
        SphereNode sphere = sphere_around(range);
        sphere.first = static_cast<std::uint32_t>(nodes_.size());
        sphere.count = static_cast<std::uint32_t>(add_children(parts[k], left));
        nodes_[first + k] = sphere;
      }
    }
    return parts.size();
  }

  SphereTree finish(std::size_t root_count) {
    check_ids(nodes_.size(), "spheres");
    SphereTree tree;
    tree.scene.nodes = std::move(nodes_);
    tree.scene.root_first = 0;
    tree.scene.root_count = static_cast<std::uint32_t>(root_count);
    if (pieces_.empty()) {
      tree.source = std::move(binary_.order);
    } else {
      number_by_first_piece(tree);
    }
    tree.scene.triangles.reserve(triangles_.size());
    for (const std::uint32_t k : tree.source) {
      tree.scene.triangles.push_back(triangles_[k]);
    }
    return tree;
  }

  [[nodiscard]] std::size_t node_count() const { return nodes_.size(); }

 private:
  /// The pieces as triangles.
  static std::vector<Triangle> shapes_of(std::span<const Triangle> triangles, std::span<const Piece> pieces) {
    std::vector<Triangle> shapes;
    shapes.reserve(pieces.size());
    for (const Piece& piece : pieces) {
      const auto& corners = points_of(triangles[piece.triangle], piece).vertices;
      shapes.push_back({corners[0], corners[1] - corners[0], corners[2] - corners[0]});
    }
    return shapes;
  }

  /// Triangle IDs in the order in which the tree comes to the triangles.
  void number_by_first_piece(SphereTree& tree) const {
    constexpr std::uint32_t kNone = ~0U;
    std::vector<std::uint32_t> ids(triangles_.size(), kNone);
    tree.scene.pieces.reserve(pieces_.size());
    for (const std::uint32_t k : binary_.order) {
      Piece piece = pieces_[k];
      std::uint32_t& id = ids[piece.triangle];
      if (id == kNone) {
        id = static_cast<std::uint32_t>(tree.source.size());
        tree.source.push_back(piece.triangle);
      }
      piece.triangle = id;
      tree.scene.pieces.push_back(piece);
    }
  }

  [[nodiscard]] bool fits_leaf(std::uint32_t node) const {
    return binary_.nodes[node].size() <= static_cast<std::uint32_t>(options_.leaf_size);
  }

  [[nodiscard]] bool is_leaf(std::uint32_t node, int room) const {
    return fits_leaf(node) && (!grouping_ || room < 1 || grouping_->children(node).size() == 1);
  }

  /// The parts that become the children's spheres: what the builder wants, or the two halves where wider
  /// ranges would not leave the ranges below enough room.
  [[nodiscard]] std::vector<std::uint32_t> children(std::uint32_t node, int room) const {
    std::vector<std::uint32_t> parts = node == 0 ? root_children() : wanted_children(node);
    const int left = room - static_cast<int>(parts.size() - 1);
    if (binary_.nodes[node].divided() &&
        std::any_of(parts.begin(), parts.end(), [&](std::uint32_t part) { return levels_[part] > left; })) {
      parts = {node + 1, binary_.nodes[node].right};
    }
    return parts;
  }

  [[nodiscard]] std::vector<std::uint32_t> wanted_children(std::uint32_t node) const {
    return grouping_ ? grouping_->children(node) : largest_halved(node);
  }

  /// The largest child's children in its place until there are `root_width`: nothing else is under test when
  /// a walk begins, and a level less to go down saves more clocks than the tests of a few spheres take.
  [[nodiscard]] std::vector<std::uint32_t> root_children() const {
    std::vector<std::uint32_t> parts = wanted_children(0);
    while (parts.size() < static_cast<std::size_t>(options_.root_width)) {
      const auto largest =
          std::max_element(parts.begin(), parts.end(), [this](std::uint32_t a, std::uint32_t b) {
            return binary_.nodes[a].size() < binary_.nodes[b].size();
          });
      if (is_leaf(*largest, kMaxStacked)) {
        break;
      }
      const std::vector<std::uint32_t> below = wanted_children(*largest);
      parts.insert(parts.erase(largest), below.begin(), below.end());
    }
    return parts;
  }

  /// Halves the largest part until there are `width` or all are leaves.
  [[nodiscard]] std::vector<std::uint32_t> largest_halved(std::uint32_t node) const {
    std::vector<std::uint32_t> parts{node};
    const auto smaller = [this](std::uint32_t a, std::uint32_t b) {
      return binary_.nodes[a].size() < binary_.nodes[b].size();
    };
    while (parts.size() < static_cast<std::size_t>(options_.width)) {
      const auto largest = std::max_element(parts.begin(), parts.end(), smaller);
      if (fits_leaf(*largest)) {
        break;
      }
      const std::uint32_t whole = *largest;
      *largest = whole + 1;
      parts.insert(largest + 1, binary_.nodes[whole].right);
    }
    return parts;
  }

  /// Levels of ranges that a walk down the binary tree stacks.
  void find_levels() {
    levels_.assign(binary_.nodes.size(), 0);
    for (std::size_t k = binary_.nodes.size(); k-- > 0;) {
      if (!fits_leaf(static_cast<std::uint32_t>(k))) {
        levels_[k] = 1 + std::max(levels_[k + 1], levels_[binary_.nodes[k].right]);
      }
    }
  }

  void group() {
    std::vector<NodeCost> costs;
    costs.reserve(binary_.nodes.size());
    const double footprint = options_.builder == TreeBuilder::pencil ? options_.footprint : 0;
    for (std::uint32_t k = 0; k < binary_.nodes.size(); ++k) {
      const BinaryNode& range = binary_.nodes[k];
      const double reach = footprint + bounding_ball(vertices_of(range)).radius;
      costs.push_back({static_cast<float>(reach * reach),
                       fits_leaf(k) ? leaf_clocks(range) : std::numeric_limits<float>::infinity()});
    }
    // Dearer spheres make larger leaves: when there are more spheres than IDs.
    constexpr double kDearest = 64;
    double sphere_clocks = 1;
    do {
      grouping_.emplace(binary_, costs, options_.width, sphere_clocks);
      sphere_clocks *= 2;
    } while (sphere_clocks <= kDearest && grouping_->spheres() > kMaxIds);
  }

  /// Different vertices: about the words of the leaf's strip.
  [[nodiscard]] float leaf_clocks(BinaryNode range) const {
    const auto vertices = vertices_of(range);
    int different = 0;
    for (auto p = vertices.begin(); p != vertices.end(); ++p) {
      different += std::find(vertices.begin(), p, *p) == p ? 1 : 0;
    }
    return static_cast<float>(different);
  }

  [[nodiscard]] std::span<const glm::dvec3> vertices_of(BinaryNode range) const {
    return std::span(vertices_).subspan(3 * std::size_t{range.begin}, 3 * std::size_t{range.size()});
  }

  [[nodiscard]] SphereNode sphere_around(BinaryNode range) const {
    const auto vertices = vertices_of(range);
    const auto stored = std::span(stored_).subspan(3 * std::size_t{range.begin}, vertices.size());
    const glm::dvec3 centre = as_stored(bounding_ball(vertices).centre);
    const double radius = std::max(enclosing_radius(vertices, centre), enclosing_radius(stored, centre));
    return {centre, radius, false, 0, 0};
  }

  [[nodiscard]] SphereNode leaf(BinaryNode range) const {
    SphereNode node = sphere_around(range);
    node.leaf = true;
    node.first = range.begin;
    node.count = range.size();
    return node;
  }

  std::span<const Triangle> triangles_;
  std::vector<Piece> pieces_;  ///< empty: whole triangles
  TreeOptions options_;
  BinaryTree binary_;
  std::vector<glm::dvec3> vertices_;  ///< in the tree's order, as stored_
  std::vector<glm::dvec3> stored_;
  std::optional<Grouping> grouping_;  ///< none for the median
  std::vector<int> levels_;
  std::vector<SphereNode> nodes_;
};

}  // namespace

SphereTree build_flat(std::span<const Triangle> triangles, const TreeOptions& options) {
  check_input(triangles.size(), options);
  TreeOptions median = options;
  median.builder = TreeBuilder::median;
  Builder builder(triangles, {}, median);
  builder.add_leaves();
  return builder.finish(builder.node_count());
}

SphereTree build_tree(std::span<const Triangle> triangles, const TreeOptions& options) {
  check_input(triangles.size(), options);
  Builder builder(triangles, cut_large(triangles, options), options);
  return builder.finish(builder.add_children(0, kMaxStacked));
}

}  // namespace raplas
