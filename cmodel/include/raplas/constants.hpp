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
/// bits of a sphere, vertex or triangle ID (the address in its memory)
inline constexpr int kIdBits = 21;
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
/// fixed point: bits of a coordinate, a normal's component, a radius
inline constexpr int kCoordinateBits = 18;
/// fixed point: fraction bits of these three
inline constexpr int kCoordinateFraction = 17;
/// fixed point: bits of a plane's offset (signed); LSB 2^-34
inline constexpr int kOffsetBits = 36;
/// fixed point: bits of n.x + p, radius added or taken off (signed); LSB 2^-34
inline constexpr int kPlaneSumBits = 40;
/// latency of dsp_plane_test, clocks from its first operand
inline constexpr int kPlaneTestStages = 6;
/// depth code: bits of the exponent; code 0 stands for 0
inline constexpr int kDepthExponentBits = 5;
/// depth code: bits of the fraction
inline constexpr int kDepthFractionBits = 10;
/// depth code of (1 + fraction / 2^10) 2^(exponent - 21); codes order as integers
inline constexpr int kDepthBits = 15;
/// depth code: bias of the exponent
inline constexpr int kDepthBias = 21;
/// scan lines: bits of a vertex' row or column on the pencil's grid (signed)
inline constexpr int kGridBits = 16;
/// scan lines: fraction bits of these
inline constexpr int kGridFraction = 5;
/// scan lines: bits of the two exponents in the grid's register
inline constexpr int kGridExponentBits = 5;
/// scan lines: bits of the grid's error class
inline constexpr int kGridErrorBits = 2;
/// scan lines: bits of a reciprocal of 1 .. 2, whose index has DEPTH_FRACTION_BITS
inline constexpr int kReciprocalBits = 17;
/// scan lines: bits of an edge's slope, columns a row (signed)
inline constexpr int kSlopeBits = 18;
/// scan lines: fraction bits of a slope
inline constexpr int kSlopeFraction = 12;
/// scan lines: bits of the column where an edge cuts line 8 (signed)
inline constexpr int kCutBits = 19;
/// scan lines: fraction bits of this column
inline constexpr int kCutFraction = 7;
/// latency of dsp_multiply_add, clocks from its factors
inline constexpr int kMultiplyAddStages = 3;
/// latency of row_interval, clocks: MULTIPLY_ADD_STAGES + 3
inline constexpr int kRowIntervalStages = 6;
/// latency of vertex_grid, clocks: MULTIPLY_ADD_STAGES, the shift before and the slot after
inline constexpr int kVertexGridStages = 5;
/// latency of edge_setup, clocks from the one in which a word is taken
inline constexpr int kEdgeSetupStages = 13;
/// latency of depth_code, clocks
inline constexpr int kDepthCodeStages = 2;
/// depth code: taken off depths, for rays whose t is a little too small
inline constexpr int kDepthMargin = 4;
/// depth code: t / d is below the code that depth_quotient gives plus this
inline constexpr int kQuotientError = 4;
/// certified hits: exponent field of the band of rays whose length is 1
inline constexpr int kBandExponent = 49;
/// certified hits: t' or d below 2^-ROUGH_SHIFT of N's largest component makes the depth rough
inline constexpr int kRoughShift = 2;
/// certified hits: below 2^-UNSURE_SHIFT of it the depth isn't known
inline constexpr int kUnsureShift = 4;
/// certified hits: below 2^-BLIND_SHIFT of it the sign isn't known
inline constexpr int kBlindShift = 10;
/// certified hits: depths less than 3 * 2^-TIE_SHIFT of their power of two apart are a tie
inline constexpr int kTieShift = 8;
/// certified hits: the same of depths of which one is rough, 2^-ROUGH_TIE_SHIFT
inline constexpr int kRoughTieShift = 4;
/// certified hits: depth codes by which a ray's bound lies beyond what QUOTIENT_ERROR asks for
inline constexpr int kBoundMargin = 8;
/// certified hits: the same of a hit whose depth is rough
inline constexpr int kRoughBoundMargin = 32;
/// pencils that the Plane, Ray and Result memories hold
inline constexpr int kPencilBanks = 4;
/// PENCIL_BANKS = 2^2
inline constexpr int kBankBits = 2;
/// 2^2 rays of a row are one word of the host's write port
inline constexpr int kWordRaysLog2 = 2;
/// index of the near plane on the row side, of the depth plane on the column side
inline constexpr int kAxisPlane = 16;
/// index of the down plane on the row side, of the across plane on the column side
inline constexpr int kGridPlane = 17;
/// planes of a pencil on each of the two sides: 16 lines, and those two
inline constexpr int kSidePlanes = 18;
/// bits of a plane's index on its side
inline constexpr int kPlaneIndexBits = 5;
/// entries at the top of the traversal stack among which the nearest comes first
inline constexpr int kSortedRanges = 4;
/// triangles that wait for the selector: 2^6
inline constexpr int kTriangleFifoDepthLog2 = 6;
/// triangles with their edges that wait for the selector: 2^5
inline constexpr int kCutFifoDepthLog2 = 5;
/// rows of triangles that wait for the selector's second half: 2^4
inline constexpr int kRowFifoDepthLog2 = 4;
/// hits that wait for the nearest hit of their ray: 2^6
inline constexpr int kHitFifoDepthLog2 = 6;

