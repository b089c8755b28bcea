// tree_walk by the clock: nearest siblings first, rows and their bounds, the whole stack, any surroundings.
#include <deque>

#include "unit/tree_walk/fixture.hpp"

namespace raplas {
namespace {

class TreeWalkOrder : public TreeWalkBench {
 protected:
  /// Pushes ranges of these depths while the root range goes on; ranges of one object, first = index.
  void push_siblings(const std::vector<std::uint32_t>& depths, std::size_t last) {
    for (std::size_t k = 0; k < depths.size(); ++k) {
      Inputs in;
      in.decision = {
          true, k == last, true, {false, 1, static_cast<std::uint32_t>(0x100 + k), kAllRows, 1, depths[k]}};
      clock(in);
    }
  }

  /// A root range under way, long enough for the pushes.
  void begin() {
    reset();
    Inputs in;
    in.start = true;
    in.root = {false, kWidest, 0, kAllRows, kAllRows, 0};
    clock(in);
    for (int k = 0; k < 14; ++k) {
      clock({});
    }
  }

  /// Numbers of the pushed ranges, in the order in which they are requested.
  std::vector<std::size_t> order(std::size_t ranges) {
    std::vector<std::size_t> seen;
    int under_test = model_.under_test();
    for (int k = 0; k < 600 && seen.size() < ranges; ++k) {
      Inputs in;
      in.decision.decided = under_test > 0;
      in.decision.last_sibling = true;
      const WalkRequest request = clock(in);
      under_test = model_.under_test();
      if (request.valid && request.columns == 1) {
        seen.push_back(request.address - 0x100);
      }
    }
    return seen;
  }
};

TEST_F(TreeWalkOrder, NearestOfFourSiblingsFirstInAnyOrderOfPushes) {
  std::vector<std::vector<std::uint32_t>> lists{
      {5, 5, 5, 5}, {7, 5, 7, 5}, {5, 7, 5, 7}, {0, 0, 1, 0}, {9, 9, 3, 3}};
  for (std::vector<std::uint32_t> depths{10, 20, 30, 40};
       lists.size() == 5 || depths.front() != 10 || !std::is_sorted(depths.begin(), depths.end());
       std::next_permutation(depths.begin(), depths.end())) {
    lists.push_back(depths);
  }
  for (int bit = 0; bit < kDepthBits; ++bit) {  // every bit of a depth counts
    lists.push_back({1U << bit, 0, (1U << bit) - 1, (1U << bit)});
    lists.push_back({0x2aaa, 0x2aaaU ^ (1U << bit), 0x2aaa, 0x2aaaU ^ (1U << bit)});
  }
  for (const auto& depths : lists) {
    std::vector<std::size_t> expected{0, 1, 2, 3};
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::size_t a, std::size_t b) { return depths[a] < depths[b]; });
    begin();
    push_siblings(depths, 3);
    EXPECT_EQ(order(4), expected);
  }
}

TEST_F(TreeWalkOrder, SiblingsOfTheNextRangeComeFirst) {
  begin();
  push_siblings({10, 20}, 1);
  push_siblings({30, 15}, 9);  // farther, but deeper in the tree
  const std::vector<std::size_t> expected{1, 0, 0, 1};
  EXPECT_EQ(order(4), expected);
}

TEST_F(TreeWalkOrder, AmongMoreThanFourTheUpperThreeAreSorted) {
  begin();
  push_siblings({10, 20, 30, 40, 5, 35, 50}, 6);
  // from the top: 10 20 30 40, then 5 10 20 30 40, then 5 10 20 35 30 40, then 5 10 20 50 35 30 40
  const std::vector<std::size_t> expected{4, 0, 1, 6, 5, 2, 3};
  EXPECT_EQ(order(7), expected);
}

// --- every bit of every input

