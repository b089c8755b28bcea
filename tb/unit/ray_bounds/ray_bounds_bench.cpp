// ray_bounds against arrays: what a row's rays had when it was read, and row bounds that are never too low.
// The bench is result_memory: it tells which rows had an update since their bank was cleared.
#include <random>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kClocks = 20'000;
constexpr int kBoundStages = kMemoryStages + kLineBits + 1;  ///< from a read to the row's bound
const PortStage kStages[]{{"bounds_o", kMemoryStages}, {"row_hit_o", kMemoryStages}};

using Bank = std::array<LineBounds, kMaxRows>;

class RayBoundsBench : public testing::Test {
 protected:
  /// pencil: the one that the update is for.
  void give(const RayBounds::Clear& clear, const RayBounds::Update& update, const RayBounds::Clear& pencil,
            const RayBounds::Read& read) {
    dut().set(dut().port("clear_i"), clear.valid ? 1 : 0);
    dut().set(dut().port("clear_bank_i"), clear.bank);
    dut().set(dut().port("clear_rows_i"), clear.rows);
    dut().set(dut().port("clear_far_i"), clear.far);
    dut().set(dut().port("update_i"), update.valid ? 1 : 0);
    dut().set(dut().port("update_bank_i"), update.bank);
    dut().set(dut().port("update_columns_i"), pencil.columns);
    dut().set(dut().port("update_far_i"), pencil.far);
    dut().set(dut().port("update_ray_i"), update.ray);
    dut().set(dut().port("update_bound_i"), update.bound);
    dut().set(dut().port("read_i"), read.valid ? 1 : 0);
    dut().set(dut().port("read_bank_i"), read.bank);
    dut().set(dut().port("read_row_i"), read.row);
    dut().set(dut().port("hit_rows_i"), hit_rows_);
  }

  /// The clock is over: what it does to the rows that had an update.
  void follow(const RayBounds::Clear& clear, const RayBounds::Update& update) {
    if (update.valid) {
      hit_rows_ |= row_bit(update.bank, update.ray / kMaxColumns);
    }
    if (clear.valid) {
      hit_rows_ &= ~(std::uint64_t{0xffff} << (clear.bank * kMaxRows));
    }
  }

  [[nodiscard]] bool hit(std::size_t bank, std::size_t row) const {
    return (hit_rows_ & row_bit(bank, row)) != 0;
  }

  RayBounds::Clear any_clear(std::size_t bank) {
    const auto lines = [this] { return static_cast<std::uint32_t>(1 + random_() % 16); };
    const std::uint32_t far = random_() % 2 == 0 ? 0x7fff : static_cast<std::uint32_t>(random_() & 0x7fff);
    return {true, bank, lines(), lines(), far};
  }

