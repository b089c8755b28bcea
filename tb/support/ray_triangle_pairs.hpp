// Pairs for ray_solver and ray_triangle, and their solution: the 33 operations one by one by MPFR.
// GUARD_BITS is the unit's generic.
#pragma once

#include <array>
#include <type_traits>

#include "bridge/dut.hpp"
#include "operands.hpp"
#include "oracle.hpp"
#include "raplas/ray_triangle.hpp"

namespace raplas {

using F = std::conditional_t<GUARD_BITS == 0, Fp24Paper, Fp24>;
using Vector = std::array<std::uint32_t, 3>;

inline std::uint32_t add(std::uint32_t a, std::uint32_t b) {
  return GUARD_BITS == 0 ? oracle::add_cut(a, b, 0) : oracle::add(a, b);
}
inline std::uint32_t subtract(std::uint32_t a, std::uint32_t b) { return add(a, oracle::negate(b)); }

inline std::uint32_t dot(const Vector& a, const Vector& b) {
  return add(add(oracle::multiply(a[0], b[0]), oracle::multiply(a[1], b[1])), oracle::multiply(a[2], b[2]));
}
inline Vector cross(const Vector& a, const Vector& b) {
  Vector result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t y = (k + 1) % 3;
    const std::size_t z = (k + 2) % 3;
    result[k] = subtract(oracle::multiply(a[y], b[z]), oracle::multiply(a[z], b[y]));
  }
  return result;
}

/// A triangle and a ray.
struct Pair {
  Vector v0{};
  Vector e1{};
  Vector e2{};
  Vector n{};
  Vector o{};
  Vector d{};

  [[nodiscard]] TriangleWord<F> triangle() const { return {vector(v0), vector(e1), vector(e2), vector(n)}; }
  [[nodiscard]] Vec3<F> origin() const { return vector(o); }
  [[nodiscard]] Vec3<F> direction() const { return vector(d); }

 private:
  static Vec3<F> vector(const Vector& v) {
    return {F::from_bits(v[0]), F::from_bits(v[1]), F::from_bits(v[2])};
  }
};

inline Solution<F> solve_by_oracle(const Pair& p) {
  const Vector t{subtract(p.v0[0], p.o[0]), subtract(p.v0[1], p.o[1]), subtract(p.v0[2], p.o[2])};
  const Vector dxt = cross(p.d, t);
  const std::uint32_t nd = dot(p.n, p.d);
  const std::uint32_t sign = nd & 0x800000U;
  const auto signed_by = [sign](std::uint32_t x) { return (x >> 16 & 127) == 0 ? 0U : x ^ sign; };
  const std::uint32_t tt = signed_by(dot(p.n, t));
  const std::uint32_t dd = signed_by(nd);
  const std::uint32_t uu = signed_by(oracle::negate(dot(dxt, p.e2)));
  const std::uint32_t vv = signed_by(dot(dxt, p.e1));
  const auto real = [](std::uint32_t x) { return oracle::Real(x); };
  const bool hit = mpfr_sgn(real(tt).get()) > 0 && mpfr_sgn(real(dd).get()) > 0 &&
                   mpfr_sgn(real(uu).get()) >= 0 && mpfr_sgn(real(vv).get()) >= 0 &&
                   mpfr_cmp(real(add(uu, vv)).get(), real(dd).get()) <= 0;
  return {hit, F::from_bits(tt), F::from_bits(dd), F::from_bits(uu), F::from_bits(vv)};
}

/// Four kinds of triangles in turn.
inline Pair some_pair(OperandPairs& pairs, int k) {
  const auto number = [&](int low, int high) { return pairs.word(63 + pairs.between(low, high)); };
  const auto vector = [&](int low, int high) {
    return Vector{number(low, high), number(low, high), number(low, high)};
  };
  Vector o = vector(-4, 0);
  Vector d = vector(-3, 0);
  Vector e1 = vector(-5, 0);
  Vector e2 = vector(-5, 0);
  Vector v0 = vector(-4, 0);
  if (k % 8 == 7) {  // anything, ends of the range included
    o = vector(-64, 64);
    e1 = vector(-64, 64);
    v0 = vector(-64, 64);
    if (k % 16 == 15) {
      d = vector(-64, 64);
      e2 = vector(-64, 64);
    }
  } else if (k % 8 == 3) {  // sums of unlike addends, and products near the ends of the range
    const int middle = k % 16 == 3 ? 0 : pairs.between(-1, 1) * 28;
    d = vector(-16, 16);
    e1 = vector(middle - 8, middle + 8);
    e2 = vector(middle - 8, middle + 8);
    o = vector(-16, 16);
    v0 = vector(-16, 16);
  } else if (k % 2 == 0) {  // aimed at a point of the triangle, often at its rim
    const double u = pairs.between(0, 8) / 8.0;
    const double v = (1 - u) * pairs.between(0, 8) / 8.0;
    const double s = (pairs.bits(1) != 0 ? 1 : -1) * (1 + pairs.between(0, 3));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = [](std::uint32_t x) { return Fp24::from_bits(x).to_double(); };
      const double point = value(v0[i]) + u * value(e1[i]) + v * value(e2[i]);
      o[i] = Fp24::from_double(point - s * value(d[i])).bits();
    }
  }
  return {v0, e1, e2, cross(e1, e2), o, d};
}

/// Puts a pair on the inputs.
inline void apply(const Pair& p) {
  dut().set(dut().port("triangle_i"), p.triangle().pack());
  dut().set(dut().port("direction_i"), pack_ray(p.direction()));
  dut().set(dut().port("origin_i"), pack_ray(p.origin()));
}

}  // namespace raplas
