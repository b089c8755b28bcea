// Latency of fixed_testers: objects in turn, with planes that stay.
#include <random>

#include "latency.hpp"
#include "raplas/fixed_point.hpp"

namespace raplas {
namespace {

TEST(Latency, OfFixedTestersIsItsStages) {
  std::mt19937_64 random(306);
  const auto word = [&random] { return static_cast<std::int32_t>(random() % (1U << 17)) - (1 << 16); };
  FixedPlanes planes;
  const auto load = [&](FixedPlane& row_plane, FixedPlane& column_plane, std::uint64_t index) {
    row_plane = {{word(), word(), word()}, std::int64_t{word()} << 13};
    column_plane = {{word(), word(), word()}, std::int64_t{word()} << 13};
    dut().set(dut().port("load_i"), 1);
    dut().set(dut().port("index_i"), index);
    dut().set(dut().port("row_plane_i"), row_plane.pack());
    dut().set(dut().port("column_plane_i"), column_plane.pack());
    dut().clock();
  };
  for (std::size_t k = 0; k < kMaxRows; ++k) {
    load(planes.rows[k], planes.columns[k], k);
  }
  load(planes.near, planes.depth, kAxisPlane);
  load(planes.down, planes.across, kGridPlane);
  dut().set(dut().port("load_i"), 0);

  const auto make = [&]() -> Operands {
    const FixedVec3 centre{word(), word(), word()};
    const auto radius = static_cast<std::uint32_t>(random() % (1U << 14));
    const FixedTest test = test_object(planes, centre, radius, 5);
    PackedWord<4 * kCoordinateBits> object{};
    for (int k = 0; k < 3; ++k) {
      insert(object, {(3 - k) * kCoordinateBits, kCoordinateBits},
             static_cast<std::uint32_t>(centre[static_cast<std::size_t>(k)]));
    }
    insert(object, {0, kCoordinateBits}, radius);
    const auto sum = [](std::int64_t value) {
      const std::uint64_t bits =
          static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << kPlaneSumBits) - 1);
      return std::array{static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
    };
    return {{port_value("object_i", object), port_value("slack_i", 5)},
            {port_value("rows_meet_o", test.rows_meet), port_value("rows_above_o", test.rows_above),
             port_value("columns_meet_o", test.columns_meet),
             port_value("columns_above_o", test.columns_above), port_value("near_o", test.near ? 1 : 0),
             port_value("z_o", test.z), port_value("depth_sum_code_o", test.depth),
             port_value("down_sum_o", sum(test.down)), port_value("across_sum_o", sum(test.across))}};
  };
  check_latency(operands_in_turn(Dut::simulator() == "ghdl" ? 4 : 20, make),
                kPlaneTestStages + kDepthCodeStages);
}

}  // namespace
}  // namespace raplas
