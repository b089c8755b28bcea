// result_memory against arrays: all banks, clearing one while others are written, both read ports.
#include <random>
#include <vector>

#include "raplas/words.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

using Word = ResultWord<Fp24>;
constexpr int kClears = 40;
constexpr std::size_t kRays = std::size_t{kMaxRows} * kMaxColumns;
constexpr std::size_t kBanks = kPencilBanks;

class ResultMemoryBench : public testing::Test {
 protected:
  /// Clears bank after bank, with so many clocks after each, and writes into the others.
  void run(unsigned write_percent, int clocks) {
    reset_dut();
    for (int clear = 0; clear < kClears && !HasFailure(); ++clear) {
      const std::size_t bank =
          clear < static_cast<int>(kBanks) ? static_cast<std::size_t>(clear) : random_() % kBanks;
      clock(bank, false);
      cleared_[bank] = true;
      std::fill_n(memory_.begin() + static_cast<std::ptrdiff_t>(bank * kRays), kRays, Word{});
      clearing_ = bank;
      for (int rows = 0; rows < kMaxRows && !HasFailure();) {
        rows += clock(kBanks, random_() % 100 < write_percent) ? 0 : 1;
      }
      clearing_ = kBanks;
      for (int k = 0; k < clocks && !HasFailure(); ++k) {
        clock(kBanks, random_() % 100 < write_percent);
      }
    }
  }

  std::mt19937 random_{101};

 private:
  struct Read {
    bool known = false;
    Word word;
  };

  /// A clock in which `clear` (kBanks: none) begins to be cleared; true if something was written.
  bool clock(std::size_t clear, bool write) {
    const std::size_t written = random_() % memory_.size();
    const std::size_t bank = written / kRays;
    write = write && cleared_[bank] && bank != clearing_;
    const auto number = [this] { return Fp24::from_bits(static_cast<std::uint32_t>(random_() & 0xffffff)); };
    const Word word{true,    static_cast<std::uint32_t>(random_() & kLastId), number(), number(), number(),
                    number()};
    const auto place = [this] { return random_() % 4 == 0 ? last_ : random_() % memory_.size(); };
    const std::size_t best = place();
    const std::size_t host = place();
    const auto set = [](const char* name, std::uint64_t value) { dut().set(dut().port(name), value); };
    set("clear_i", clear < kBanks ? 1 : 0);
    set("clear_bank_i", clear < kBanks ? clear : random_() % kBanks);
    set("write_i", write ? 1 : 0);
    set("write_bank_i", bank);
    set("write_ray_i", written % kRays);
    dut().set(dut().port("write_data_i"), word.pack());
    set("best_bank_i", best / kRays);
    set("best_ray_i", best % kRays);
    set("host_ray_i", host);
    dut().settle();
    expect_port(dut().port("clearing_o"), clearing_ < kBanks ? 1 : 0, "clearing_o");
    // nobody reads what is written in this clock, nor a bank that is being cleared
    const auto read = [&](std::size_t from) {
      const std::size_t from_bank = from / kRays;
      return Read{
          cleared_[from_bank] && from_bank != clearing_ && from_bank != clear && !(write && from == written),
          memory_[from]};
    };
    if (const auto due = board_.clock({read(best), read(host)})) {
      compare("best_o", due->at(0));
      compare("host_data_o", due->at(1));
    }
    if (write) {
      memory_[written] = word;
      last_ = written;
    }
    return write;
  }

  static void compare(const char* name, const Read& expected) {
    if (!expected.known) {
      return;
    }
    PackedWord<ResultLayout::kBits> seen{};
    dut().get(dut().port(name), seen);
    const Word word = Word::unpack(seen);
    ASSERT_EQ(word.hit, expected.word.hit) << name << " in clock " << dut().cycles();
    if (word.hit) {  // else the other fields mean nothing
      ASSERT_EQ(word, expected.word) << name << " in clock " << dut().cycles();
    }
    count_checked();
  }

  std::vector<Word> memory_ = std::vector<Word>(kBanks * kRays);
  std::array<bool, kBanks> cleared_{};
  std::size_t clearing_ = kBanks;
  std::size_t last_ = 0;  // written last
  Scoreboard<std::array<Read, 2>> board_{kMemoryStages};
};

TEST_F(ResultMemoryBench, KeepsTheLastWriteOfEachRayAndForgetsWhenCleared) { run(25, 1'500); }
TEST_F(ResultMemoryBench, ClearsBetweenTheWritesOfOtherBanks) { run(90, 400); }
TEST_F(ResultMemoryBench, ClearsARowEachClockWithoutWrites) { run(2, 700); }

TEST_F(ResultMemoryBench, ForgetsThatItClearsWhenReset) {
  reset_dut();
  dut().set(dut().port("write_i"), 0);
  dut().set(dut().port("clear_i"), 1);
  dut().clock();
  dut().set(dut().port("clear_i"), 0);
  dut().clock();
  expect_port(dut().port("clearing_o"), 1, "clearing_o");
  dut().set(dut().port("rst_i"), 1);
  dut().clock();
  expect_port(dut().port("clearing_o"), 0, "clearing_o");
  dut().set(dut().port("rst_i"), 0);
  dut().clock();
  expect_port(dut().port("clearing_o"), 0, "clearing_o");
}

}  // namespace
}  // namespace raplas
