// Latency of plane_sphere_subunit with 4 + 4 planes: flags, valid and tag.
#include <algorithm>

#include "balls.hpp"
#include "latency.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr std::size_t kPlanes = 8;

TEST(Latency, OfPlaneSphereSubunitIsItsTesters) {
  OperandPairs pairs(304);
  const auto make = [&pairs]() -> Operands {
    const SphereWord<Fp24> sphere = some_sphere(pairs);
    PackedWord<kPlanes * 96> planes{};
    std::uint32_t flags = 0;
    for (std::size_t k = 0; k < kPlanes; ++k) {
      const PlaneWord<Fp24> plane = some_plane(pairs);
      const auto word = plane.pack();
      std::copy(word.begin(), word.end(), planes.begin() + static_cast<std::ptrdiff_t>(3 * k));
      flags |= (plane_meets_sphere(plane, sphere.centre, sphere.radius) ? 1U : 0U) << k;
    }
    const std::uint32_t valid = pairs.bits(1);
    const std::uint32_t tag = pairs.bits(5);
    return {{port_value("valid_i", valid), port_value("ball_i", pack_ball(sphere)),
             port_value("planes_i", planes), port_value("tag_i", tag)},
            {port_value("valid_o", valid), port_value("row_flags_o", flags & 15U),
             port_value("column_flags_o", flags >> 4), port_value("tag_o", tag)}};
  };
  reset_dut();
  check_latency(operands_in_turn(20, make), kTesterStages);
}

}  // namespace
}  // namespace raplas
