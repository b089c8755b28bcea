// edge_setup: the edges of each triangle as edge_cut() has them, each word once, in order and
// EDGE_SETUP_STAGES clocks after it is taken, three clocks a triangle. That a cut covers its edge is checked
// in integers: wherever the ends of the edge are moved by at most the reach, it stays within first .. last
// and at +- margin. The bench is ray_bounds' row bounds and the queue of cut triangles.
#include <array>
#include <cstdlib>
#include <deque>
#include <random>
#include <vector>

#include "raplas/edge_setup.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr std::size_t kTriangles = 1500;
constexpr std::size_t kQueueWords = std::size_t{1} << kCutFifoDepthLog2;
constexpr std::size_t kStages{kEdgeSetupStages};
constexpr int kLine = 1 << kGridFraction;
const PortStage kPortStages[]{
    {"ready_o", 0}, {"pair_bank_o", 0}, {"valid_o", kEdgeSetupStages}, {"word_o", kEdgeSetupStages}};

using Word = PackedWord<CutTriangle::kBits>;

/// What a column or a row of a point has at most, 2^(bits - 1), and what of the error of edges whose points
/// have that is for the roundings of points and edges.
struct SizeClass {
  int bits;
  int error;     ///< for error_i = 0; doubles with each
  int rounding;  ///< these in units of 1 / kLine lines
};
constexpr std::array<SizeClass, 3> kClasses{{{11, 4, 1}, {13, 16, 8}, {kGridBits, 64, 32}}};

std::int32_t sign_extended(std::uint32_t value, int bits) {
  const std::uint32_t sign = std::uint32_t{1} << (bits - 1);
  return static_cast<std::int32_t>((value ^ sign) - sign);
}

/// The cut of an edge in a packed word.
EdgeCut cut_of(const Word& word, int edge) {
  int lsb = (2 - edge) * CutTriangle::kEdgeBits;
  const auto take = [&word, &lsb](int width) {
    lsb += width;
    return extract(word, {lsb - width, width});
  };
  EdgeCut cut;
  cut.margin = static_cast<std::int32_t>(take(CutTriangle::kMarginBits));
  cut.slope = sign_extended(take(kSlopeBits), kSlopeBits);
  cut.at = sign_extended(take(kCutBits), kCutBits);
  cut.last = sign_extended(take(CutTriangle::kCutLineBits), CutTriangle::kCutLineBits);
  cut.first = sign_extended(take(CutTriangle::kCutLineBits), CutTriangle::kCutLineBits);
  cut.open = take(1) != 0;
  return cut;
}

/// The word without what doesn't count: of a pencil's end all but last and bank, of a whole one its cuts.
Word counting(Word word, bool last, bool whole) {
  const int lsb = last ? CutTriangle::kBits - 1 - kBankBits : (whole ? 3 * CutTriangle::kEdgeBits : 0);
  for (int bit = 0; bit < lsb; ++bit) {
    insert(word, {bit, 1}, 0);
  }
  return word;
}

