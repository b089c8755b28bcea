// traversal on random trees: clock by clock as its model, every sphere whose ancestors are met exactly once,
// and the stack within its bound.
#include <algorithm>
#include <random>

#include "raplas/traversal.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

const PortStage kStages[]{{"request_o", 0}, {"address_o", 0}, {"set_o", 0}, {"first_o", 0}, {"last_o", 0}};

constexpr std::uint32_t kFirst = 0x81234;  // address of the root range
constexpr std::uint32_t kAddresses = 1U << kIdBits;

struct Node {
  bool inner = false;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// A tree whose root range has `width` nodes; nodes are inner down to `depth` with `percent` likelihood.
std::vector<Node> random_tree(std::mt19937& random, std::uint32_t root, std::uint32_t width, int depth,
                              unsigned percent) {
  std::vector<Node> nodes(root);
  std::vector<std::pair<std::size_t, std::size_t>> levels{{0, root}};
  for (int level = 0; level < depth; ++level) {
    const auto [begin, end] = levels.back();
    for (std::size_t k = begin; k < end && nodes.size() < 3000; ++k) {
      if (random() % 100 < percent) {
        const auto count = static_cast<std::uint32_t>(1 + random() % width);
        nodes[k] = {true, static_cast<std::uint32_t>(nodes.size()), count};
        nodes.resize(nodes.size() + count);
      }
    }
    levels.emplace_back(end, nodes.size());
  }
  return nodes;
}

class TraversalBench : public testing::Test {
 protected:
  /// One plane set, an empty leaf queue, and testers that decide nothing.
  static void clear_inputs() {
    for (const char* name : {"start_i", "root_first_i", "root_count_i", "last_set_i", "push_i",
                             "push_first_i", "push_count_i", "decided_i", "leaves_i"}) {
      dut().set(dut().port(name), 0);
    }
  }

  /// Walks the tree with testers of `latency` clocks; leaves pile up as the selector takes `take_percent`.
  void walk(const std::vector<Node>& nodes, std::uint32_t root, int last_set, int latency,
            unsigned take_percent, std::uint32_t base = kFirst, int stop_after = 0) {
    std::mt19937 random(82);
    reset_dut();
    Traversal model;
    std::deque<SphereRequest> testers(static_cast<std::size_t>(latency));
    std::vector<int> seen(nodes.size());
    int leaves = 0;
    dut().set(dut().port("root_first_i"), base);
    dut().set(dut().port("root_count_i"), root);
    dut().set(dut().port("last_set_i"), static_cast<std::uint64_t>(last_set));
    for (int k = 0; k == 0 || k == 1 || !model.idle(); ++k) {
      ASSERT_LT(k, 2'000'000) << "does not end";
      if (stop_after != 0 && k == stop_after) {
        return;
      }
      const SphereRequest leaving = testers.front();
      testers.pop_front();
      const bool decided = leaving.valid && leaving.last_set;
      const Node node = decided ? nodes[leaving.address - base] : Node{};
      dut().set(dut().port("start_i"), k == 0 ? 1 : 0);
      dut().set(dut().port("decided_i"), decided ? 1 : 0);
      dut().set(dut().port("push_i"), node.inner ? 1 : 0);
      const SphereRange children{node.first + base, node.count};
      dut().set(dut().port("push_first_i"), children.first);
      dut().set(dut().port("push_count_i"), node.count);
      dut().set(dut().port("leaves_i"), static_cast<std::uint64_t>(leaves));
      dut().settle();
      const SphereRequest request = model.request(last_set, leaves);
      ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("request_o"), request.valid ? 1 : 0, "request_o"));
      ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("idle_o"), model.idle() ? 1 : 0, "idle_o"));
      ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("stack_level_o"),
                                          static_cast<std::uint64_t>(model.level()), "stack_level_o"));
      ASSERT_LE(model.level(), kStackDepth);
      highest_ = std::max(highest_, model.level());
      if (request.valid) {
        ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("address_o"), request.address, "address_o"));
        ASSERT_NO_FATAL_FAILURE(
            expect_port(dut().port("set_o"), static_cast<std::uint64_t>(request.set), "set_o"));
        ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("first_o"), request.first_set ? 1 : 0, "first_o"));
        ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("last_o"), request.last_set ? 1 : 0, "last_o"));
        seen[request.address - base] += request.last_set ? 1 : 0;
      }
      testers.push_back(request);
      dut().clock();
      model.clock(k == 0, {base, root}, request, node.inner, children, decided);
      const bool leaf = decided && !node.inner && random() % 2 == 0;
      leaves += (leaf ? 1 : 0) - (leaves > 0 && random() % 100 < take_percent ? 1 : 0);
      ASSERT_LE(leaves, kLeafFifoDepth);
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(nodes.size()));
    count_checked(nodes.size());
  }

  int highest_ = 0;
};

