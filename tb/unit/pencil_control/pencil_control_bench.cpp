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

/// Percentages of the clocks, but for the last two.
struct Pattern {
  unsigned start;         // the host tries to start a bank
  unsigned spent;         // the walk has no object left
  unsigned idle;          // the walk is over
  unsigned ready;         // the triangle queue has room
  unsigned done;          // a token leaves the hit queue, if there is one
  std::size_t least = 0;  // clocks that a walk takes before it may be over
  bool any = false;       // spent and idle come and go, instead of idle after spent until the next walk
};

struct Clock {
  // inputs
  bool start;
  std::size_t start_bank;
  std::uint32_t rows;
  std::uint32_t columns;
  bool spent;
  bool idle;
  bool ready;
  bool done;
  std::size_t done_bank;
  // outputs
  std::uint32_t busy;
  bool clear;
  std::size_t clear_bank;
  bool load;
  std::size_t load_bank;
  std::uint32_t line;
  bool walk;
  bool token;
  bool turn;  // from walk_o until the token is gone: bank is that pencil's
  std::size_t bank;
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
    walk_ = {};
    loaded_once_ = false;
    std::size_t done = 0;
    while (done < pencils && log_.size() < most) {
      const bool finishing = sizes_of_run_.size() >= pencils;
      ASSERT_NO_FATAL_FAILURE(clock(pattern, finishing));
      done += log_.back().done ? 1U : 0U;
    }
    ASSERT_NO_FATAL_FAILURE(check_run());
    ASSERT_NO_FATAL_FAILURE(check_rules());
  }

  void clock(const Pattern& pattern, bool finishing) {
    const auto chance = [this](unsigned percent) { return random_() % 100 < percent; };
    const auto lines = [this] { return static_cast<std::uint32_t>(1 + random_() % kMaxRows); };
    Clock now{};
    now.start = !finishing && chance(pattern.start);
    now.start_bank = random_() % kPencilBanks;
    const Size size = model_.out().clear ? sizes_[model_.clear_bank()] : Size{lines(), lines()};
    now.rows = size.rows;
    now.columns = size.columns;
    ++walk_.clocks;
    const bool over = walk_.clocks > pattern.least && chance(pattern.idle);
    walk_.idle = over || (walk_.idle && !pattern.any);
    walk_.spent = chance(pattern.spent) || (walk_.spent && !pattern.any) || (walk_.idle && !pattern.any);
    now.spent = walk_.spent;
    now.idle = walk_.idle;
    now.ready = chance(pattern.ready);
    now.done = !tokens_.empty() && chance(pattern.done);
    now.done_bank = now.done ? tokens_.front() : random_() % kPencilBanks;
    apply(now);
    dut().settle();
    ASSERT_NO_FATAL_FAILURE(compare());
    now.busy = static_cast<std::uint32_t>(dut().get(dut().port("busy_o")));
    now.clear = dut().get(dut().port("clear_o")) != 0;
    now.clear_bank = dut().get(dut().port("clear_bank_o"));
    now.load = dut().get(dut().port("load_o")) != 0;
    now.load_bank = dut().get(dut().port("load_bank_o"));
    now.line = static_cast<std::uint32_t>(dut().get(dut().port("line_o")));
    now.walk = dut().get(dut().port("walk_o")) != 0;
    now.token = dut().get(dut().port("token_o")) != 0;
    now.bank = dut().get(dut().port("bank_o"));
    log_.push_back(now);

    if (now.walk) {
      walk_ = {0, false, false};
    }
    if (now.done) {
      tokens_.pop_front();
    }
    if (now.token && now.ready) {
      tokens_.push_back(model_.bank());
    }
    dut().clock();
    const bool accepted = now.start && (model_.busy() >> now.start_bank & 1U) == 0;
    model_.clock(now.start, now.start_bank, now.rows, now.columns, now.spent, now.idle, now.ready, now.done,
                 now.done_bank);
    if (accepted) {
      sizes_[now.start_bank] = next_size();
      sizes_of_run_.push_back(sizes_[now.start_bank]);
    }
  }

  /// Clocks of the run in which planes were loaded while a walk was under way.
  [[nodiscard]] std::size_t overlaps() const { return overlaps_; }
  /// Walks of the run but the first that didn't begin in the clock behind the token before.
  [[nodiscard]] std::size_t gaps() const { return gaps_; }

  std::mt19937 random_{311};

 private:
  struct Size {
    std::uint32_t rows;
    std::uint32_t columns;
  };
  struct Walk {
    std::size_t clocks = 0;  // since its first
    bool spent = true;
    bool idle = true;
  };
  /// Clocks of a pencil.
  struct Turn {
    std::size_t walk = 0;
    std::size_t idle = 0;
    std::size_t gone = 0;
  };

  /// All of them, in some order, then again.
  Size next_size() {
    const std::size_t k = all_sizes_++ * 37 % kSizes;
    return {static_cast<std::uint32_t>(k / kMaxColumns) + 1, static_cast<std::uint32_t>(k % kMaxColumns) + 1};
  }

  static void apply(const Clock& now) {
    const auto set = [](const char* name, std::uint64_t value) { dut().set(dut().port(name), value); };
    set("start_i", now.start ? 1 : 0);
    set("bank_i", now.start_bank);
    set("rows_i", now.rows);
    set("columns_i", now.columns);
    set("walk_spent_i", now.spent ? 1 : 0);
    set("walk_idle_i", now.idle ? 1 : 0);
    set("token_ready_i", now.ready ? 1 : 0);
    set("done_i", now.done ? 1 : 0);
    set("done_bank_i", now.done_bank);
  }

  void compare() {
    const auto expect = [](const char* name, std::uint64_t value) {
      expect_port(dut().port(name), value, name);
    };
    const PencilControl::Out out = model_.out();
    expect("busy_o", model_.busy());
    expect("clear_o", out.clear ? 1 : 0);
    expect("load_o", out.load ? 1 : 0);
    expect("walk_o", out.walk ? 1 : 0);
    expect("token_o", out.token ? 1 : 0);
    if (out.clear) {
      expect("clear_bank_o", model_.clear_bank());
    }
    if (out.load) {
      expect("line_o", out.line);
      expect("load_bank_o", model_.load_bank());
    }
    loaded_once_ = loaded_once_ || out.load;
    if (loaded_once_) {
      expect("bank_o", model_.bank());
    }
  }

  /// First clock from `begin` on in which `is` holds; the end of the run if there is none.
  template <typename Is>
  std::size_t first(std::size_t begin, Is is) const {
    for (std::size_t k = begin; k < log_.size(); ++k) {
      if (is(k)) {
        return k;
      }
    }
    return log_.size();
  }

  /// What each output must be, from the inputs alone.
  void check_run() {
    std::vector<Clock> expected(log_.size());
    Turn turn;  // of the pencil before
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
        turn = describe(expected, k, pencil++, turn);
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
      if (e.clear) {
        ASSERT_EQ(seen.clear_bank, e.clear_bank) << "clock " << k;
      }
      if (e.load) {
        ASSERT_EQ(seen.load_bank, e.load_bank) << "clock " << k;
        ASSERT_EQ(seen.line, e.line) << "clock " << k;
      }
      if (e.turn) {
        ASSERT_EQ(seen.bank, e.bank) << "clock " << k;
      }
      count_checked();
    }
  }

  /// Outputs for a pencil that is started in clock `start`, from the turn of the one before.
  Turn describe(std::vector<Clock>& expected, std::size_t start, std::size_t pencil,
                const Turn& before) const {
    const std::size_t bank = log_[start].start_bank;
    const auto at = [&](std::size_t k) -> Clock& { return k < expected.size() ? expected[k] : beyond_; };
    at(start + 1).clear = true;
    at(start + 1).clear_bank = bank;

    // cleared, the one before walks, and none of its objects needs its planes
    std::size_t k = first(std::max(start + 2, before.walk + 1),
                          [&](std::size_t c) { return c > before.idle || log_[c].spent; });
    const auto load = [&](std::uint32_t line) {
      Clock& e = at(++k);
      e.load = true;
      e.load_bank = bank;
      e.line = line;
    };
    const Size& size = sizes_of_run_[pencil];
    for (std::uint32_t line = 0; line < size.rows || line < size.columns; ++line) {
      load(line);
    }
    load(16);
    load(17);

    Turn turn;
    turn.walk = std::max(k, before.gone + 1);
    turn.idle = first(turn.walk + 1, [&](std::size_t c) { return log_[c].idle; });
    turn.gone = first(turn.idle + 1, [&](std::size_t c) { return log_[c].ready; });
    at(turn.walk).walk = true;
    for (k = turn.walk; k <= turn.gone && k < expected.size(); ++k) {
      expected[k].turn = true;
      expected[k].bank = bank;
      expected[k].token = k > turn.idle;
    }
    return turn;
  }

  /// What must hold of every run, as its outputs show it: planes aren't replaced while a walk has objects,
  /// and the bank stays from the begin of a walk until its token is gone.
  void check_rules() {
    bool walking = false;
    bool token = false;
    std::size_t bank = 0;
    std::size_t gone = log_.size();
    overlaps_ = 0;
    gaps_ = 0;
    for (std::size_t k = 0; k < log_.size(); ++k) {
      const Clock& now = log_[k];
      if (now.walk) {
        ASSERT_FALSE(walking || token) << "clock " << k;
        ASSERT_FALSE(k + 1 < log_.size() && log_[k + 1].load)
            << "the next planes come too early, clock " << k;
        bank = now.bank;
        gaps_ += gone != log_.size() && gone + 1 != k ? 1U : 0U;
      }
      if (now.walk || walking || token) {
        ASSERT_EQ(now.bank, bank) << "clock " << k;
      }
      ASSERT_EQ(now.token, token) << "clock " << k;
      if (k + 1 < log_.size() && !now.load && log_[k + 1].load) {
        ASSERT_TRUE(!walking || now.spent) << "clock " << k;
      }
      overlaps_ += walking && now.load ? 1U : 0U;
      if (token && now.ready) {
        gone = k;
      }
      token = (walking && now.idle) || (token && !now.ready);
      walking = now.walk || (walking && !now.idle);
    }
  }

  PencilControl model_;
  std::array<Size, kPencilBanks> sizes_{};  // of the banks
  std::size_t all_sizes_ = 0;
  std::vector<Clock> log_;
  std::vector<Size> sizes_of_run_;  // of the pencils in the order of their starts
  std::deque<std::size_t> tokens_;  // banks whose tokens are under way
  Walk walk_;
  bool loaded_once_ = false;  // bank_o says something
  std::size_t overlaps_ = 0;
  std::size_t gaps_ = 0;
  mutable Clock beyond_{};  // the end of the run
};

