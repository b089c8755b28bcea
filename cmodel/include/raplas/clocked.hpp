// Building blocks of the clocked models. Outputs are functions of the state (and, where it says so, of the
// same clock's inputs); clock() is the rising edge.
#pragma once

#include <array>
#include <cstddef>

namespace raplas {

/// A word, kStages clocks later: entity delay, and every pipeline that takes a word a clock.
template <typename T, std::size_t kStages>
class Delay {
 public:
  static_assert(kStages > 0);

  /// The word given kStages clocks ago.
  [[nodiscard]] const T& out() const noexcept { return line_[next_]; }

  void clock(const T& in) noexcept {
    line_[next_] = in;
    next_ = next_ + 1 == kStages ? 0 : next_ + 1;
  }

 private:
  std::array<T, kStages> line_{};
  std::size_t next_ = 0;
};

/// First-word fall-through queue: entity fifo.
template <typename T, std::size_t kDepth>
class Fifo {
 public:
  [[nodiscard]] bool valid() const noexcept { return count_ != 0; }       ///< not empty
  [[nodiscard]] bool ready() const noexcept { return count_ != kDepth; }  ///< not full
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] const T& front() const noexcept { return memory_[head_]; }

  /// A write into a full queue and a read from an empty one are ignored.
  void clock(bool write, const T& word, bool read) noexcept {
    const bool write_now = write && ready();
    const bool read_now = read && valid();
    if (write_now) {
      memory_[tail_] = word;
      tail_ = (tail_ + 1) % kDepth;
    }
    if (read_now) {
      head_ = (head_ + 1) % kDepth;
    }
    count_ = count_ + (write_now ? 1 : 0) - (read_now ? 1 : 0);
  }

 private:
  std::array<T, kDepth> memory_{};
  std::size_t head_ = 0;
  std::size_t tail_ = 0;
  std::size_t count_ = 0;
};

}  // namespace raplas
