// Latency of ray_triangle: hits, misses and bubbles, with no best hit yet.
#include "latency.hpp"
#include "operands.hpp"
#include "raplas/ray_triangle.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

/// A ray through the point u, v of a triangle, both in eighths: a hit when they lie inside it.
struct Case {
  TriangleWord<Fp24> triangle;
  Vec3<Fp24> origin;
  Vec3<Fp24> direction;
};

Case some_case(OperandPairs& pairs) {
  const auto vector = [&pairs] {
    const auto number = [&pairs] { return Fp24::from_bits(pairs.word(63 + pairs.between(-4, 0))); };
    return Vec3<Fp24>{number(), number(), number()};
  };
  Case c{{vector(), vector(), vector(), {}}, {}, vector()};
  c.triangle.n = cross(c.triangle.e1, c.triangle.e2);
  const double u = pairs.between(1, 6) / 8.0;
  const double v = pairs.between(1, 6) / 8.0;
  const auto start = [u, v](Fp24 v0, Fp24 e1, Fp24 e2, Fp24 d) {
    return Fp24::from_double(v0.to_double() + u * e1.to_double() + v * e2.to_double() - d.to_double());
  };
  c.origin = {start(c.triangle.v0.x, c.triangle.e1.x, c.triangle.e2.x, c.direction.x),
              start(c.triangle.v0.y, c.triangle.e1.y, c.triangle.e2.y, c.direction.y),
              start(c.triangle.v0.z, c.triangle.e1.z, c.triangle.e2.z, c.direction.z)};
  return c;
}

TEST(Latency, OfRayTriangleIsItsStages) {
  OperandPairs pairs(305);
  int hits = 0;
  const auto make = [&]() -> Operands {
    const Case c = some_case(pairs);
    const Solution<Fp24> s = solve(c.triangle, c.origin, c.direction);
    const bool valid = pairs.between(0, 3) != 0;
    const bool hit = valid && s.hit;
    const std::uint32_t ray = pairs.bits(8);
    const std::uint32_t id = pairs.bits(20);
    const ResultWord<Fp24> result{hit, id, s.t, s.d, s.u, s.v};
    const std::uint32_t stored = hit ? 1 : 0;
    hits += hit ? 1 : 0;
    return {{port_value("valid_i", valid ? 1 : 0), port_value("ray_i", ray), port_value("triangle_id_i", id),
             port_value("triangle_i", c.triangle.pack()), port_value("direction_i", pack_ray(c.direction)),
             port_value("origin_i", pack_ray(c.origin))},
            {port_value("valid_o", valid ? 1 : 0), port_value("hit_o", stored), port_value("write_o", stored),
             port_value("first_o", stored), port_value("ray_o", ray), port_value("result_o", result.pack())}};
  };
  reset_dut();
  dut().set(dut().port("best_i"), ResultWord<Fp24>{}.pack());
  check_latency(operands_in_turn(20, make), kRayTriangleStages);
  EXPECT_GT(hits, 4);
}

}  // namespace
}  // namespace raplas
