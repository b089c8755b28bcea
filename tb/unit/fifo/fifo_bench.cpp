// fifo of 8 bits and 16 words against a std::deque.
#include <random>

#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kClocks = 20'000;
constexpr std::size_t kDepth = 16;
const PortStage kStages[]{{"data_o", 1}, {"valid_o", 1}, {"ready_o", 1}, {"count_o", 1}};

class FifoBench : public testing::Test {
 protected:
  void run(unsigned write_percent, unsigned read_percent, unsigned reset_percent = 0) {
    std::mt19937 random(51);
    reset_dut();
    std::deque<std::uint32_t> queue;
    std::size_t fullest = 0;
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      const bool write = random() % 100 < write_percent;
      const bool read = random() % 100 < read_percent;
      const bool reset = reset_percent != 0 && random() % 100 < reset_percent;
      const auto word = static_cast<std::uint32_t>(random() & 0xff);
      dut().set(dut().port("write_i"), write ? 1 : 0);
      dut().set(dut().port("read_i"), read ? 1 : 0);
      dut().set(dut().port("data_i"), word);
      dut().set(dut().port("rst_i"), reset ? 1 : 0);
      dut().clock();
      const bool full = queue.size() == kDepth;
      if (read && !queue.empty()) {
        queue.pop_front();
      }
      if (write && !full) {
        queue.push_back(word);
      }
      if (reset) {
        queue.clear();
      }
      fullest = std::max(fullest, queue.size());
      expect_port(dut().port("valid_o"), queue.empty() ? 0 : 1, "valid_o");
      expect_port(dut().port("ready_o"), queue.size() == kDepth ? 0 : 1, "ready_o");
      expect_port(dut().port("count_o"), queue.size(), "count_o");
      if (!queue.empty()) {
        expect_port(dut().port("data_o"), queue.front(), "data_o");
      }
    }
    fullest_ = fullest;
  }
  std::size_t fullest_ = 0;
};

TEST_F(FifoBench, PassesAWordEveryClock) { run(100, 100); }
TEST_F(FifoBench, FillsAndRefusesWhenNobodyReads) {
  run(90, 30);
  EXPECT_EQ(fullest_, kDepth);
}
TEST_F(FifoBench, RunsEmptyWhenNobodyWrites) { run(30, 90); }
TEST_F(FifoBench, KeepsOrderUnderRandomStalls) { run(50, 50); }
TEST_F(FifoBench, IsEmptyAfterAResetAtAnyTime) { run(60, 40, 5); }

}  // namespace
}  // namespace raplas
