// Latency of depth_code.
#include <random>

#include "latency.hpp"
#include "raplas/fixed_point.hpp"

namespace raplas {
namespace {

TEST(Latency, OfDepthCodeIsItsStages) {
  std::mt19937_64 random(305);
  const auto make = [&random]() -> Operands {
    const std::uint64_t d = random() >> (24 + random() % 30);
    return {
        {port_value("d_i", std::array{static_cast<std::uint32_t>(d), static_cast<std::uint32_t>(d >> 32)})},
        {port_value("code_o", depth_code(static_cast<std::int64_t>(d))),
         port_value("z_o", depth_lower(static_cast<std::int64_t>(d)))}};
  };
  check_latency(operands_in_turn(20, make), kDepthCodeStages);
}

}  // namespace
}  // namespace raplas
