// What a ray hits in exact arithmetic: double precision with a certified bound, and exact reals where that
// leaves the verdict, or the order of two hits, open.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "raplas/device.hpp"

namespace raplas {

/// The hits of a ray in exact arithmetic, edges and corners included.
struct TrueHits {
  std::vector<std::uint32_t> nearest;     ///< all triangles that are hit first, ascending; empty: none is hit
  std::vector<std::uint32_t> candidates;  ///< triangles whose spheres the ray meets: all hits are among them
  double t = 0;                           ///< of the nearest, to 2^-30
  double t_last = 0;                      ///< of the farthest, to 2^-30
  std::uint32_t exact_pairs = 0;          ///< how many triangles exact reals were needed for
};

/// Triangles in a tree of its own.
class ExactTruth {
 public:
  explicit ExactTruth(std::span<const Triangle> triangles);

  /// IDs are indices of the triangles as given. `direction` has unit length.
  [[nodiscard]] TrueHits hits(const glm::dvec3& origin, const glm::dvec3& direction) const;

 private:
  DeviceScene scene_;
  std::vector<std::uint32_t> source_;  ///< by ID in the tree: index as given
};

}  // namespace raplas
