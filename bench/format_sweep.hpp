// The number formats that are compared.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "error_counter.hpp"

namespace raplas {

/// Adders: what they keep below the last bit, and how they round.
struct Adder {
  Guard guard;
  Rounding rounding;
};

inline constexpr std::array<Adder, 4> kSweptAdders{{{Guard::none, Rounding::toward_zero},
                                                    {Guard::one, Rounding::toward_zero},
                                                    {Guard::exact, Rounding::toward_zero},
                                                    {Guard::exact, Rounding::nearest_even}}};
/// Fraction bits, at kExponentBits exponent bits.
inline constexpr int kLeastFraction = 8;
inline constexpr int kMostFraction = 23;
/// Other exponent bits, at kFractionBits fraction bits.
inline constexpr std::array<int, 3> kOtherExponents{5, 6, 8};

/// Every adder with each of these sizes.
inline constexpr auto kSweep = [] {
  constexpr std::size_t kFractions = kMostFraction - kLeastFraction + 1;
  std::array<Format, kSweptAdders.size() * (kFractions + kOtherExponents.size())> sweep{};
  std::size_t next = 0;
  for (const Adder& adder : kSweptAdders) {
    for (int bits = kLeastFraction; bits <= kMostFraction; ++bits) {
      sweep[next++] = {kExponentBits, bits, adder.guard, adder.rounding};
    }
    for (const int bits : kOtherExponents) {
      sweep[next++] = {bits, kFractionBits, adder.guard, adder.rounding};
    }
  }
  return sweep;
}();

/// Words for figures' names: "none", "one", "exact"; "truncate", "nearest".
[[nodiscard]] const char* name_of(Guard guard);
[[nodiscard]] const char* name_of(Rounding rounding);

/// As fp_e7_f16_exact_truncate.
[[nodiscard]] std::string name_of(const Format& format);

/// measure() of format kSweep[k].
[[nodiscard]] FormatErrors measure_swept(std::size_t k, const Sample& sample);

}  // namespace raplas
