// ray_triangle against the 33 operations done by MPFR and the exact nearest-hit order, at full speed and with
// bubbles. GUARD_BITS is the unit's generic. The bench plays the Result memory.
#include <random>

#include "support/ray_triangle_pairs.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const int kCases = Dut::simulator() == "ghdl" ? 1'500 : 30'000;
constexpr int kBestStage = kRayTriangleStages - kMulStages - kMemoryStages;  // the best hit is asked for
const PortStage kHitStage{"hit_o", kRayTriangleStages};
const PortStage kWriteStage{"write_o", kRayTriangleStages};
const PortStage kResultStage{"result_o", kRayTriangleStages};
const PortStage kBestStageOf{"best_ray_o", kBestStage};

struct Expected {
  bool valid = false;
  bool hit = false;
  std::uint32_t ray = 0;
  std::uint32_t id = 0;
  ResultWord<F> solution;
  ResultWord<F> best;
};

class RayTriangle : public testing::Test {
 protected:
  void run(int bubble_percent) {
    OperandPairs pairs(111);
    std::mt19937 random(112);
    reset_dut();
    std::deque<Expected> line;
    int hits = 0;
    int stored = 0;
    const std::size_t best_at = kBestStage + kMemoryStages;
    for (int k = 0; k < kCases && !HasFailure(); ++k) {
      Expected e = some_case(pairs, k);
      e.valid = pairs.between(0, 99) >= bubble_percent;
      dut().set(dut().port("valid_i"), e.valid ? 1 : 0);
      line.push_back(e);
      if (line.size() > best_at) {  // the pair now at s26 gets the best hit of its ray
        Expected& asks = line[line.size() - 1 - best_at];
        asks.best = best_for(asks, random);
        dut().set(dut().port("best_i"), asks.best.pack());
      }
      dut().clock();
      if (line.size() >= kBestStage) {
        const Expected& asks = line[line.size() - kBestStage];
        expect_port(dut().port("best_ray_o"), asks.ray, "best_ray_o");
      }
      if (line.size() == kRayTriangleStages) {
        const Expected due = line.front();
        line.pop_front();
        const bool store = due.valid && due.hit && nearer(due.solution.t, due.solution.d, due.id, due.best);
        hits += due.hit ? 1 : 0;
        stored += store ? 1 : 0;
        expect_port(dut().port("valid_o"), due.valid ? 1 : 0, "valid_o");
        expect_port(dut().port("hit_o"), due.valid && due.hit ? 1 : 0, "hit_o");
        expect_port(dut().port("write_o"), store ? 1 : 0, "write_o");
        expect_port(dut().port("first_o"), due.valid && due.hit && !due.best.hit ? 1 : 0, "first_o");
        if (due.valid) {
          ResultWord<F> word = due.solution;
          word.triangle = due.id;
          expect_port(dut().port("ray_o"), due.ray, "ray_o");
          expect_port(dut().port("result_o"), word.pack(), "result_o");
        }
      }
    }
    EXPECT_GT(hits, kCases / 20) << "hardly a hit is tested";
    EXPECT_GT(stored, kCases / 40);
  }

 private:
  static Expected some_case(OperandPairs& pairs, int k) {
    const Pair pair = some_pair(pairs, k);
    const Solution<F> s = solve_by_oracle(pair);
    apply(pair);
    Expected e;
    e.hit = s.hit;
    e.solution = {s.hit, 0, s.t, s.d, s.u, s.v};
    e.ray = pairs.bits(8);
    e.id = pairs.bits(20);
    dut().set(dut().port("ray_i"), e.ray);
    dut().set(dut().port("triangle_id_i"), e.id);
    return e;
  }

  /// A best hit: none, nearer, farther, or the same distance.
  static ResultWord<F> best_for(const Expected& asks, std::mt19937& random) {
    ResultWord<F> best{random() % 4 != 0,
                       static_cast<std::uint32_t>(random() & kLastId),
                       asks.solution.t,
                       asks.solution.d,
                       {},
                       {}};
    const auto step = static_cast<std::uint32_t>(random() % 3);  // an ulp more, equal, or far
    if (best.t.magnitude() > 0x020000 && best.t.magnitude() < 0x700000) {
      best.t = F::from_bits(best.t.magnitude() + (step == 0 ? 1 : (step == 1 ? 0 : 0x010000)));
    }
    return best;
  }
};

TEST_F(RayTriangle, SolvesAPairEveryClock) { run(0); }
TEST_F(RayTriangle, KeepsItsPlaceAmongBubbles) { run(60); }
TEST_F(RayTriangle, ForgetsWhatIsInsideWhenReset) { expect_empty_after_reset(kRayTriangleStages); }

}  // namespace
}  // namespace raplas
