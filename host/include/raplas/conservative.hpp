// The radius that the devices store: enlarged so that no rounding loses a sphere that is met.
#pragma once

#include <glm/vec3.hpp>

namespace raplas {

/// An enlarged radius for which this is proven: if a plane n.x + p = 0 (|n| = 1 and |p| <= max_origin, each
/// to 2^-40 relative) meets the sphere of `radius` around `stored_centre` in exact arithmetic, then the
/// plane-sphere tester finds d <= r, with n and p rounded to the nearest fp24, either adder (with or without
/// guard bits), and r = Fp24::from_double_up(result). `stored_centre` holds fp24 numbers; magnitudes below
/// 2^60. radius + g4 (|c| + min(max_origin, radius + |c|)) + (8 + norm1(c)) 2^-62, with g_k = k u / (1 - k
/// u), u = 2^-16. Derivation: docs/radius.md.
[[nodiscard]] double conservative_radius(const glm::dvec3& stored_centre, double radius, double max_origin);

}  // namespace raplas
