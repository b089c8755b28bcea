// Embree as a device: an independent ray tracer in single precision.
#pragma once

#include <memory>

#include "raplas/device.hpp"

namespace raplas {

/// A device on Embree 3, packets of 16 rays; `robust` sets RTC_SCENE_FLAG_ROBUST (watertight). Hits of
/// pencils with any_hit name no triangle. Throws std::runtime_error if Embree cannot be started.
[[nodiscard]] std::unique_ptr<IntersectionDevice> make_embree_device(bool robust);

}  // namespace raplas
