// Spheres and planes that meet in about half of the cases.
#pragma once

#include "operands.hpp"
#include "raplas/plane_sphere.hpp"

namespace raplas {

inline Fp24 small_number(OperandPairs& pairs) {
  return Fp24::from_bits(pairs.word(63 + pairs.between(-4, 0)));
}
inline Vec3<Fp24> small_vector(OperandPairs& pairs) {
  return {small_number(pairs), small_number(pairs), small_number(pairs)};
}
inline PlaneWord<Fp24> some_plane(OperandPairs& pairs) { return {small_vector(pairs), small_number(pairs)}; }
inline SphereWord<Fp24> some_sphere(OperandPairs& pairs) {
  return {small_vector(pairs), Fp24::from_bits(small_number(pairs).magnitude()), false, 0, 0};
}
/// cx cy cz r, as the testers take them.
inline PackedWord<96> pack_ball(const SphereWord<Fp24>& sphere) {
  return PlaneWord<Fp24>{sphere.centre, sphere.radius}.pack();
}

}  // namespace raplas
