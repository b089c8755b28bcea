// Which depths are a tie, by its definition, in doubles that hold it exactly.
#pragma once

#include <cmath>
#include <cstdint>

#include "raplas/constants.hpp"

namespace raplas {

/// The product of two words above 0 on a scale on which powers of two are 1 apart, and even between them: 42
/// bits.
inline double place(std::uint32_t a, std::uint32_t b) {
  const auto number = [](std::uint32_t word) {
    return std::ldexp((word & 0xffffU) | 0x10000U, static_cast<int>(word >> 16 & 127U));
  };
  int exponent = 0;
  const double half = std::frexp(number(a) * number(b), &exponent);
  return exponent + (2 * half - 1);
}

/// A hit at t / d is less than 3 * 2^-TIE_SHIFT from the best one, or, `rough`, 2^-ROUGH_TIE_SHIFT.
inline bool tied(std::uint32_t t, std::uint32_t d, std::uint32_t best_t, std::uint32_t best_d,
                 bool rough = false) {
  const double apart = place(t, best_d) - place(best_t, d);
  const double least = rough ? std::ldexp(1, -kRoughTieShift) : std::ldexp(3, -kTieShift);
  return apart >= -least && apart < least;
}

}  // namespace raplas
