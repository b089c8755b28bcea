// column_selector: the pairs of each row, each once and in order, ends of pencils among them, and no clock
// without one while rows wait.
#include <random>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr std::size_t kRows = 2'000;
const PortStage kStages[]{{"issue_o", 1}, {"ray_o", 1},  {"triangle_o", 1}, {"z_o", 1},
                          {"bank_o", 1},  {"last_o", 1}, {"ready_o", 1}};

/// What goes in a clock: a pair, or the end of a pencil.
struct Issue {
  bool last = false;
  std::uint32_t bank = 0;
  std::uint32_t ray = 0;
  std::uint32_t triangle = 0;
  std::uint32_t z = 0;
};

std::vector<Issue> issues_of(const QueuedRow& row) {
  if (row.last) {
    return {{true, row.bank, 0, 0, 0}};
  }
  std::vector<Issue> issues;
  for (std::uint32_t column = 0; column < kMaxColumns; ++column) {
    if ((row.columns >> column & 1U) != 0) {
      issues.push_back({false, row.bank, row.row * kMaxColumns + column, row.triangle, row.z});
    }
  }
  return issues;
}

class ColumnSelectorBench : public testing::Test {
 protected:
  static std::vector<QueuedRow> rows() {
    std::mt19937 random(73);
    std::vector<QueuedRow> list{{false, 0, 5, 1, 0, 1},
                                {false, 1, 6, 2, 15, 0x8000},
                                {false, 2, 7, 3, 9, 0xffff},
                                {true, 3, 0, 0, 0, 0},
                                {true, 0, kLastId, 0x7fff, 15, 0xffff}};
    while (list.size() < kRows) {
      const auto bits = static_cast<LineMask>(random() & (random() % 2 == 0 ? 0xffff : random()) & 0xffff);
      list.push_back({random() % 10 == 0, static_cast<std::uint32_t>(random() % 4),
                      static_cast<std::uint32_t>(random() & kLastId),
                      static_cast<std::uint32_t>(random() & 0x7fff),
                      static_cast<std::uint32_t>(random() % 16), bits == 0 ? 1U << (random() % 16) : bits});
    }
    return list;
  }

  static void give(bool valid, const QueuedRow& row, bool stall) {
    dut().set(dut().port("valid_i"), valid ? 1 : 0);
    dut().set(dut().port("row_word_i"), row.pack());
    dut().set(dut().port("stall_i"), stall ? 1 : 0);
  }

  /// Gives all rows and checks every clock; gives the clocks without stall in which nothing went though rows
  /// had been waiting.
  int run(unsigned row_percent, unsigned stall_percent) {
    std::mt19937 random(74);
    reset_dut();
    ColumnSelector model;
    const std::vector<QueuedRow> list = rows();
    std::vector<Issue> expected;
    for (const QueuedRow& row : list) {
      const auto issues = issues_of(row);
      expected.insert(expected.end(), issues.begin(), issues.end());
    }
    std::size_t next_row = 0;
    std::size_t next = 0;
    bool offered = false;
    int bubbles = 0;
    while (next < expected.size() && !HasFailure()) {
      offered = next_row < list.size() && (offered || random() % 100 < row_percent);
      const bool stall = random() % 100 < stall_percent;
      const QueuedRow row = offered ? list[next_row] : QueuedRow{true, 3, kLastId, 0x7fff, 15, 0xffff};
      give(offered, row, stall);
      dut().settle();
      expect_port(dut().port("ready_o"), model.ready(stall) ? 1 : 0, "ready_o");
      expect_port(dut().port("issue_o"), model.issue(stall) ? 1 : 0, "issue_o");
      expect_port(dut().port("last_o"), model.last(stall) ? 1 : 0, "last_o");
      const bool issue = dut().get(dut().port("issue_o")) != 0;
      const bool last = dut().get(dut().port("last_o")) != 0;
      EXPECT_FALSE(stall && (issue || last));
      if (issue || last) {
        const Issue& due = expected[next];
        EXPECT_EQ(last, due.last);
        EXPECT_EQ(issue, !due.last);
        expect_port(dut().port("bank_o"), due.bank, "bank_o");
        EXPECT_EQ(model.row().bank, due.bank);
        if (issue) {
          expect_port(dut().port("ray_o"), due.ray, "ray_o");
          expect_port(dut().port("triangle_o"), due.triangle, "triangle_o");
          expect_port(dut().port("z_o"), due.z, "z_o");
          EXPECT_EQ(model.ray(), due.ray);
          EXPECT_EQ(model.row().triangle, due.triangle);
          EXPECT_EQ(model.row().z, due.z);
        }
        ++next;
      } else {
        bubbles += next != 0 && !stall ? 1 : 0;
      }
      const bool taken = offered && dut().get(dut().port("ready_o")) != 0;
      dut().clock();
      model.clock(offered, row, stall);
      if (taken) {
        ++next_row;
        offered = false;
      }
    }
    EXPECT_EQ(next_row, list.size());
    give(false, {true, 0, 0, 0, 0, 0xffff}, false);
    for (int k = 0; k < 4; ++k) {  // nothing more comes out
      dut().settle();
      expect_port(dut().port("issue_o"), 0, "issue_o");
      expect_port(dut().port("last_o"), 0, "last_o");
      dut().clock();
    }
    return bubbles;
  }
};

TEST_F(ColumnSelectorBench, GivesAPairEveryClockWithoutBubbles) { EXPECT_EQ(run(100, 0), 0); }
TEST_F(ColumnSelectorBench, NeitherLosesNorRepeatsUnderStalls) { EXPECT_EQ(run(100, 60), 0); }
TEST_F(ColumnSelectorBench, NeitherLosesNorRepeatsWhenRowsAreRare) { run(10, 0); }

TEST_F(ColumnSelectorBench, ForgetsItsRowWhenReset) {
  for (const bool last : {false, true}) {
    for (int clocks = 0; clocks < 18; ++clocks) {
      reset_dut();
      give(true, {last, 1, 2, 3, 4, 0xffff}, false);
      for (int k = 0; k < clocks; ++k) {
        dut().clock();
        expect_port(dut().port("issue_o"), last ? 0 : 1, "issue_o");
        expect_port(dut().port("last_o"), last ? 1 : 0, "last_o");
      }
      dut().set(dut().port("rst_i"), 1);  // with a row at hand: it must not be taken either
      dut().clock();
      expect_port(dut().port("issue_o"), 0, "issue_o");
      expect_port(dut().port("last_o"), 0, "last_o");
    }
  }
  run(40, 30);
}

}  // namespace
}  // namespace raplas
