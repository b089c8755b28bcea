#include "hit_records.hpp"

#include <bit>

namespace raplas {
namespace {

void put(std::string& bytes, std::uint64_t value, int count) {
  for (int k = 0; k < count; ++k) {
    bytes.push_back(static_cast<char>((value >> (8 * k)) & 0xffU));
  }
}

}  // namespace

std::uint64_t differing_bits(const Hit& a, const Hit& b) {
  const auto differing = [](auto x, auto y) { return static_cast<std::uint64_t>(std::popcount(x ^ y)); };
  std::uint64_t bits = differing(a.triangle, b.triangle) + (a.hit == b.hit ? 0U : 1U);
  for (double Hit::*const value : {&Hit::t_scaled, &Hit::d, &Hit::u_scaled, &Hit::v_scaled}) {
    bits += differing(std::bit_cast<std::uint64_t>(a.*value), std::bit_cast<std::uint64_t>(b.*value));
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
