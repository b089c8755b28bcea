// Groups a binary tree's nodes into a wide tree by dynamic programming.
#include "grouping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raplas {

Grouping::Grouping(const BinaryTree& tree, std::span<const NodeCost> costs, int width, double sphere_clocks)
    : tree_(tree), width_(static_cast<std::size_t>(width)) {
  const std::size_t cells = tree.nodes.size() * width_;
  cost_.assign(cells, std::numeric_limits<float>::infinity());
  choice_.assign(cells, 0);
  for (std::size_t k = tree.nodes.size(); k-- > 0;) {
    const auto node = static_cast<std::uint32_t>(k);
    const BinaryNode& range = tree.nodes[k];
    const NodeCost& cost = costs[k];
    if (std::isfinite(cost.leaf_clocks)) {
      cost_[at(node, 1)] = cost.weight * cost.leaf_clocks;
    }
    if (!range.divided()) {
      continue;
    }
    const std::size_t most = std::min<std::size_t>(width_, range.size());
    for (std::size_t parts = 2; parts <= most; ++parts) {
      for (std::size_t left = 1; left < parts; ++left) {
        const float sum = cost_[at(node + 1, left)] + cost_[at(range.right, parts - left)];
        if (sum < cost_[at(node, parts)]) {
          cost_[at(node, parts)] = sum;
          choice_[at(node, parts)] = static_cast<std::uint8_t>(left);
        }
      }
      const float clocks = static_cast<float>(parts) * static_cast<float>(sphere_clocks);
      const float inner = cost_[at(node, parts)] + cost.weight * clocks;
      if (inner < cost_[at(node, 1)]) {
        cost_[at(node, 1)] = inner;
        choice_[at(node, 1)] = static_cast<std::uint8_t>(parts);
      }
    }
  }
}

std::vector<std::uint32_t> Grouping::children(std::uint32_t node) const {
  std::vector<std::uint32_t> found;
  const std::size_t parts = choice_[at(node, 1)];
  collect(node, std::max<std::size_t>(parts, 1), found);
  return found;
}

void Grouping::collect(std::uint32_t node, std::size_t parts, std::vector<std::uint32_t>& into) const {
  if (parts == 1) {
    into.push_back(node);
    return;
  }
  const std::size_t left = choice_[at(node, parts)];
  collect(node + 1, left, into);
  collect(tree_.nodes[node].right, parts - left, into);
}

std::size_t Grouping::spheres() const {
  std::size_t count = 0;
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const std::uint32_t node = waiting.back();
    waiting.pop_back();
    const auto below = children(node);
    if (below.size() > 1) {
      count += below.size();
      waiting.insert(waiting.end(), below.begin(), below.end());
    }
  }
  return std::max<std::size_t>(count, 1);
}

}  // namespace raplas
