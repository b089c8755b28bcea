// ray_bounds, row_selector with row_interval, queue of rows and column_selector together: while hits lower
// the bounds, no pair that matters is missing, none is there that did not matter when its triangle came or
// lies beyond its edges, and no clock is lost.
#include <optional>
#include <random>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kPencils = 16;
constexpr std::size_t kHitClocks = 35;  ///< from a pair to the bound that its hit lowers
/// From the first clock of a word at the front to its first pair: through row_selector, the queue of rows and
/// column_selector.
constexpr int kFirstPairClocks = int{RowSelector::kRowStages} + 1 + 1;
constexpr std::size_t kRestClocks = 50;  ///< from a pencil's end to the next clear of its bank
const PortStage kStages[]{{"issue_o", kFirstPairClocks}, {"last_o", kFirstPairClocks}};

/// The four units' models, connected.
struct Model {
  RayBounds bounds;
  RowSelector rows;
  Fifo<QueuedRow, RowSelector::kQueueRows> queue;
  ColumnSelector columns;

  void clock(const RayBounds::Clear& clear, const RayBounds::Update& update, bool valid,
             const CutTriangle& word, bool stall) {
    const std::size_t count = queue.count();
    const QueuedRow front = queue.front();
    const bool front_valid = queue.valid();
    const bool take = columns.ready(stall);
    const RayBounds::Read read = rows.read();
    queue.clock(rows.row_valid(), rows.row(), take);
    columns.clock(front_valid, front, stall);
    rows.clock(valid, word, bounds.bounds(), count);
    bounds.clock(clear, update, read);
  }
};

struct Pattern {
  unsigned word_percent = 100;
  unsigned stall_percent = 0;
  unsigned hit_percent = 0;  ///< of the pairs lower their ray's bound
  bool far = true;           ///< nothing is too far at first
  bool tokens = true;
  bool whole = false;        ///< each word has a row, each row all columns
  std::uint32_t lines = 16;  ///< most rows and columns that a triangle crosses
  int words_per_pencil = 60;
};

struct Figures {
  int bubbles = 0;    ///< clocks without pair, end or stall after the first pair
  int dead_rows = 0;  ///< rows read in vain
  int dead_words = 0;
  int pairs = 0;
};

class PairSelectionBench : public testing::Test {
 protected:
  using Bank = std::array<std::uint32_t, std::size_t{kMaxRows} * kMaxColumns>;

  /// A word that has come, and what its rays' bounds were then.
  struct Word {
    CutTriangle word;
    Bank bounds;
  };

  std::uint32_t number(std::uint32_t mask) { return static_cast<std::uint32_t>(random_() & mask); }

  /// Within the pencil and the bounds of its rows, as edge_setup leaves it.
  CutTriangle any_word(std::uint32_t bank, const Pattern& pattern, const RayBounds& bounds) {
    const auto mask = [&] {
      const std::uint32_t lines = static_cast<std::uint32_t>(1 + random_() % pattern.lines);
      LineMask bits = 0;
      for (std::uint32_t k = 0; k < lines; ++k) {
        bits |= 1U << (random_() % 16);
      }
      return bits;
    };
    const auto place = [&] { return static_cast<std::int32_t>(number(0x3ff)) - 0x200; };
    std::array<GridPoint, 3> points;
    for (GridPoint& point : points) {
      point = {true, place(), place()};
    }
    const std::uint32_t z = number(0x3fff);
    const LineMask rows = !pattern.whole && number(7) == 0 ? 0 : mask();
    return {false,
            bank,
            number(kLastId),
            z,
            rows & lines_beyond(z, bounds.row_bounds(bank)),
            mask() & first_lines(pencils_[bank].columns),
            pattern.whole || number(3) == 0,
            edge_cuts(points, 0)};
  }

