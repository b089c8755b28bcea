#include "scene_pencils.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "shadow_pencil.hpp"

namespace raplas {
namespace {

constexpr int kSide = kMaxRows;  // rays in a row of a pencil

}  // namespace

std::vector<Pencil> camera_pencils(const Camera& camera, int width, int height) {
  const CameraFrame frame(camera, width, height);
  std::vector<Pencil> pencils;
  for (int y = 0; y < height; y += kSide) {
    for (int x = 0; x < width; x += kSide) {
      pencils.push_back(frame.pencil(x, y, std::min(kSide, width - x), std::min(kSide, height - y)));
    }
  }
  return pencils;
}

std::vector<SeenPixel> seen_pixels(const Scene& scene, std::span<const std::uint32_t> source, int width,
                                   int height, int tile, std::span<const Pencil> pencils,
                                   std::span<const std::vector<Hit>> hits) {
  const auto in_row = static_cast<std::size_t>((width + kSide - 1) / kSide);
  std::vector<SeenPixel> pixels;
  for (int y0 = 0; y0 < height; y0 += tile) {
    for (int x0 = 0; x0 < width; x0 += tile) {
      const auto place = [&](int first, int end, std::uint64_t salt) {
        const int size = std::min(tile, end - first);
        return first + std::min(size - 1, static_cast<int>((pixel_noise(x0, y0, salt) + 0.5) * size));
      };
      const int x = place(x0, width, 3);
      const int y = place(y0, height, 4);
      const auto pencil = static_cast<std::size_t>(y / kSide) * in_row + static_cast<std::size_t>(x / kSide);
      const int in_pencil = y % kSide * pencils[pencil].columns + x % kSide;
      const auto ray = static_cast<std::size_t>(in_pencil);
      const Hit& hit = hits[pencil][ray];
      const glm::dvec3& direction = pencils[pencil].directions[ray];
      if (hit.hit && !sees_light(scene.light, scene.camera.eye, direction, hit.t())) {
        pixels.push_back({x, y, seen_point(scene, source[hit.triangle], hit, direction)});
      }
    }
  }
  return pixels;
}

std::vector<Pencil> shadow_pencils(const Scene& scene, std::span<const SeenPixel> pixels) {
  std::vector<Pencil> pencils;
  for (const SeenPixel& pixel : pixels) {
    if (needs_shadow_rays(pixel.point, scene.light)) {
      pencils.push_back(shadow_pencil(pixel.point, shadow_grid(scene.light, kSide, pixel.x, pixel.y)));
    }
  }
  return pencils;
}

std::vector<Pencil> hemisphere_pencils(const SurfacePoint& point) {
  const glm::dvec3 up = point.facing;
  const glm::dvec3 apart = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(up, apart));
  const glm::dvec3 v = glm::cross(up, u);
  const glm::dvec3 origin = shadow_origin(point);
  constexpr double kStep = 2.0 / kSide;  // faces are at a distance of 1 and 2 wide
  const auto face = [&](const glm::dvec3& axis, const glm::dvec3& right, const glm::dvec3& down, int rows) {
    // of a side face the lower half is left out
    const glm::dvec3 first = origin + axis - (1 - kStep / 2) * (right + down);
    Pencil pencil = make_pencil(origin, {first, kStep * down, kStep * right, rows, kSide});
    pencil.front = up;
    return pencil;
  };
  std::vector<Pencil> pencils{face(up, u, v, kSide)};
  for (const glm::dvec3& axis : {u, v, -u, -v}) {
    pencils.push_back(face(axis, glm::cross(up, axis), -up, kSide / 2));
  }
  return pencils;
}

}  // namespace raplas
