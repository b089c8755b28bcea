// The walk through the sphere tree, nearest children first, clock by clock: entity tree_walk.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raplas/fixed_point.hpp"

namespace raplas {

/// A range of spheres or, of a leaf, of vertices.
struct WalkRange {
  bool leaf = false;
  std::uint32_t count = 0;
  std::uint32_t first = 0;
  std::uint32_t rows = 0;     ///< mask of the rows that the sphere above meets
  std::uint32_t columns = 0;  ///< of the columns
  std::uint32_t z = 0;        ///< depth code of that sphere

  static constexpr int kBits = 1 + kCountBits + kIdBits + kMaxRows + kMaxColumns + kDepthBits;

  friend constexpr bool operator==(const WalkRange&, const WalkRange&) noexcept = default;

  /// The word of port push_range_i.
  [[nodiscard]] PackedWord<kBits> pack() const noexcept {
    PackedWord<kBits> word{};
    int lsb = 0;
    const auto put = [&](std::uint32_t value, int width) {
      insert(word, Field{lsb, width}, value);
      lsb += width;
    };
    put(z, kDepthBits);
    put(columns, kMaxColumns);
    put(rows, kMaxRows);
    put(first, kIdBits);
    put(count, kCountBits);
    put(leaf ? 1 : 0, 1);
    return word;
  }
};

/// An object for the testers.
struct WalkRequest {
  bool valid = false;
  bool vertex = false;
  std::uint32_t address = 0;
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  bool last = false;  ///< of its range
};

/// What the testers and the decision behind them give back in a clock.
struct WalkDecision {
  bool decided = false;
  bool last_sibling = false;  ///< with `decided`
  bool push = false;          ///< with `decided`
  WalkRange range{};
};

/// Stack and range counter; see rtl/traversal/tree_walk.vhd for the rules.
class TreeWalk {
 public:
  /// The request of this clock, given the words in the triangle queue.
  [[nodiscard]] WalkRequest request(int triangles) const noexcept {
    const bool room = under_test_ + triangles < (1 << kTriangleFifoDepthLog2);
    return {active_ && (!range_.leaf || room),
            range_.leaf,
            range_.first,
            range_.rows,
            range_.columns,
            range_.count == 1};
  }
  [[nodiscard]] bool idle() const noexcept { return !active_ && stack_.empty() && under_test_ == 0; }
  /// No object goes to the testers any more.
  [[nodiscard]] bool spent() const noexcept {
    return !active_ && stack_.empty() && under_test_ <= vertices_behind_;
  }
  [[nodiscard]] int level() const noexcept { return static_cast<int>(stack_.size()); }
  [[nodiscard]] int under_test() const noexcept { return under_test_; }
  /// The range that the next clock compares with the row bounds; only if level() != 0.
  [[nodiscard]] const WalkRange& top() const noexcept { return stack_.back(); }

  /// One clock. `request` is what request() gave in this clock.
  void clock(bool start, const WalkRange& root, const WalkRequest& request, const LineBounds& bounds,
             const WalkDecision& decision) {
    const bool alone = !active_ && under_test_ == 0;
    const bool relaxed = level() < kStackWatermark;
    if (request.valid) {
      range_.first = (range_.first + 1) & ((1U << kIdBits) - 1);
      --range_.count;
      active_ = range_.count != 0;
    }
    const bool free = !active_;
    under_test_ += (request.valid ? 1 : 0) - (decision.decided ? 1 : 0);
    if (request.valid) {
      vertices_behind_ = request.vertex ? std::min(vertices_behind_ + 1, kMostBehind) : 0;
    }

    if (start) {
      range_ = root;
      active_ = true;
    } else if (!stack_.empty()) {
      WalkRange next = stack_.back();
      next.rows &= lines_beyond(next.z, bounds);
      const bool wanted = (free && relaxed) || alone;
      if (next.rows == 0 || wanted) {
        stack_.pop_back();
        siblings_ = std::max(siblings_ - 1, 0);
        if (next.rows != 0) {
          range_ = next;
          active_ = true;
        }
      }
    }
    if (decision.push) {
      auto place = stack_.end();
      for (int k = 0; k < siblings_ && (place - 1)->z <= decision.range.z; ++k) {
        --place;
      }
      stack_.insert(place, decision.range);
      siblings_ = std::min(siblings_ + 1, kSortedRanges - 1);
    }
    if (decision.decided && decision.last_sibling) {
      siblings_ = 0;
    }
  }

 private:
  static constexpr int kMostBehind = 15;

  bool active_ = false;
  WalkRange range_{};             ///< what is left of the current range
  std::vector<WalkRange> stack_;  ///< back() is the top
  int siblings_ = 0;              ///< entries among which the next one is sorted
  int under_test_ = 0;
  int vertices_behind_ = 0;  ///< behind the last sphere
};

}  // namespace raplas
