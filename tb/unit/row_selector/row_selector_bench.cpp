// row_selector: the rows of each triangle in which it matters to a ray, each once and in order, and no clock
// without one while triangles wait. The bench is ray_bounds and the queue of rows; a fourth of the rows have
// no bounds yet, and what is given for them doesn't count.
#include <random>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr std::size_t kTriangles = 800;
constexpr std::size_t kRowStages = kRowIntervalStages + 1;
constexpr std::size_t kReadStages = kRowIntervalStages - kMemoryStages;
constexpr std::size_t kQueueRows = std::size_t{1} << kRowFifoDepthLog2;
const PortStage kStages[]{{"ready_o", 0},         {"read_o", kReadStages},     {"bank_o", kReadStages},
                          {"row_o", kReadStages}, {"row_valid_o", kRowStages}, {"row_word_o", kRowStages}};

/// A row that is to be asked for, or the end of a pencil.
struct Item {
  CutTriangle word;
  std::uint32_t row = 0;
};

class RowSelectorBench : public testing::Test {
 protected:
  using Words = std::array<std::uint32_t, 2>;

  std::uint32_t number(std::uint32_t mask) { return static_cast<std::uint32_t>(random_() & mask); }

  /// Bounds about as large as z, and all larger if `live`.
  LineBounds bounds_near(std::uint32_t z, bool live) {
    LineBounds bounds;
    for (std::uint32_t& bound : bounds) {
      const std::uint32_t bit = 1U << (random_() % kDepthBits);
      const std::array<std::uint32_t, 6> choice{z + 1, z | bit, 0x7fff, z, z & ~bit, number(0x7fff)};
      bound = std::min(choice[random_() % choice.size()], 0x7fffU);
      bound = live && bound <= z ? z + 1 + number(0xff) : bound;
    }
    return bounds;
  }

  /// What ray_bounds says of a row.
  struct Answer {
    LineBounds bounds{};
    bool hit = false;

    /// The bounds that count.
    [[nodiscard]] LineBounds all() const {
      LineBounds none;
      none.fill(1U << kDepthBits);
      return hit ? bounds : none;
    }
  };
  Answer answer(std::uint32_t z, bool live) { return {bounds_near(z, live), number(3) != 0}; }

  /// Edges of a triangle on the grid, or anything.
  EdgeCuts cuts() {
    const auto point = [this] {
      const auto place = [this] { return static_cast<std::int32_t>(number(0x3ff)) - 0x200; };
      return GridPoint{true, place(), place()};
    };
    return edge_cuts({point(), point(), point()}, number(3));
  }

  std::vector<CutTriangle> triangles(bool live) {
    std::vector<CutTriangle> list;
    while (list.size() < kTriangles) {
      const auto mask = [this](LineMask none) {
        const LineMask bits = number(0xffff) & number(0xffff);
        return bits == 0 ? none : bits;
      };
      CutTriangle word;
      word.last = random_() % 10 == 0;
      word.bank = number(3);
      word.triangle = number(kLastId);
      word.z = live ? number(0x3fff) : number(0x7fff) >> (random_() % 15);
      word.rows = random_() % 8 == 0 ? 0 : random_() % 4 == 0 ? 1U << (random_() % 16) : mask(1);
      word.columns = mask(0x8000);
      word.whole = random_() % 4 < (live ? 3 : 1);
      word.cuts = cuts();
      list.push_back(word);
    }
    return list;
  }

  /// What becomes of a word.
  static std::vector<Item> items_of(const CutTriangle& word) {
    if (word.last) {
      return {{word}};
    }
    std::vector<Item> items;
    for (std::uint32_t row = 0; row < kMaxRows; ++row) {
      if ((word.rows >> row & 1U) != 0) {
        items.push_back({word, row});
      }
    }
    return items;
  }

  static QueuedRow row_of(const Item& item, const LineBounds& bounds) {
    const CutTriangle& word = item.word;
    QueuedRow row{false, word.bank, word.triangle, word.z, item.row, 0};
    for (std::uint32_t column = 0; column < kMaxColumns; ++column) {
      const bool crossed = (word.columns >> column & 1U) != 0;
      const bool inside = word.whole || (row_columns(word.cuts, item.row) >> column & 1U) != 0;
      row.columns |= (crossed && inside && word.z < bounds[column] ? 1U : 0U) << column;
    }
    return row;
  }

