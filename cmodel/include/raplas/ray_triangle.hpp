// Ray-triangle test and nearest hit, value-exact: entities ray_solver, ray_triangle, nearest_hit and
// depth_quotient.
#pragma once

#include <algorithm>
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
  F t;                  ///< t'
  F d;                  ///< |N.D|
  F u;                  ///< u'
  F v;                  ///< v'
  bool rough = false;   ///< of a certified hit: t'/d may be some percent from t
  bool unsure = false;  ///< or says nothing of t
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

/// The same with certified hits, if `band` isn't 0: a hit is what may be one, where u', v' and d - u' - v'
/// are off by at most `band`, and t' and d are too if they are small beside N (docs/exact.md).
template <typename F>
[[nodiscard]] constexpr Solution<F> solve(const TriangleWord<F>& triangle, const Vec3<F>& origin,
                                          const Vec3<F>& direction, F band) noexcept {
  Solution<F> s = solve(triangle, origin, direction);
  if (band.is_zero()) {
    return s;
  }
  const int normal = std::max({triangle.n.x.exponent(), triangle.n.y.exponent(), triangle.n.z.exponent()});
  const int normal_d =
      normal + band.exponent() - kBandExponent;  // d grows with the ray's length, as the band
  const auto small_t = [&](int shift) { return s.t.exponent() + shift < normal; };
  const auto small_d = [&](int shift) { return s.d.exponent() + shift < normal_d; };
  const auto not_below = [band](F x) { return !x.sign() || x.magnitude() <= band.magnitude(); };
  const F sum = s.u + s.v;    // s26
  const F most = s.d + band;  // s26
  const bool inside = not_below(s.u) && not_below(s.v) && (sum.sign() || sum.magnitude() <= most.magnitude());
  const bool before = (!s.t.sign() && !s.t.is_zero()) || small_t(kBlindShift);
  s.hit = small_d(kBlindShift) || (inside && before && !s.d.is_zero());
  s.rough = small_d(kRoughShift) || small_t(kRoughShift);
  s.unsure = small_d(kUnsureShift) || small_t(kUnsureShift);
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

/// How t'/d of two hits compare, in exact arithmetic.
struct DepthOrder {
  bool nearer = false;     ///< the first is less deep; equal: it has the lower triangle ID
  bool tie = false;        ///< they are less than 3 * 2^-kTieShift of their power of two apart
  bool rough_tie = false;  ///< they are less than 2^-kRoughTieShift of it apart
};

template <typename F>
[[nodiscard]] constexpr DepthOrder depth_order(F t, F d, std::uint32_t triangle,
                                               const ResultWord<F>& best) noexcept {
  constexpr int kProductFraction = 2 * F::kFractionBits + 1;
  constexpr std::int64_t kOctave = std::int64_t{1} << kProductFraction;
  const ExactProduct here = exact_product(t, best.d);
  const ExactProduct there = exact_product(best.t, d);
  const std::int64_t apart = (here.exponent - there.exponent) * kOctave +
                             static_cast<std::int64_t>(here.significand) -
                             static_cast<std::int64_t>(there.significand);
  const auto within = [apart](std::int64_t most) { return apart >= -most && apart < most; };
  return {apart < 0 || (apart == 0 && triangle < best.triangle), within(3 * (kOctave >> kTieShift)),
          within(kOctave >> kRoughTieShift)};
}

/// t'/d < best.t'/best.d in exact arithmetic; equal: the lower triangle ID; no best hit yet: yes.
template <typename F>
[[nodiscard]] constexpr bool nearer(F t, F d, std::uint32_t triangle, const ResultWord<F>& best) noexcept {
  return !best.hit || depth_order(t, d, triangle, best).nearer;
}

/// A hit on its way to its ray's word.
template <typename F>
struct FoundHit {
  ResultWord<F> result;     ///< its hit bit counts as 1
  std::uint32_t bound = 0;  ///< of the ray, if this is its nearest hit
  bool certify = false;     ///< it is only possible
  bool rough = false;       ///< and its depth is known roughly
  bool unsure = false;      ///< or not at all
  bool ends = false;        ///< two possible hits are enough
};

/// What a hit makes of its ray's word.
template <typename F>
struct KeptHit {
  bool write = false;   ///< the word changes
  bool first = false;   ///< the ray had no hit
  bool bounds = false;  ///< with write: the ray's bound changes
  RayHits<F> word;
  std::uint32_t bound = 0;
};

/// The word keeps the nearest hit; of certified ones also one that may be nearer, a rival, and whether there
/// are more.
template <typename F>
[[nodiscard]] constexpr KeptHit<F> keep_hit(const FoundHit<F>& hit, const RayHits<F>& best) noexcept {
  const ResultWord<F>& r = hit.result;
  KeptHit<F> kept;
  kept.first = !best.nearest.hit;
  const bool second = hit.certify && best.nearest.hit;
  const bool known =
      best.crowd || r.triangle == best.nearest.triangle || (best.rival && r.triangle == best.rival_triangle);
  const DepthOrder order = depth_order(r.t, r.d, r.triangle, best.nearest);
  const bool unknown = hit.unsure || best.unsure;
  const bool tie = hit.rough || best.rough ? order.rough_tie : order.tie;
  const bool open = second && (unknown || tie);  // either may be nearer
  const bool nearest = kept.first || (second && unknown ? !hit.unsure : order.nearer);
  kept.write = (kept.first || open || nearest) && !(second && known);
  kept.word = kept.first ? RayHits<F>{} : best;
  kept.word.crowd = open && best.rival;
  kept.word.rival = open || (best.rival && best.rival_rough);
  if (open) {
    kept.word.rival_rough = nearest ? best.unsure || best.rough : hit.unsure || hit.rough;
    kept.word.rival_triangle = nearest ? best.nearest.triangle : r.triangle;
  }
  if (nearest) {
    kept.word.nearest = r;
    kept.word.nearest.hit = true;
    kept.word.rough = hit.rough;
    kept.word.unsure = hit.unsure;
  }
  const bool ended = kept.word.crowd || (open && hit.ends);
  kept.bounds = nearest || ended;
  kept.bound = ended ? 0 : hit.bound;
  return kept;
}

}  // namespace raplas
