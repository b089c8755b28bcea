// The pencils of a scene that programs measure: those of its camera's picture, and of points seen in it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raplas/pencil.hpp"
#include "shading.hpp"

namespace raplas {

/// Pencils of at most 16x16 rays for a picture of width x height pixels, row by row.
[[nodiscard]] std::vector<Pencil> camera_pencils(const Camera& camera, int width, int height);

/// A pixel that shows a surface, not the light.
struct SeenPixel {
  int x;
  int y;
  SurfacePoint point;
};

/// Of each tile x tile pixels one, chosen by a fixed hash, if it shows a surface. `pencils` and `hits` are
/// those of camera_pencils(); the device's triangle k is the scene's source[k].
[[nodiscard]] std::vector<SeenPixel> seen_pixels(const Scene& scene, std::span<const std::uint32_t> source,
                                                 int width, int height, int tile,
                                                 std::span<const Pencil> pencils,
                                                 std::span<const std::vector<Hit>> hits);

/// The shadow pencils of 16x16 rays of those pixels that need them.
[[nodiscard]] std::vector<Pencil> shadow_pencils(const Scene& scene, std::span<const SeenPixel> pixels);

/// Rays all over the hemisphere above a point, as over the upper half of a cube's faces: 16x16 on the face
/// across the surface's normal, 8x16 on each of four others. The nearest hits are wanted.
[[nodiscard]] std::vector<Pencil> hemisphere_pencils(const SurfacePoint& point);

}  // namespace raplas
