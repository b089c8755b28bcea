// tree_walk on whole trees, by rules stated here: each object once unless its rows' bounds were reached,
// stack and triangle queue within their bounds; spent when nothing can be requested any more.
#include <deque>
#include <map>

#include "unit/tree_walk/fixture.hpp"

namespace raplas {
namespace {

const PortStage kStages[]{{"request_o", 0}, {"vertex_o", 0},  {"address_o", 0},
                          {"rows_o", 0},    {"columns_o", 0}, {"last_o", 0}};

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
    std::vector<Moment> moments;
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
      const auto valid = [](const Object& object) { return object.valid; };
      const auto sphere = [](const Object& object) { return object.valid && !object.vertex; };
      Moment now{false, model_.level() != 0, std::any_of(testers.begin(), testers.end(), sphere),
                 std::count_if(testers.begin(), testers.end(), valid) > kCounted, false};
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
      now.request = request.valid;
      now.spent = spent_;
      moments.push_back(now);
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
    ASSERT_NO_FATAL_FAILURE(check_spent(moments));
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

 private:
  static constexpr int kCounted = 15;  // vertices under test that can make it spent
  /// A clock of a walk.
  struct Moment {
    bool request;
    bool stacked;  ///< ranges
    bool sphere;   ///< one is under test
    bool many;     ///< more than kCounted objects are
    bool spent;
  };

  /// Spent: nothing was requested from here on, the stack is empty, and only vertices are under test.
  static void check_spent(const std::vector<Moment>& moments) {
    bool more = false;  // in this clock or later
    for (std::size_t k = moments.size(); k-- > 1;) {
      const Moment& now = moments[k];
      more = more || now.request;
      ASSERT_EQ(now.spent, !more && !now.stacked && !now.sphere && !now.many) << "clock " << k;
    }
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

}  // namespace
}  // namespace raplas