  /// Gives all triangles and checks every clock. Returns the clocks in which the queue had room and a word
  /// waited, but neither did a row go, to be asked for kReadStages later, nor was a word taken.
  int run(unsigned word_percent, unsigned take_percent, bool live, int reset_after = -1) {
    reset_dut();
    const std::vector<CutTriangle> list = triangles(live);
    std::deque<Item> items;          // still to be asked for
    std::deque<QueuedRow> expected;  // to be written, in order
    const auto pass_ends = [&] {
      while (!items.empty() && items.front().word.last) {
        expected.push_back({true, items.front().word.bank, 0, 0, 0, 0});
        items.pop_front();
      }
    };
    RowSelector model;
    std::deque<std::size_t> queue;  // rows, their number only
    Delay<Answer, kMemoryStages> asked;
    std::deque<bool> must_go(kReadStages);  // in earlier clocks a row had to
    std::size_t next = 0;
    bool offered = false;
    int idle = 0;
    int drain = 0;
    std::size_t fullest = 0;
    for (int clock = 0; drain < 100 && clock != reset_after && !HasFailure(); ++clock) {
      if (!offered && next < list.size() && random_() % 100 < word_percent) {
        offered = true;
        const auto its_items = items_of(list[next]);
        items.insert(items.end(), its_items.begin(), its_items.end());
      }
      const CutTriangle word = offered ? list[next] : triangles_none();
      drain += next == list.size() && items.empty() && expected.empty() ? 1 : 0;
      dut().set(dut().port("valid_i"), offered ? 1 : 0);
      dut().set(dut().port("word_i"), word.pack());
      dut().set(dut().port("bounds_i"), pack(asked.out().bounds));
      dut().set(dut().port("row_hit_i"), asked.out().hit ? 1 : 0);
      dut().set(dut().port("row_count_i"), queue.size());
      dut().settle();
      expect_port(dut().port("ready_o"), model.ready(offered, word, queue.size()) ? 1 : 0, "ready_o");
      const RayBounds::Read read = model.read();
      expect_port(dut().port("read_o"), read.valid ? 1 : 0, "read_o");
      Answer row_read = answer(number(0x7fff), live);
      if (dut().get(dut().port("read_o")) != 0) {
        pass_ends();
        if (items.empty()) {
          ADD_FAILURE() << "a row is asked for that is of no triangle";
          break;
        }
        const Item item = items.front();
        items.pop_front();
        expect_port(dut().port("bank_o"), item.word.bank, "bank_o");
        expect_port(dut().port("row_o"), item.row, "row_o");
        row_read = answer(item.word.z, live);
        if (const QueuedRow row = row_of(item, row_read.all()); row.columns != 0) {
          expected.push_back(row);
        }
      }
      expect_port(dut().port("row_valid_o"), model.row_valid() ? 1 : 0, "row_valid_o");
      const bool write = dut().get(dut().port("row_valid_o")) != 0;
      if (write) {
        if (expected.empty()) {
          pass_ends();
        }
        if (expected.empty()) {
          ADD_FAILURE() << "a row of no triangle";
          break;
        }
        Words bits{};
        dut().get(dut().port("row_word_o"), bits);
        const QueuedRow row = QueuedRow::unpack(bits);
        if (row.last) {  // nothing else in it counts
          EXPECT_FALSE(dut().has_unknown(dut().port("row_word_o")));
          EXPECT_EQ((QueuedRow{true, row.bank, 0, 0, 0, 0}), expected.front());
          count_checked();
        } else {
          expect_port(dut().port("row_word_o"), expected.front().pack(), "row_word_o");
          EXPECT_EQ(model.row(), expected.front());
        }
        EXPECT_LT(queue.size(), kQueueRows) << "overflow";
        expected.pop_front();
      }
      const bool taken = offered && dut().get(dut().port("ready_o")) != 0;
      const bool room = queue.size() + kRowStages < kQueueRows;
      must_go.push_back(offered && room && !taken);
      idle += must_go.front() && !read.valid ? 1 : 0;
      must_go.pop_front();
      dut().clock();
      model.clock(offered, word, asked.out().all(), queue.size());
      asked.clock(row_read);
      if (taken) {
        ++next;
        offered = false;
      }
      if (!queue.empty() && random_() % 100 < take_percent) {
        queue.pop_front();
      }
      if (write) {
        queue.push_back(next);
      }
      fullest = std::max(fullest, queue.size());
    }
    if (reset_after < 0) {
      EXPECT_EQ(next, list.size());
      EXPECT_TRUE(expected.empty());
      EXPECT_TRUE(take_percent > 50 || fullest + kRowStages >= kQueueRows);
    }
    return idle;
  }

  /// What stands at the port while no word waits.
  CutTriangle triangles_none() {
    return {number(1) != 0, number(3), number(kLastId), 0, 0xffff, 0xffff, number(1) != 0, cuts()};
  }

 private:
  std::mt19937 random_{75};
};

TEST_F(RowSelectorBench, LetsARowGoEveryClockWithoutBubbles) { EXPECT_EQ(run(100, 100, true), 0); }
TEST_F(RowSelectorBench, DropsRowsWithoutARayToTest) { EXPECT_EQ(run(100, 100, false), 0); }
TEST_F(RowSelectorBench, NeverOverflowsTheQueueOfRows) { EXPECT_EQ(run(100, 30, true), 0); }
TEST_F(RowSelectorBench, NeverOverflowsItWhenHardlyTaken) { EXPECT_EQ(run(100, 15, false), 0); }
TEST_F(RowSelectorBench, NeitherLosesNorRepeatsWhenTrianglesAreRare) { run(10, 70, false); }
TEST_F(RowSelectorBench, ForgetsItsTriangleWhenReset) {
  for (int clocks = 1; clocks < 40; ++clocks) {
    run(100, 50, true, clocks);
    dut().set(dut().port("rst_i"), 1);
    dut().clock();
    dut().set(dut().port("rst_i"), 0);
    dut().set(dut().port("valid_i"), 0);
    dut().set(dut().port("row_count_i"), 0);
    for (std::size_t k = 0; k < 2 * kRowStages; ++k) {
      dut().settle();
      expect_port(dut().port("read_o"), 0, "read_o");
      expect_port(dut().port("row_valid_o"), 0, "row_valid_o");
      dut().clock();
    }
  }
  run(60, 60, false);
}

}  // namespace
}  // namespace raplas