TEST_F(TraversalBench, GivesAFlatListASphereEachClock) { walk(std::vector<Node>(500), 500, 0, 15, 100); }
TEST_F(TraversalBench, GivesAFlatListSetBySet) { walk(std::vector<Node>(100), 100, 3, 15, 100); }
TEST_F(TraversalBench, GivesAFlatListInSixteenSets) { walk(std::vector<Node>(40), 40, 15, 15, 100); }
TEST_F(TraversalBench, EndsAtOnceWithoutSpheres) { walk({}, 0, 0, 15, 100); }
TEST_F(TraversalBench, WaitsForRoomInTheLeafQueue) { walk(std::vector<Node>(500), 500, 0, 15, 3); }

TEST_F(TraversalBench, CountsSpheresUnderTestAndLeavesTogether) {
  walk(std::vector<Node>(400), 400, 0, 60, 100);  // slow testers: the queue's depth is under test
  walk(std::vector<Node>(400), 400, 0, 40, 10);
  walk(std::vector<Node>(400), 400, 0, 25, 30);
  walk(std::vector<Node>(200), 200, 3, 15, 3);  // the other sets of a sphere need no room
}

TEST_F(TraversalBench, UsesTheWholeStack) {
  std::mt19937 random(85);
  reset_dut();
  Traversal model;
  int under_test = 0;
  int pushed = 0;
  for (int k = 0; k == 0 || !model.idle(); ++k) {  // each of the first spheres has children
    ASSERT_LT(k, 100'000) << "does not end";
    const bool start = k == 0;
    const SphereRequest request = model.request(0, 0);
    const bool decide = under_test > 0 && random() % 4 != 0;
    under_test += (request.valid ? 1 : 0) - (decide ? 1 : 0);
    const bool push = decide && pushed < kStackDepth;
    pushed += push ? 1 : 0;
    const SphereRange root{0x12345, 200};
    const SphereRange children{static_cast<std::uint32_t>(random() & (kAddresses - 1)),
                               static_cast<std::uint32_t>(1 + random() % 127)};
    dut().set(dut().port("start_i"), start ? 1 : 0);
    dut().set(dut().port("root_first_i"), root.first);
    dut().set(dut().port("root_count_i"), root.count);
    dut().set(dut().port("last_set_i"), 0);
    dut().set(dut().port("leaves_i"), 0);
    dut().set(dut().port("decided_i"), decide ? 1 : 0);
    dut().set(dut().port("push_i"), push ? 1 : 0);
    dut().set(dut().port("push_first_i"), children.first);
    dut().set(dut().port("push_count_i"), children.count);
    dut().settle();
    ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("request_o"), request.valid ? 1 : 0, "request_o"));
    ASSERT_NO_FATAL_FAILURE(
        expect_port(dut().port("stack_level_o"), static_cast<std::uint64_t>(model.level()), "stack_level_o"));
    ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("idle_o"), model.idle() ? 1 : 0, "idle_o"));
    if (request.valid) {
      ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("address_o"), request.address, "address_o"));
    }
    highest_ = std::max(highest_, model.level());
    dut().clock();
    model.clock(start, root, request, push, children, decide);
  }
  EXPECT_EQ(highest_, kStackDepth);
}

TEST_F(TraversalBench, TakesEveryBitOfTheRootRange) {
  clear_inputs();
  for (int k = 0; k <= 2 * kIdBits; ++k) {
    const std::uint32_t count =
        (1U << (k / 2)) + (k % 2 == 0 ? 0U : 2U);  // without its highest bit: ends early
    reset_dut();
    dut().set(dut().port("root_first_i"), count & (kAddresses - 1));
    dut().set(dut().port("root_count_i"), count);
    dut().set(dut().port("start_i"), 1);
    dut().clock();
    dut().set(dut().port("start_i"), 0);
    for (std::uint32_t sphere = 0; sphere < 8; ++sphere) {
      dut().settle();
      expect_port(dut().port("request_o"), sphere < count ? 1 : 0, "request_o");
      if (sphere < count) {
        expect_port(dut().port("address_o"), (count + sphere) & (kAddresses - 1), "address_o");
      }
      dut().clock();
    }
  }
}

