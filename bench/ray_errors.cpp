#include "ray_errors.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "raplas/image.hpp"

namespace raplas {
namespace {

class Comparison {
 public:
  explicit Comparison(const Prepared& prepared) : prepared_(prepared) {}

  void add(const Pencil& pencil, std::size_t ray, const Hit& expected, const Hit& found) {
    ++errors_.rays;
    const bool same = expected.hit == found.hit && (pencil.any_hit || expected.triangle == found.triangle);
    if (!same) {
      count(verdict(pencil, pencil.directions[ray], found));
    } else if (expected.hit && !pencil.any_hit) {
      const double t = expected.t();
      const double error = std::abs(found.t() - t);
      t_relative_.push_back(error / t);
      t_ulp_.push_back(error / std::ldexp(1.0, std::ilogb(t) - kFractionBits));
    }
  }

  [[nodiscard]] RayErrors errors() && {
    errors_.t_relative = quantiles(std::move(t_relative_));
    errors_.t_ulp = quantiles(std::move(t_ulp_));
    return errors_;
  }

 private:
  /// Nothing: undecided.
  [[nodiscard]] std::optional<RayVerdict> verdict(const Pencil& pencil, const glm::dvec3& direction,
                                                  const Hit& found) const {
    SampledRay ray = sampled_ray(prepared_.tree.scene, pencil.origin, direction);
    const double limit = pencil.far / glm::dot(pencil.axis, direction);
    std::erase_if(ray.pairs, [&](const ReferencePair& pair) { return !(pair.t < limit); });
    const ReferencePair* nearest = nearest_hit(ray.pairs);
    if (nearest == nullptr && ray.undecided > 0) {
      return std::nullopt;
    }
    if (pencil.any_hit || !found.hit || nearest == nullptr) {
      const bool is_hit = nearest != nullptr;
      return is_hit == found.hit ? RayVerdict::right : is_hit ? RayVerdict::missed : RayVerdict::false_hit;
    }
    const ReferencePair pair =
        reference_pair(prepared_.scene.triangles[found.triangle], found.triangle, pencil.origin, direction);
    if (pair.verdict == Verdict::undecided) {
      return std::nullopt;
    }
    return compare_nearest(nearest, &pair);
  }

  void count(std::optional<RayVerdict> verdict) {
    errors_.undecided += verdict ? 0U : 1U;
    errors_.missed += verdict == RayVerdict::missed ? 1U : 0U;
    errors_.false_hits += verdict == RayVerdict::false_hit ? 1U : 0U;
    errors_.other += verdict == RayVerdict::other ? 1U : 0U;
  }

  const Prepared& prepared_;
  RayErrors errors_;
  std::vector<double> t_relative_;
  std::vector<double> t_ulp_;
};

}  // namespace

RayErrors compare_rays(const Prepared& prepared, std::span<const Pencil> pencils,
                       std::span<const std::vector<Hit>> expected, std::span<const std::vector<Hit>> found) {
  Comparison comparison(prepared);
  for (std::size_t k = 0; k < pencils.size(); ++k) {
    for (std::size_t ray = 0; ray < pencils[k].directions.size(); ++ray) {
      comparison.add(pencils[k], ray, expected[k][ray], found[k][ray]);
    }
  }
  return std::move(comparison).errors();
}

std::optional<double> psnr_of(double rmse) {
  constexpr double kMost = 255;
  return rmse > 0 ? std::optional(20 * std::log10(kMost / rmse)) : std::nullopt;
}

PictureErrors compare_pictures(const std::vector<std::uint8_t>& expected,
                               const std::vector<std::uint8_t>& found) {
  double squares = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double difference = double(found[k]) - double(expected[k]);
    squares += difference * difference;
  }
  const double rmse = std::sqrt(squares / static_cast<double>(expected.size()));
  const double pixels = static_cast<double>(expected.size()) / 3;
  return {rmse, psnr_of(rmse), 100 * static_cast<double>(pixels_off(found, expected, 0)) / pixels};
}

}  // namespace raplas
