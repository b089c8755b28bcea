// One maker for each device, for make_device().
#pragma once

#include <memory>

#include "raplas/device.hpp"

namespace raplas {

[[nodiscard]] std::unique_ptr<IntersectionDevice> make_reference_device();
[[nodiscard]] std::unique_ptr<IntersectionDevice> make_model_device(const DeviceOptions& options);
/// Only in builds with RAPLAS_WITH_RTL.
[[nodiscard]] std::unique_ptr<IntersectionDevice> make_rtl_device(const DeviceOptions& options);

}  // namespace raplas
