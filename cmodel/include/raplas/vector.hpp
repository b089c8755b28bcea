// Vectors of the accelerator's numbers, with sums in the RTL's order.
#pragma once

#include "raplas/float.hpp"

namespace raplas {

/// Three numbers of one format.
template <typename F>
struct Vec3 {
  F x;
  F y;
  F z;

  friend constexpr bool operator==(const Vec3&, const Vec3&) noexcept = default;
};

/// a - b, rounded.
template <typename F>
[[nodiscard]] constexpr Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// (ax*bx + ay*by) + az*bz, each operation rounded: fp_dot3.
template <typename F>
[[nodiscard]] constexpr F dot(const Vec3<F>& a, const Vec3<F>& b) noexcept {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// a x b, each operation rounded: fp_cross.
template <typename F>
[[nodiscard]] constexpr Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace raplas
