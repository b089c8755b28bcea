// What a number format of the ray-triangle test does wrong: the golden model against double precision.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "raplas/encode.hpp"
#include "raplas/ray_triangle.hpp"
#include "reference_pairs.hpp"

namespace raplas {

/// Of a list of numbers: the least ones that are not exceeded by 50 %, 99 %, 100 % of them.
struct Quantiles {
  double median;
  double percent_99;
  double largest;
};

/// Nothing for an empty list. The order of `values` does not matter.
[[nodiscard]] std::optional<Quantiles> quantiles(std::vector<double> values);

/// How a ray's nearest hit in a format compares with that in double precision.
enum class RayVerdict {
  right,      ///< no hit in either, the same triangle, or one as near within the error of double precision
  missed,     ///< no hit, but there is one
  false_hit,  ///< a hit where there is none
  other       ///< another triangle
};

/// `nearest` and `found`: the nearest hit in double precision and the pair that the format found nearest, of
/// the same ray; nullptr: none.
[[nodiscard]] RayVerdict compare_nearest(const ReferencePair* nearest, const ReferencePair* found);

/// Errors of one format on a sample; what is counted is out of the sample's decided pairs and rays.
struct FormatErrors {
  std::uint64_t false_hits = 0;         ///< pairs
  std::uint64_t missed_hits = 0;        ///< pairs
  std::uint64_t rays_missed = 0;        ///< RayVerdict::missed
  std::uint64_t rays_false = 0;         ///< RayVerdict::false_hit
  std::uint64_t rays_other = 0;         ///< RayVerdict::other
  std::optional<Quantiles> t_relative;  ///< |t - reference| / reference, of pairs that hit in both
  std::optional<Quantiles> t_ulp;       ///< the same in units of the last place of the reference's binade

  [[nodiscard]] std::uint64_t misclassified() const { return false_hits + missed_hits; }
  [[nodiscard]] std::uint64_t rays_wrong() const { return rays_missed + rays_false + rays_other; }
};

/// Counts the errors of format F, pair by pair.
template <typename F>
class ErrorCounter {
 public:
  /// Throws std::range_error for a number outside the format.
  explicit ErrorCounter(std::span<const Triangle> triangles) {
    words_.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
      words_.push_back(encode<F>(triangle));
    }
  }

  void add(const SampledPencil& pencil) {
    const auto origin = encode<F>(pencil.origin, "pencil origin");
    for (const SampledRay& ray : pencil.rays) {
      add(ray, origin);
    }
  }

  [[nodiscard]] FormatErrors errors() && {
    errors_.t_relative = quantiles(std::move(t_relative_));
    errors_.t_ulp = quantiles(std::move(t_ulp_));
    return errors_;
  }

 private:
  void add(const SampledRay& ray, const Vec3<F>& origin) {
    const auto direction = encode<F>(ray.direction, "ray direction");
    ResultWord<F> best;
    const ReferencePair* found = nullptr;
    for (const ReferencePair& pair : ray.pairs) {
      const Solution<F> s = solve(words_[pair.triangle], origin, direction);
      add(pair, s);
      if (s.hit && nearer(s.t, s.d, pair.triangle, best)) {
        best = {true, pair.triangle, s.t, s.d, s.u, s.v};
        found = &pair;
      }
    }
    const RayVerdict verdict = compare_nearest(nearest_hit(ray.pairs), found);
    errors_.rays_missed += verdict == RayVerdict::missed ? 1U : 0U;
    errors_.rays_false += verdict == RayVerdict::false_hit ? 1U : 0U;
    errors_.rays_other += verdict == RayVerdict::other ? 1U : 0U;
  }

  void add(const ReferencePair& pair, const Solution<F>& s) {
    const bool hit = pair.verdict == Verdict::hit;
    errors_.false_hits += s.hit && !hit ? 1U : 0U;
    errors_.missed_hits += !s.hit && hit ? 1U : 0U;
    if (s.hit && hit) {
      const double error = std::abs(s.t.to_double() / s.d.to_double() - pair.t);
      t_relative_.push_back(error / pair.t);
      t_ulp_.push_back(error / std::ldexp(1.0, std::ilogb(pair.t) - F::kFractionBits));
    }
  }

  std::vector<TriangleWord<F>> words_;  ///< by triangle ID
  FormatErrors errors_;
  std::vector<double> t_relative_;
  std::vector<double> t_ulp_;
};

/// The errors of format F on a sample. Throws std::range_error for a number outside the format.
template <typename F>
[[nodiscard]] FormatErrors measure(const Sample& sample) {
  ErrorCounter<F> counter(sample.triangles);
  for (const SampledPencil& pencil : sample.pencils) {
    counter.add(pencil);
  }
  return std::move(counter).errors();
}

}  // namespace raplas
