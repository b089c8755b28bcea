// selector: the pairs of each leaf, each once and in order, and no clock without a pair while leaves wait.
#include <random>

#include "raplas/selector.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kLeaves = 600;
const PortStage kStages[]{{"valid_o", 1}, {"ray_o", 1}, {"triangle_o", 1}, {"ready_o", 0}};

std::vector<Pair> pairs_of(const Leaf& leaf) {
  std::vector<Pair> pairs;
  for (std::uint32_t k = 0; k < leaf.count; ++k) {
    for (std::uint32_t row = 0; row < kMaxRows; ++row) {
      for (std::uint32_t column = 0; column < kMaxColumns; ++column) {
        if (((leaf.row_mask >> row) & (leaf.column_mask >> column) & 1U) != 0) {
          pairs.push_back({row * kMaxColumns + column, leaf.first + k});
        }
      }
    }
  }
  return pairs;
}

class SelectorBench : public testing::Test {
 protected:
  static std::vector<Leaf> leaves() {
    std::mt19937 random(61);
    const auto mask = [&random] {
      const auto bits = static_cast<std::uint32_t>(random() & random() & 0xffff);
      return bits == 0 ? 1U << (random() % 16) : bits;
    };
    std::vector<Leaf> list{
        {5, 1, 1, 1}, {6, 1, 0x8000, 0x8000}, {7, 3, 0xffff, 0xffff}, {0, 1, 1, 0x8000}, {9, 127, 2, 4}};
    while (list.size() < kLeaves) {
      list.push_back({static_cast<std::uint32_t>(random() & 0xfff00),
                      static_cast<std::uint32_t>(1 + random() % 5), mask(), mask()});
    }
    return list;
  }

  /// Feeds all leaves and checks every clock; gives the clocks in which no pair was offered though leaves
  /// were.
  int run(unsigned leaf_percent, unsigned take_percent) {
    std::mt19937 random(62);
    reset_dut();
    Selector model;
    const std::vector<Leaf> list = leaves();
    std::vector<Pair> expected;
    for (const Leaf& leaf : list) {
      const auto pairs = pairs_of(leaf);
      expected.insert(expected.end(), pairs.begin(), pairs.end());
    }
    std::size_t next_leaf = 0;
    std::size_t next_pair = 0;
    bool offered = false;
    int bubbles = 0;
    while (next_pair < expected.size() && !HasFailure()) {
      offered = next_leaf < list.size() && (offered || random() % 100 < leaf_percent);
      const bool take = random() % 100 < take_percent;
      const Leaf leaf = offered ? list[next_leaf] : Leaf{};
      dut().set(dut().port("valid_i"), offered ? 1 : 0);
      dut().set(dut().port("first_i"), leaf.first);
      dut().set(dut().port("count_i"), leaf.count);
      dut().set(dut().port("row_mask_i"), leaf.row_mask);
      dut().set(dut().port("column_mask_i"), leaf.column_mask);
      dut().set(dut().port("ready_i"), take ? 1 : 0);
      dut().settle();
      expect_port(dut().port("ready_o"), model.ready(take) ? 1 : 0, "ready_o");
      expect_port(dut().port("valid_o"), model.valid() ? 1 : 0, "valid_o");
      if (dut().get(dut().port("valid_o")) != 0) {
        expect_port(dut().port("ray_o"), expected[next_pair].ray, "ray_o");
        expect_port(dut().port("triangle_o"), expected[next_pair].triangle, "triangle_o");
        next_pair += take ? 1 : 0;
      } else {
        bubbles += next_pair != 0 ? 1 : 0;
      }
      const bool leaf_taken = offered && dut().get(dut().port("ready_o")) != 0;
      dut().clock();
      model.clock(offered, leaf, take);
      if (leaf_taken) {
        ++next_leaf;
        offered = false;
      }
    }
    EXPECT_EQ(next_leaf, list.size());
    dut().set(dut().port("valid_i"), 0);
    dut().set(dut().port("ready_i"), 1);
    for (int k = 0; k < 4; ++k) {  // nothing more comes out
      dut().settle();
      expect_port(dut().port("valid_o"), 0, "valid_o");
      dut().clock();
    }
    return bubbles;
  }
};

TEST_F(SelectorBench, GivesAPairEveryClockWithoutBubbles) { EXPECT_EQ(run(100, 100), 0); }
TEST_F(SelectorBench, NeitherLosesNorRepeatsUnderStalls) { EXPECT_EQ(run(100, 40), 0); }
TEST_F(SelectorBench, NeitherLosesNorRepeatsWhenLeavesAreRare) { run(5, 100); }
TEST_F(SelectorBench, ForgetsItsLeafWhenReset) {
  for (int clocks = 0; clocks < 20; ++clocks) {
    reset_dut();
    dut().set(dut().port("valid_i"), 1);
    dut().set(dut().port("first_i"), 5);
    dut().set(dut().port("count_i"), 3);
    dut().set(dut().port("row_mask_i"), 0xffff);
    dut().set(dut().port("column_mask_i"), 0xffff);
    dut().set(dut().port("ready_i"), 1);
    for (int k = 0; k < clocks; ++k) {
      dut().clock();
      expect_port(dut().port("valid_o"), 1, "valid_o");
    }
    dut().set(dut().port("rst_i"), 1);  // with a leaf at hand: it must not be taken either
    dut().clock();
    expect_port(dut().port("valid_o"), 0, "valid_o");
  }
  run(30, 70);
}
TEST_F(SelectorBench, NeitherLosesNorRepeatsUnderAnyPattern) { run(30, 70); }

}  // namespace
}  // namespace raplas
