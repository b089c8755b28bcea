// One pencil after the other, clock by clock: entity pencil_control.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "raplas/clocked.hpp"
#include "raplas/constants.hpp"

namespace raplas {

/// Clears, loads planes for, walks and ends the pencils of the banks that the host starts.
class PencilControl {
 public:
  /// What it gives in a clock.
  struct Out {
    bool clear = false;  ///< bounds and hit bits of clear_bank(), please
    bool load = false;   ///< planes `line` of both sides of load_bank(), please
    std::uint32_t line = 0;
    bool walk = false;   ///< the walk begins
    bool token = false;  ///< wants to go
  };

  /// A bit for each bank that was started and isn't done.
  [[nodiscard]] std::uint32_t busy() const noexcept { return busy_; }
  [[nodiscard]] std::size_t clear_bank() const noexcept { return clear_bank_; }
  [[nodiscard]] std::size_t load_bank() const noexcept { return loading_.bank; }
  /// The bank whose turn it is.
  [[nodiscard]] std::size_t bank() const noexcept { return bank_; }
  [[nodiscard]] Out out() const noexcept {
    return {clear_, load_ == Load::loading, line_, turn_ == Turn::none && loaded(), turn_ == Turn::token};
  }

  /// One clock. rows, columns: of the pencil in clear_bank(). done, done_bank: a token left the hit queue.
  void clock(bool start, std::size_t start_bank, std::uint32_t rows, std::uint32_t columns, bool walk_spent,
             bool walk_idle, bool token_ready, bool done, std::size_t done_bank) noexcept {
    const bool accepted = start && (busy_ >> start_bank & 1U) == 0;
    const bool take = load_ == Load::none && queue_.valid() && (turn_ != Turn::walking || walk_spent);
    const Waiting next = queue_.front();

    step(walk_idle, token_ready);
    if (take) {
      loading_ = next;
      line_ = 0;
      load_ = Load::loading;
    }
    if (turn_ == Turn::none) {
      bank_ = loading_.bank;
    }
    queue_.clock(clear_, {clear_bank_, std::max(rows, columns)}, take);
    clear_ = accepted;
    clear_bank_ = start_bank;
    busy_ &= ~((done ? 1U : 0U) << done_bank);
    busy_ |= (accepted ? 1U : 0U) << start_bank;
  }

 private:
  enum class Load { none, loading, loaded };
  enum class Turn { none, walking, token };
  struct Waiting {
    std::size_t bank = 0;
    std::uint32_t lines = 0;  ///< of the longer side
  };

  /// The last planes are asked for now, or were.
  [[nodiscard]] bool loaded() const noexcept {
    return load_ == Load::loaded || (load_ == Load::loading && line_ == kGridPlane);
  }

  void step(bool walk_idle, bool token_ready) noexcept {
    const bool walk = turn_ == Turn::none && loaded();
    if (load_ == Load::loading) {
      load_ = loaded() ? Load::loaded : Load::loading;
      ++line_;
      if (line_ == loading_.lines) {
        line_ = kAxisPlane;
      }
    }
    if (walk) {
      turn_ = Turn::walking;
      load_ = Load::none;
    } else if (turn_ == Turn::walking && walk_idle) {
      turn_ = Turn::token;
    } else if (turn_ == Turn::token && token_ready) {
      turn_ = Turn::none;
    }
  }

  bool clear_ = false;  ///< clear_bank_ was started
  std::size_t clear_bank_ = 0;
  Fifo<Waiting, kPencilBanks> queue_;
  Load load_ = Load::none;
  Waiting loading_;
  std::uint32_t line_ = 0;
  Turn turn_ = Turn::none;
  std::size_t bank_ = 0;
  std::uint32_t busy_ = 0;
};

}  // namespace raplas