TEST_F(TreeWalkBench, ARowMattersIfAndOnlyIfTheDepthIsBelowItsBound) {
  constexpr int kRows = kMaxRows;
  for (int row = 0; row < kRows; ++row) {
    for (int bit = 0; bit < kDepthBits; ++bit) {
      for (int more = -1; more <= 1; ++more) {
        const std::uint32_t z = 1U << bit;
        reset();
        Inputs in;
        in.start = true;
        in.root = {false, 1, 0, kAllRows, kAllRows, 0};
        clock(in);
        clock({});
        Inputs push;
        push.decision = {true, true, true, {false, 1, 0x55555, 1U << row, 0x1234, z}};
        clock(push);
        Inputs compare;  // other rows' bounds would let it live
        compare.bounds[static_cast<std::size_t>(row)] =
            static_cast<std::uint32_t>(static_cast<int>(z) + more);
        clock(compare);
        const bool live = more > 0;
        expect_port(dut().port("request_o"), number(live), "request_o");
        expect_port(dut().port("idle_o"), number(!live), "idle_o");
        if (live) {
          expect_port(dut().port("rows_o"), std::uint64_t{1} << row, "rows_o");
        }
      }
    }
  }
}

TEST_F(TreeWalkBench, UsesTheWholeStack) {
  std::mt19937 random(76);
  for (int run = 0; run < 2; ++run) {
    reset();
    int pushed = 0;
    for (int k = 0; k == 0 || !model_.idle(); ++k) {
      ASSERT_LT(k, 20'000) << "does not end";
      Inputs in;
      in.start = k == 0;
      in.root = {false, kWidest, 0x3ff80, kAllRows, kAllRows, 0};
      in.decision.decided = model_.under_test() >= kMostUnderTest - 1 ||
                            (model_.under_test() > (k > 300 ? 0 : 2) && (k > 400 || random() % 8 != 0));
      in.decision.push = in.decision.decided && pushed < 400 && model_.level() < kStackDepth;
      in.decision.last_sibling = random() % 4 == 0;
      in.decision.range = {random() % 2 == 0,
                           static_cast<std::uint32_t>(pushed < 50 ? kWidest : 1 + random() % 3),
                           static_cast<std::uint32_t>(random() & (kAddresses - 1)),
                           static_cast<std::uint32_t>(1 + random() % kAllRows),
                           static_cast<std::uint32_t>(random() & kAllRows),
                           static_cast<std::uint32_t>(random() % (kDepths - 1))};
      pushed += in.decision.push ? 1 : 0;
      clock(in);
      ASSERT_FALSE(HasFatalFailure());
    }
  }
  EXPECT_EQ(highest_, kStackDepth);
}

TEST_F(TreeWalkBench, IsAsItsModelInAnySurroundings) {
  std::mt19937 random(77);
  const auto percent = [&](unsigned share) { return random() % 100 < share; };
  for (int run = 0; run < 60; ++run) {
    reset();
    const unsigned decide = 20 + static_cast<unsigned>(random() % 80);
    const unsigned push = static_cast<unsigned>(random() % 100);
    const unsigned near = static_cast<unsigned>(random() % 3);
    for (int k = 0; k < 600; ++k) {
      Inputs in;
      in.start = model_.idle() && percent(70);
      const auto draw = [&](std::uint32_t mask) { return static_cast<std::uint32_t>(random()) & mask; };
      in.root = {
          false, 1 + draw(63) % (percent(90) ? 8 : 64), draw(kAddresses - 1), draw(kAllRows), draw(kAllRows),
          0};
      in.triangles = percent(50) ? 0 : static_cast<int>(random() % (kTriangleRoom + 1));
      in.decision.decided =
          model_.under_test() > 0 && (percent(decide) || model_.under_test() >= kMostUnderTest - 1);
      in.decision.push = in.decision.decided && percent(push) && model_.level() < kStackDepth;
      in.decision.last_sibling = percent(30);  // by itself it means nothing
      const std::uint32_t z = near == 0 ? draw(3) : (percent(50) ? draw(kDepths - 1) : 0x3ff8 + draw(15));
      in.decision.range = {percent(40), 1 + draw(3), draw(kAddresses - 1), draw(kAllRows), draw(kAllRows), z};
      if (model_.level() != 0) {  // bounds about the depth of the top
        const std::uint32_t depth = model_.top().z;
        for (std::uint32_t& bound : in.bounds) {
          const std::uint32_t other = percent(50) ? depth ^ (1U << random() % kDepthBits) : depth + draw(1);
          bound = (percent(80) ? other : draw(kDepths - 1)) & (kDepths - 1);
        }
      }
      clock(in);
      ASSERT_FALSE(HasFatalFailure());
    }
  }
}

}  // namespace
}  // namespace raplas
