// Generated from raplas.toml by scripts/constants.py: change it there.
// Format widths, stage counts, memory word layouts and counter names shared with the RTL.
// clang-format off
#pragma once

#include <array>
#include <string_view>

namespace raplas {

/// fp24: bits of the exponent field
inline constexpr int kExponentBits = 7;
/// fp24: bits of the fraction field; the significand has one more, the hidden one
inline constexpr int kFractionBits = 16;
/// fp24: value = significand * 2^(exponent - EXPONENT_BIAS - FRACTION_BITS)
inline constexpr int kExponentBias = 63;
/// fp24: width of a word: sign, exponent, fraction
inline constexpr int kFpBits = 24;
/// latency of fp_add, clocks
inline constexpr int kAddStages = 4;
/// latency of fp_mul, clocks
inline constexpr int kMulStages = 3;
/// latency of the compare at the end of a plane-sphere tester, clocks
inline constexpr int kCompareStages = 1;
/// latency of every memory read port, clocks
inline constexpr int kMemoryStages = 2;
/// most row planes of a pencil (M)
inline constexpr int kMaxRows = 16;
/// most column planes of a pencil (N)
inline constexpr int kMaxColumns = 16;
/// bits of a row or column number; ray ID = row * MAX_COLUMNS + column
inline constexpr int kLineBits = 4;
/// bits of a sphere or triangle ID (the address in its memory)
inline constexpr int kIdBits = 20;
/// bits of the number of children (spheres or triangles) of a node
inline constexpr int kCountBits = 7;
/// bits of each event counter
inline constexpr int kCounterBits = 32;
/// entries of the traversal stack
inline constexpr int kStackDepth = 128;
/// STACK_DEPTH = 2^7
inline constexpr int kStackDepthLog2 = 7;
/// from this many stacked ranges on the traversal takes one range at a time
inline constexpr int kStackWatermark = 48;
/// leaves waiting for the selector
inline constexpr int kLeafFifoDepth = 32;
/// LEAF_FIFO_DEPTH = 2^5
inline constexpr int kLeafFifoDepthLog2 = 5;
/// (ray, triangle) pairs waiting for the ray-triangle subunit
inline constexpr int kPairFifoDepth = 16;
/// PAIR_FIFO_DEPTH = 2^4
inline constexpr int kPairFifoDepthLog2 = 4;

/// Place of a field in a memory word.
struct Field {
  int lsb;
  int width;
};

/// node of the sphere tree; children first .. first+count-1: triangles in a leaf, else spheres
struct SphereLayout {
  static constexpr int kBits = 124;
  static constexpr Field cx{100, 24};
  static constexpr Field cy{76, 24};
  static constexpr Field cz{52, 24};
  static constexpr Field r{28, 24};
  static constexpr Field leaf{27, 1};
  static constexpr Field count{20, 7};
  static constexpr Field first{0, 20};
};

/// vertex V0, edges E1 = V1-V0 and E2 = V2-V0, normal N = E1 x E2
struct TriangleLayout {
  static constexpr int kBits = 288;
  static constexpr Field v0x{264, 24};
  static constexpr Field v0y{240, 24};
  static constexpr Field v0z{216, 24};
  static constexpr Field e1x{192, 24};
  static constexpr Field e1y{168, 24};
  static constexpr Field e1z{144, 24};
  static constexpr Field e2x{120, 24};
  static constexpr Field e2y{96, 24};
  static constexpr Field e2z{72, 24};
  static constexpr Field nx{48, 24};
  static constexpr Field ny{24, 24};
  static constexpr Field nz{0, 24};
};

/// n.x + p = 0, n of unit length; address = bank * 32 + (row, or 16 + column)
struct PlaneLayout {
  static constexpr int kBits = 96;
  static constexpr Field nx{72, 24};
  static constexpr Field ny{48, 24};
  static constexpr Field nz{24, 24};
  static constexpr Field p{0, 24};
};

/// unit direction; address = bank * 256 + ray ID
struct RayLayout {
  static constexpr int kBits = 72;
  static constexpr Field dx{48, 24};
  static constexpr Field dy{24, 24};
  static constexpr Field dz{0, 24};
};

/// register: common origin and size of a pencil (rows 1..16, columns 1..16); address = bank
struct PencilLayout {
  static constexpr int kBits = 82;
  static constexpr Field rows{77, 5};
  static constexpr Field columns{72, 5};
  static constexpr Field ox{48, 24};
  static constexpr Field oy{24, 24};
  static constexpr Field oz{0, 24};
};

/// register: root range of the sphere tree, and number of spheres in the memory
struct SceneLayout {
  static constexpr int kBits = 62;
  static constexpr Field spheres{41, 21};
  static constexpr Field count{20, 21};
  static constexpr Field first{0, 20};
};

/// nearest hit of a ray: t = t'/d, u = u'/d, v = v'/d; address = bank * 256 + ray ID
struct ResultLayout {
  static constexpr int kBits = 117;
  static constexpr Field hit{116, 1};
  static constexpr Field triangle{96, 20};
  static constexpr Field t{72, 24};
  static constexpr Field d{48, 24};
  static constexpr Field u{24, 24};
  static constexpr Field v{0, 24};
};

/// Targets of the host's write port.
enum class Target : int {
  sphere = 0,
  triangle = 1,
  plane = 2,
  ray = 3,
  pencil = 4,
  scene = 5,
};

/// Event counters, in the order of the RTL's counter bus.
enum class Counter : int {
  cycles = 0,  ///< clocks with busy_o = 1
  spheres_tested = 1,  ///< spheres given to the plane-sphere testers
  spheres_skipped = 2,  ///< spheres never read because an ancestor was dropped
  plane_tests = 3,  ///< tests of one plane against one sphere
  pairs_tested = 4,  ///< (ray, triangle) pairs given to the ray-triangle subunit
  hits = 5,  ///< rays that hit a triangle
  stall_cycles = 6,  ///< clocks in which a pair waited for an earlier pair of the same ray
};
inline constexpr int kNumCounters = 7;
inline constexpr std::array<std::string_view, kNumCounters> kCounterNames{
    "cycles",
    "spheres_tested",
    "spheres_skipped",
    "plane_tests",
    "pairs_tested",
    "hits",
    "stall_cycles",
};

}  // namespace raplas
