// result_memory against arrays: all banks, clearing one while others are written, both read ports, and which
// rows have a hit. WIDTH is the unit's generic.
#include <algorithm>
#include <random>
#include <vector>

#include "raplas/words.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

static_assert(WIDTH == ResultLayout::kBits || WIDTH == RayHitsLayout::kBits);
using Word = PackedWord<WIDTH>;
constexpr Field kHit{WIDTH - 1, 1};
constexpr std::size_t kRays = std::size_t{kMaxRows} * kMaxColumns;
constexpr std::size_t kBanks = kPencilBanks;
const PortStage kStages[]{{"best_o", kMemoryStages}, {"host_data_o", kMemoryStages}, {"hit_rows_o", 1}};

class ResultMemoryBench : public testing::Test {
 protected:
  /// Clears bank after bank, with so many clocks after each, and writes into all others meanwhile.
  void run(unsigned write_percent, int clears, int clocks) {
    for (std::size_t bank = 0; bank < kBanks; ++bank) {
      clock(bank, random_() % 100 < write_percent);
    }
    for (int clear = 0; clear < clears && !HasFailure(); ++clear) {
      clock(random_() % kBanks, random_() % 100 < write_percent);
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

  /// A clock in which `clear` (kBanks: none) is cleared.
  void clock(std::size_t clear, bool write) {
    const std::size_t written = random_() % memory_.size();
    const std::size_t bank = written / kRays;
    write = write && cleared_[bank] && bank != clear;
    Word word{};
    std::generate(word.begin(), word.end(), [this] { return static_cast<std::uint32_t>(random_()); });
    word.back() &= (2U << (WIDTH - 1) % 32) - 1;
    insert(word, kHit, 1);
    const std::size_t best = place();
    const std::size_t host = place();
    const auto set = [](const char* name, std::uint64_t value) { dut().set(dut().port(name), value); };
    set("clear_i", clear < kBanks ? 1 : 0);
    set("clear_bank_i", clear < kBanks ? clear : random_() % kBanks);
    set("write_i", write ? 1 : 0);
    set("write_bank_i", bank);
    set("write_ray_i", written % kRays);
    Word given = word;
    insert(given, kHit, static_cast<std::uint32_t>(random_() % 2));  // counts as 1
    dut().set(dut().port("write_data_i"), given);
    set("best_bank_i", best / kRays);
    set("best_ray_i", best % kRays);
    set("host_ray_i", host);
    // nobody reads what is written in this clock, nor a bank that is cleared in it
    const auto read = [&](std::size_t from) {
      const std::size_t from_bank = from / kRays;
      return Read{cleared_[from_bank] && from_bank != clear && !(write && from == written), memory_[from]};
    };
    if (const auto due = board_.clock({read(best), read(host)})) {
      compare("best_o", due->at(0));
      compare("host_data_o", due->at(1));
    }
    if (write) {
      memory_[written] = word;
      last_ = written;
    }
    if (clear < kBanks) {
      cleared_[clear] = true;
      std::fill_n(memory_.begin() + static_cast<std::ptrdiff_t>(clear * kRays), kRays, Word{});
      emptied_ = clear;
    }
    compare_rows();
  }

  /// Often the ray written last, one of its row, or one of the bank cleared last.
  std::size_t place() {
    switch (random_() % 6) {
      case 0:
        return last_;
      case 1:
        return last_ - last_ % kMaxColumns + random_() % kMaxColumns;
      case 2:
        return emptied_ * kRays + random_() % kRays;
      default:
        return random_() % memory_.size();
    }
  }

  static void compare(const char* name, const Read& expected) {
    if (!expected.known) {
      return;
    }
    Word word{};
    dut().get(dut().port(name), word);
    ASSERT_EQ(extract(word, kHit), extract(expected.word, kHit)) << name << " in clock " << dut().cycles();
    if (extract(word, kHit) != 0) {  // else the other fields mean nothing
      ASSERT_EQ(word, expected.word) << name << " in clock " << dut().cycles();
    }
    count_checked();
  }

  void compare_rows() const {
    std::uint64_t rows = 0;
    std::uint64_t known = 0;
    for (std::size_t ray = 0; ray < memory_.size(); ++ray) {
      const std::size_t row = ray / kMaxColumns;
      rows |= std::uint64_t{extract(memory_[ray], kHit)} << row;
      known |= std::uint64_t{cleared_[ray / kRays] ? 1U : 0U} << row;
    }
    const PortId port = dut().port("hit_rows_o");
    if (~known == 0) {
      expect_port(port, rows, "hit_rows_o");
    } else {
      ASSERT_EQ(dut().get(port) & known, rows) << "hit_rows_o in clock " << dut().cycles();
    }
  }

  std::vector<Word> memory_ = std::vector<Word>(kBanks * kRays);
  std::array<bool, kBanks> cleared_{};
  std::size_t last_ = 0;     // ray written last
  std::size_t emptied_ = 0;  // bank cleared last
  Scoreboard<std::array<Read, 2>> board_{kMemoryStages};
};

TEST_F(ResultMemoryBench, KeepsTheLastWriteOfEachRayAndForgetsWhenCleared) { run(25, 20, 3'000); }
TEST_F(ResultMemoryBench, ClearsWhileOtherBanksAreWritten) { run(95, 400, 150); }
TEST_F(ResultMemoryBench, ClearsBanksThatAreHardlyWritten) { run(5, 1'000, 50); }
TEST_F(ResultMemoryBench, ClearsABankInEachClock) { run(90, 30'000, 0); }
TEST_F(ResultMemoryBench, HasNoHitAfterEachClearThoughARayWasWritten) { run(80, 6'000, 5); }

}  // namespace
}  // namespace raplas
