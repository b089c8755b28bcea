// Hits as the Result Memory holds them, for comparing and for dump files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "raplas/device.hpp"

namespace raplas {

/// The fields of a result word.
struct HitRecord {
  std::uint32_t hit_and_triangle;  ///< bit kIdBits: hit; below: triangle ID
  std::uint32_t t;
  std::uint32_t d;
  std::uint32_t u;
  std::uint32_t v;
};

/// The record of a hit of a 24-bit device, whose values are exact fp24 numbers. Throws std::range_error
/// otherwise.
[[nodiscard]] HitRecord record_of(const Hit& hit);

/// Number of bits in which two records differ, 0 .. ResultLayout::kBits.
[[nodiscard]] std::uint64_t differing_bits(const HitRecord& a, const HitRecord& b);

/// First line of a dump file; the records follow.
inline constexpr std::string_view kHitFileHeader =
    "raplas hits 1: hit u8, triangle u32, t' d u' v' f64, little-endian\n";

/// The hits as records of a dump file, 37 bytes each, without padding.
[[nodiscard]] std::string dump(std::span<const Hit> hits);

}  // namespace raplas
