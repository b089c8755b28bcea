// tree_walk clock by clock as its model; and by rules stated here: each object once unless its rows' bounds
// were reached, nearest siblings first, stack and triangle queue within their bounds.
#include <algorithm>
#include <deque>
#include <map>
#include <random>
#include <vector>

#include "raplas/tree_walk.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const PortStage kStages[]{{"request_o", 0}, {"vertex_o", 0},  {"address_o", 0},
                          {"rows_o", 0},    {"columns_o", 0}, {"last_o", 0}};

constexpr std::uint32_t kAddresses = 1U << kIdBits;
constexpr std::uint32_t kDepths = 1U << kDepthBits;
constexpr std::uint32_t kAllRows = (1U << kMaxRows) - 1;
constexpr std::uint32_t kWidest = (1U << kCountBits) - 1;
constexpr int kTriangleRoom = 1 << kTriangleFifoDepthLog2;
constexpr int kMostUnderTest = 32;  // that the environment may have

LineBounds all_bounds(std::uint32_t bound) {
  LineBounds bounds{};
  bounds.fill(bound);
  return bounds;
}

class TreeWalkBench : public testing::Test {
 protected:
  /// What goes in, in one clock.
  struct Inputs {
    bool start = false;
    WalkRange root{};
    LineBounds bounds = all_bounds(kDepths - 1);
    WalkDecision decision{};
    int triangles = 0;
  };

  void reset() {
    reset_dut();
    model_ = {};
  }

  static std::uint64_t number(bool bit) { return bit ? 1 : 0; }

  /// One clock of the unit and of its model; gives the request that both showed.
  WalkRequest clock(const Inputs& in) {
    dut().set(start_, number(in.start));
    dut().set(root_first_, in.root.first);
    dut().set(root_count_, in.root.count);
    dut().set(rows_, in.root.rows);
    dut().set(columns_, in.root.columns);
    dut().set(row_bounds_, pack(in.bounds));
    dut().set(push_, number(in.decision.push));
    dut().set(push_range_, in.decision.range.pack());
    dut().set(decided_, number(in.decision.decided));
    dut().set(last_sibling_, number(in.decision.last_sibling));
    dut().set(triangles_, static_cast<std::uint64_t>(in.triangles));
    dut().settle();
    const WalkRequest request = model_.request(in.triangles);
    expect_port(request_o_, number(request.valid), "request_o");
    expect_port(idle_o_, number(model_.idle()), "idle_o");
    expect_port(stack_level_o_, static_cast<std::uint64_t>(model_.level()), "stack_level_o");
    if (request.valid) {
      expect_port(vertex_o_, number(request.vertex), "vertex_o");
      expect_port(address_o_, request.address, "address_o");
      expect_port(rows_o_, request.rows, "rows_o");
      expect_port(columns_o_, request.columns, "columns_o");
      expect_port(last_o_, number(request.last), "last_o");
    }
    highest_ = std::max(highest_, model_.level());
    dut().clock();
    model_.clock(in.start, in.root, request, in.bounds, in.decision);
    return request;
  }

  TreeWalk model_;
  int highest_ = 0;

 private:
  PortId start_ = dut().port("start_i");
  PortId root_first_ = dut().port("root_first_i");
  PortId root_count_ = dut().port("root_count_i");
  PortId rows_ = dut().port("rows_i");
  PortId columns_ = dut().port("columns_i");
  PortId row_bounds_ = dut().port("row_bounds_i");
  PortId push_ = dut().port("push_i");
  PortId push_range_ = dut().port("push_range_i");
  PortId decided_ = dut().port("decided_i");
  PortId last_sibling_ = dut().port("last_sibling_i");
  PortId triangles_ = dut().port("triangles_i");
  PortId request_o_ = dut().port("request_o");
  PortId vertex_o_ = dut().port("vertex_o");
  PortId address_o_ = dut().port("address_o");
  PortId rows_o_ = dut().port("rows_o");
  PortId columns_o_ = dut().port("columns_o");
  PortId last_o_ = dut().port("last_o");
  PortId stack_level_o_ = dut().port("stack_level_o");
  PortId idle_o_ = dut().port("idle_o");
};

// --- whole walks

/// A range of a tree: which of its objects have a range below, and which.
struct TreeRange {
  WalkRange range;
  std::map<std::uint32_t, std::size_t> below;  ///< object -> index of its range
};

/// How the surroundings behave.
struct Surroundings {
  int latency = 16;             ///< of the testers
  unsigned take_percent = 100;  ///< likelihood that a triangle leaves its queue in a clock
  unsigned fall_percent = 0;    ///< that a row's bound falls
  int stop_after = 0;           ///< clocks; 0: at the end
};

