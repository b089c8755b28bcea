// Latency of plane_sphere_tester: cases that meet and cases that don't, in turn.
#include "balls.hpp"
#include "latency.hpp"

namespace raplas {
namespace {

TEST(Latency, OfPlaneSphereTesterIsItsStages) {
  OperandPairs pairs(303);
  const auto make = [&pairs]() -> Operands {
    const PlaneWord<Fp24> plane = some_plane(pairs);
    const SphereWord<Fp24> sphere = some_sphere(pairs);
    const bool meets = plane_meets_sphere(plane, sphere.centre, sphere.radius);
    return {{port_value("plane_i", plane.pack()), port_value("ball_i", pack_ball(sphere))},
            {port_value("meets_o", meets ? 1 : 0)}};
  };
  check_latency(operands_in_turn(40, make), kTesterStages);
}

}  // namespace
}  // namespace raplas
