// What the host writes into entity raplas_unit: words for its write port.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "raplas/fixed_trace.hpp"

namespace raplas {

/// A word for the write port, right-aligned.
struct HostWord {
  Target target = Target::scene;
  std::size_t address = 0;
  PackedWord<TriangleLayout::kBits> data{};
};

/// Packed words in one word of the port, the first in its low bits.
template <std::size_t kWords, std::size_t kCount>
[[nodiscard]] HostWord host_word(
    Target target, std::size_t address, int bits,
    const std::array<std::array<std::uint32_t, kWords>, kCount>& words) noexcept {
  HostWord host{target, address, {}};
  for (std::size_t k = 0; k < kCount; ++k) {
    for (int lsb = 0; lsb < bits; lsb += 32) {
      const int width = std::min(32, bits - lsb);
      insert(host.data, {static_cast<int>(k) * bits + lsb, width}, extract(words[k], {lsb, width}));
    }
  }
  return host;
}
template <std::size_t kWords>
[[nodiscard]] HostWord host_word(Target target, std::size_t address,
                                 const std::array<std::uint32_t, kWords>& word) noexcept {
  HostWord host{target, address, {}};
  std::copy(word.begin(), word.end(), host.data.begin());
  return host;
}

inline constexpr std::size_t kWordRays = std::size_t{1} << kWordRaysLog2;

/// Words of a pencil before those of its lines: two registers, and two pairs of planes.
inline constexpr std::size_t kPencilHead = 4;

/// Words of a pencil: its head, the planes of its lines, the rays.
template <typename F>
[[nodiscard]] std::size_t pencil_words(const FixedPencilMemory<F>& pencil) noexcept {
  const std::size_t rows = pencil.pencil.rows;
  const std::size_t columns = pencil.pencil.columns;
  return kPencilHead + std::max(rows, columns) + rows * ((columns + kWordRays - 1) / kWordRays);
}

/// Word 0 .. pencil_words() - 1 of the pencil of a bank.
template <typename F>
[[nodiscard]] HostWord pencil_word(const FixedPencilMemory<F>& pencil, std::size_t bank, std::size_t word) {
  const auto planes = [bank](std::size_t index, const FixedPlane& row, const FixedPlane& column) {
    return host_word(Target::plane, bank << kPlaneIndexBits | index, FixedPlaneLayout::kBits,
                     std::array{row.pack(), column.pack()});
  };
  const std::size_t lines = std::max(pencil.pencil.rows, pencil.pencil.columns);
  switch (word) {
    case 0:
      return host_word(Target::pencil, bank, pencil.pencil.pack());
    case 1:
      return host_word(Target::limits, bank, pencil.limits.pack());
    case 2:
      return planes(kAxisPlane, pencil.planes.near, pencil.planes.depth);
    case 3:
      return planes(kGridPlane, pencil.planes.down, pencil.planes.across);
    default:
      word -= kPencilHead;
  }
  if (word < lines) {
    return planes(word, pencil.planes.rows[word], pencil.planes.columns[word]);
  }
  word -= lines;
  const std::size_t in_row = (pencil.pencil.columns + kWordRays - 1) / kWordRays;
  const std::size_t first = word / in_row * kMaxColumns + word % in_row * kWordRays;
  std::array<PackedWord<RayLayout::kBits>, kWordRays> rays;
  for (std::size_t k = 0; k < kWordRays; ++k) {
    rays[k] = pack_ray(pencil.rays[first + k]);
  }
  return host_word(Target::ray, (bank * kMaxRays + first) / kWordRays, RayLayout::kBits, rays);
}

}  // namespace raplas
