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

/// Queue whose words show a clock later than those of Fifo: entity block_fifo.
template <typename T, std::size_t kDepth>
class BlockFifo {
 public:
  [[nodiscard]] bool valid() const noexcept { return valid_; }  ///< front() is a word
  [[nodiscard]] bool ready() const noexcept { return words_.ready(); }
  [[nodiscard]] std::size_t count() const noexcept { return words_.count(); }  ///< shown or not yet
  [[nodiscard]] const T& front() const noexcept { return words_.front(); }

  /// A write into a full queue and a read while nothing is valid are ignored.
  void clock(bool write, const T& word, bool read) noexcept {
    const bool read_now = read && valid_;
    valid_ = words_.count() > (read_now ? 1 : 0);  // those of the clocks before
    words_.clock(write, word, read_now);
  }

 private:
  Fifo<T, kDepth> words_;
  bool valid_ = false;
};

}  // namespace raplas
