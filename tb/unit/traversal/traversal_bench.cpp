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
  /// Walks the tree with testers of `latency` clocks; leaves pile up as the selector takes `take_percent`.
  void walk(const std::vector<Node>& nodes, std::uint32_t root, int last_set, int latency,
            unsigned take_percent) {
    std::mt19937 random(82);
    reset_dut();
    Traversal model;
    std::deque<SphereRequest> testers(static_cast<std::size_t>(latency));
    std::vector<int> seen(nodes.size());
    int leaves = 0;
    dut().set(dut().port("root_first_i"), kFirst);
    dut().set(dut().port("root_count_i"), root);
    dut().set(dut().port("last_set_i"), static_cast<std::uint64_t>(last_set));
    for (int k = 0; k == 0 || k == 1 || !model.idle(); ++k) {
      ASSERT_LT(k, 2'000'000) << "does not end";
      const SphereRequest leaving = testers.front();
      testers.pop_front();
      const bool decided = leaving.valid && leaving.last_set;
      const Node node = decided ? nodes[leaving.address - kFirst] : Node{};
      dut().set(dut().port("start_i"), k == 0 ? 1 : 0);
      dut().set(dut().port("decided_i"), decided ? 1 : 0);
      dut().set(dut().port("push_i"), node.inner ? 1 : 0);
      const SphereRange children{node.first + kFirst, node.count};
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
        seen[request.address - kFirst] += request.last_set ? 1 : 0;
      }
      testers.push_back(request);
      dut().clock();
      model.clock(k == 0, {kFirst, root}, request, node.inner, children, decided);
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
TEST_F(TraversalBench, EndsAtOnceWithoutSpheres) { walk({}, 0, 0, 15, 100); }
TEST_F(TraversalBench, WaitsForRoomInTheLeafQueue) { walk(std::vector<Node>(500), 500, 0, 15, 3); }

TEST_F(TraversalBench, WalksRandomTreesOnce) {
  std::mt19937 random(81);
  for (int tree = 0; tree < 25; ++tree) {
    const auto width = static_cast<std::uint32_t>(1 + random() % 8);
    walk(random_tree(random, 1, width, 8, 80), 1, static_cast<int>(random() % 4), 15,
         tree % 2 == 0 ? 100 : 30);
  }
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
