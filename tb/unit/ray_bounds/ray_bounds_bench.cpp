// ray_bounds against arrays: what a row's rays had when it was read, and row bounds that are never too low.
#include <random>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kClocks = 30'000;
constexpr int kClearClocks = kMaxRows;
constexpr int kBoundStages = kMemoryStages + kLineBits + 1;  ///< from a read to the row's bound
const PortStage kStages[]{{"clearing_o", 1}, {"bounds_o", kMemoryStages}};

using Bank = std::array<LineBounds, kMaxRows>;

class RayBoundsBench : public testing::Test {
 protected:
  void give(const RayBounds::Clear& clear, const RayBounds::Update& update, const RayBounds::Read& read) {
    dut().set(dut().port("clear_i"), clear.valid ? 1 : 0);
    dut().set(dut().port("clear_bank_i"), clear.bank);
    dut().set(dut().port("clear_rows_i"), clear.rows);
    dut().set(dut().port("clear_columns_i"), clear.columns);
    dut().set(dut().port("clear_far_i"), clear.far);
    dut().set(dut().port("update_i"), update.valid ? 1 : 0);
    dut().set(dut().port("update_bank_i"), update.bank);
    dut().set(dut().port("update_ray_i"), update.ray);
    dut().set(dut().port("update_bound_i"), update.bound);
    dut().set(dut().port("read_i"), read.valid ? 1 : 0);
    dut().set(dut().port("read_bank_i"), read.bank);
    dut().set(dut().port("read_row_i"), read.row);
  }

  RayBounds::Clear any_clear(std::size_t bank) {
    const auto lines = [this] { return static_cast<std::uint32_t>(1 + random_() % 16); };
    const std::uint32_t far = random_() % 2 == 0 ? 0x7fff : static_cast<std::uint32_t>(random_() & 0x7fff);
    return {true, bank, lines(), lines(), far};
  }

  /// Pencils come and go in all banks while the others are read and updated.
  void run(unsigned update_percent, unsigned read_percent) {
    reset_dut();
    RayBounds model;
    std::array<Bank, kPencilBanks> truth{};
    std::array<LineBounds, kPencilBanks> least{};  // what the row bounds are
    std::array<int, kPencilBanks> quiet{};         // clocks without a read of the bank
    std::array<bool, kPencilBanks> known{};
    Scoreboard<LineBounds> reads(kMemoryStages);
    std::deque<bool> row_known;
    std::deque<Maximum> maxima;  // of the rows read, on their way to the row bounds
    std::size_t resting = 0;     // not read for a while: it is cleared next
    std::size_t clearing_bank = 0;
    int clearing = 0;
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      RayBounds::Clear clear{false, random_() % 4, 1, 1, 0x1234};
      clear.rows = static_cast<std::uint32_t>(random_() % 32);  // of no account without valid
      clear.columns = static_cast<std::uint32_t>(random_() % 32);
      const bool all_known = known[0] && known[1] && known[2] && known[3];
      if (clearing == 0 && quiet[resting] >= kBoundStages - 1 && (!all_known || random_() % 200 == 0)) {
        clear = any_clear(resting);
      }
      const auto usable = [&](std::size_t bank) {
        return known[bank] && bank != resting && !(clearing != 0 && bank == clearing_bank);
      };
      RayBounds::Update update{random_() % 100 < update_percent, random_() % 4, random_() % 256, 0};
      std::uint32_t& old = truth[update.bank][update.ray / 16][update.ray % 16];
      update.valid = update.valid && usable(update.bank);
      const LineBounds& others = truth[update.bank][update.ray / 16];
      const std::uint32_t other = others[(update.ray ^ 1U << (random_() % 4)) % 16];
      const std::array<std::uint32_t, 3> choice{
          old - static_cast<std::uint32_t>(random_() % 256),
          static_cast<std::uint32_t>(random_() % (old + 1)),
          other ^ 1U << (random_() % kDepthBits)};  // near a ray that it is compared with
      update.bound = std::min(choice[random_() % 3], old);
      update.bound = update.valid ? update.bound : static_cast<std::uint32_t>(random_() & 0x7fff);
      RayBounds::Read read{random_() % 100 < read_percent, random_() % 4, random_() % 16};
      if (random_() % 8 == 0) {
        read.bank = update.bank;  // the word that is written in this clock: as it was before
        read.row = update.ray / 16;
      }
      read.valid = read.valid && usable(read.bank);
      const std::size_t walk_bank = random_() % 4;
      const std::size_t pair_bank = random_() % 4;
      give(clear, update, read);
      dut().set(dut().port("walk_bank_i"), walk_bank);
      dut().set(dut().port("pair_bank_i"), pair_bank);

      // the clock, as the oracle sees it
      const LineBounds row = truth[read.bank][read.row];
      const bool read_known = known[read.bank] && !(clearing != 0 && read.bank == clearing_bank);
      if (update.valid) {
        old = update.bound;
      } else if (clearing != 0) {
        --clearing;
      }
      for (std::size_t bank = 0; bank < kPencilBanks; ++bank) {
        quiet[bank] = read.valid && read.bank == bank ? 0 : quiet[bank] + 1;
      }
      const auto bounds = reads.clock(row);
      model.clock(clear, update, read);
      row_known.push_back(read_known);
      maxima.push_back({read, *std::ranges::max_element(row)});
      if (maxima.size() == kBoundStages) {
        if (const Maximum& due = maxima.front(); due.read.valid) {
          least[due.read.bank][due.read.row] = due.bound;
        }
        maxima.pop_front();
      }
      if (clear.valid) {
        for (std::size_t line = 0; line < 16; ++line) {
          least[clear.bank][line] = line < clear.rows ? clear.far : 0;
          for (std::size_t column = 0; column < 16; ++column) {
            truth[clear.bank][line][column] = line < clear.rows && column < clear.columns ? clear.far : 0;
          }
        }
        known[clear.bank] = true;
        clearing = kClearClocks;
        clearing_bank = clear.bank;
        resting = all_known ? random_() % 4 : (resting + 1) % 4;
      }

      expect_port(dut().port("clearing_o"), clearing != 0 ? 1 : 0, "clearing_o");
      EXPECT_EQ(model.clearing(), clearing != 0);
      if (bounds) {
        if (row_known.front()) {
          expect_port(dut().port("bounds_o"), pack(*bounds), "bounds_o");
          EXPECT_EQ(model.bounds(), *bounds);
        }
        row_known.pop_front();
      }
      for (const auto& [bank, name] :
           {std::pair{walk_bank, "row_bounds_o"}, std::pair{pair_bank, "pair_row_bounds_o"}}) {
        if (known[bank]) {
          expect_port(dut().port(name), pack(least[bank]), name);
          EXPECT_EQ(model.row_bounds(bank), least[bank]);
          for (std::size_t line = 0; line < 16; ++line) {
            EXPECT_GE(least[bank][line], *std::ranges::max_element(truth[bank][line])) << "bound too low";
          }
        }
      }
    }
  }

 private:
  struct Maximum {
    RayBounds::Read read;
    std::uint32_t bound;
  };

  std::mt19937 random_{72};
};

