// pair_issue: a ray never twice within the hazard window, and no clock lost otherwise.
#include <random>

#include "raplas/selector.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kClocks = 20'000;
const PortStage kStages[]{{"issue_o", 0}, {"stall_o", 0}};

class PairIssueBench : public testing::Test {
 protected:
  void run(unsigned valid_percent, unsigned rays) {
    std::mt19937 random(71);
    reset_dut();
    std::deque<std::int64_t> last_issue(256, -100);
    bool waiting = false;
    std::uint32_t ray = 0;
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      if (!waiting && random() % 100 < valid_percent) {
        waiting = true;
        ray = static_cast<std::uint32_t>(random() % rays);
      }
      dut().set(dut().port("valid_i"), waiting ? 1 : 0);
      dut().set(dut().port("ray_i"), ray);
      dut().settle();
      // independent of the model: the issue times themselves
      const bool blocked = k - last_issue[ray] < static_cast<std::int64_t>(PairIssue::kHazardClocks);
      expect_port(dut().port("issue_o"), waiting && !blocked ? 1 : 0, "issue_o");
      expect_port(dut().port("stall_o"), waiting && blocked ? 1 : 0, "stall_o");
      if (waiting && !blocked) {
        last_issue[ray] = k;
        waiting = false;
      }
      dut().clock();
    }
  }
};

TEST_F(PairIssueBench, HoldsBackTheSameRay) { run(100, 1); }
TEST_F(PairIssueBench, LetsOtherRaysPass) { run(100, 256); }
TEST_F(PairIssueBench, IsExactAtTheEdgeOfTheWindow) { run(100, 6); }
TEST_F(PairIssueBench, CountsIdleClocksToo) { run(40, 3); }

}  // namespace
}  // namespace raplas
