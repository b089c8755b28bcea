// pencil_control: all outputs of a whole run from the times of the starts and of the answers, one pencil
// after the other; and the model clock by clock. The bench plays the host, the memories, the walk and the
// queues.
#include <algorithm>
#include <deque>
#include <random>
#include <vector>

#include "raplas/pencil_control.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr std::size_t kSizes = std::size_t{kMaxRows} * kMaxColumns;

/// Percentages of the clocks.
struct Pattern {
  unsigned start;     // the host tries to start a bank
  unsigned clearing;  // bounds or hit bits are being cleared
  unsigned idle;      // the walk is over
  unsigned ready;     // the triangle queue has room
  unsigned done;      // a token leaves the hit queue, if there is one
};

struct Clock {
  // inputs
  bool start;
  std::size_t start_bank;
  bool clearing;
  bool idle;
  bool ready;
  bool done;
  std::size_t done_bank;
  // outputs
  std::uint32_t busy;
  std::size_t bank;
  bool clear;
  bool load;
  std::uint32_t line;
  bool walk;
  bool token;
};

class PencilControlBench : public testing::Test {
 protected:
  /// From reset on: until `pencils` are done, or for `most` clocks.
  void run(const Pattern& pattern, std::size_t pencils, std::size_t most) {
    apply({});
    reset_dut();
    model_ = PencilControl();
    log_.clear();
    sizes_of_run_.clear();
    tokens_.clear();
    std::size_t done = 0;
    while (done < pencils && log_.size() < most) {
      const bool finishing = sizes_of_run_.size() >= pencils;
      ASSERT_NO_FATAL_FAILURE(clock(pattern, finishing));
      done += log_.back().done ? 1U : 0U;
    }
    ASSERT_NO_FATAL_FAILURE(check_run());
  }

  void clock(const Pattern& pattern, bool finishing) {
    const auto chance = [this](unsigned percent) { return random_() % 100 < percent; };
    Clock now{};
    now.start = !finishing && chance(pattern.start);
    now.start_bank = random_() % kPencilBanks;
    now.clearing = chance(pattern.clearing);
    now.idle = chance(pattern.idle);
    now.ready = chance(pattern.ready);
    now.done = !tokens_.empty() && chance(pattern.done);
    now.done_bank = now.done ? tokens_.front() : random_() % kPencilBanks;
    apply(now);
    dut().settle();
    ASSERT_NO_FATAL_FAILURE(compare(now.clearing));
    now.busy = static_cast<std::uint32_t>(dut().get(dut().port("busy_o")));
    now.bank = dut().get(dut().port("bank_o"));
    now.clear = dut().get(dut().port("clear_o")) != 0;
    now.load = dut().get(dut().port("load_o")) != 0;
    now.line = static_cast<std::uint32_t>(dut().get(dut().port("line_o")));
    now.walk = dut().get(dut().port("walk_o")) != 0;
    now.token = dut().get(dut().port("token_o")) != 0;
    log_.push_back(now);

    if (now.done) {
      tokens_.pop_front();
    }
    if (now.token && now.ready) {
      tokens_.push_back(model_.bank());
    }
    const Size size = sizes_[model_.bank()];
    dut().clock();
    const bool accepted = now.start && (model_.busy() >> now.start_bank & 1U) == 0;
    model_.clock(now.start, now.start_bank, size.rows, size.columns, now.clearing, now.idle, now.ready,
                 now.done, now.done_bank);
    if (accepted) {
      sizes_[now.start_bank] = next_size();
      sizes_of_run_.push_back(sizes_[now.start_bank]);
    }
  }

  std::mt19937 random_{311};

 private:
  struct Size {
    std::uint32_t rows;
    std::uint32_t columns;
  };

  /// All of them, in some order, then again.
  Size next_size() {
    const std::size_t k = all_sizes_++ * 37 % kSizes;
    return {static_cast<std::uint32_t>(k / kMaxColumns) + 1, static_cast<std::uint32_t>(k % kMaxColumns) + 1};
  }

  void apply(const Clock& now) {
    const auto set = [](const char* name, std::uint64_t value) { dut().set(dut().port(name), value); };
    set("start_i", now.start ? 1 : 0);
    set("bank_i", now.start_bank);
    set("rows_i", sizes_[model_.bank()].rows);
    set("columns_i", sizes_[model_.bank()].columns);
    set("clearing_i", now.clearing ? 1 : 0);
    set("walk_idle_i", now.idle ? 1 : 0);
    set("token_ready_i", now.ready ? 1 : 0);
    set("done_i", now.done ? 1 : 0);
    set("done_bank_i", now.done_bank);
  }

  void compare(bool clearing) {
    const auto expect = [](const char* name, std::uint64_t value) {
      expect_port(dut().port(name), value, name);
    };
    const PencilControl::Out out = model_.out(clearing);
    expect("busy_o", model_.busy());
    expect("clear_o", out.clear ? 1 : 0);
    expect("load_o", out.load ? 1 : 0);
    expect("walk_o", out.walk ? 1 : 0);
    expect("token_o", out.token ? 1 : 0);
    if (out.load) {
      expect("line_o", out.line);
    }
    if (out.load || out.walk || out.token) {
      expect("bank_o", model_.bank());
    }
  }

