// Which nodes of a binary tree become the spheres of a wide one.
#pragma once

#include <span>
#include <vector>

#include "binary_tree.hpp"

namespace raplas {

/// What a node of the binary tree costs: how often it is met, and the clocks of its triangles as a leaf.
struct NodeCost {
  float weight;
  float leaf_clocks;  ///< infinite: too many triangles for a leaf
};

/// The cheapest wide tree over a binary tree: a node's cost is weight * (clocks of its leaf), or weight *
/// (number of children * sphere_clocks) and its children's cost. Found for all nodes bottom up
/// by the least cost of j = 1 .. width spheres below each. Source: H. Ylitie, T. Karras, S. Laine 2017,
/// section 3.
class Grouping {
 public:
  Grouping(const BinaryTree& tree, std::span<const NodeCost> costs, int width, double sphere_clocks);

  /// The nodes that become the children of the sphere of `node`, at least 2; only `node` itself if it is
  /// a leaf.
  [[nodiscard]] std::vector<std::uint32_t> children(std::uint32_t node) const;

  /// Spheres of the whole tree.
  [[nodiscard]] std::size_t spheres() const;

 private:
  [[nodiscard]] std::size_t at(std::uint32_t node, std::size_t parts) const {
    return node * width_ + parts - 1;
  }
  void collect(std::uint32_t node, std::size_t parts, std::vector<std::uint32_t>& into) const;

  const BinaryTree& tree_;
  std::size_t width_;
  std::vector<float> cost_;
  std::vector<std::uint8_t> choice_;  ///< parts > 1: parts on the left; parts = 1: children, 0 for a leaf
};

}  // namespace raplas
