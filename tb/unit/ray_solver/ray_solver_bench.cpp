// ray_solver against the 33 operations done by MPFR, at full speed and with bubbles. GUARD_BITS is the unit's
// generic.
#include <deque>

#include "support/ray_triangle_pairs.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const int kCases = Dut::simulator() == "ghdl" ? 1'500 : 30'000;
constexpr int kSignStage = kRaySolverStages - kAddStages;  // t' and d are known
const PortStage kHitStage{"hit_o", kRaySolverStages};
const PortStage kEarlyStage{"t_s22_o", kSignStage};

class RaySolver : public testing::Test {
 protected:
  void run(int bubble_percent) {
    struct Expected {
      bool valid;
      Solution<F> solution;
    };
    OperandPairs pairs(131);
    reset_dut();
    std::deque<Expected> line;  // the youngest at the front
    int hits = 0;
    for (int k = 0; k < kCases && !HasFailure(); ++k) {
      const Solution<F> s = apply_pair(pairs, k);
      line.push_front({pairs.between(0, 99) >= bubble_percent, s});
      dut().set(dut().port("valid_i"), line.front().valid ? 1 : 0);
      dut().clock();
      if (line.size() >= kSignStage) {
        const Solution<F>& early = line[kSignStage - 1].solution;
        expect_port(dut().port("t_s22_o"), early.t.bits(), "t_s22_o");
        expect_port(dut().port("d_s22_o"), early.d.bits(), "d_s22_o");
      }
      if (line.size() == kRaySolverStages) {
        const auto [valid, due] = line.back();
        line.pop_back();
        hits += valid && due.hit ? 1 : 0;
        expect_port(dut().port("valid_o"), valid ? 1 : 0, "valid_o");
        expect_port(dut().port("hit_o"), valid && due.hit ? 1 : 0, "hit_o");
        expect_port(dut().port("t_o"), due.t.bits(), "t_o");
        expect_port(dut().port("d_o"), due.d.bits(), "d_o");
        expect_port(dut().port("u_o"), due.u.bits(), "u_o");
        expect_port(dut().port("v_o"), due.v.bits(), "v_o");
      }
    }
    EXPECT_GT(hits, kCases / 40) << "hardly a hit is tested";
  }
};

TEST_F(RaySolver, SolvesAPairEveryClock) { run(0); }
TEST_F(RaySolver, KeepsItsPlaceAmongBubbles) { run(60); }
TEST_F(RaySolver, ForgetsWhatIsInsideWhenReset) { expect_empty_after_reset(kRaySolverStages); }

}  // namespace
}  // namespace raplas
