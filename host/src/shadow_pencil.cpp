#include "shadow_pencil.hpp"

#include <glm/geometric.hpp>

namespace raplas {
namespace {

/// An occluder counts when it is nearer than this share of the way to the light's plane.
constexpr double kBeforeLight = 1 - 1.0 / 128;

}  // namespace

/// Integer mixing after SplitMix64.
double pixel_noise(int x, int y, std::uint64_t salt) {
  std::uint64_t z =
      (static_cast<std::uint64_t>(y) << 32) + static_cast<std::uint64_t>(x) + salt * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-53 - 0.5;
}

SurfacePoint seen_point(const Scene& scene, std::uint32_t triangle, const Hit& hit,
                        const glm::dvec3& direction) {
  return surface_point(scene.triangles[triangle], scene.surfaces[triangle], hit, direction,
                       scene.longest_edge);
}

bool needs_shadow_rays(const SurfacePoint& point, const AreaLight& light) {
  return point.colour != glm::dvec3(0) && may_be_lit(point, light);
}

Grid shadow_grid(const AreaLight& light, int size, int x, int y) {
  return light_grid(light, size, pixel_noise(x, y, 1), pixel_noise(x, y, 2));
}

Pencil shadow_pencil(const SurfacePoint& point, const Grid& light) {
  Pencil pencil = make_pencil(shadow_origin(point), light);
  pencil.front = point.facing;
  pencil.any_hit = true;
  pencil.far = kBeforeLight * glm::dot(pencil.axis, light.first - pencil.origin);
  return pencil;
}

}  // namespace raplas
