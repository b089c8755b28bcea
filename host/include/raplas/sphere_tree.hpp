// Bounding spheres over triangles: the paper's flat list, and a tree.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "raplas/device.hpp"

namespace raplas {

/// How ranges of triangles are cut in two.
enum class TreeBuilder {
  median,   ///< at the median along the longest axis; leaves are full
  surface,  ///< least sum of surface times number, over boxes
  pencil    ///< least sum of (footprint + radius)^2 times number: spheres that a pencil meets
};

/// TreeOptions::longest_edge with which no triangle is cut.
inline constexpr double kWholeTriangles = std::numeric_limits<double>::infinity();

struct TreeOptions {
  int leaf_size = 4;                          ///< most pieces of a leaf, 1 .. 127
  int width = 4;                              ///< most children of an inner node, 2 .. 127 (tree only)
  TreeBuilder builder = TreeBuilder::pencil;  ///< (tree only)
  double footprint = 0.06;  ///< half the width of a usual pencil at the scene, in the scene's unit (pencil)
  double longest_edge = 0.25;      ///< triangles with a longer one are cut into pieces (tree only)
  double extra_pieces = 1.0 / 32;  ///< most pieces that are added, as a share of the triangles (tree only)
  int root_width = 8;              ///< children that the root gets at least, if there are as many (tree only)
};

/// A device's scene without max_origin, and where its triangles came from.
struct SphereTree {
  DeviceScene scene;
  std::vector<std::uint32_t> source;  ///< by triangle ID: its index in the list that was built from
};

/// One level: all spheres are leaves and the root range holds them all, neighbours in space near each other.
/// Triangles of more than 4 times the median size come last; then ranges are halved at the median centroid
/// along their longest axis until they fit a leaf. Throws std::runtime_error if there are no triangles, an
/// option is out of range, or IDs don't fit kIdBits.
[[nodiscard]] SphereTree build_flat(std::span<const Triangle> triangles, const TreeOptions& options = {});

/// A tree; the root range is the root's children. Children of one node lie next to each other, and so do the
/// pieces below a node. Triangle IDs are in the order of their first pieces. docs/host.md says how large
/// triangles are cut, and how each builder makes the tree. Errors as build_flat().
[[nodiscard]] SphereTree build_tree(std::span<const Triangle> triangles, const TreeOptions& options = {});

/// Most ranges that may wait on the traversal stack: what the watermark and the leaves in flight leave of it.
inline constexpr int kMaxStacked = kStackDepth - kStackWatermark - kLeafFifoDepth;

/// Verifies what the devices rely on: every node and piece is reached exactly once, the pieces of each
/// triangle are all of it and don't overlap, counts are 1 .. 127, IDs fit, the pieces below a node lie next
/// to each other, centres are fp24 numbers, each sphere encloses the pieces below it, and on every path from
/// the root the ranges have sum of (count - 1) <= kMaxStacked. Throws std::runtime_error naming the node or
/// triangle that fails.
void check_tree(const DeviceScene& scene);

}  // namespace raplas
