// What the hits of a configuration are off by: rays against double precision, pictures byte by byte.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "error_counter.hpp"
#include "session.hpp"

namespace raplas {

/// Errors of hits of rays; triangles are numbers in the scene.
struct RayErrors {
  std::uint64_t rays = 0;
  std::uint64_t undecided = 0;          ///< double precision cannot tell; not among the three below
  std::uint64_t missed = 0;             ///< RayVerdict::missed
  std::uint64_t false_hits = 0;         ///< RayVerdict::false_hit
  std::uint64_t other = 0;              ///< RayVerdict::other; 0 for pencils with any_hit
  std::optional<Quantiles> t_relative;  ///< |t - reference| / reference, of rays that hit the same triangle
  std::optional<Quantiles> t_ulp;  ///< the same in units of the last place of fp24 in the reference's binade

  [[nodiscard]] std::uint64_t decided() const { return rays - undecided; }
  [[nodiscard]] std::uint64_t wrong() const { return missed + false_hits + other; }
};

/// Compares what was `found` with what device `reference` has found, `expected`. Where they differ, the ray's
/// pairs decide (reference_pairs.hpp), so that ties and hits that double precision cannot tell from misses
/// are no errors. `prepared` is that of the reference.
[[nodiscard]] RayErrors compare_rays(const Prepared& prepared, std::span<const Pencil> pencils,
                                     std::span<const std::vector<Hit>> expected,
                                     std::span<const std::vector<Hit>> found);

/// Errors of a picture of 8 bits a channel.
struct PictureErrors {
  double rmse = 0;             ///< root of the mean square difference of the bytes, in levels
  std::optional<double> psnr;  ///< 20 log10(255 / rmse) in dB; nothing if all bytes are equal
  double pixels_percent = 0;   ///< pixels of which a channel differs, % of the pixels
};

/// The PSNR of a root mean square error in levels; nothing for 0.
[[nodiscard]] std::optional<double> psnr_of(double rmse);

/// Both of 3 bytes a pixel and one size, at least a pixel.
[[nodiscard]] PictureErrors compare_pictures(const std::vector<std::uint8_t>& expected,
                                             const std::vector<std::uint8_t>& found);

}  // namespace raplas
