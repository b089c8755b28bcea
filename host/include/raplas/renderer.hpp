// Renders a scene with any device: camera pencils, a shadow pencil for each pixel that is hit, Lambert
// shading.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raplas/device.hpp"
#include "raplas/image.hpp"
#include "raplas/scene.hpp"

namespace raplas {

struct RenderOptions {
  int width = 512;   ///< pixels, 1 .. 16384
  int height = 512;  ///< pixels, 1 .. 16384
  int pencil = 16;   ///< rays in a row and in a column of a camera pencil, 1 .. 16
  int shadow = 4;    ///< the same of a shadow pencil; 0: no shadows
};

struct RenderStats {
  std::uint64_t camera_rays = 0;
  std::uint64_t shadow_rays = 0;
  std::uint64_t pencils = 0;
  double trace_seconds = 0;  ///< within IntersectionDevice::trace()
};

struct Rendering {
  Image image;
  RenderStats stats;
};

/// Called from within render(); either may be empty.
struct RenderHooks {
  std::function<void(std::span<const Hit>)> hits;  ///< of each pencil, in the order of tracing
  std::function<void(double)> progress;            ///< share of the work done, 0 .. 1
};

/// Renders with a device whose memories hold the scene's triangles in another order: the device's triangle k
/// is the scene's source[k]. Deterministic: devices with equal hits get equal pencils and give equal
/// pictures.
[[nodiscard]] Rendering render(const Scene& scene, std::span<const std::uint32_t> source,
                               IntersectionDevice& device, const RenderOptions& options,
                               const RenderHooks& hooks = {});

}  // namespace raplas
