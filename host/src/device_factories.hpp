// One maker for each device, for make_device(), and what devices share.
#pragma once

#include <memory>
#include <span>

#include "raplas/device.hpp"

namespace raplas {

[[nodiscard]] std::unique_ptr<IntersectionDevice> make_reference_device();
[[nodiscard]] std::unique_ptr<IntersectionDevice> make_model_device(const DeviceOptions& options);
/// Of a pencil with any_hit only hits before Pencil::far count: for devices that don't know it.
void drop_far_hits(const Pencil& pencil, std::span<Hit> hits);

/// Only in builds with RAPLAS_WITH_RTL.
[[nodiscard]] std::unique_ptr<IntersectionDevice> make_rtl_device(const DeviceOptions& options);

}  // namespace raplas
