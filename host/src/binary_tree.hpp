// Triangles in an order in which every part of a scene is a range, and the binary tree of these ranges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raplas/device.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {

/// A range of triangles. Its left half is the next node of the list.
struct BinaryNode {
  std::uint32_t begin;
  std::uint32_t end;
  std::uint32_t right;  ///< the right half's index; 0: not divided

  [[nodiscard]] std::uint32_t size() const { return end - begin; }
  [[nodiscard]] bool divided() const { return right != 0; }
};

struct BinaryTree {
  std::vector<BinaryNode> nodes;     ///< every node before its halves; the root is first
  std::vector<std::uint32_t> order;  ///< triangles, as indices of the list that was built from
};

/// Smallest d with 2^d >= count.
[[nodiscard]] int ceil_log2(std::size_t count);

/// Divides until ranges are leaves (median) or single triangles. No node of more than a leaf lies below more
/// than kMaxStacked others: where that is near, ranges are halved.
[[nodiscard]] BinaryTree build_binary(std::span<const Triangle> triangles, const TreeOptions& options);

}  // namespace raplas