/// A tree of spheres down to leaves, with depths and rows that shrink downwards. Index 0 is the root.
std::vector<TreeRange> random_tree(std::mt19937& random, std::uint32_t root, std::uint32_t width, int depth,
                                   unsigned inner_percent, std::uint32_t base) {
  std::vector<TreeRange> ranges{{{false, root, base, kAllRows, kAllRows, 0}, {}}};
  std::uint32_t spheres = base + root;
  std::uint32_t vertices = static_cast<std::uint32_t>(random()) & (kAddresses / 2 - 1);
  std::size_t begin = 0;
  for (int level = 0; level < depth; ++level) {
    const std::size_t end = ranges.size();
    for (std::size_t k = begin; k < end && ranges.size() < 400; ++k) {
      for (std::uint32_t object = 0; object < ranges[k].range.count && !ranges[k].range.leaf; ++object) {
        const bool leaf = level + 1 == depth || random() % 100 >= inner_percent;
        const auto count = static_cast<std::uint32_t>(1 + random() % width);
        const WalkRange& above = ranges[k].range;
        const std::uint32_t rows = above.rows & static_cast<std::uint32_t>(random());
        if (random() % 8 == 0 || rows == 0) {
          continue;  // the sphere is not met
        }
        const WalkRange range{leaf,
                              count,
                              (leaf ? vertices : spheres) & (kAddresses - 1),
                              rows,
                              above.columns & static_cast<std::uint32_t>(random()),
                              above.z + static_cast<std::uint32_t>(random() % 3000)};
        (leaf ? vertices : spheres) += count;
        ranges[k].below[object] = ranges.size();
        ranges.push_back({range, {}});
      }
    }
    begin = end;
  }
  return ranges;
}

class TreeWalkTrees : public TreeWalkBench {
 protected:
  /// Walks the tree; afterwards each range was requested as a whole, once, in order, or not at all because
  /// its depth is not below the bounds of its rows.
  void walk(const std::vector<TreeRange>& ranges, const Surroundings& around) {
    struct Object {
      bool valid = false;
      bool vertex = false;
      bool last = false;
      std::size_t range = 0;
      std::uint32_t number = 0;
    };
    std::mt19937 random(72);
    reset();
    std::map<std::pair<bool, std::uint32_t>, std::size_t> range_at;  // (leaf, first address) -> index
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      range_at[{ranges[k].range.leaf, ranges[k].range.first}] = k;
    }
    std::vector<std::uint32_t> requested(ranges.size());
    std::vector<std::uint32_t> masks(ranges.size());
    std::vector<bool> given(ranges.size());
    std::deque<Object> testers(static_cast<std::size_t>(around.latency));
    LineBounds bounds = all_bounds(kDepths - 1);
    std::size_t current = 0;
    int triangles = 0;
    given[0] = true;
    for (int k = 0; k < 2 || !model_.idle(); ++k) {
      ASSERT_LT(k, 200'000) << "does not end";
      if (around.stop_after != 0 && k == around.stop_after) {
        return;
      }
      Inputs in;
      in.start = k == 0;
      in.root = ranges[0].range;
      const Object leaving = testers.front();
      testers.pop_front();
      in.decision.decided = leaving.valid;
      in.decision.last_sibling = leaving.last;
      if (leaving.valid && !leaving.vertex) {
        const auto below = ranges[leaving.range].below.find(leaving.number);
        if (below != ranges[leaving.range].below.end()) {
          in.decision.push = true;
          in.decision.range = ranges[below->second].range;
          given[below->second] = true;
        }
      }
      for (std::uint32_t& bound : bounds) {
        if (random() % 1000 < around.fall_percent) {
          bound -= std::min<std::uint32_t>(bound, static_cast<std::uint32_t>(random() % 4000));
        }
      }
      in.bounds = bounds;
      in.triangles = triangles;
      const WalkRequest request = clock(in);
      ASSERT_FALSE(HasFatalFailure());
      Object started{request.valid, request.vertex, request.last, 0, 0};
      if (request.valid) {
        const auto begins = range_at.find({request.vertex, request.address});
        if (begins != range_at.end() && requested[current] == (k == 1 ? 0 : ranges[current].range.count)) {
          current = begins->second;
          masks[current] = request.rows;
        }
        const WalkRange& range = ranges[current].range;
        ASSERT_TRUE(given[current]) << "a range that was never pushed";
        ASSERT_EQ(request.vertex, range.leaf);
        ASSERT_EQ(request.address, (range.first + requested[current]) & (kAddresses - 1));
        ASSERT_EQ(request.last, requested[current] + 1 == range.count);
        ASSERT_EQ(request.rows, masks[current]) << "the mask changes within a range";
        ASSERT_EQ(request.columns, range.columns);
        started.range = current;
        started.number = requested[current]++;
      }
      testers.push_back(started);
      const bool triangle = leaving.valid && leaving.vertex && random() % 3 != 0;
      triangles += (triangle ? 1 : 0) - (triangles > 0 && random() % 100 < around.take_percent ? 1 : 0);
      ASSERT_LE(triangles, kTriangleRoom);
      ASSERT_LE(model_.level(), kStackDepth);
    }
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const WalkRange& range = ranges[k].range;
      ASSERT_TRUE(requested[k] == 0 || requested[k] == range.count) << "a part of a range";
      ASSERT_TRUE(given[k] || requested[k] == 0);
      ASSERT_EQ(masks[k] & ~range.rows, 0U);
      ASSERT_TRUE(requested[k] == 0 || masks[k] != 0);
      for (std::size_t row = 0; row < kMaxRows && given[k]; ++row) {
        const bool left_out = ((range.rows & ~masks[k]) >> row & 1U) != 0;
        ASSERT_TRUE(!left_out || range.z >= bounds[row]) << "row " << row << " matters";
      }
    }
    count_checked(ranges.size());
  }
};

