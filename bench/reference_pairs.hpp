// The rays of a picture with the triangles that they may hit, decided in double precision.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "parallel.hpp"
#include "raplas/device.hpp"
#include "raplas/scene_file.hpp"

namespace raplas {

/// Whether a ray hits a triangle; undecided: double precision cannot tell.
enum class Verdict : std::uint8_t { miss, hit, undecided };

/// A ray and a triangle in double precision.
struct ReferencePair {
  std::uint32_t triangle = 0;
  Verdict verdict = Verdict::undecided;
  double t = 0;        ///< of a hit: the distance, in units of the direction's length
  double t_error = 0;  ///< of a hit: t is off by at most this
};

/// Moeller's test as device `reference` makes it, of triangle and ray as they are. A pair is undecided if t',
/// u', v' or d - u' - v' could be on either side of 0 within a crude bound of their rounding errors and the
/// others do not make it a miss, or if N.D is within its bound.
[[nodiscard]] ReferencePair reference_pair(const Triangle& triangle, std::uint32_t id,
                                           const glm::dvec3& origin, const glm::dvec3& direction);

/// All triangles of which a piece is in a leaf sphere that the ray meets in front of its origin, ascending.
/// Spheres are taken a little larger than they are, so that none is lost; `direction` has unit length.
[[nodiscard]] std::vector<std::uint32_t> candidates(const DeviceScene& scene, const glm::dvec3& origin,
                                                    const glm::dvec3& direction);

/// A ray and its decided pairs.
struct SampledRay {
  glm::dvec3 direction;  ///< unit length
  std::vector<ReferencePair> pairs;
  std::uint32_t undecided = 0;  ///< pairs left out
};

/// The ray with the pairs of its candidates; `direction` has unit length.
[[nodiscard]] SampledRay sampled_ray(const DeviceScene& scene, const glm::dvec3& origin,
                                     const glm::dvec3& direction);

/// Rays of one origin.
struct SampledPencil {
  glm::dvec3 origin;
  std::vector<SampledRay> rays;
};

/// What every format is measured on.
struct Sample {
  std::span<const Triangle> triangles;  ///< of the scene that the sample was made of
  std::vector<SampledPencil> pencils;
};

struct SampleCounts {
  std::uint64_t rays = 0;
  std::uint64_t rays_hit = 0;  ///< rays with a hit
  std::uint64_t pairs = 0;     ///< decided
  std::uint64_t hits = 0;      ///< decided pairs that hit
  std::uint64_t undecided = 0;
};

/// The camera's rays of a picture of width x height pixels in pencils of at most 16x16, with the pairs of
/// their candidates. `scene` must outlive the sample.
[[nodiscard]] Sample make_sample(const DeviceScene& scene, const Camera& camera, int width, int height,
                                 const ShowProgress& progress);

[[nodiscard]] SampleCounts count(const Sample& sample);

/// The nearest hit, the lower triangle on a tie; nullptr: none.
[[nodiscard]] const ReferencePair* nearest_hit(std::span<const ReferencePair> pairs);

}  // namespace raplas