  /// First clock from `begin` on in which `is` holds; the end of the run if there is none.
  template <typename Is>
  std::size_t first(std::size_t begin, Is is) const {
    const auto from = log_.begin() + static_cast<std::ptrdiff_t>(std::min(begin, log_.size()));
    return static_cast<std::size_t>(std::find_if(from, log_.end(), is) - log_.begin());
  }

  /// What each output must be, from the inputs alone.
  void check_run() {
    std::vector<Clock> expected(log_.size() + 64);  // a pencil may begin at the very end
    std::size_t free = 0;                           // first clock in which the next pencil may be taken
    std::size_t pencil = 0;
    std::vector<std::size_t> busy_from(kPencilBanks, log_.size());
    for (std::size_t k = 0; k < log_.size(); ++k) {
      const Clock& now = log_[k];
      std::uint32_t busy = 0;
      for (std::size_t bank = 0; bank < kPencilBanks; ++bank) {
        busy |= (k > busy_from[bank] ? 1U : 0U) << bank;
      }
      expected[k].busy = busy;
      if (now.start && (busy >> now.start_bank & 1U) == 0) {
        busy_from[now.start_bank] = k;
        const std::size_t end = describe(expected, std::max(free, k + 1) + 1, now.start_bank, pencil++);
        free = end + 1;
      }
      if (now.done) {
        busy_from[now.done_bank] = log_.size();
      }
    }
    ASSERT_EQ(pencil, sizes_of_run_.size());
    for (std::size_t k = 0; k < log_.size(); ++k) {
      const Clock& seen = log_[k];
      const Clock& e = expected[k];
      ASSERT_EQ(seen.busy, e.busy) << "clock " << k;
      ASSERT_EQ(seen.clear, e.clear) << "clock " << k;
      ASSERT_EQ(seen.load, e.load) << "clock " << k;
      ASSERT_EQ(seen.walk, e.walk) << "clock " << k;
      ASSERT_EQ(seen.token, e.token) << "clock " << k;
      if (e.load) {
        ASSERT_EQ(seen.line, e.line) << "clock " << k;
      }
      if (e.load || e.walk || e.token) {
        ASSERT_EQ(seen.bank, e.bank) << "clock " << k;
      }
      count_checked();
    }
  }

  /// Outputs for a pencil whose first planes are loaded in clock `begin`; gives the clock in which its token
  /// goes.
  std::size_t describe(std::vector<Clock>& expected, std::size_t begin, std::size_t bank,
                       std::size_t pencil) {
    std::size_t k = begin;
    const auto load = [&](std::uint32_t line) {
      if (k < expected.size()) {
        expected[k].load = true;
        expected[k].line = line;
        expected[k].clear = k == begin;
        expected[k].bank = bank;
      }
      ++k;
    };
    const Size& size = sizes_of_run_[pencil];
    for (std::uint32_t line = 0; line < size.rows || line < size.columns; ++line) {
      load(line);
    }
    load(16);
    load(17);
    k = first(k, [](const Clock& now) { return !now.clearing; });
    if (k < log_.size()) {
      expected[k].walk = true;
      expected[k].bank = bank;
    }
    k = first(k + 1, [](const Clock& now) { return now.idle; }) + 1;
    const std::size_t gone = first(k, [](const Clock& now) { return now.ready; });
    for (; k <= gone && k < log_.size(); ++k) {
      expected[k].token = true;
      expected[k].bank = bank;
    }
    return gone;
  }

  PencilControl model_;
  std::array<Size, kPencilBanks> sizes_{};  // of the banks
  std::size_t all_sizes_ = 0;
  std::vector<Clock> log_;
  std::vector<Size> sizes_of_run_;  // of the pencils in the order of their starts
  std::deque<std::size_t> tokens_;  // banks whose tokens are under way
};

constexpr std::size_t kNoEnd = 1'000'000;

TEST_F(PencilControlBench, TakesPencilsOfEverySizeWithoutAGap) {
  run({100, 0, 100, 100, 100}, kSizes, kNoEnd);
}
TEST_F(PencilControlBench, WaitsForAllOthers) {
  for (int k = 0; k < 12; ++k) {
    const auto some = [this] { return static_cast<unsigned>(1 + random_() % 100); };
    run({some(), some() - 1, some(), some(), some()}, 25, 12'000);
  }
}
TEST_F(PencilControlBench, QueuesAllBanks) { run({100, 50, 4, 10, 3}, 60, kNoEnd); }
TEST_F(PencilControlBench, LetsDoneBanksStartAtOnce) { run({100, 10, 50, 50, 60}, 100, kNoEnd); }
TEST_F(PencilControlBench, WaitsForTheHost) { run({2, 30, 40, 50, 30}, 30, kNoEnd); }

TEST_F(PencilControlBench, StartsAfreshAfterAResetInTheMiddle) {
  for (std::size_t clocks = 1; clocks < 60; clocks += 1 + clocks / 12) {
    ASSERT_NO_FATAL_FAILURE(run({100, 60, 10, 20, 5}, kNoEnd, clocks));
    ASSERT_NO_FATAL_FAILURE(run({0, 10, 50, 50, 50}, kNoEnd, 40));  // nothing happens by itself
  }
  run({100, 30, 30, 40, 30}, 20, kNoEnd);
}

}  // namespace
}  // namespace raplas
