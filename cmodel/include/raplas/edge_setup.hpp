// The lines through the edges of triangles, clock by clock: entity edge_setup.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raplas/clocked.hpp"
#include "raplas/pair_selection.hpp"
#include "raplas/scan_lines.hpp"

namespace raplas {

/// Entity edge_setup. Cuts of a word with `last` or `whole` don't count and are not those of the RTL.
class EdgeSetup {
 public:
  static constexpr std::size_t kQueueWords = std::size_t{1} << kCutFifoDepthLog2;
  static constexpr std::size_t kStages{kEdgeSetupStages};

  /// A word goes into the queue of cut triangles.
  [[nodiscard]] bool valid() const noexcept { return stages_.out().valid; }
  [[nodiscard]] const CutTriangle& word() const noexcept { return stages_.out().word; }

  /// The front word is taken in this clock, given its row bounds and the words in the queue of cut triangles.
  [[nodiscard]] bool ready(bool valid, const QueuedTriangle& front, const LineBounds& row_bounds,
                           std::size_t count) const noexcept {
    return edge_ == 2 || (starts(valid, count) && !has_edges(front, row_bounds));
  }

  /// row_bounds, error: of the front word's bank.
  void clock(bool valid, const QueuedTriangle& front, const LineBounds& row_bounds, std::uint32_t error,
             std::size_t count) noexcept {
    const LineMask rows = front.rows & lines_beyond(front.z, row_bounds);
    cuts_[edge_] = edge_cut(front.points[edge_], front.points[(edge_ + 1) % 3], error);
    const bool goes = ready(valid, front, row_bounds, count) && (edge_ == 2 || front.last || rows != 0);
    stages_.clock(
        {goes, {front.last, front.bank, front.triangle, front.z, rows, front.columns, !known(front), cuts_}});
    const bool begins = edge_ == 0 && starts(valid, count) && has_edges(front, row_bounds);
    edge_ = edge_ == 2 ? 0 : edge_ + (edge_ == 1 || begins ? 1 : 0);
  }

 private:
  struct Stage {
    bool valid = false;
    CutTriangle word;
  };

  [[nodiscard]] static bool known(const QueuedTriangle& front) noexcept {
    return front.points[0].known && front.points[1].known && front.points[2].known;
  }
  /// Its edges count; else it takes one clock.
  [[nodiscard]] static bool has_edges(const QueuedTriangle& front, const LineBounds& row_bounds) noexcept {
    return !front.last && known(front) && (front.rows & lines_beyond(front.z, row_bounds)) != 0;
  }
  /// The queue has room behind all that can be under way.
  [[nodiscard]] bool starts(bool valid, std::size_t count) const noexcept {
    return edge_ == 0 && valid && count < kQueueWords - kStages;
  }

  std::size_t edge_ = 0;  ///< of the front word
  EdgeCuts cuts_{};
  Delay<Stage, kStages> stages_;
};

}  // namespace raplas
