// row_interval: every column between the outermost cuts of the edges that reach the row, and no other. Each
// answer is that of the definition and that of a count column by column in integers without rounding.
#include <algorithm>
#include <random>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const int kClocks = Dut::simulator() == "ghdl" ? 8'000 : 60'000;
const PortStage kStage{"columns_o", kRowIntervalStages};

constexpr int kColumn = 1 << kCutFraction;
constexpr int kDropped = kSlopeFraction - kCutFraction;
constexpr std::int32_t kCutLimit = 1 << (kCutBits - 1);
constexpr std::int32_t kSlopeLimit = 1 << (kSlopeBits - 1);
constexpr std::int32_t kMarginLimit = 1 << CutTriangle::kMarginBits;

/// The column, from the middle, is not to the left of all intervals and not to the right of all. An interval
/// is the margin around floor(cut / 2^kDropped).
bool between_cuts(const EdgeCuts& cuts, int line, std::int64_t column) {
  bool behind_one = false;
  bool before_one = false;
  for (const EdgeCut& edge : cuts) {
    if (line < edge.first || edge.last < line) {
      continue;
    }
    const std::int64_t cut = std::int64_t{edge.at} * (1 << kDropped) + std::int64_t{line} * edge.slope;
    const std::int64_t place = column * kColumn;
    behind_one = behind_one || edge.open || (place + edge.margin + 1) * (1 << kDropped) > cut;
    before_one = before_one || edge.open || (place - edge.margin) * (1 << kDropped) <= cut;
  }
  return behind_one && before_one;
}

class RowInterval : public testing::Test {
 protected:
  std::int32_t between(std::int32_t least, std::int32_t most) {
    return std::uniform_int_distribution<std::int32_t>(least, most)(random_);
  }

  /// Signed: the ends, small, or anything.
  std::int32_t number(std::int32_t limit) {
    switch (between(0, 7)) {
      case 0:
        return -limit + between(0, 1);
      case 1:
        return limit - 1 - between(0, 1);
      case 2:
        return between(-2, 2);
      default:
        return between(-limit, limit - 1) >> between(0, 10);
    }
  }

  EdgeCut any_cut() {
    EdgeCut cut;
    cut.open = between(0, 15) == 0;
    cut.first = between(-kGridOrigin, between(-kGridOrigin, kGridOrigin));
    cut.last = between(between(-kGridOrigin - 1, kGridOrigin - 1), kGridOrigin - 1);
    cut.at = number(kCutLimit);
    cut.slope = number(kSlopeLimit);
    cut.margin = between(0, 7) == 0 ? kMarginLimit - 1 : between(0, kMarginLimit - 1) >> between(0, 17);
    return cut;
  }

  /// One end of its interval in that row is at a column's place, or a unit off.
  EdgeCut cut_near_a_column(int line) {
    EdgeCut cut = any_cut();
    cut.margin >>= between(0, 6);
    const int side = between(0, 1) == 0 ? cut.margin : -cut.margin;
    const int column = between(-kGridOrigin - 1, kGridOrigin);
    cut.slope >>= between(0, 4);
    const int at = column * kColumn + side + between(-1, 1) - (line * cut.slope >> kDropped);
    cut.at = std::clamp(at, -kCutLimit, kCutLimit - 1);
    return cut;
  }

  GridPoint any_point() {
    const int reach = 1 << between(kGridFraction, kGridBits - 1);
    return {true, between(-reach, reach - 1), between(-reach, reach - 1)};
  }

  void check(const EdgeCuts& cuts, std::uint32_t row, bool whole) {
    CutTriangle word;
    word.cuts = cuts;
    const auto bits = word.pack();
    PackedWord<3 * CutTriangle::kEdgeBits> low{};
    std::copy_n(bits.begin(), low.size(), low.begin());
    low.back() &= (1U << (3 * CutTriangle::kEdgeBits % 32)) - 1;
    const LineMask columns = whole ? first_lines(kMaxColumns) : row_columns(cuts, row);
    const int line = static_cast<int>(row) - kGridOrigin;
    for (int column = 0; column < kMaxColumns; ++column) {
      const bool inside = whole || between_cuts(cuts, line, column - kGridOrigin);
      ASSERT_EQ((columns >> column & 1U) != 0, inside) << "the definition, column " << column;
    }
    narrow_ += columns != 0 && columns != first_lines(kMaxColumns) ? 1 : 0;
    dut().set(row_, row);
    dut().set(cuts_, low);
    dut().set(whole_, whole ? 1 : 0);
    if (const auto due = board_.clock(columns)) {
      expect_port(columns_, *due, "columns_o");
    }
  }

  void TearDown() override {  // the last results leave the pipeline
    for (int k = 1; k < kRowIntervalStages; ++k) {
      check({}, 0, false);
    }
  }

  std::uint32_t any_row() { return static_cast<std::uint32_t>(between(0, kMaxRows - 1)); }

  int narrow_ = 0;  ///< answers of some columns, not all

 private:
  std::mt19937 random_{91};
  PortId row_ = dut().port("row_i");
  PortId cuts_ = dut().port("cuts_i");
  PortId whole_ = dut().port("whole_i");
  PortId columns_ = dut().port("columns_o");
  Scoreboard<LineMask> board_{kRowIntervalStages};
};

TEST_F(RowInterval, IsThatOfItsEdgesWhateverTheirWordsHold) {
  for (int k = 0; k < kClocks; ++k) {
    ASSERT_NO_FATAL_FAILURE(check({any_cut(), any_cut(), any_cut()}, any_row(), between(0, 15) == 0));
  }
}

TEST_F(RowInterval, BeginsAndEndsAtTheColumnThatACutTouches) {
  for (int k = 0; k < kClocks; ++k) {
    const std::uint32_t row = any_row();
    const int line = static_cast<int>(row) - kGridOrigin;
    EdgeCuts cuts{cut_near_a_column(line), cut_near_a_column(line), cut_near_a_column(line)};
    for (EdgeCut& cut : cuts) {
      cut.open = cut.open && between(0, 3) == 0;
    }
    ASSERT_NO_FATAL_FAILURE(check(cuts, row, between(0, 63) == 0));
  }
  EXPECT_GT(narrow_, kClocks / 2);
}

TEST_F(RowInterval, HoldsTheColumnsOfATriangleInAllItsRows) {
  for (int k = 0; k < kClocks / kMaxRows; ++k) {
    const EdgeCuts cuts =
        edge_cuts({any_point(), any_point(), any_point()}, static_cast<std::uint32_t>(between(0, 3)));
    for (std::uint32_t row = 0; row < kMaxRows; ++row) {
      ASSERT_NO_FATAL_FAILURE(check(cuts, row, false));
    }
  }
}

TEST_F(RowInterval, IsEmptyIfNoEdgeReachesTheRowAndWholeIfAskedFor) {
  for (std::uint32_t row = 0; row < kMaxRows; ++row) {
    const int line = static_cast<int>(row) - kGridOrigin;
    for (int first = -kGridOrigin; first <= kGridOrigin; ++first) {
      for (int last = -kGridOrigin - 1; last < kGridOrigin; ++last) {
        EdgeCuts cuts{};  // default: no row
        EdgeCut& cut = cuts[static_cast<std::size_t>(between(0, 2))];
        cut = {(first ^ last) % 2 != 0, first, last, line, kSlopeLimit - 1, kMarginLimit - 1};
        ASSERT_NO_FATAL_FAILURE(check(cuts, row, between(0, 3) == 0));
      }
    }
  }
}

}  // namespace
}  // namespace raplas