/// An edge may reach `row` only if first <= row <= last, and there only at +- margin: exact. Its true ends
/// are anywhere within `reach` of a and b, so a point of it is within `reach` of a point between a and b.
void expect_covers(const EdgeCut& cut, GridPoint a, GridPoint b, std::uint32_t error) {
  if (b.down < a.down) {
    std::swap(a, b);
  }
  std::size_t k = 0;
  while (!fits(a.across, kClasses[k].bits) || !fits(a.down, kClasses[k].bits) ||
         !fits(b.across, kClasses[k].bits) || !fits(b.down, kClasses[k].bits)) {
    ++k;
  }
  const int reach = (kClasses[k].error << error) - kClasses[k].rounding;
  const std::int64_t across = b.across - a.across;
  const std::int64_t down = b.down - a.down;
  for (int row = -kGridOrigin; row < kGridOrigin; ++row) {
    const int from = std::max(a.down, row * kLine - reach);
    const int to = std::min(b.down, row * kLine + reach);
    if (from > to) {
      continue;
    }
    EXPECT_TRUE(cut.first <= row && row <= cut.last) << "row " << row;
    if (cut.open) {
      continue;
    }
    ASSERT_NE(down, 0);
    // columns times kScale times down
    constexpr std::int64_t kScale = std::int64_t{1} << kCutFraction;
    constexpr std::int64_t kUnit = kScale / kLine;
    const auto column = [&](int at) { return kUnit * (a.across * down + across * (at - a.down)); };
    const auto [low, high] = std::minmax({column(from), column(to)});
    const std::int64_t at = cut.at + (row * cut.slope >> (kSlopeFraction - kCutFraction));
    EXPECT_LE((at - cut.margin) * down, low - kUnit * reach * down) << "row " << row;
    EXPECT_GE((at + cut.margin) * down, high + kUnit * reach * down) << "row " << row;
  }
  if (cut.open && down != 0) {  // only a line that is nearly a row, or passes far from all columns
    constexpr std::int64_t kMostSlope = std::int64_t{1} << (kSlopeBits - 1 - kSlopeFraction);
    constexpr std::int64_t kMostAt = std::int64_t{1} << (kCutBits - 1 - kCutFraction);
    const bool flat = std::abs(across) * 1000 >= kMostSlope * down * 999;
    const bool far = std::abs(a.across * down - across * a.down) >= (kMostAt - kMostAt / 64) * kLine * down;
    EXPECT_TRUE(flat || far);
  }
}

enum class Kind { all, edges, whole, reciprocals };

class EdgeSetupBench : public testing::Test {
 protected:
  std::uint32_t number(std::uint32_t mask) { return static_cast<std::uint32_t>(random_() & mask); }
  std::int32_t between(std::int32_t low, std::int32_t high) {
    return std::uniform_int_distribution<std::int32_t>(low, high)(random_);
  }

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

  std::int32_t coordinate(int bits) {
    const std::int32_t most = (1 << (bits - 1)) - 1;
    switch (random_() % 6) {
      case 0:
        return between(-most - 1, most);
      case 1:
        return number(1) != 0 ? most - between(0, 3) : -most - 1 + between(0, 3);
      case 2:
        return (between(-1, 1) << between(0, bits - 2)) + between(-1, 1);
      case 3:
        return between(-12, 12) * kLine + between(-1, 1);
      default:
        return between(-10 * kLine, 10 * kLine);
    }
  }

  /// Three points: of one size class mostly, with edges that are flat, steep, or as flat as a slope can be.
  std::array<GridPoint, 3> points(Kind kind) {
    std::array<GridPoint, 3> list;
    if (kind == Kind::reciprocals) {  // differ in the last place of a slope
      constexpr int kMost = 15'000;
      const int down = (1 << kDepthFractionBits) + index_;
      index_ = (index_ + 1) % (1 << kDepthFractionBits);
      const std::int32_t across = between(kMost - 1000, kMost) * (number(1) != 0 ? 1 : -1);
      return {{{true, across, -down / 2}, {true, -across, down - down / 2}, {true, 0, between(-300, 300)}}};
    }
    const int bits = kClasses[random_() % 3].bits;
    for (GridPoint& point : list) {
      const int own = random_() % 8 == 0 ? kGridBits : bits;
      point = {kind == Kind::edges || random_() % 8 != 0, coordinate(own), coordinate(own)};
    }
    if (kind == Kind::whole) {
      list[random_() % 3].known = false;
    }
    const GridPoint& a = list[0];
    GridPoint b = list[1];
    switch (random_() % 8) {
      case 0:
        b.down = a.down + between(-1, 1);
        break;
      case 1:
        b.across = a.across + between(-2, 2);
        break;
      case 2:
        b.across = a.across + (b.down - a.down) * (number(1) != 0 ? 32 : -32) + between(-40, 40);
        break;
      case 3:
        b.down = a.down + between(-40, 40);
        b.across = a.across + between(-40, 40);
        break;
      case 4:
        b = a;
        break;
      default:
        break;
    }
    if (fits(b.across, kGridBits) && fits(b.down, kGridBits)) {
      list[1] = b;
    }
    return list;
  }

