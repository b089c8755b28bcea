// From leaves to (ray, triangle) pairs, clock by clock: entities selector and pair_issue.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "raplas/constants.hpp"

namespace raplas {

/// A leaf that the pencil meets: its triangles, and the rows and columns that meet it.
struct Leaf {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t row_mask = 0;
  std::uint32_t column_mask = 0;
};

/// A ray (row * kMaxColumns + column) to be tested against a triangle.
struct Pair {
  std::uint32_t ray = 0;
  std::uint32_t triangle = 0;

  friend bool operator==(const Pair&, const Pair&) = default;
};

/// Entity selector: triangles in the outer loop, then rows, then columns.
class Selector {
 public:
  [[nodiscard]] bool valid() const noexcept { return active_; }
  [[nodiscard]] Pair pair() const noexcept {
    const auto row = static_cast<std::uint32_t>(std::countr_zero(rows_left_));
    const auto column = static_cast<std::uint32_t>(std::countr_zero(columns_left_));
    return {row * kMaxColumns + column, triangle_};
  }

  /// A leaf is taken in this clock, given that the pair is (not) taken.
  [[nodiscard]] bool ready(bool pair_taken) const noexcept {
    return !active_ || (pair_taken && without_lowest(columns_left_) == 0 && without_lowest(rows_left_) == 0 &&
                        left_ == 1);
  }

  void clock(bool leaf_valid, const Leaf& leaf, bool pair_taken) noexcept {
    if (ready(pair_taken)) {
      active_ = leaf_valid;
      triangle_ = leaf.first;
      left_ = leaf.count;
      leaf_ = leaf;
      rows_left_ = leaf.row_mask;
      columns_left_ = leaf.column_mask;
    } else if (pair_taken) {
      columns_left_ = without_lowest(columns_left_);
      if (columns_left_ == 0) {
        columns_left_ = leaf_.column_mask;
        rows_left_ = without_lowest(rows_left_);
        if (rows_left_ == 0) {
          rows_left_ = leaf_.row_mask;
          ++triangle_;
          --left_;
        }
      }
    }
  }

 private:
  static constexpr std::uint32_t without_lowest(std::uint32_t mask) noexcept { return mask & (mask - 1); }

  bool active_ = false;
  std::uint32_t triangle_ = 0;
  std::uint32_t left_ = 0;
  Leaf leaf_;
  std::uint32_t rows_left_ = 0;
  std::uint32_t columns_left_ = 0;
};

/// Entity pair_issue: a pair waits while an earlier one of its ray is between reading and writing the best
/// hit.
class PairIssue {
 public:
  static constexpr std::size_t kHazardClocks = kMemoryStages + kMulStages + 1;

  PairIssue() noexcept { history_.fill(kNoRay); }

  /// The pair of this ray is held back in this clock.
  [[nodiscard]] bool blocked(std::uint32_t ray) const noexcept {
    for (const auto recent : history_) {
      if (recent == ray) {
        return true;
      }
    }
    return false;
  }

  void clock(bool issue, std::uint32_t ray) noexcept {
    history_[next_] = issue ? ray : kNoRay;
    next_ = (next_ + 1) % history_.size();
  }

 private:
  static constexpr std::uint32_t kNoRay = ~std::uint32_t{0};

  std::array<std::uint32_t, kHazardClocks - 1> history_;
  std::size_t next_ = 0;
};

}  // namespace raplas