  void give(const RayBounds::Clear& clear, const RayBounds::Update& update, bool valid,
            const CutTriangle& word, bool stall) {
    if (clear.valid) {
      pencils_[clear.bank] = clear;
    }
    dut().set(dut().port("clear_i"), clear.valid ? 1 : 0);
    dut().set(dut().port("clear_bank_i"), clear.bank);
    dut().set(dut().port("clear_rows_i"), clear.rows);
    dut().set(dut().port("clear_far_i"), clear.far);
    dut().set(dut().port("update_i"), update.valid ? 1 : 0);
    dut().set(dut().port("update_bank_i"), update.bank);
    dut().set(dut().port("update_columns_i"), pencils_[update.bank].columns);
    dut().set(dut().port("update_far_i"), pencils_[update.bank].far);
    dut().set(dut().port("update_ray_i"), update.ray);
    dut().set(dut().port("update_bound_i"), update.bound);
    dut().set(dut().port("valid_i"), valid ? 1 : 0);
    dut().set(dut().port("word_i"), word.pack());
    dut().set(dut().port("stall_i"), stall ? 1 : 0);
  }

  /// All that the word could give, in order.
  template <typename Visit>
  static void each_crossing(const CutTriangle& word, Visit visit) {
    for (std::uint32_t row = 0; row < kMaxRows; ++row) {
      const LineMask interval = word.whole ? first_lines(kMaxColumns) : row_columns(word.cuts, row);
      for (std::uint32_t column = 0; column < kMaxColumns; ++column) {
        if ((word.rows >> row & (word.columns & interval) >> column & 1U) != 0) {
          visit(row * kMaxColumns + column);
        }
      }
    }
  }

  /// A pair goes. Those in front of it that have not gone (places from at_ on, in the order of each_crossing)
  /// must not matter any more.
  void expect_pair(const std::array<Bank, kPencilBanks>& truth, std::uint32_t ray, std::uint32_t triangle,
                   std::uint32_t z) {
    while (!words_.empty() && !HasFailure()) {
      const Word& front = words_.front();
      bool found = false;
      ASSERT_FALSE(front.word.last) << "a pair that belongs behind the end of the pencil";
      std::size_t place = 0;
      each_crossing(front.word, [&](std::uint32_t crossed) {
        if (found || place++ < at_) {
          return;
        }
        ++at_;
        if (crossed == ray && front.word.triangle == triangle && front.word.z == z) {
          found = true;
          EXPECT_LT(z, front.bounds[ray]) << "a pair that did not matter";
          expect_port(dut().port("bank_o"), front.word.bank, "bank_o");
        } else {
          EXPECT_GE(front.word.z, truth[front.word.bank][crossed]) << "a pair is missing";
        }
      });
      if (found) {
        return;
      }
      words_.pop_front();
      at_ = 0;
    }
    FAIL() << "a pair of no triangle";
  }

  void expect_end(const std::array<Bank, kPencilBanks>& truth) {
    while (!words_.empty() && !words_.front().word.last) {
      std::size_t place = 0;
      const Word& front = words_.front();
      each_crossing(front.word, [&](std::uint32_t crossed) {
        if (place++ >= at_) {
          EXPECT_GE(front.word.z, truth[front.word.bank][crossed]) << "a pair is missing";
        }
      });
      words_.pop_front();
      at_ = 0;
    }
    ASSERT_FALSE(words_.empty());
    expect_port(dut().port("bank_o"), words_.front().word.bank, "bank_o");
    words_.pop_front();
  }

