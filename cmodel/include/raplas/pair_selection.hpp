// From tested vertices to (ray, triangle) pairs, clock by clock: entities triangle_lines, ray_bounds,
// row_selector and column_selector.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "raplas/clocked.hpp"
#include "raplas/fixed_point.hpp"
#include "raplas/scan_lines.hpp"

namespace raplas {

/// A triangle that crosses rows and columns of the pencil.
struct CrossingTriangle {
  bool valid = false;
  LineMask rows = 0;
  LineMask columns = 0;
  std::uint32_t z = 0;
  std::uint32_t triangle = 0;
};

/// Entity triangle_lines.
class TriangleLines {
 public:
  /// The triangle that the vertex of the last clock closed.
  [[nodiscard]] const CrossingTriangle& out() const noexcept { return out_; }

  /// A vertex goes into slot 0, 1 or 2; with emit the slots hold a triangle. rows, columns: masks inherited
  /// from the spheres above it.
  void clock(bool valid, std::size_t slot, bool emit, const FixedTest& test, LineMask rows, LineMask columns,
             std::uint32_t triangle) noexcept {
    if (valid && slot < slots_.size()) {
      slots_[slot] = test;
    }
    const CrossedLines lines = crossed_lines(slots_);
    out_.rows = rows & lines.rows;
    out_.columns = columns & lines.columns;
    out_.z = lines.z;
    out_.triangle = triangle;
    out_.valid = valid && emit && lines.near && out_.rows != 0 && out_.columns != 0;
  }

 private:
  std::array<FixedTest, 3> slots_{};
  CrossingTriangle out_;
};

/// Entity vertex_grid, clock by clock: the points of the three slots.
class VertexGrid {
 public:
  using Points = std::array<GridPoint, 3>;

  /// The slots with the vertex given kVertexGridStages clocks ago. A point that isn't known is only that.
  [[nodiscard]] const Points& points() const noexcept { return stages_.out(); }

  /// A vertex goes into slot 0, 1 or 2: its sums over two planes, and its depth code before the margin.
  void clock(bool valid, std::size_t slot, std::int64_t across, std::int64_t down, std::uint32_t depth,
             const LimitsWord& limits) noexcept {
    if (valid && slot < slots_.size()) {
      slots_[slot] = project(across, down, depth, limits);
    }
    stages_.clock(slots_);
  }

 private:
  Points slots_{};
  Delay<Points, kVertexGridStages> stages_;
};

/// Entity ray_bounds. What is beyond a ray's bound never matters again in that pencil, so a row's bound,
/// which is that of its last read, may lag and is never too low.
class RayBounds {
 public:
  /// Clocks from a read to its maximum; a clock later it is the row's bound.
  static constexpr std::size_t kMaximumStages = kMemoryStages + kLineBits;

  /// A pencil begins: `far` for its rays, 0 elsewhere.
  struct Clear {
    bool valid = false;
    std::size_t bank = 0;
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    std::uint32_t far = 0;
  };
  struct Update {
    bool valid = false;
    std::size_t bank = 0;
    std::size_t ray = 0;
    std::uint32_t bound = 0;
  };
  struct Read {
    bool valid = false;
    std::size_t bank = 0;
    std::size_t row = 0;
  };

  /// Of the row asked for kMemoryStages clocks ago. The RTL says of a row without an update only that.
  [[nodiscard]] const LineBounds& bounds() const noexcept { return read_.out(); }
  [[nodiscard]] const LineBounds& row_bounds(std::size_t bank) const noexcept { return row_bounds_[bank]; }

  void clock(const Clear& clear, const Update& update, const Read& read) noexcept {
    if (const Maximum& maximum = maximum_.out(); maximum.read.valid) {
      row_bounds_[maximum.read.bank][maximum.read.row] = maximum.bound;
    }
    const LineBounds& row = rows_[read.bank][read.row];  // as it is before the writes of this clock
    maximum_.clock({read, *std::ranges::max_element(row)});
    read_.clock(row);
    if (update.valid) {
      rows_[update.bank][update.ray / kMaxColumns][update.ray % kMaxColumns] = update.bound;
    }
    if (clear.valid) {
      for (std::size_t k = 0; k < kMaxRows; ++k) {
        const std::uint32_t bound = k < clear.rows ? clear.far : 0;
        row_bounds_[clear.bank][k] = bound;
        for (std::size_t column = 0; column < kMaxColumns; ++column) {
          rows_[clear.bank][k][column] = column < clear.columns ? bound : 0;
        }
      }
    }
  }

 private:
  using Bank = std::array<LineBounds, kMaxRows>;
  struct Maximum {
    Read read;
    std::uint32_t bound = 0;
  };