TEST_F(RayBoundsBench, FollowsUpdatesAndClearsAtFullSpeed) { run(100, 100); }
TEST_F(RayBoundsBench, FollowsThemInAnyPattern) { run(40, 50); }
TEST_F(RayBoundsBench, ClearsWithoutUpdatesInSixteenClocks) { run(0, 100); }

TEST_F(RayBoundsBench, ResetEndsClearingAndReadsUnderWay) {
  reset_dut();
  const RayBounds::Clear clear{true, 2, 16, 16, 1000};
  give(clear, {}, {});
  dut().set(dut().port("walk_bank_i"), 2);
  dut().clock();
  for (int k = 0; k < kClearClocks; ++k) {
    give({}, {}, {});
    dut().clock();
  }
  expect_port(dut().port("clearing_o"), 0, "clearing_o");
  constexpr std::size_t kRow = 5;
  for (std::size_t column = 0; column < 16; ++column) {
    give({}, {true, 2, kRow * kMaxColumns + column, 10}, {});
    dut().clock();
  }
  for (int clocks = 0; clocks <= kBoundStages; ++clocks) {  // a read of so many clocks ago
    give(clear, {}, {});
    dut().clock();
    dut().set(dut().port("rst_i"), 1);
    give({}, {}, {});
    dut().clock();
    dut().set(dut().port("rst_i"), 0);
    expect_port(dut().port("clearing_o"), 0, "clearing_o");  // and row kRow is not set
    give({}, {}, {true, 2, kRow});
    for (int k = 0; k < clocks; ++k) {
      dut().clock();
      give({}, {}, {});
    }
    dut().set(dut().port("rst_i"), 1);
    dut().clock();
    dut().set(dut().port("rst_i"), 0);
    LineBounds expected;
    expected.fill(1000);
    expected[kRow] = clocks >= kBoundStages - 1 ? 10 : 1000;
    for (int k = 0; k < kBoundStages; ++k) {
      give({}, {}, {});
      dut().clock();
      expect_port(dut().port("row_bounds_o"), pack(expected), "row_bounds_o");
    }
  }
}

}  // namespace
}  // namespace raplas