  Figures run(const Pattern& pattern, int reset_after = -1) {
    reset_dut();
    words_.clear();
    at_ = 0;
    Model model;
    Figures figures;
    std::array<Bank, kPencilBanks> truth{};
    std::deque<RayBounds::Update> hits(kHitClocks);
    std::array<std::size_t, kPencilBanks> rest{};  // clocks since its pencil's end; of no account before
    std::array<bool, kPencilBanks> busy{};
    int pencil = 0;
    int words = 0;  // of this pencil still to come, its end included
    int ends = 0;
    const int all_ends = pattern.tokens ? kPencils : 1;
    bool cleared = false;
    bool offered = false;
    CutTriangle word;
    std::size_t count_before = 0;
    for (int clock = 0; ends < all_ends && clock != reset_after && !HasFailure(); ++clock) {
      const auto bank = static_cast<std::size_t>(pencil % kPencilBanks);
      RayBounds::Clear clear{false, number(3), number(31), number(31), number(0x7fff)};
      if (pencil < all_ends && !cleared && !busy[bank] && rest[bank] >= kRestClocks) {
        const auto lines = [&] { return pattern.far ? 16 : 1 + number(15); };
        clear = {true, bank, lines(), lines(), pattern.far ? 0x7fff : 0x2000 + number(0x1fff)};
        cleared = busy[bank] = true;
        words = pattern.words_per_pencil;
        for (std::size_t ray = 0; ray < truth[bank].size(); ++ray) {
          const bool inside = ray / kMaxColumns < clear.rows && ray % kMaxColumns < clear.columns;
          truth[bank][ray] = inside ? clear.far : 0;
        }
      } else if (cleared && words > 0 && !offered) {
        offered = number(127) * 100 < pattern.word_percent * 128;
        word = any_word(static_cast<std::uint32_t>(bank), pattern, model.bounds);
        word.last = words == 1;
        if (offered) {
          words_.push_back({word, truth[bank]});
          figures.dead_words += !word.last && word.rows == 0 ? 1 : 0;
        }
      }
      RayBounds::Update update = hits.front();
      hits.pop_front();
      std::uint32_t& bound = truth[update.bank][update.ray];
      update.bound = std::min(update.bound, bound);
      const bool stall = number(127) * 100 < pattern.stall_percent * 128;
      give(clear, update, offered, word, stall);
      dut().settle();

      const std::size_t count = model.queue.count();
      expect_port(dut().port("ready_o"), model.rows.ready(offered, word, count) ? 1 : 0, "ready_o");
      expect_port(dut().port("read_o"), model.rows.read().valid ? 1 : 0, "read_o");
      expect_port(dut().port("row_valid_o"), model.rows.row_valid() ? 1 : 0, "row_valid_o");
      expect_port(dut().port("row_count_o"), count, "row_count_o");
      expect_port(dut().port("issue_o"), model.columns.issue(stall) ? 1 : 0, "issue_o");
      expect_port(dut().port("last_o"), model.columns.last(stall) ? 1 : 0, "last_o");
      figures.dead_rows += static_cast<int>(dut().get(dut().port("read_o")));
      figures.dead_rows -= static_cast<int>(dut().get(dut().port("row_valid_o")));
      const bool issue = dut().get(dut().port("issue_o")) != 0;
      const bool last = dut().get(dut().port("last_o")) != 0;
      hits.push_back({});
      if (issue) {
        const auto ray = static_cast<std::uint32_t>(dut().get(dut().port("ray_o")));
        const auto z = static_cast<std::uint32_t>(dut().get(dut().port("z_o")));
        EXPECT_EQ(ray, model.columns.ray());
        expect_pair(truth, ray, static_cast<std::uint32_t>(dut().get(dut().port("triangle_o"))), z);
        ++figures.pairs;
        if (random_() % 100 < pattern.hit_percent) {
          hits.back() = {true, dut().get(dut().port("bank_o")), ray, z + number(0xff)};
        }
      } else if (last) {
        ++figures.dead_rows;  // its row word came without a read
        const std::size_t ended = dut().get(dut().port("bank_o"));
        expect_end(truth);
        busy[ended] = false;
        rest[ended] = 0;
        ++ends;
      } else if (!stall) {
        EXPECT_EQ(count_before, 0U) << "a row waited";
        figures.bubbles += figures.pairs != 0 ? 1 : 0;
      }
      count_before = count;
      const bool taken = offered && dut().get(dut().port("ready_o")) != 0;
      dut().clock();
      model.clock(clear, update, offered, word, stall);
      if (update.valid) {
        bound = update.bound;
      }
      for (std::size_t& clocks : rest) {
        ++clocks;
      }
      if (taken) {
        offered = false;
        if (--words == 0) {
          ++pencil;
          cleared = false;
        }
      }
    }
    if (reset_after < 0) {
      EXPECT_TRUE(words_.empty());
    }
    return figures;
  }