  std::array<Bank, kPencilBanks> rows_{};
  std::array<LineBounds, kPencilBanks> row_bounds_{};
  Delay<LineBounds, kMemoryStages> read_;
  Delay<Maximum, kMaximumStages> maximum_;
};

/// Word of the queue of triangles: one that the pencil meets, or the pencil's end.
struct QueuedTriangle {
  static constexpr int kPointBits = 1 + 2 * kGridBits;
  static constexpr int kBits = 1 + kBankBits + kIdBits + kDepthBits + kMaxRows + kMaxColumns + 3 * kPointBits;

  bool last = false;  ///< end of the pencil: nothing else but bank counts
  std::uint32_t bank = 0;
  std::uint32_t triangle = 0;
  std::uint32_t z = 0;  ///< it is not nearer
  LineMask rows = 0;
  LineMask columns = 0;
  std::array<GridPoint, 3> points{};

  [[nodiscard]] PackedWord<kBits> pack() const noexcept {
    PackedWord<kBits> word{};
    int lsb = 0;
    const auto put = [&word, &lsb](std::uint32_t value, int width) {
      insert(word, {lsb, width}, value);
      lsb += width;
    };
    for (std::size_t k = points.size(); k-- > 0;) {
      const GridPoint& point = points[k];
      put(static_cast<std::uint32_t>(point.down), kGridBits);
      put(static_cast<std::uint32_t>(point.across), kGridBits);
      put(point.known ? 1 : 0, 1);
    }
    put(columns, kMaxColumns);
    put(rows, kMaxRows);
    put(z, kDepthBits);
    put(triangle, kIdBits);
    put(bank, kBankBits);
    put(last ? 1 : 0, 1);
    return word;
  }
};

/// Word of the queue of cut triangles: one with its edges, or the pencil's end.
struct CutTriangle {
  static constexpr int kCutLineBits = kLineBits + 1;
  static constexpr int kMarginBits = kSlopeBits - 1;
  static constexpr int kEdgeBits = 1 + 2 * kCutLineBits + kCutBits + kSlopeBits + kMarginBits;
  static constexpr int kBits =
      1 + kBankBits + kIdBits + kDepthBits + kMaxRows + kMaxColumns + 1 + 3 * kEdgeBits;

  bool last = false;  ///< end of the pencil: nothing else but bank counts
  std::uint32_t bank = 0;
  std::uint32_t triangle = 0;
  std::uint32_t z = 0;
  LineMask rows = 0;
  LineMask columns = 0;
  bool whole = false;  ///< all columns of each row: cuts don't count
  EdgeCuts cuts{};

  [[nodiscard]] PackedWord<kBits> pack() const noexcept {
    PackedWord<kBits> word{};
    int lsb = 0;
    const auto put = [&word, &lsb](std::int64_t value, int width) {
      insert(word, {lsb, width}, static_cast<std::uint32_t>(value));
      lsb += width;
    };
    for (std::size_t k = cuts.size(); k-- > 0;) {
      const EdgeCut& cut = cuts[k];
      put(cut.margin, kMarginBits);
      put(cut.slope, kSlopeBits);
      put(cut.at, kCutBits);
      put(cut.last, kCutLineBits);
      put(cut.first, kCutLineBits);
      put(cut.open ? 1 : 0, 1);
    }
    put(whole ? 1 : 0, 1);
    put(columns, kMaxColumns);
    put(rows, kMaxRows);
    put(z, kDepthBits);
    put(triangle, kIdBits);
    put(bank, kBankBits);
    put(last ? 1 : 0, 1);
    return word;
  }
};

/// Word of the queue of rows: the rays of one row that are to be tested against a triangle, or the pencil's
/// end.
struct QueuedRow {
  static constexpr int kBits = 1 + kBankBits + kIdBits + kDepthBits + kLineBits + kMaxColumns;

  bool last = false;  ///< end of the pencil: nothing else but bank counts
  std::uint32_t bank = 0;
  std::uint32_t triangle = 0;
  std::uint32_t z = 0;
  std::uint32_t row = 0;
  LineMask columns = 0;

  friend bool operator==(const QueuedRow&, const QueuedRow&) = default;

  [[nodiscard]] PackedWord<kBits> pack() const noexcept {
    PackedWord<kBits> word{};
    int lsb = 0;
    const auto put = [&word, &lsb](std::uint32_t value, int width) {
      insert(word, {lsb, width}, value);
      lsb += width;
    };
    put(columns, kMaxColumns);
    put(row, kLineBits);
    put(z, kDepthBits);
    put(triangle, kIdBits);
    put(bank, kBankBits);
    put(last ? 1 : 0, 1);
    return word;
  }

