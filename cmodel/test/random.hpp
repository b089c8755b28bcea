// A fast random number generator.
#pragma once

#include <bit>
#include <cstdint>

namespace raplas {

/// xoshiro256++ of Blackman and Vigna, seeded by SplitMix64.
class Xoshiro {
 public:
  explicit Xoshiro(std::uint64_t seed) {
    for (std::uint64_t& word : state_) {
      seed += 0x9e3779b97f4a7c15U;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
      word = z ^ (z >> 31);
    }
  }

  std::uint64_t operator()() noexcept {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// 0 .. limit - 1
  std::uint32_t below(std::uint32_t limit) noexcept {
    return static_cast<std::uint32_t>(((*this)() >> 32) * limit >> 32);
  }

 private:
  std::uint64_t state_[4];
};

}  // namespace raplas