constexpr std::size_t kNoEnd = 1'000'000;

TEST_F(PencilControlBench, TakesPencilsOfEverySizeAtOnce) { run({100, 100, 100, 100, 100}, kSizes, kNoEnd); }

TEST_F(PencilControlBench, LoadsPencilsOfEverySizeInTheTailOfTheWalkBefore) {
  run({100, 100, 100, 100, 100, 19}, kSizes, kNoEnd);  // 18 planes behind the first clock of the walk
  EXPECT_EQ(gaps(), 0U);
  EXPECT_GT(overlaps(), 10 * kSizes);
}

TEST_F(PencilControlBench, LoadsLateInTheTail) {
  run({100, 15, 8, 100, 100}, kSizes, kNoEnd);
  EXPECT_GT(overlaps(), kSizes);
  EXPECT_GT(gaps(), 0U);
  run({100, 40, 3, 20, 100}, kSizes, kNoEnd);
}

TEST_F(PencilControlBench, LoadsNothingWhileTheWalkHasObjects) {
  for (const unsigned ready : {100U, 30U, 3U}) {
    run({100, 0, 10, ready, 100}, 60, kNoEnd);
    EXPECT_EQ(overlaps(), 0U);
  }
}

TEST_F(PencilControlBench, LoadsWhileTheTokenWaits) { run({100, 0, 50, 4, 100}, 100, kNoEnd); }