  [[nodiscard]] static QueuedRow unpack(const PackedWord<kBits>& word) noexcept {
    QueuedRow row;
    int lsb = 0;
    const auto take = [&word, &lsb](int width) {
      lsb += width;
      return extract(word, {lsb - width, width});
    };
    row.columns = take(kMaxColumns);
    row.row = take(kLineBits);
    row.z = take(kDepthBits);
    row.triangle = take(kIdBits);
    row.bank = take(kBankBits);
    row.last = take(1) != 0;
    return row;
  }
};

/// The mask without its lowest line.
[[nodiscard]] constexpr LineMask without_lowest(LineMask mask) noexcept { return mask & (mask - 1); }

/// Entity row_selector: the rows of a triangle in which it matters to a ray. The word of a triangle stays at
/// the front of its queue until its last row goes.
class RowSelector {
 public:
  static constexpr std::size_t kRowStages = kRowIntervalStages + 1;
  static constexpr std::size_t kQueueRows = std::size_t{1} << kRowFifoDepthLog2;

  /// The row of the last stage and whether it goes into the queue.
  [[nodiscard]] bool row_valid() const noexcept { return decided_valid_; }
  [[nodiscard]] const QueuedRow& row() const noexcept { return decided_; }

  /// The front word is taken in this clock: it has no row, or its last one goes. row_count: words in the
  /// queue of rows.
  [[nodiscard]] bool ready(bool valid, const CutTriangle& front, std::size_t row_count) const noexcept {
    const LineMask rows = rows_left(front);
    return valid && without_lowest(rows) == 0 && (rows == 0 || goes(valid, front, row_count));
  }

  /// The row that is asked for in this clock.
  [[nodiscard]] RayBounds::Read read() const noexcept {
    const auto& [valid, row] = on_the_way_.out();
    return {valid && !row.last, row.bank, row.row};
  }

  /// bounds: of the row asked for kMemoryStages clocks ago.
  void clock(bool valid, const CutTriangle& front, const LineBounds& bounds, std::size_t row_count) noexcept {
    const Stage& read_now = asked_.out();
    decided_ = read_now.row;
    decided_.columns &= lines_beyond(decided_.z, bounds);
    decided_valid_ = read_now.valid && (decided_.last || decided_.columns != 0);
    asked_.clock(on_the_way_.out());

    const LineMask rows = rows_left(front);
    const auto row = static_cast<std::uint32_t>(rows == 0 ? 0 : std::countr_zero(rows));
    const LineMask interval = front.whole ? first_lines(kMaxColumns) : row_columns(front.cuts, row);
    const bool go = goes(valid, front, row_count);
    const bool taken = ready(valid, front, row_count);
    on_the_way_.clock({go, {front.last, front.bank, front.triangle, front.z, row, front.columns & interval}});
    if (go) {
      rows_left_ = without_lowest(rows);
    }
    fresh_ = taken || (fresh_ && !go);
  }

 private:
  struct Stage {
    bool valid = false;
    QueuedRow row;
  };

  /// Of the front word; the end of a pencil goes as one row.
  [[nodiscard]] LineMask rows_left(const CutTriangle& front) const noexcept {
    return front.last ? 1 : fresh_ ? front.rows : rows_left_;
  }
  /// A row, or the end of a pencil, goes: the queue has room behind all that can be under way.
  [[nodiscard]] bool goes(bool valid, const CutTriangle& front, std::size_t row_count) const noexcept {
    return valid && rows_left(front) != 0 && row_count < kQueueRows - kRowStages;
  }

  bool fresh_ = true;  ///< no row of the front word has gone
  LineMask rows_left_ = 0;
  Delay<Stage, kRowIntervalStages - kMemoryStages> on_the_way_;
  Delay<Stage, kMemoryStages> asked_;
  bool decided_valid_ = false;
  QueuedRow decided_;
};

/// Entity column_selector: the pairs of a row, one a clock.
class ColumnSelector {
 public:
  [[nodiscard]] bool issue(bool stall) const noexcept { return row_.columns != 0 && !stall; }
  [[nodiscard]] bool last(bool stall) const noexcept { return row_.last && !stall; }
  [[nodiscard]] std::uint32_t ray() const noexcept {
    const int column = row_.columns == 0 ? 0 : std::countr_zero(row_.columns);
    return row_.row * kMaxColumns + static_cast<std::uint32_t>(column);
  }
  /// Its triangle, z and bank.
  [[nodiscard]] const QueuedRow& row() const noexcept { return row_; }

  /// The front row is taken in this clock.
  [[nodiscard]] bool ready(bool stall) const noexcept {
    const bool busy = row_.last || row_.columns != 0;
    return !busy || (!stall && without_lowest(row_.columns) == 0);
  }

  void clock(bool valid, const QueuedRow& front, bool stall) noexcept {
    if (ready(stall)) {
      row_ = front;
      row_.last = valid && front.last;
      row_.columns = valid && !front.last ? front.columns : 0;
    } else if (!stall) {
      row_.columns = without_lowest(row_.columns);
    }
  }

 private:
  QueuedRow row_;
};

}  // namespace raplas
