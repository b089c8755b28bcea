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
  /// `rim`: each plane is moved until it touches the sphere exactly, or all but the last bits.
  void run(int bubble_percent, bool rim) {
    OperandPairs pairs(31);
    reset_dut();
    Scoreboard<Due> board(kTesterStages);
    int met = 0;
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      const int spread = rim && k % 2 == 1 ? 16 : 4;
      const auto number = [&pairs, spread] {
        return F::from_bits(pairs.word(63 + pairs.between(-spread, 0)));
      };
      SphereWord<F> sphere{{number(), number(), number()}, F::from_bits(number().magnitude()), false, 0, 0};
      PackedWord<kPlanes * 96> planes{};
      Due due{pairs.between(0, 99) >= bubble_percent, 0, pairs.bits(5)};
      std::array<PlaneWord<F>, kPlanes> all{};
      for (PlaneWord<F>& plane : all) {
        plane = {{number(), number(), number()}, number()};
        if (rim) {
          const double target = (pairs.bits(1) != 0 ? 1 : -1) * sphere.radius.to_double();
          for (int step = 0; step < 3; ++step) {  // rounding leaves a rest: to be made up for
            const double rest = target - plane_distance(plane, sphere.centre).to_double();
            plane.offset = F::from_double(plane.offset.to_double() + rest);
          }
          if (pairs.bits(1) != 0) {  // or an ulp or so beside it
            plane.offset = F::from_bits(plane.offset.bits() ^ (1U << pairs.bits(2)));
          }
        }
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
