// Hits compared bit by bit, and dump files of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "raplas/device.hpp"

namespace raplas {

/// Number of bits in which two hits differ: hit, triangle, and t', d, u' and v' as doubles.
[[nodiscard]] std::uint64_t differing_bits(const Hit& a, const Hit& b);

/// Bits of a hit: more than differing_bits() can be.
inline constexpr std::uint64_t kHitBits = 1 + 32 + 4 * 64;

/// First line of a dump file; the records follow.
inline constexpr std::string_view kHitFileHeader =
    "raplas hits 1: hit u8, triangle u32, t' d u' v' f64, little-endian\n";

/// The hits as records of a dump file, 37 bytes each, without padding.
[[nodiscard]] std::string dump(std::span<const Hit> hits);

}  // namespace raplas
