// Ray-triangle test and nearest hit, value-exact: entities ray_solver, ray_triangle, nearest_hit and
// depth_quotient.
#pragma once

#include <cstdint>

#include "raplas/words.hpp"

namespace raplas {

inline constexpr int kRaySolverStages =
    kAddStages + (kMulStages + kAddStages) + (kMulStages + 2 * kAddStages) + kAddStages;
inline constexpr int kRayTriangleStages = kRaySolverStages + kMulStages;

/// What a triangle is to a ray: t = t'/d, u = u'/d, v = v'/d, after the sign rule.
template <typename F>
struct Solution {
  bool hit = false;
  F t;  ///< t'
  F d;  ///< |N.D|
  F u;  ///< u'
  F v;  ///< v'
};

/// Moeller's test without the division, 33 operations; the sign of N.D goes into t', u', v' and N.D.
template <typename F>
[[nodiscard]] constexpr Solution<F> solve(const TriangleWord<F>& triangle, const Vec3<F>& origin,
                                          const Vec3<F>& direction) noexcept {
  const Vec3<F> t = triangle.v0 - origin;   // s4
  const Vec3<F> dxt = cross(direction, t);  // s11
  const F nd = dot(triangle.n, direction);  // s22
  const F nt = dot(triangle.n, t);          // s22
  const F dxt_e2 = dot(dxt, triangle.e2);   // s22
  const F dxt_e1 = dot(dxt, triangle.e1);   // s22
  const auto flip = [](F x, bool sign) { return sign ? x.negated() : (x.is_zero() ? F() : x); };
  Solution<F> s{false, flip(nt, nd.sign()), flip(nd, nd.sign()), flip(dxt_e2, !nd.sign()),
                flip(dxt_e1, nd.sign())};
  const F sum = s.u + s.v;  // s26
  s.hit = !s.t.sign() && !s.t.is_zero() && !s.d.is_zero() && !s.u.sign() && !s.v.sign() &&
          sum.magnitude() <= s.d.magnitude();
  return s;
}

/// t'/d as a depth code, at most 3 codes too low; signs are ignored, and a zero's fraction is taken as a
/// number's. Codes below 2^kDepthFractionBits go on downward with exponent 0; the largest is the last but
/// one.
template <typename F>
[[nodiscard]] constexpr std::uint32_t depth_quotient(F t, F d) noexcept {
  static_assert(F::kFractionBits == kFractionBits && F::kExponentBits == kExponentBits);
  constexpr std::uint32_t kHidden = std::uint32_t{1} << kFractionBits;
  constexpr std::uint32_t kOne = std::uint32_t{1} << kDepthFractionBits;
  constexpr std::uint32_t kLast = (std::uint32_t{1} << kDepthBits) - 2;
  const std::uint32_t top = (d.bits() & (kHidden - 1)) >> (kFractionBits - kDepthFractionBits);
  const std::uint32_t reciprocal = 2 * kOne * kOne / (kOne + 1 + top);                // s1
  const std::uint32_t product = ((t.bits() & (kHidden - 1)) | kHidden) * reciprocal;  // s3
  const bool carry = product >> (kFractionBits + kDepthFractionBits + 1) != 0;
  const int exponent = t.exponent() - d.exponent() + kDepthBias - (carry ? 0 : 1);
  const std::uint32_t fraction = (product >> (kFractionBits + (carry ? 1 : 0))) & (kOne - 1);
  if (exponent < 0) {
    return 0;
  }
  if (exponent >= 1 << kDepthExponentBits) {
    return kLast;
  }
  const std::uint32_t code = static_cast<std::uint32_t>(exponent) * kOne + fraction;
  return code < kLast ? code : kLast;
}

/// t'/d < best.t'/best.d in exact arithmetic; equal: the lower triangle ID; no best hit yet: yes.
template <typename F>
[[nodiscard]] constexpr bool nearer(F t, F d, std::uint32_t triangle, const ResultWord<F>& best) noexcept {
  if (!best.hit) {
    return true;
  }
  const ExactProduct here = exact_product(t, best.d);
  const ExactProduct there = exact_product(best.t, d);
  return here < there || (here == there && triangle < best.triangle);
}

}  // namespace raplas