  std::vector<QueuedTriangle> triangles(Kind kind, bool live) {
    std::vector<QueuedTriangle> list;
    while (list.size() < kTriangles) {
      QueuedTriangle word;
      word.last = kind == Kind::all && random_() % 10 == 0;
      word.bank = number(3);
      word.triangle = number(kLastId);
      word.z = live ? number(0x3fff) : number(0x7fff) >> (random_() % 15);
      word.rows = (number(0xffff) & number(0xffff)) | 1U << (random_() % 16);
      word.columns = number(0xffff);
      word.points = points(kind);
      list.push_back(word);
    }
    return list;
  }

  struct Expected {
    std::uint64_t clock = 0;  ///< in which it is written
    CutTriangle word;
    std::array<GridPoint, 3> points;
    std::array<std::uint32_t, 3> errors{};
  };

  void check_word(const Expected& expected) {
    const PortId port = dut().port("word_o");
    const auto& [clock, word, points, errors] = expected;
    if (!word.last && !word.whole) {
      expect_port(port, word.pack(), "word_o");
      Word seen{};
      dut().get(port, seen);
      for (std::size_t k = 0; k < 3; ++k) {
        const EdgeCut cut = cut_of(seen, static_cast<int>(k));
        EXPECT_EQ(cut, word.cuts[k]) << "edge " << k << " from " << points[k].across << ", " << points[k].down
                                     << " to " << points[(k + 1) % 3].across << ", "
                                     << points[(k + 1) % 3].down << " at error " << errors[k];
        expect_covers(cut, points[k], points[(k + 1) % 3], errors[k]);
      }
      return;
    }
    Word seen{};
    dut().get(port, seen);
    EXPECT_EQ(counting(seen, word.last, word.whole), counting(word.pack(), word.last, word.whole));
    count_checked();
  }

  struct Seen {
    int idle = 0;    ///< clocks in which a word waited and the queue had room, but no edge nor a word went
    int clocks = 0;  ///< from the first to the last clock in which a word waited
    int needed = 0;  ///< three for each triangle with edges, one for each other word
    std::size_t fullest = 0;
  };

  /// Gives all words and checks every clock. hold: clocks in which nothing is taken out of the queue, first.
  Seen run(Kind kind, unsigned word_percent, unsigned take_percent, bool live, int hold = 0,
           int reset_after = -1) {
    reset_dut();
    const std::vector<QueuedTriangle> list = triangles(kind, live);
    std::deque<Expected> expected;
    EdgeSetup model;
    Seen seen;
    std::size_t queue = 0;
    std::size_t next = 0;
    bool offered = false;
    std::size_t edge = 0;  // of the word at the front
    std::array<std::uint32_t, 3> errors{};
    for (int clock = 0; (next < list.size() || !expected.empty() || queue != 0) && clock != reset_after;
         ++clock) {
      if (HasFailure()) {
        return seen;
      }
      offered = next < list.size() && (offered || random_() % 100 < word_percent);
      const QueuedTriangle word = offered ? list[next] : list[random_() % list.size()];
      const LineBounds row_bounds = bounds_near(word.z, live);
      const std::uint32_t error = number((1U << kGridErrorBits) - 1);
      dut().set(dut().port("valid_i"), offered ? 1 : 0);
      dut().set(dut().port("word_i"), word.pack());
      dut().set(dut().port("row_bounds_i"), pack(row_bounds));
      dut().set(dut().port("error_i"), error);
      dut().set(dut().port("count_i"), queue);
      dut().settle();

      // what must become of the word
      LineMask rows = 0;
      for (std::uint32_t row = 0; row < kMaxRows; ++row) {
        rows |= (word.rows >> row & 1U) != 0 && word.z < row_bounds[row] ? 1U << row : 0;
      }
      const bool known = word.points[0].known && word.points[1].known && word.points[2].known;
      const bool room = queue + kStages < kQueueWords;
      bool take = edge == 2;
      bool begin = false;
      if (offered && room && edge == 0) {
        take = word.last || !known || rows == 0;
        begin = !take;
      }
      errors[edge] = error;
      expect_port(dut().port("ready_o"), take ? 1 : 0, "ready_o");
      EXPECT_EQ(model.ready(offered, word, row_bounds, queue), take);
      expect_port(dut().port("pair_bank_o"), word.bank, "pair_bank_o");
      seen.clocks += offered ? 1 : 0;
      seen.idle += offered && room && !take && !begin && edge == 0 ? 1 : 0;
      if (take) {
        seen.needed += edge == 2 ? 3 : 1;
        if (edge == 2 || word.last || rows != 0) {
          CutTriangle cut{word.last, word.bank, word.triangle, word.z, rows, word.columns, !known, {}};
          for (std::size_t k = 0; k < 3; ++k) {
            cut.cuts[k] = edge_cut(word.points[k], word.points[(k + 1) % 3], errors[k]);
          }
          expected.push_back({dut().cycles() + kStages, cut, word.points, errors});
        }
        ++next;
        offered = false;
        edge = 0;
      } else if (begin || edge != 0) {
        ++edge;
      }

      const bool write = !expected.empty() && expected.front().clock == dut().cycles();
      expect_port(dut().port("valid_o"), write ? 1 : 0, "valid_o");
      EXPECT_EQ(model.valid(), write);
      if (write) {
        check_word(expected.front());
        const CutTriangle& due = expected.front().word;
        EXPECT_EQ(counting(model.word().pack(), due.last, due.whole),
                  counting(due.pack(), due.last, due.whole));
        expected.pop_front();
        EXPECT_LT(queue, kQueueWords) << "overflow";
      }
      // `offered` is that of the next clock already: a word was there if it still is, or was taken
      model.clock(offered || take, word, row_bounds, error, queue);
      dut().clock();
      if (queue != 0 && clock >= hold && random_() % 100 < take_percent) {
        --queue;
      }
      queue += write ? 1 : 0;
      seen.fullest = std::max(seen.fullest, queue);
    }
    EXPECT_EQ(seen.idle, 0);
    return seen;
  }