 private:
  std::mt19937 random_{76};
  std::array<RayBounds::Clear, kPencilBanks> pencils_{};
  std::deque<Word> words_;
  std::size_t at_ = 0;  ///< places of the front word that are decided
};

TEST_F(PairSelectionBench, APairGoesEveryClockWhileTrianglesWaitThatHaveLiveRays) {
  for (const unsigned stall_percent : {0U, 30U, 70U}) {
    for (const std::uint32_t lines : {1U, 2U, 16U}) {
      if (stall_percent != 0 && lines == 16) {
        continue;  // hundreds of pairs a triangle: a stall is no matter
      }
      Pattern pattern;
      pattern.tokens = false;
      pattern.whole = true;
      pattern.lines = lines;
      pattern.stall_percent = stall_percent;
      pattern.words_per_pencil = 1'500;
      const Figures figures = run(pattern);
      EXPECT_EQ(figures.bubbles, 0) << "triangles of up to " << lines << " rows and columns";
      EXPECT_EQ(figures.dead_rows, 0);
      EXPECT_GE(figures.pairs, 1'499);
    }
  }
}

TEST_F(PairSelectionBench, OnlyWhatIsReadInVainCostsAClockAndOnlyIfNoRowWaits) {
  Pattern pattern;
  pattern.tokens = false;
  pattern.words_per_pencil = 1'500;
  pattern.hit_percent = 30;
  for (const std::uint32_t lines : {3U, 16U}) {
    pattern.lines = lines;
    const Figures figures = run(pattern);
    EXPECT_GT(figures.dead_rows + figures.dead_words, 100);
    EXPECT_LE(figures.bubbles, figures.dead_rows + figures.dead_words);
  }
}

TEST_F(PairSelectionBench, PencilsFollowEachOtherWhileBoundsFall) {
  Pattern pattern;
  pattern.far = false;
  pattern.hit_percent = 20;
  EXPECT_GT(run(pattern).pairs, 1'000);
}
TEST_F(PairSelectionBench, PencilsFollowEachOtherUnderStalls) {
  Pattern pattern;
  pattern.far = false;
  pattern.hit_percent = 20;
  pattern.stall_percent = 60;
  EXPECT_GT(run(pattern).pairs, 1'000);
}
TEST_F(PairSelectionBench, PencilsFollowEachOtherWhenTrianglesAreRare) {
  Pattern pattern;
  pattern.far = false;
  pattern.hit_percent = 50;
  pattern.word_percent = 5;
  EXPECT_GT(run(pattern).pairs, 1'000);
}

TEST_F(PairSelectionBench, TheFirstPairComesNineClocksAfterItsTriangle) {
  reset_dut();
  Model model;
  const auto clock = [&](const RayBounds::Clear& clear, bool valid) {
    const CutTriangle word{false, 1, 2, 3, 4, 5, true, {}};
    give(clear, {}, valid, word, false);
    dut().clock();
    model.clock(clear, {}, valid, word, false);
  };
  clock({true, 1, 16, 16, 0x7fff}, false);
  clock({}, true);
  for (int k = 1; k < kFirstPairClocks; ++k) {
    expect_port(dut().port("issue_o"), 0, "issue_o");
    clock({}, false);
  }
  expect_port(dut().port("issue_o"), 1, "issue_o");
}

TEST_F(PairSelectionBench, NothingIsLeftAfterAReset) {
  for (int clocks = 20; clocks < 120; clocks += 7) {
    Pattern pattern;
    pattern.hit_percent = 50;
    run(pattern, clocks);
    dut().set(dut().port("rst_i"), 1);
    dut().clock();
    dut().set(dut().port("rst_i"), 0);
    give({}, {}, false, {}, false);
    for (int k = 0; k < 2 * kFirstPairClocks; ++k) {
      expect_port(dut().port("issue_o"), 0, "issue_o");
      expect_port(dut().port("last_o"), 0, "last_o");
      expect_port(dut().port("read_o"), 0, "read_o");
      dut().clock();
    }
  }
}

}  // namespace
}  // namespace raplas
