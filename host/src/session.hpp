// What the commands share: their options, a scene made ready for devices, one rendering run.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "raplas/renderer.hpp"
#include "raplas/scene.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {

/// The command line after the profile and the single options that override it.
struct Settings {
  std::filesystem::path scene;
  std::string profile;
  RenderOptions render;
  bool flat = false;
  TreeOptions tree;
  DeviceOptions device;
  std::filesystem::path json;  ///< empty: none
  bool quiet = false;
};

/// A scene and the memories' contents made of it.
struct Prepared {
  Scene scene;
  SphereTree tree;
};

/// One device's picture and figures.
struct DeviceRun {
  Rendering rendering;
  Counters counters{};
  Retests retests;
  double seconds = 0;                  ///< of load and render
  std::uint64_t simulated_clocks = 0;  ///< IntersectionDevice::simulated_clocks()

  [[nodiscard]] std::uint64_t cycles() const { return counters[static_cast<std::size_t>(Counter::cycles)]; }
  [[nodiscard]] std::uint64_t rays() const {
    return rendering.stats.camera_rays + rendering.stats.shadow_rays;
  }
};

/// Loads the scene, builds and checks its spheres. Says on stderr how many degenerate triangles were dropped.
/// Throws std::runtime_error, also when the memories of `settings.device` are too small.
[[nodiscard]] Prepared prepare(const Settings& settings);

/// Renders with the device of this name; `hits` as in RenderHooks. Errors name the scene or the device.
[[nodiscard]] DeviceRun run_device(const Prepared& prepared, const Settings& settings,
                                   const std::string& name,
                                   const std::function<void(std::span<const Hit>)>& hits);

}  // namespace raplas
