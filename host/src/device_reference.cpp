// The double-precision device.
#include "device_factories.hpp"
#include "reference_device.hpp"

namespace raplas {

std::unique_ptr<IntersectionDevice> make_reference_device() {
  return std::make_unique<ReferenceDevice<double>>();
}

}  // namespace raplas