/// Place of a field in a memory word.
struct Field {
  int lsb;
  int width;
};

/// node of the sphere tree; children first .. first+count-1: triangles in a leaf, else spheres
struct SphereLayout {
  static constexpr int kBits = 125;
  static constexpr Field cx{101, 24};
  static constexpr Field cy{77, 24};
  static constexpr Field cz{53, 24};
  static constexpr Field r{29, 24};
  static constexpr Field leaf{28, 1};
  static constexpr Field count{21, 7};
  static constexpr Field first{0, 21};
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

/// unit direction; address = bank * 256 + ray ID, four in a word in profile raplas: that / 4
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
  static constexpr int kBits = 65;
  static constexpr Field spheres{43, 22};
  static constexpr Field count{21, 22};
  static constexpr Field first{0, 21};
};

/// nearest hit of a ray: t = t'/d, u = u'/d, v = v'/d; address = bank * 256 + ray ID
struct ResultLayout {
  static constexpr int kBits = 118;
  static constexpr Field hit{117, 1};
  static constexpr Field triangle{96, 21};
  static constexpr Field t{72, 24};
  static constexpr Field d{48, 24};
  static constexpr Field u{24, 24};
  static constexpr Field v{0, 24};
};

/// profile raplas: nearest hit of a ray, and what else it may hit; address = bank * 256 + ray ID
struct RayHitsLayout {
  static constexpr int kBits = 144;
  static constexpr Field hit{143, 1};
  static constexpr Field crowd{142, 1};
  static constexpr Field unsure{141, 1};
  static constexpr Field rough{140, 1};
  static constexpr Field rival{139, 1};
  static constexpr Field rival_rough{138, 1};
  static constexpr Field rival_triangle{117, 21};
  static constexpr Field triangle{96, 21};
  static constexpr Field t{72, 24};
  static constexpr Field d{48, 24};
  static constexpr Field u{24, 24};
  static constexpr Field v{0, 24};
};

/// sphere in fixed point; children first .. first+count-1: vertices in a leaf, else nodes
struct NodeLayout {
  static constexpr int kBits = 101;
  static constexpr Field cx{83, 18};
  static constexpr Field cy{65, 18};
  static constexpr Field cz{47, 18};
  static constexpr Field r{29, 18};
  static constexpr Field leaf{28, 1};
  static constexpr Field count{21, 7};
  static constexpr Field first{0, 21};
};

/// vertex in fixed point, goes to a slot (0..2); emit: slots now hold the triangle
struct VertexLayout {
  static constexpr int kBits = 78;
  static constexpr Field x{60, 18};
  static constexpr Field y{42, 18};
  static constexpr Field z{24, 18};
  static constexpr Field slot{22, 2};
  static constexpr Field emit{21, 1};
  static constexpr Field triangle{0, 21};
};

/// n.x + p = 0, |n| <= 1; two in a word, the row side low; address = bank * 32 + index
struct FixedPlaneLayout {
  static constexpr int kBits = 90;
  static constexpr Field nx{72, 18};
  static constexpr Field ny{54, 18};
  static constexpr Field nz{36, 18};
  static constexpr Field p{0, 36};
};

/// register: band of certified hits; any hit; scan lines; slack; first far depth; address = bank
struct LimitsLayout {
  static constexpr int kBits = 70;
  static constexpr Field band{46, 24};
  static constexpr Field any_hit{45, 1};
  static constexpr Field scale{40, 5};
  static constexpr Field least{35, 5};
  static constexpr Field error{33, 2};
  static constexpr Field slack{15, 18};
  static constexpr Field far{0, 15};
};

/// Targets of the host's write port.
enum class Target : int {
  sphere = 0,
  triangle = 1,
  plane = 2,
  ray = 3,
  pencil = 4,
  scene = 5,
  vertex = 6,
  limits = 7,
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
  vertices_tested = 7,  ///< vertices of triangles given to the plane-sphere testers
};
inline constexpr int kNumCounters = 8;
inline constexpr std::array<std::string_view, kNumCounters> kCounterNames{
    "cycles",
    "spheres_tested",
    "spheres_skipped",
    "plane_tests",
    "pairs_tested",
    "hits",
    "stall_cycles",
    "vertices_tested",
};

}  // namespace raplas
