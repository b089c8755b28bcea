// Does a ray as stored meet a triangle as stored? In exact arithmetic, by MPFR.
#pragma once

#include <mpfr.h>

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

namespace raplas {

/// A real number of 640 bits: exact for sums and differences of products of three fp24 numbers.
class ExactReal {
 public:
  explicit ExactReal(double value = 0) {
    mpfr_init2(value_, 640);
    mpfr_set_d(value_, value, MPFR_RNDN);
  }
  ExactReal(const ExactReal& other) : ExactReal() { mpfr_set(value_, other.value_, MPFR_RNDN); }
  ExactReal& operator=(const ExactReal& other) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~ExactReal() { mpfr_clear(value_); }

  friend ExactReal operator+(ExactReal a, const ExactReal& b) {
    mpfr_add(a.value_, a.value_, b.value_, MPFR_RNDN);
    return a;
  }
  friend ExactReal operator-(ExactReal a, const ExactReal& b) {
    mpfr_sub(a.value_, a.value_, b.value_, MPFR_RNDN);
    return a;
  }
  friend ExactReal operator*(ExactReal a, const ExactReal& b) {
    mpfr_mul(a.value_, a.value_, b.value_, MPFR_RNDN);
    return a;
  }
  [[nodiscard]] int sign() const { return mpfr_sgn(value_); }

  /// floor(2^34 * a / b), at most 2^39.
  friend std::int64_t quotient_units(ExactReal a, const ExactReal& b) {
    mpfr_div(a.value_, a.value_, b.value_, MPFR_RNDD);
    mpfr_mul_2si(a.value_, a.value_, 34, MPFR_RNDD);
    constexpr std::int64_t kMost = std::int64_t{1} << 39;
    return mpfr_cmp_d(a.value_, 0x1p39) > 0 ? kMost : mpfr_get_si(a.value_, MPFR_RNDD);
  }

 private:
  mpfr_t value_;
};

using ExactVec3 = std::array<ExactReal, 3>;

inline ExactVec3 exact(const glm::dvec3& v) { return {ExactReal(v.x), ExactReal(v.y), ExactReal(v.z)}; }

inline ExactVec3 operator-(const ExactVec3& a, const ExactVec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline ExactReal dot(const ExactVec3& a, const ExactVec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline ExactVec3 cross(const ExactVec3& a, const ExactVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// floor(2^34 t), t > 0, of the point where the ray meets the triangle (border included); none if it doesn't.
inline std::optional<std::int64_t> exact_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                                             const glm::dvec3& v0, const glm::dvec3& e1,
                                             const glm::dvec3& e2) {
  // origin + t direction = v0 + u e1 + v e2, by Cramer's rule with the columns direction, -e1, -e2
  const ExactVec3 d = exact(direction);
  const ExactVec3 a = exact(e1);
  const ExactVec3 b = exact(e2);
  const ExactVec3 to = exact(v0) - exact(origin);
  const ExactReal det = dot(d, cross(a, b));
  if (det.sign() == 0) {
    return std::nullopt;
  }
  const ExactReal sign(det.sign());
  const ExactReal t = sign * dot(to, cross(a, b));
  const ExactReal u = sign * dot(d, cross(b, to));
  const ExactReal v = sign * dot(d, cross(to, a));
  if (t.sign() <= 0 || u.sign() < 0 || v.sign() < 0 || (sign * det - u - v).sign() < 0) {
    return std::nullopt;
  }
  return quotient_units(t, sign * det);
}

}  // namespace raplas
