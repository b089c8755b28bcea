// The triangles of a leaf as words of the Vertex Memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raplas/fixed_point.hpp"

namespace raplas {

/// A triangle by its corners; corners with equal coordinates are one vertex.
struct FixedTriangle {
  std::array<FixedVec3, 3> corners;
  std::uint32_t id;
};

/// Most triangles for which make_strip() gives the least number of words.
inline constexpr std::size_t kMaxExactStrip = 8;

/// Words that put each triangle once into the three slots, in an order of few words: a triangle takes over
/// the vertices that it shares with the one before, 1 to 3 words are new. Up to kMaxExactStrip triangles: the
/// least number of words; above: each time a triangle that needs least, from the best first one. Which of the
/// corners lies in which slot is left open.
[[nodiscard]] std::vector<VertexWord> make_strip(std::span<const FixedTriangle> triangles);

}  // namespace raplas