  /// Pencils come and go in all banks while the others are read and updated. A bank is cleared in one of so
  /// many clocks, or as soon as its reads are over.
  void run(unsigned update_percent, unsigned read_percent, unsigned clocks_per_clear) {
    reset_dut();
    hit_rows_ = random_();
    RayBounds model;
    std::array<Bank, kPencilBanks> truth{};
    std::array<LineBounds, kPencilBanks> least{};  // what the row bounds are
    std::array<int, kPencilBanks> quiet{};         // clocks without a read of the bank
    std::array<RayBounds::Clear, kPencilBanks> pencils{};
    std::array<bool, kPencilBanks> known{};
    Scoreboard<Row> reads(kMemoryStages);
    std::deque<Maximum> maxima;  // of the rows read, on their way to the row bounds
    std::size_t resting = 0;     // not read for a while: it is cleared next
    for (int k = 0; k < kClocks && !HasFailure(); ++k) {
      RayBounds::Clear clear{false, random_() % 4, 1, 1, 0x1234};
      clear.rows = static_cast<std::uint32_t>(random_() % 32);  // of no account without valid
      const bool all_known = known[0] && known[1] && known[2] && known[3];
      if (quiet[resting] >= kBoundStages - 2 && (!all_known || random_() % clocks_per_clear == 0)) {
        clear = any_clear(resting);
      }
      RayBounds::Update update{random_() % 100 < update_percent, random_() % 4, random_() % 256, 0};
      std::uint32_t& old = truth[update.bank][update.ray / 16][update.ray % 16];
      RayBounds::Clear pencil = pencils[update.bank];
      update.valid = update.valid && known[update.bank] && !(clear.valid && update.bank == clear.bank) &&
                     update.ray / 16 < pencil.rows;
      const LineBounds& others = truth[update.bank][update.ray / 16];
      const std::uint32_t other = others[(update.ray ^ 1U << (random_() % 4)) % 16];
      const std::array<std::uint32_t, 3> choice{
          old - static_cast<std::uint32_t>(random_() % 256),
          static_cast<std::uint32_t>(random_() % (old + 1)),
          other ^ 1U << (random_() % kDepthBits)};  // near a ray that it is compared with
      update.bound = std::min(choice[random_() % 3], old);
      if (!update.valid || hit(update.bank, update.ray / 16)) {  // of no account
        pencil.columns = static_cast<std::uint32_t>(random_() % 32);
        pencil.far = static_cast<std::uint32_t>(random_() & 0x7fff);
      }
      update.bound = update.valid ? update.bound : static_cast<std::uint32_t>(random_() & 0x7fff);
      RayBounds::Read read{random_() % 100 < read_percent, random_() % 4, random_() % 16};
      if (random_() % 8 == 0) {
        read.bank = update.bank;  // the word that is written in this clock: as it was before
        read.row = update.ray / 16;
      }
      read.valid = read.valid && known[read.bank] && read.bank != resting;
      const std::size_t walk_bank = random_() % 4;
      const std::size_t pair_bank = random_() % 4;
      give(clear, update, pencil, read);
      dut().set(dut().port("walk_bank_i"), walk_bank);
      dut().set(dut().port("pair_bank_i"), pair_bank);

      // the clock, as the oracle sees it
      const Row row{known[read.bank], hit(read.bank, read.row), truth[read.bank][read.row]};
      if (update.valid) {
        old = update.bound;
      }
      follow(clear, update);
      for (std::size_t bank = 0; bank < kPencilBanks; ++bank) {
        quiet[bank] = read.valid && read.bank == bank ? 0 : quiet[bank] + 1;
      }
      const auto due_row = reads.clock(row);
      model.clock(clear, update, read);
      maxima.push_back({read, *std::ranges::max_element(row.bounds)});
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
        pencils[clear.bank] = clear;
        resting = all_known ? random_() % 4 : (resting + 1) % 4;
      }

      if (due_row) {
        expect_port(dut().port("row_hit_o"), due_row->hit ? 1 : 0, "row_hit_o");
        if (due_row->known) {
          EXPECT_EQ(model.bounds(), due_row->bounds);
          if (due_row->hit) {  // else they don't count
            expect_port(dut().port("bounds_o"), pack(due_row->bounds), "bounds_o");
          }
        }
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

  std::mt19937_64 random_{72};

 private:
  struct Maximum {
    RayBounds::Read read;
    std::uint32_t bound;
  };
  /// As it was when it was asked for.
  struct Row {
    bool known;
    bool hit;
    LineBounds bounds;
  };

  static std::uint64_t row_bit(std::size_t bank, std::size_t row) {
    return std::uint64_t{1} << (bank * kMaxRows + row);
  }

  std::uint64_t hit_rows_ = 0;  ///< bank and row: updated since its clear; anything before the first clear
};

TEST_F(RayBoundsBench, FollowsUpdatesAndClearsAtFullSpeed) { run(100, 100, 200); }
TEST_F(RayBoundsBench, FollowsThemInAnyPattern) { run(40, 50, 200); }
TEST_F(RayBoundsBench, ClearsABankAsOftenAsItCan) { run(80, 80, 1); }
TEST_F(RayBoundsBench, ReadsOfRowsWithoutUpdateChangeNothing) {
  run(90, 90, 30);  // leaves other bounds in the memory
  run(2, 100, 30);
}

TEST_F(RayBoundsBench, RowBoundIsTheGreatestOfTwoThatDifferInAnyBit) {
  reset_dut();
  std::size_t bank = 0;
  LineBounds expected{};
  std::size_t row = 0;
  const auto clock = [&](const RayBounds::Clear& clear, const RayBounds::Update& update,
                         const RayBounds::Read& read) {
    give(clear, update, {true, bank, 16, 16, 0x7fff}, read);
    dut().set(dut().port("walk_bank_i"), bank);
    dut().clock();
    follow(clear, update);
  };
  const auto end_of_bank = [&] {
    for (int k = 0; k < kBoundStages; ++k) {
      clock({}, {}, {k == 0, bank, kMaxRows - 1});
    }
    expect_port(dut().port("row_bounds_o"), pack(expected), "row_bounds_o");
    bank = (bank + 1) % kPencilBanks;
    row = 0;
  };
  // two columns that meet at each node of the tree, each of them the greater one
  for (std::uint32_t k = 0; k < 16 * kLineBits * kDepthBits * 2; ++k) {
    const std::uint32_t column = k % 16;
    const std::uint32_t bit = 1U << (k / 16 % kDepthBits);
    const auto level = k / 16 / kDepthBits % kLineBits;
    const auto other = static_cast<std::uint32_t>((column ^ 1U << level) ^ (random_() & ((1U << level) - 1)));
    const std::uint32_t greater = static_cast<std::uint32_t>(random_() & 0x7fff) | bit;
    const std::uint32_t less = greater ^ bit ^ static_cast<std::uint32_t>(random_() & random_() & (bit - 1));
    if (row == 0) {
      clock({true, bank, 16, 16, 0x7fff}, {}, {});
    }
    for (std::uint32_t ray = 0; ray < 16; ++ray) {
      const std::uint32_t bound = ray == column ? greater : ray == other ? less : 0;
      clock({}, {true, bank, row * kMaxColumns + ray, bound}, {ray == 0 && row != 0, bank, (row + 15) % 16});
    }
    expected[row] = greater;
    if (++row == kMaxRows) {
      end_of_bank();
    }
  }
}

TEST_F(RayBoundsBench, ResetEndsReadsUnderWay) {
  reset_dut();
  const RayBounds::Clear clear{true, 2, 16, 16, 1000};
  constexpr std::size_t kRow = 5;
  dut().set(dut().port("walk_bank_i"), 2);
  const auto clock = [&](const RayBounds::Clear& cleared, const RayBounds::Update& update,
                         const RayBounds::Read& read) {
    give(cleared, update, clear, read);
    dut().clock();
    follow(cleared, update);
  };
  for (int clocks = 0; clocks <= kBoundStages; ++clocks) {  // a read of so many clocks ago
    clock(clear, {}, {});
    for (std::size_t column = 0; column < 16; ++column) {
      clock({}, {true, 2, kRow * kMaxColumns + column, 10}, {});
    }
    for (int k = 0; k < clocks; ++k) {
      clock({}, {}, {k == 0, 2, kRow});
    }
    dut().set(dut().port("rst_i"), 1);
    clock({}, {}, {clocks == 0, 2, kRow});
    dut().set(dut().port("rst_i"), 0);
    LineBounds expected;
    expected.fill(1000);
    expected[kRow] = clocks >= kBoundStages - 1 ? 10 : 1000;
    for (int k = 0; k < kBoundStages; ++k) {
      expect_port(dut().port("row_bounds_o"), pack(expected), "row_bounds_o");
      clock({}, {}, {});
    }
  }
}

}  // namespace
}  // namespace raplas
