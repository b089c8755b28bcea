#include "raplas/device.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "device_factories.hpp"

namespace raplas {

std::unique_ptr<IntersectionDevice> make_device(const std::string& name, const DeviceOptions& options) {
  if (name == "reference") {
    return make_reference_device();
  }
  if (name == "model") {
    return make_model_device(options);
  }
  if (name == "rtl") {
#ifdef RAPLAS_WITH_RTL
    return make_rtl_device(options);
#else
    throw std::runtime_error("device rtl: this build has no Verilator model");
#endif
  }
  throw std::runtime_error(fmt::format("unknown device {}; the devices are reference, model, rtl", name));
}

}  // namespace raplas
