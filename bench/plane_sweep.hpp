// Plane tests of several arithmetics on the spheres that a camera's pencils meet: what they lose, and what
// they find that isn't there.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "parallel.hpp"
#include "raplas/device.hpp"

namespace raplas {

inline constexpr int kLeastWidth = 10;
inline constexpr int kMostWidth = 24;

/// Answers of one arithmetic, compared with those of double precision.
struct PlaneErrors {
  std::uint64_t lost = 0;         ///< meets that were not found
  std::uint64_t false_meets = 0;  ///< found, but there is none
};

/// An arithmetic with what it was measured to do.
struct PlaneTester {
  std::string key;           ///< w10 .. w24: fixed point of so many bits; fp24_paper, fp24
  int dsp48 = 0;             ///< of one test
  PlaneErrors conservative;  ///< with the margin for which nothing is lost
  PlaneErrors bare;          ///< without it, all words to nearest
};

struct PlaneSweep {
  std::uint64_t tests = 0;  ///< of a sphere by a plane
  std::uint64_t meets = 0;  ///< in double precision
  std::vector<PlaneTester> testers;
};

/// DSP48 of a test with words of `width` bits: docs/benchmarks.md.
[[nodiscard]] int fixed_plane_dsp48(int width);

/// Every sphere that a pencil's walk tests by each line of the pencil. In double precision, a sphere is
/// walked into if it meets a row and a column.
[[nodiscard]] PlaneSweep sweep_planes(const DeviceScene& scene, std::span<const Pencil> pencils,
                                      const ShowProgress& progress);

}  // namespace raplas
