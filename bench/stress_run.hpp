// Runs cases of the stress catalogue on devices, and counts which answers are wrong, and why.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "error_band.hpp"
#include "raplas/device.hpp"
#include "stress_cases.hpp"

namespace raplas {

/// A column of the report.
struct StressDevice {
  const char* name;
  const char* maker;  ///< of make_device()
  DeviceOptions options;
  ErrorModel errors;       ///< what its answers may be off by
  bool flat = false;       ///< takes a flat list of spheres
  bool refuses = true;     ///< says so when it can't take an input
  bool near_plane = true;  ///< leaves out what is behind the surface that rays start on
  std::size_t share = 1;   ///< takes one pencil of so many
  bool closed = false;     ///< borders are as wide as its errors: closed meshes have no holes
};

/// All devices of this build.
[[nodiscard]] std::span<const StressDevice> stress_devices();

/// Must the property hold on the device? Others are known not to: how often they fail is shown.
[[nodiscard]] bool is_promised(const StressCase& stress, const StressDevice& device);

/// "explained", "moved" and so on.
[[nodiscard]] const char* name_of(Property property);

/// What one device made of a case.
struct StressCounts {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;         ///< rays that truly hit
  std::uint64_t differing = 0;    ///< not what exact arithmetic finds: hit or not, and which triangle
  std::uint64_t unexplained = 0;  ///< beyond what the device's error bound explains: never promised to happen
  std::uint64_t broken = 0;       ///< answers that break the case's property
  std::uint64_t inexact = 0;      ///< of an exact device: other bits than those of the reference
  double t_error = 0;             ///< largest relative error of t, of rays with the true triangle
  std::string refusal;            ///< what the device said instead of answering

  /// Promised properties that failed: 0 to 3.
  [[nodiscard]] int failures(bool promised) const {
    return (unexplained > 0 ? 1 : 0) + (inexact > 0 ? 1 : 0) + (promised && broken > 0 ? 1 : 0);
  }
};

/// Runs a case with about `rays` rays; one result for each device. The same `rays` give the same results.
/// Throws what the case's make() throws, if it isn't meant to be refused.
[[nodiscard]] std::vector<StressCounts> run_case(const StressCase& stress, std::size_t rays,
                                                 std::span<const StressDevice> devices);

}  // namespace raplas
