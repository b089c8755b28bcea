// The pencils of a picture as double precision makes them: what all configurations are compared on.
#pragma once

#include <span>
#include <vector>

#include "raplas/renderer.hpp"
#include "session.hpp"

namespace raplas {

/// Pencils with the hits that device `reference` finds; a hit's triangle is its number in the scene, not the
/// device's.
struct Recorded {
  std::vector<Pencil> camera;
  std::vector<Pencil> shadow;
  std::vector<std::vector<Hit>> camera_hits;
  std::vector<std::vector<Hit>> shadow_hits;
  Image picture;
};

/// Renders with device `reference` and keeps what went through it.
[[nodiscard]] Recorded record(const Prepared& prepared, const RenderOptions& options);

/// The hits with their triangles' numbers in the scene for those in the device.
void to_scene_triangles(std::span<const std::uint32_t> source, std::vector<std::vector<Hit>>& hits);

}  // namespace raplas
