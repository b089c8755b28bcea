#include "hit_records.hpp"

#include <bit>
#include <stdexcept>

#include "raplas/float.hpp"

namespace raplas {
namespace {

std::uint32_t word_of(double value) {
  const Fp24 word = Fp24::from_double(value, "hit value");
  if (word.to_double() != value) {
    throw std::range_error("a hit's value is not a number of the devices' format");
  }
  return word.bits();
}

void put(std::string& bytes, std::uint64_t value, int count) {
  for (int k = 0; k < count; ++k) {
    bytes.push_back(static_cast<char>((value >> (8 * k)) & 0xffU));
  }
}

}  // namespace

HitRecord record_of(const Hit& hit) {
  return {(hit.hit ? 1U << kIdBits : 0U) | hit.triangle, word_of(hit.t_scaled), word_of(hit.d),
          word_of(hit.u_scaled), word_of(hit.v_scaled)};
}

std::uint64_t differing_bits(const HitRecord& a, const HitRecord& b) {
  std::uint64_t bits = 0;
  for (const std::uint32_t difference :
       {a.hit_and_triangle ^ b.hit_and_triangle, a.t ^ b.t, a.d ^ b.d, a.u ^ b.u, a.v ^ b.v}) {
    bits += static_cast<std::uint32_t>(std::popcount(difference));
  }
  return bits;
}

std::string dump(std::span<const Hit> hits) {
  std::string bytes;
  for (const Hit& hit : hits) {
    put(bytes, hit.hit ? 1 : 0, 1);
    put(bytes, hit.triangle, 4);
    for (const double value : {hit.t_scaled, hit.d, hit.u_scaled, hit.v_scaled}) {
      put(bytes, std::bit_cast<std::uint64_t>(value), 8);
    }
  }
  return bytes;
}

}  // namespace raplas