TEST_F(TreeWalkTrees, WalksRandomTrees) {
  std::mt19937 random(71);
  for (unsigned tree = 0; tree < 24; ++tree) {
    const auto root = static_cast<std::uint32_t>(1 + random() % 8);
    const auto width = static_cast<std::uint32_t>(1 + random() % 8);
    const std::uint32_t base = static_cast<std::uint32_t>(random()) & (kAddresses - 1);
    walk(random_tree(random, root, width, 6, 70, base),
         {static_cast<int>(1 + random() % 17), tree % 2 == 0 ? 100U : 20U, tree % 3 * 20, 0});
  }
}

TEST_F(TreeWalkTrees, WalksRangesOfUpTo127Objects) {
  std::mt19937 random(73);
  for (const std::uint32_t root : {1U, 2U, 64U, 126U, 127U}) {
    std::vector<TreeRange> ranges{{{false, root, kAddresses - root, kAllRows, kAllRows, 0}, {}}};
    for (const std::uint32_t object : {0U, 1U, 40U, 126U}) {
      if (object < root) {
        ranges[0].below[object] = ranges.size();
        ranges.push_back(
            {{true, kWidest - object % 5, 1000 * (object + 1), 1U << object % 16, 0x8001, 5}, {}});
      }
    }
    walk(ranges, {});
    walk(ranges, {16, 10, 0, 0});
  }
}

TEST_F(TreeWalkTrees, KeepsRoomForTriangles) {
  std::vector<TreeRange> ranges{{{false, 4, 0, kAllRows, kAllRows, 0}, {}}};
  for (std::uint32_t object = 0; object < 4; ++object) {
    ranges[0].below[object] = ranges.size();
    ranges.push_back({{true, kWidest, 200 * object, kAllRows, kAllRows, 9 - object}, {}});
  }
  for (const int latency : {1, 8, 16, 31, 40}) {
    for (const unsigned percent : {100U, 30U, 3U}) {
      walk(ranges, {latency, percent, 0, 0});
    }
  }
}

TEST_F(TreeWalkTrees, StaysWithinTheStackOnTheDeepestTreeThatIsAllowed) {
  // a path's sum of (inner children - 1) <= kStackDepth - kStackWatermark - kMostUnderTest = 48
  constexpr std::uint32_t kWidth = 17;  // 3 * (17 - 1) = 48
  static_assert(kStackDepth - kStackWatermark - kMostUnderTest == 3 * (kWidth - 1));
  std::mt19937 random(74);
  std::vector<TreeRange> ranges{{{false, kWidth, 0, kAllRows, kAllRows, 0}, {}}};
  std::uint32_t next = kWidth;
  std::size_t begin = 0;
  for (int level = 0; level < 3; ++level) {
    const std::size_t end = ranges.size();
    for (std::size_t k = begin; k < end; ++k) {
      for (std::uint32_t object = 0; object < kWidth; ++object) {
        const bool leaf = level == 2;
        ranges[k].below[object] = ranges.size();
        ranges.push_back({{leaf, leaf ? 1 : kWidth, next, kAllRows, kAllRows,
                           static_cast<std::uint32_t>(random() % kDepths) / 2},
                          {}});
        next += leaf ? 1 : kWidth;
      }
    }
    begin = end;
  }
  for (const int latency : {16, 31}) {
    walk(ranges, {latency, 100, 0, 0});
  }
  EXPECT_GT(highest_, kStackWatermark) << "the test does not reach the watermark";
}

TEST_F(TreeWalkTrees, StartsAfreshAfterAResetInTheMiddle) {
  std::mt19937 random(75);
  const auto ranges = random_tree(random, 6, 6, 5, 80, 0x12345);
  const std::vector<TreeRange> few{{{false, 2, 77, 0x21, 0x84, 0}, {}}};
  for (int clocks = 2; clocks < 100; clocks += 7) {
    walk(ranges, {16, 10, 0, clocks});
    walk(few, {});
  }
}

// --- the order of siblings

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
