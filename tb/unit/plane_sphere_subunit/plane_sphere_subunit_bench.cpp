// plane_sphere_subunit with 4 + 4 planes against the value-exact model, at full speed and with bubbles.
#include "operands.hpp"
#include "raplas/plane_sphere.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

using F = Fp24;
const int kClocks = Dut::simulator() == "ghdl" ? 300 : 20'000;
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
  /// What the planes have to do with the sphere.
  enum class Planes {
    any,
    at_the_rim,  // each is moved until it touches the sphere exactly, or all but the last bits
    hard_sums    // corners, sums that cancel, far exponents; one plane in turn touches the sphere
  };

  void run(int bubble_percent, Planes kind) {
    OperandPairs pairs(31);
    reset_dut();
    Scoreboard<Due> board(kTesterStages);
    int met = 0;
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      const int spread = kind != Planes::any && k % 2 == 1 ? 16 : 4;
      const auto number = [&pairs, spread] {
        return F::from_bits(pairs.word(63 + pairs.between(-spread, 0)));
      };
      SphereWord<F> sphere{{number(), number(), number()}, F::from_bits(number().magnitude()), false, 0, 0};
      PackedWord<kPlanes * 96> planes{};
      Due due{pairs.between(0, 99) >= bubble_percent, 0, pairs.bits(5)};
      const auto corner = [&pairs] {
        return F::from_bits(kCorners[static_cast<std::size_t>(pairs.between(0, kCorners.size() - 1))]);
      };
      const bool hard = kind == Planes::hard_sums;
      if (hard && k % 4 == 0) {
        sphere.centre = {corner(), corner(), corner()};
      } else if (kind != Planes::any && k % 4 == 1) {
        sphere.centre.y = F::from_bits(sphere.centre.x.bits() ^ pairs.bits(8));
      }
      std::array<PlaneWord<F>, kPlanes> all{};
      for (PlaneWord<F>& plane : all) {
        plane = {{number(), number(), number()}, number()};
        if (kind != Planes::any && k % 4 == 1) {  // the first sum nearly cancels
          plane.normal.y = F::from_bits(plane.normal.x.bits() ^ 0x800000U);
        }
        if (hard && k % 4 == 0) {
          plane = {{corner(), corner(), corner()}, corner()};
        } else if (hard && k % 4 == 2) {  // the second one
          plane.offset = F::from_bits((plane.normal.z * sphere.centre.z).bits() ^ 0x800000U ^ pairs.bits(4));
        } else if (hard && k % 4 == 3) {  // the last one
          const F xy = plane.normal.x * sphere.centre.x + plane.normal.y * sphere.centre.y;
          plane.offset =
              F::from_bits((xy + plane.normal.z * sphere.centre.z).bits() ^ 0x800000U ^ pairs.bits(6));
        }
        if (kind == Planes::at_the_rim) {
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
      if (hard) {
        const F distance = plane_distance(all[static_cast<std::size_t>(pairs.bits(3))], sphere.centre);
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
    EXPECT_GT(met, kClocks / 4);  // flags of both kinds are common
  }
};

TEST_F(PlaneSphereSubunit, TestsASphereEveryClock) { run(0, Planes::any); }
TEST_F(PlaneSphereSubunit, KeepsItsPlaceAmongBubbles) { run(60, Planes::any); }
TEST_F(PlaneSphereSubunit, IsExactAtTheRimOfEveryPlane) { run(0, Planes::at_the_rim); }
TEST_F(PlaneSphereSubunit, IsExactAtTheRimWhateverIsAdded) { run(0, Planes::hard_sums); }
TEST_F(PlaneSphereSubunit, ForgetsWhatIsInsideWhenReset) { expect_empty_after_reset(kTesterStages); }

}  // namespace
}  // namespace raplas
