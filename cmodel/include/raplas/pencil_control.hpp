// One pencil after the other, clock by clock: entity pencil_control.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "raplas/clocked.hpp"
#include "raplas/constants.hpp"

namespace raplas {

/// Loads planes, starts walks and sends the end-of-pencil tokens of the banks that the host starts.
class PencilControl {
 public:
  /// What it gives in a clock.
  struct Out {
    bool clear = false;  ///< bounds and hit bits of the bank, please
    bool load = false;   ///< planes `line` of both sides of the bank, please
    std::uint32_t line = 0;
    bool walk = false;   ///< the walk begins
    bool token = false;  ///< wants to go
  };

  /// A bit for each bank that was started and isn't done.
  [[nodiscard]] std::uint32_t busy() const noexcept { return busy_; }
  /// The bank whose turn it is.
  [[nodiscard]] std::size_t bank() const noexcept { return bank_; }
  [[nodiscard]] Out out(bool clearing) const noexcept {
    return {clear_, state_ == State::loading, line_, state_ == State::settling && !clearing,
            state_ == State::token};
  }

  /// One clock. rows, columns: of the pencil in bank(). done, done_bank: a token left the hit queue.
  void clock(bool start, std::size_t start_bank, std::uint32_t rows, std::uint32_t columns, bool clearing,
             bool walk_idle, bool token_ready, bool done, std::size_t done_bank) noexcept {
    const bool take = state_ == State::waiting && queue_.valid();
    const bool accepted = start && (busy_ >> start_bank & 1U) == 0;
    const std::size_t next = queue_.front();
    queue_.clock(accepted, start_bank, take);
    clear_ = take;
    step(rows, columns, clearing, walk_idle, token_ready);
    if (take) {
      bank_ = next;
      line_ = 0;
      state_ = State::loading;
    }
    busy_ &= ~((done ? 1U : 0U) << done_bank);
    busy_ |= (accepted ? 1U : 0U) << start_bank;
  }

 private:
  enum class State { waiting, loading, settling, walking, token };

  void step(std::uint32_t rows, std::uint32_t columns, bool clearing, bool walk_idle,
            bool token_ready) noexcept {
    if (state_ == State::loading) {
      if (line_ == kGridPlane) {
        state_ = State::settling;
      }
      ++line_;
      if (line_ == std::max(rows, columns)) {
        line_ = kAxisPlane;
      }
    } else if (state_ == State::settling && !clearing) {
      state_ = State::walking;
    } else if (state_ == State::walking && walk_idle) {
      state_ = State::token;
    } else if (state_ == State::token && token_ready) {
      state_ = State::waiting;
    }
  }

  State state_ = State::waiting;
  bool clear_ = false;
  std::uint32_t line_ = 0;
  std::size_t bank_ = 0;
  std::uint32_t busy_ = 0;
  Fifo<std::size_t, kPencilBanks> queue_;
};

}  // namespace raplas
