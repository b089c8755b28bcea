// Which camera hits need shadow rays, and the pencils of these: what the renderer and `raplas skip` trace.
#pragma once

#include <cstdint>

#include "raplas/pencil.hpp"
#include "raplas/scene.hpp"
#include "shading.hpp"

namespace raplas {

/// A number in -0.5 .. 0.5 for each pixel and `salt`, always the same.
[[nodiscard]] double pixel_noise(int x, int y, std::uint64_t salt);

/// The surface that a camera ray has hit; `triangle` is the scene's index.
[[nodiscard]] SurfacePoint seen_point(const Scene& scene, std::uint32_t triangle, const Hit& hit,
                                      const glm::dvec3& direction);

/// Is light that arrives at the point seen, if any does?
[[nodiscard]] bool needs_shadow_rays(const SurfacePoint& point, const AreaLight& light);

/// The grid of size x size points on the light for the shadow rays of pixel (x, y).
[[nodiscard]] Grid shadow_grid(const AreaLight& light, int size, int x, int y);

/// The pencil from the point to the grid; a hit a little before the light's plane is enough.
[[nodiscard]] Pencil shadow_pencil(const SurfacePoint& point, const Grid& light);

}  // namespace raplas
