// fifo and block_fifo of 8 bits and 16 words against a std::deque that knows the clock of each write, and
// their models. SHOWN: clocks from a write to the front of an empty queue.
#include <deque>
#include <random>
#include <type_traits>

#include "raplas/clocked.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kClocks = 20'000;
constexpr std::size_t kDepth = 16;
const PortStage kStages[]{{"data_o", SHOWN}, {"valid_o", SHOWN}, {"ready_o", 1}, {"count_o", 1}};

using Model = std::conditional_t<SHOWN == 1, Fifo<std::uint32_t, kDepth>, BlockFifo<std::uint32_t, kDepth>>;

class FifoBench : public testing::Test {
 protected:
  struct Word {
    std::uint32_t bits;
    int shown;  // from this clock on
  };

  void run(unsigned write_percent, unsigned read_percent, unsigned reset_percent = 0) {
    std::mt19937 random(51);
    reset_dut();
    std::deque<Word> queue;
    Model model;
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
      model.clock(write, word, read);
      const bool full = queue.size() == kDepth;
      if (read && !queue.empty() && queue.front().shown <= k) {
        queue.pop_front();
        ++reads_;
      }
      if (write && !full) {
        queue.push_back({word, k + SHOWN});
      }
      if (reset) {
        queue.clear();
        model = {};
      }
      fullest_ = std::max(fullest_, queue.size());
      const bool valid = !queue.empty() && queue.front().shown <= k + 1;
      expect_port(dut().port("valid_o"), valid ? 1 : 0, "valid_o");
      expect_port(dut().port("ready_o"), queue.size() == kDepth ? 0 : 1, "ready_o");
      expect_port(dut().port("count_o"), queue.size(), "count_o");
      ASSERT_EQ(model.valid(), valid);
      ASSERT_EQ(model.ready(), queue.size() != kDepth);
      ASSERT_EQ(model.count(), queue.size());
      if (valid) {
        expect_port(dut().port("data_o"), queue.front().bits, "data_o");
        ASSERT_EQ(model.front(), queue.front().bits);
      }
    }
  }
  std::size_t fullest_ = 0;
  int reads_ = 0;
};

TEST_F(FifoBench, PassesAWordEveryClock) {
  run(100, 100);
  EXPECT_EQ(reads_, kClocks - SHOWN);
}
TEST_F(FifoBench, FillsAndRefusesWhenNobodyReads) {
  run(90, 30);
  EXPECT_EQ(fullest_, kDepth);
}
TEST_F(FifoBench, GivesAWordEveryClockWhenFull) {
  run(100, 95);
  EXPECT_EQ(fullest_, kDepth);
}
TEST_F(FifoBench, RunsEmptyWhenNobodyWrites) { run(30, 90); }
TEST_F(FifoBench, KeepsOrderUnderRandomStalls) { run(50, 50); }
TEST_F(FifoBench, IsEmptyAfterAResetAtAnyTime) { run(60, 40, 5); }

}  // namespace
}  // namespace raplas
