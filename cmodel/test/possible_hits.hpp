// Certified hits by brute force: what a ray's word must hold, whatever was skipped and in whichever order.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "raplas/fixed_trace.hpp"

namespace raplas {

/// The triangles that the rays of a pencil may hit: by counted_hit(), ray by ray and piece by piece.
template <typename F>
class PossibleHits {
 public:
  PossibleHits(const FixedSceneMemory<F>& scene, const FixedPencilMemory<F>& pencil) : pencil_(pencil) {
    std::array<FixedTest, 3> slots;
    for (const VertexWord& vertex : scene.vertices) {
      slots[vertex.slot] = test_object(pencil.planes, vertex.point, 0, pencil.limits.slack);
      if (!vertex.emit) {
        continue;
      }
      const CrossedLines lines = crossed_lines(slots);
      const ReachedColumns reached = reached_columns(slots, pencil.limits);
      for (std::uint32_t row = 0; lines.near && row < pencil.pencil.rows; ++row) {
        for (std::uint32_t column = 0; column < pencil.pencil.columns; ++column) {
          if ((lines.rows >> row & (lines.columns & reached[row]) >> column & 1U) != 0) {
            add(scene.triangles[vertex.triangle], vertex.triangle, row * kMaxColumns + column, lines.z);
          }
        }
      }
    }
  }

  /// What is wrong with a ray's word; nothing: "".
  [[nodiscard]] std::string wrong(std::uint32_t ray, const RayHits<F>& word) const {
    const Possible& possible = possible_[ray];
    const std::uint32_t bound = least_bound(possible);
    const auto seen = [bound](const auto& one) { return one.second.z < bound; };
    const auto least = static_cast<std::size_t>(std::count_if(possible.begin(), possible.end(), seen));
    if (!word.nearest.hit) {
      return least == 0 ? "" : "no hit";
    }
    const auto stored = possible.find(word.nearest.triangle);
    if (stored == possible.end() || stored->second.hit.result != word.nearest) {
      return "the nearest hit is none";
    }
    if (stored->second.hit.unsure != word.unsure || stored->second.hit.rough != word.rough) {
      return "unsure or rough";
    }
    if (word.rival) {
      const auto rival = possible.find(word.rival_triangle);
      if (rival == possible.end() || rival == stored) {
        return "the rival is no other possible hit";
      }
      const FoundHit<F>& other = rival->second.hit;
      if (word.rival_rough != (other.unsure || other.rough)) {
        return "rival_rough";
      }
      if (!word.unsure && !other.unsure && nearer(rival->second.hit.result, word.nearest)) {
        return "the rival is nearer";
      }
    }
    if (word.crowd) {
      return word.rival && possible.size() > 2 ? "" : "no crowd";
    }
    if (pencil_.limits.any_hit) {  // two are enough
      return word.rival || least < 2 ? "" : "no rival";
    }
    for (const auto& [triangle, hit] : possible) {
      hidden_ += hit.z < bound ? 0 : 1;
      if (hit.z < bound && triangle != word.nearest.triangle && may_be_nearest(hit.hit, word) &&
          !(word.rival && triangle == word.rival_triangle)) {
        return "triangle " + std::to_string(triangle) + " is missing";
      }
    }
    return "";
  }

  /// Hits that wrong() took as hidden.
  [[nodiscard]] std::uint64_t hidden() const noexcept { return hidden_; }

 private:
  struct Hit {
    FoundHit<F> hit;
    std::uint32_t z;  ///< least of its pieces
  };
  using Possible = std::map<std::uint32_t, Hit>;  // by triangle

  void add(const TriangleWord<F>& words, std::uint32_t triangle, std::uint32_t ray, std::uint32_t z) {
    const Solution<F> s =
        solve(words, pencil_.pencil.origin, pencil_.rays[ray], F::from_bits(pencil_.limits.band));
    const CountedHit<F> counted = counted_hit(s, triangle, z, pencil_.limits);
    if (counted.valid) {
      const auto [place, first] = possible_[ray].insert({triangle, {counted.hit, z}});
      place->second.z = std::min(z, place->second.z);
    }
  }

  /// A piece from this depth on may be hidden, whatever depth its triangle seems to have: it is farther than
  /// a hit whose depth is known.
  [[nodiscard]] std::uint32_t least_bound(const Possible& possible) const {
    std::uint32_t bound = pencil_.limits.far;
    for (const auto& [triangle, hit] : possible) {
      bound = hit.hit.unsure ? bound : std::min(bound, hit.hit.bound);
    }
    return bound;
  }

  [[nodiscard]] static bool nearer(const ResultWord<F>& a, const ResultWord<F>& b) {
    return a.t.to_double() * b.d.to_double() < b.t.to_double() * a.d.to_double();  // exact
  }

  /// Depths that are no tie are 3/512 apart or more, 1/32 if one is rough.
  [[nodiscard]] static bool may_be_nearest(const FoundHit<F>& hit, const RayHits<F>& word) {
    const double tie = 1 + (hit.rough ? 0.5 / (1 << kRoughTieShift) : 1.5 / (1 << kTieShift));
    const double here = hit.result.t.to_double() * word.nearest.d.to_double();
    const double there = word.nearest.t.to_double() * hit.result.d.to_double();
    return hit.unsure || word.unsure || here < there * tie;  // exact
  }

  const FixedPencilMemory<F>& pencil_;
  std::array<Possible, kMaxRays> possible_;
  mutable std::uint64_t hidden_ = 0;
};

}  // namespace raplas
