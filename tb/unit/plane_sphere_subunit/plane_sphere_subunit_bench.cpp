// plane_sphere_subunit with 4 + 4 planes against the value-exact model, at full speed and with bubbles.
#include "operands.hpp"
#include "raplas/plane_sphere.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

using F = Fp24;
const int kClocks = Dut::simulator() == "ghdl" ? 300 : 12'000;
constexpr std::size_t kPlanes = 8;
const PortStage kFlagsStage{"row_flags_o", kTesterStages};
const PortStage kColumnsStage{"column_flags_o", kTesterStages};
const PortStage kValidStage{"valid_o", kTesterStages};
const PortStage kTagStage{"tag_o", kTesterStages};

struct Due {
  bool valid;
  std::uint32_t flags;
  std::uint32_t tag;
};

class PlaneSphereSubunit : public testing::Test {
 protected:
  /// `rim`: each plane is moved to touch the sphere, but for the last bits; one in turn touches it exactly.
  void run(int bubble_percent, bool rim) {
    OperandPairs pairs(31);
    reset_dut();
    Scoreboard<Due> board(kTesterStages);
    int met = 0;
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      const auto number = [&pairs] { return F::from_bits(pairs.word(63 + pairs.between(-4, 0))); };
      SphereWord<F> sphere{{number(), number(), number()}, F::from_bits(number().magnitude()), false, 0, 0};
      PackedWord<kPlanes * 96> planes{};
      Due due{pairs.between(0, 99) >= bubble_percent, 0, pairs.bits(5)};
      std::array<PlaneWord<F>, kPlanes> all{};
      for (PlaneWord<F>& plane : all) {
        plane = {{number(), number(), number()}, number()};
        if (rim) {
          const double dot = plane.normal.x.to_double() * sphere.centre.x.to_double() +
                             plane.normal.y.to_double() * sphere.centre.y.to_double() +
                             plane.normal.z.to_double() * sphere.centre.z.to_double();
          const double radius = sphere.radius.to_double();
          plane.offset = F::from_double((pairs.bits(1) != 0 ? radius : -radius) - dot);
        }
      }
      if (rim) {
        const F distance = plane_distance(all[static_cast<std::size_t>(k) % kPlanes], sphere.centre);
        const std::uint32_t outside = distance.magnitude() > 0x010000U ? pairs.bits(1) : 0U;
        sphere.radius = F::from_bits(distance.magnitude() - outside);
      }
      for (std::size_t i = 0; i < kPlanes; ++i) {
        const PlaneWord<F>& plane = all[i];
        const auto word = plane.pack();
        std::copy(word.begin(), word.end(), planes.begin() + static_cast<std::ptrdiff_t>(3 * i));
        due.flags |= (plane_meets_sphere(plane, sphere.centre, sphere.radius) ? 1U : 0U) << i;
      }
      PackedWord<96> ball{};
      const auto word = sphere.pack();
      for (int i = 0; i < 4; ++i) {
        insert(ball, {72 - 24 * i, 24}, extract(word, {SphereLayout::cx.lsb - 24 * i, 24}));
      }
      dut().set(dut().port("valid_i"), due.valid ? 1 : 0);
      dut().set(dut().port("ball_i"), ball);
      dut().set(dut().port("planes_i"), planes);
      dut().set(dut().port("tag_i"), due.tag);
      met += due.flags != 0 && due.flags != 0xff ? 1 : 0;
      if (const auto seen = board.clock(due)) {
        expect_port(dut().port("valid_o"), seen->valid ? 1 : 0, "valid_o");
        if (seen->valid) {
          expect_port(dut().port("row_flags_o"), seen->flags & 15U, "row_flags_o");
          expect_port(dut().port("column_flags_o"), seen->flags >> 4, "column_flags_o");
          expect_port(dut().port("tag_o"), seen->tag, "tag_o");
        }
      }
    }
    EXPECT_GT(met, kClocks / 2);  // flags of both kinds are common
  }
};

TEST_F(PlaneSphereSubunit, TestsASphereEveryClock) { run(0, false); }
TEST_F(PlaneSphereSubunit, KeepsItsPlaceAmongBubbles) { run(60, false); }
TEST_F(PlaneSphereSubunit, IsExactAtTheRimOfEveryPlane) { run(0, true); }

}  // namespace
}  // namespace raplas
