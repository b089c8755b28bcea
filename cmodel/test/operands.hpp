// fp24 words that find faults: a list of corners, and random words biased toward what is hard for an adder.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <utility>

namespace raplas {

/// Zeros of every spelling, the ends of the range, powers of two and their neighbours, and their negatives.
inline constexpr std::array<std::uint32_t, 40> kCorners{
    0x000000, 0x800000, 0x00ffff, 0x80ffff, 0x000001, 0x010000, 0x010001, 0x01ffff, 0x020000, 0x110000,
    0x1fffff, 0x200000, 0x2d8000, 0x2e0000, 0x2effff, 0x2f0000, 0x3e0000, 0x3effff, 0x3f0000, 0x3f0001,
    0x3f8000, 0x3fffff, 0x400000, 0x4f0000, 0x500001, 0x5fffff, 0x7e0000, 0x7effff, 0x7f0000, 0x7ffffe,
    0x7fffff, 0x810000, 0x81ffff, 0xaf0000, 0xbeffff, 0xbf0000, 0xbf0001, 0xbfffff, 0xff0000, 0xffffff};

/// Pairs of words: uniform, close exponents, near cancellation, near overflow and underflow, sparse
/// fractions.
class OperandPairs {
 public:
  explicit OperandPairs(std::uint64_t seed) : random_(seed) {}

  std::pair<std::uint32_t, std::uint32_t> operator()() {
    const std::uint32_t a = word(exponent());
    switch (random_() % 5) {
      case 0:
        return {a, word(exponent())};
      case 1:  // exponents within the significand's reach
        return {a, word(static_cast<int>((a >> 16) & 127) + between(-20, 20))};
      case 2:  // near cancellation
        return {a, ((a ^ 0x800000U) + static_cast<std::uint32_t>(between(-2, 2))) & 0xffffffU};
      case 3:  // one exponent apart with full fractions
        return {a, (a ^ 0x800000U) ^ 0x010000U};
      default: {  // product or sum at an end of the range
        const int e = static_cast<int>((a >> 16) & 127);
        const int other = (random_() & 1) != 0 ? 127 + 63 - e : 64 - e;
        return {a, word(other + between(-2, 2))};
      }
    }
  }

  /// A word; its exponent is clamped to the format.
  std::uint32_t word(int exponent) {
    const std::uint32_t clamped =
        exponent < 0 ? 0U : (exponent > 127 ? 127U : static_cast<std::uint32_t>(exponent));
    return (bits(1) << 23) | (clamped << 16) | fraction();
  }

  std::uint32_t bits(unsigned count) { return static_cast<std::uint32_t>(random_()) & ((1U << count) - 1); }
  int between(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  int exponent() {
    return random_() % 8 == 0 ? between(0, 2) : (random_() % 8 == 0 ? between(125, 127) : between(0, 127));
  }
  std::uint32_t fraction() {
    const std::uint32_t uniform = bits(16);
    switch (random_() % 4) {
      case 0:
        return uniform & (0xffffU << between(0, 16)) & 0xffffU;
      case 1:
        return uniform | (0xffffU >> between(0, 16));
      default:
        return uniform;
    }
  }

  std::mt19937_64 random_;
};

}  // namespace raplas
