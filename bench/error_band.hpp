// How far the ray-triangle test of a device may be off: bounds of its rounding errors, operation by
// operation.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "raplas/device.hpp"
#include "reference_pairs.hpp"

namespace raplas {

/// What an arithmetic rounds. All are shares of magnitudes but `tiny`, which is absolute.
struct ErrorModel {
  double input;      ///< of a coordinate, an edge or a normal that is put into a memory word
  double operation;  ///< of a result
  double cut;        ///< of the larger operand of a sum, what an adder without guard bits loses
  double tiny;       ///< results below this become 0
  double border;     ///< how far outside u', v' or d - u' - v' may be, as a share of their factors' 1-norms
  bool depth_codes;  ///< hits whose depth is off by more than its code's margin are rejected
};

/// Device `reference`, whose borders are 2^-49 wide.
inline constexpr ErrorModel kDoubleErrors{0, 0x1p-53, 0, 0x1p-1000, 0x1p-49, false};
/// fp24 as docs/number_format.md has it: to nearest on its way in, truncated in each operation.
inline constexpr ErrorModel kRaplasErrors{0x1.001p-17, 0x1.001p-16, 0, 0x1p-62, 0, true};
/// The same without guard bits: docs/fp_add.md.
inline constexpr ErrorModel kPaperErrors{0x1.001p-17, 0x1.001p-16, 0x1.001p-16, 0x1p-62, 0, false};

/// What a device may find for a ray and a triangle.
struct Band {
  Verdict verdict = Verdict::undecided;  ///< hit or miss: it must find that; undecided: it may find either
  bool deep_enough = true;               ///< its depth code is certain to be accepted
  double t_low = 0;                      ///< t of a hit, in units of the direction's length
  double t_high = 0;
};

/// Moeller's test of triangle and ray as they are, by the steps of docs/ray_triangle.md, each with a bound of
/// what the model's roundings have made of it so far. The bounds follow from the model alone; they hold for
/// every input whose numbers don't overflow.
[[nodiscard]] Band error_band(const ErrorModel& model, const Triangle& triangle, const glm::dvec3& origin,
                              const glm::dvec3& direction);

}  // namespace raplas
