// Plane-sphere test: value-exact, and the decoder that joins the flags of a pencil's planes.
#pragma once

#include <cstdint>

#include "raplas/clocked.hpp"
#include "raplas/words.hpp"

namespace raplas {

inline constexpr int kTesterStages = kMulStages + 2 * kAddStages + kCompareStages;

/// Signed distance of a point from a plane: (nx*cx + ny*cy) + (nz*cz + p), each operation rounded.
template <typename F>
[[nodiscard]] constexpr F plane_distance(const PlaneWord<F>& plane, const Vec3<F>& point) noexcept {
  return (plane.normal.x * point.x + plane.normal.y * point.y) + (plane.normal.z * point.z + plane.offset);
}

/// |n.c + p| <= r: plane_sphere_tester.
template <typename F>
[[nodiscard]] constexpr bool plane_meets_sphere(const PlaneWord<F>& plane, const Vec3<F>& centre,
                                                F radius) noexcept {
  return plane_distance(plane, centre).magnitude() <= radius.magnitude();
}

/// Flags of one plane set: bit k belongs to tester k.
struct PlaneFlags {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
};

/// What the decoder says of a sphere in the clock in which it leaves the testers.
struct Decision {
  bool decided = false;
  bool leaf = false;  ///< a leaf that meets a row and a column
  bool push = false;  ///< an inner node that meets a row and a column
  std::uint32_t row_mask = 0;
  std::uint32_t column_mask = 0;
};

/// Entity plane_sphere_decoder.
class PlaneSphereDecoder {
 public:
  PlaneSphereDecoder(int row_testers, int column_testers) noexcept
      : row_testers_(row_testers), column_testers_(column_testers) {}

  [[nodiscard]] const Decision& out() const noexcept { return r_; }

  /// One clock: flags of plane set `set` of a sphere, for a pencil of rows x columns rays.
  void clock(int rows, int columns, bool valid, int set, bool last, bool leaf, PlaneFlags flags) noexcept {
    if (valid) {
      if (set == 0) {
        r_.row_mask = 0;
        r_.column_mask = 0;
      }
      r_.row_mask |= lines(flags.rows, row_testers_, set, rows);
      r_.column_mask |= lines(flags.columns, column_testers_, set, columns);
    }
    r_.decided = valid && last;
    const bool meet = r_.decided && r_.row_mask != 0 && r_.column_mask != 0;
    r_.leaf = meet && leaf;
    r_.push = meet && !leaf;
  }

 private:
  static constexpr std::uint32_t low_bits(int count) noexcept { return (std::uint32_t{1} << count) - 1; }

  /// The flags of a set at the places of its lines; those beyond the pencil's `count` are dropped.
  static constexpr std::uint32_t lines(std::uint32_t flags, int testers, int set, int count) noexcept {
    const std::uint64_t placed =
        set * testers < 32 ? std::uint64_t{flags & low_bits(testers)} << (set * testers) : 0;
    return static_cast<std::uint32_t>(placed) & low_bits(count);
  }

  int row_testers_;
  int column_testers_;
  Decision r_;
};

}  // namespace raplas
