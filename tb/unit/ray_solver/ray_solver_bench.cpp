// ray_solver against the operations done one by one by MPFR, plain and with certified hits, at full speed and
// with bubbles. GUARD_BITS is the unit's generic.
#include <deque>

#include "certified_pairs.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const int kCases = Dut::simulator() == "ghdl" ? 3'000 : 60'000;
constexpr int kSignStage = kRaySolverStages - kAddStages;  // t' and d are known
const PortStage kHitStage{"hit_o", kRaySolverStages};
const PortStage kRoughStage{"rough_o", kRaySolverStages};
const PortStage kUnsureStage{"unsure_o", kRaySolverStages};
const PortStage kEarlyStage{"t_s22_o", kSignStage};

class RaySolver : public testing::Test {
 protected:
  void run(int bubble_percent) {
    struct Expected {
      bool valid;
      Solution<F> solution;
    };
    reset_dut();
    std::deque<Expected> line;  // the youngest at the front
    for (int k = 0; k < kCases && !HasFailure(); ++k) {
      const bool valid = pairs_.between(0, 99) >= bubble_percent;
      line.push_front({valid, next(k, valid)});
      dut().set(dut().port("valid_i"), valid ? 1 : 0);
      dut().clock();
      if (line.size() >= kSignStage) {
        const Solution<F>& early = line[kSignStage - 1].solution;
        expect_port(dut().port("t_s22_o"), early.t.bits(), "t_s22_o");
        expect_port(dut().port("d_s22_o"), early.d.bits(), "d_s22_o");
      }
      if (line.size() == kRaySolverStages) {
        const auto [was_valid, due] = line.back();
        line.pop_back();
        expect_port(dut().port("valid_o"), was_valid ? 1 : 0, "valid_o");
        expect_port(dut().port("hit_o"), was_valid && due.hit ? 1 : 0, "hit_o");
        expect_port(dut().port("rough_o"), due.rough ? 1 : 0, "rough_o");
        expect_port(dut().port("unsure_o"), due.unsure ? 1 : 0, "unsure_o");
        expect_port(dut().port("t_o"), due.t.bits(), "t_o");
        expect_port(dut().port("d_o"), due.d.bits(), "d_o");
        expect_port(dut().port("u_o"), due.u.bits(), "u_o");
        expect_port(dut().port("v_o"), due.v.bits(), "v_o");
      }
    }
    const int valid_cases = kCases * (100 - bubble_percent) / 100;
    EXPECT_GT(hits_, valid_cases / 40) << "hardly a hit of the plain test";
    decisions_.expect_at_least(valid_cases / 1'000);
  }

 private:
  /// Puts a case on the inputs, every second one without a band; gives its solution.
  Solution<F> next(int k, bool valid) {
    const bool plain = k % 2 == 0;
    const bool aimed = k % 8 == 6 || k % 4 == 1;
    BandedPair given = aimed ? aimed_pair(pairs_) : BandedPair{some_pair(pairs_, number_[plain ? 0 : 1]++)};
    Verdict verdict{solve_by_oracle(given.pair)};
    if (plain) {
      given.band = pairs_.bits(1) != 0 ? 0 : pairs_.word(0);
      hits_ += valid && verdict.solution.hit ? 1 : 0;
    } else {
      given.band = aimed ? given.band : band_near(pairs_, verdict.solution);
      verdict = certify_by_oracle(given.pair, given.band);
      if (valid) {
        decisions_.count(verdict);
      }
    }
    const Solution<F>& s = verdict.solution;
    const Solution<F> model =
        solve(given.pair.triangle(), given.pair.origin(), given.pair.direction(), F::from_bits(given.band));
    EXPECT_EQ(model.hit, s.hit) << "the model, case " << k;
    EXPECT_EQ(model.rough, s.rough) << "the model, case " << k;
    EXPECT_EQ(model.unsure, s.unsure) << "the model, case " << k;
    apply(given.pair);
    dut().set(dut().port("band_i"), given.band);
    return s;
  }

  OperandPairs pairs_{131};
  std::array<int, 2> number_{};  // pairs from some_pair, with a band and without
  int hits_ = 0;
  Decisions decisions_;
};

TEST_F(RaySolver, SolvesAPairEveryClock) { run(0); }
TEST_F(RaySolver, KeepsItsPlaceAmongBubbles) { run(60); }
TEST_F(RaySolver, ForgetsWhatIsInsideWhenReset) { expect_empty_after_reset(kRaySolverStages); }

}  // namespace
}  // namespace raplas