TEST_F(TraversalBench, WalksRandomTreesOnce) {
  std::mt19937 random(81);
  for (int tree = 0; tree < 25; ++tree) {
    const auto width = static_cast<std::uint32_t>(1 + random() % 8);
    walk(random_tree(random, 1, width, 8, 80), 1, static_cast<int>(random() % 4), 15,
         tree % 2 == 0 ? 100 : 30);
  }
}

TEST_F(TraversalBench, WalksTreesAnywhereInTheMemoryWithAnyNumberOfSets) {
  std::mt19937 random(83);
  for (int tree = 0; tree < 16; ++tree) {
    const auto nodes = random_tree(random, 1, 1 + static_cast<std::uint32_t>(random() % 6), 6, 70);
    const auto last = kAddresses - static_cast<std::uint32_t>(nodes.size());
    const std::uint32_t base =
        tree == 0 ? 0 : (tree == 1 ? last : static_cast<std::uint32_t>(random() % last));
    walk(nodes, 1, tree, 15, 100, base);
  }
}

TEST_F(TraversalBench, WalksRangesOfUpTo127Children) {
  constexpr std::uint32_t kWidest = 127;
  for (const std::uint32_t inner : {1U, 2U, 7U, 40U}) {  // only these have children: the stack's bound holds
    std::vector<Node> nodes(kWidest);
    for (std::uint32_t k = 0; k < inner; ++k) {
      nodes[k * 3] = {true, static_cast<std::uint32_t>(nodes.size()), kWidest - k};
      nodes.resize(nodes.size() + kWidest - k);
    }
    walk(nodes, kWidest, 0, 15, 100, 0xfedcb - 0xffff);
  }
}

TEST_F(TraversalBench, StartsAfreshAfterAResetInTheMiddle) {
  std::mt19937 random(84);
  const auto nodes = random_tree(random, 3, 6, 6, 80);
  for (int clocks = 2; clocks < 120; clocks += 3) {
    walk(nodes, 3, clocks % 5, 15, 10, kFirst, clocks);
    walk(std::vector<Node>(2), 2, 0, 15, 100);
  }
}

TEST_F(TraversalBench, CountsEverySphereOfTheLongestList) {
  const std::uint32_t spheres = Dut::simulator() == "ghdl" ? 3000 : kAddresses;
  reset_dut();
  const PortId start = dut().port("start_i");
  const PortId request = dut().port("request_o");
  const PortId address = dut().port("address_o");
  const PortId idle = dut().port("idle_o");
  const PortId decided = dut().port("decided_i");
  clear_inputs();
  dut().set(dut().port("root_count_i"), spheres);
  dut().set(start, 1);
  dut().clock();
  dut().set(start, 0);
  for (std::uint32_t k = 0; k < spheres; ++k) {
    dut().settle();
    ASSERT_EQ(dut().get(request), 1U) << "sphere " << k;
    ASSERT_EQ(dut().get(address), k);
    dut().clock();
    dut().set(decided, 1);  // each a clock after its request
  }
  count_checked(spheres);
  dut().settle();
  ASSERT_NO_FATAL_FAILURE(expect_port(request, 0, "request_o"));
  ASSERT_NO_FATAL_FAILURE(expect_port(idle, 0, "idle_o"));
  dut().clock();
  dut().set(decided, 0);
  ASSERT_NO_FATAL_FAILURE(expect_port(idle, 1, "idle_o"));
}

TEST_F(TraversalBench, StaysWithinTheStackOnTheDeepestTreeThatTheHostAccepts) {
  // the bound: a path's sum of (inner children - 1) <= kStackDepth - kStackWatermark - kLeafFifoDepth = 48
  constexpr std::uint32_t kWidth = 17;
  constexpr int kInnerLevels = 3;  // 3 * (17 - 1) = 48
  std::vector<Node> nodes(kWidth);
  std::size_t begin = 0;
  for (int level = 0; level < kInnerLevels; ++level) {
    const std::size_t end = nodes.size();
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t count = level + 1 < kInnerLevels ? kWidth : 1;
      nodes[k] = {true, static_cast<std::uint32_t>(nodes.size()), count};
      nodes.resize(nodes.size() + count);
    }
    begin = end;
  }
  for (const int latency : {15, 31, 60}) {
    walk(nodes, kWidth, 0, latency, 100);
  }
  EXPECT_GT(highest_, kStackWatermark) << "the test does not reach the watermark";
}

}  // namespace
}  // namespace raplas