 private:
  std::mt19937 random_{83};
  int index_ = 0;
};

TEST_F(EdgeSetupBench, TakesATriangleInThreeClocks) {
  const Seen seen = run(Kind::edges, 100, 100, true);
  EXPECT_EQ(seen.needed, 3 * static_cast<int>(kTriangles));
  EXPECT_EQ(seen.clocks, seen.needed);
}
TEST_F(EdgeSetupBench, TakesAnyOtherWordInOneClock) {
  const Seen seen = run(Kind::all, 100, 100, true);
  EXPECT_EQ(seen.clocks, seen.needed);
}
TEST_F(EdgeSetupBench, KnowsEveryReciprocal) {
  static_assert(kTriangles > 1 << kDepthFractionBits);
  run(Kind::reciprocals, 100, 100, true);
}
TEST_F(EdgeSetupBench, DropsTrianglesThatCannotMatter) {
  const Seen seen = run(Kind::all, 100, 100, false);
  EXPECT_EQ(seen.clocks, seen.needed);
}
TEST_F(EdgeSetupBench, NeitherLosesNorRepeatsUnderStalls) {
  run(Kind::all, 60, 30, false);
  run(Kind::all, 15, 70, false);
}
TEST_F(EdgeSetupBench, FillsTheQueueAndNeverOverflowsIt) {
  EXPECT_EQ(run(Kind::whole, 100, 20, true, 60).fullest, kQueueWords);
  EXPECT_LE(run(Kind::edges, 100, 20, true, 200).fullest, kQueueWords);
}
TEST_F(EdgeSetupBench, ForgetsItsWordsWhenReset) {
  for (int clocks = 1; clocks < 40; ++clocks) {
    run(Kind::edges, 100, 100, true, 0, clocks);
    dut().set(dut().port("rst_i"), 1);
    dut().clock();
    dut().set(dut().port("rst_i"), 0);
    dut().set(dut().port("valid_i"), 0);
    dut().set(dut().port("count_i"), 0);
    for (std::size_t k = 0; k < 2 * kStages; ++k) {
      dut().settle();
      expect_port(dut().port("ready_o"), 0, "ready_o");
      expect_port(dut().port("valid_o"), 0, "valid_o");
      dut().clock();
    }
  }
  run(Kind::all, 60, 60, false);
}

}  // namespace
}  // namespace raplas
