#include "raplas/device.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <stdexcept>

#include "device_factories.hpp"

namespace raplas {

void drop_far_hits(const Pencil& pencil, std::span<Hit> hits) {
  if (!pencil.any_hit) {
    return;
  }
  for (std::size_t ray = 0; ray < hits.size(); ++ray) {
    if (hits[ray].hit && hits[ray].t() * glm::dot(pencil.axis, pencil.directions[ray]) >= pencil.far) {
      hits[ray] = {};
    }
  }
}

std::unique_ptr<IntersectionDevice> make_device(const std::string& name, const DeviceOptions& options) {
  if (options.exact && options.profile == Profile::paper) {
    throw std::runtime_error("profile paper has no certified hits: only profile raplas can be exact");
  }
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