TEST_F(PencilControlBench, WaitsForAllOthers) {
  for (int k = 0; k < 24; ++k) {
    const auto some = [this] { return static_cast<unsigned>(1 + random_() % 100); };
    run({some(), some() - 1, some(), some(), some(), 0, k % 2 == 0}, 25, 12'000);
  }
}
TEST_F(PencilControlBench, QueuesAllBanks) {
  run({100, 50, 4, 10, 3}, 60, kNoEnd);
  run({100, 3, 4, 10, 3, 0, true}, 60, kNoEnd);
}
TEST_F(PencilControlBench, LetsDoneBanksStartAtOnce) { run({100, 10, 50, 50, 60}, 100, kNoEnd); }
TEST_F(PencilControlBench, WaitsForTheHost) { run({2, 30, 40, 50, 30}, 30, kNoEnd); }

TEST_F(PencilControlBench, StartsAfreshAfterAResetInTheMiddle) {
  for (std::size_t clocks = 1; clocks < 90; clocks += 1 + clocks / 12) {
    ASSERT_NO_FATAL_FAILURE(run({100, 60, 10, 20, 5}, kNoEnd, clocks));
    ASSERT_NO_FATAL_FAILURE(run({0, 10, 50, 50, 50}, kNoEnd, 40));  // nothing happens by itself
    ASSERT_NO_FATAL_FAILURE(run({100, 100, 5, 10, 5}, kNoEnd, clocks));
    ASSERT_NO_FATAL_FAILURE(run({0, 90, 90, 90, 90}, kNoEnd, 40));
  }
  run({100, 30, 30, 40, 30}, 20, kNoEnd);
}

}  // namespace
}  // namespace raplas
