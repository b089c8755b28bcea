// From valid hits to nearest hits, clock by clock: entity hit_queue.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raplas/clocked.hpp"
#include "raplas/constants.hpp"
#include "raplas/ray_triangle.hpp"
#include "raplas/selector.hpp"
#include "raplas/words.hpp"

namespace raplas {

/// A valid hit of a ray, or the token that ends a pencil (then only the bank counts).
template <typename F>
struct ValidHit {
  bool token = false;
  std::uint32_t bank = 0;
  std::uint32_t ray = 0;
  FoundHit<F> hit;
};

/// What entity hit_queue says in a clock.
template <typename F>
struct NearestHit {
  KeptHit<F> kept;         ///< without write it says nothing but that
  bool done = false;       ///< a token passed
  std::uint32_t bank = 0;  ///< of the write, or of the token
  std::uint32_t ray = 0;
};

/// Entity hit_queue. Each clock: read stall(), asks() and out(), then clock().
template <typename F>
class HitQueue {
 public:
  static constexpr std::size_t kDepth = std::size_t{1} << kHitFifoDepthLog2;
  static constexpr int kStages = kMemoryStages + kMulStages;

  [[nodiscard]] bool stall() const noexcept { return queue_.count() >= kDepth / 2; }
  [[nodiscard]] std::size_t count() const noexcept { return queue_.count(); }
  /// Front word: the best hit of this bank and ray is asked for; any word if the queue is empty.
  [[nodiscard]] const ValidHit<F>& asks() const noexcept { return queue_.front(); }
  [[nodiscard]] const NearestHit<F>& out() const noexcept { return decided_.out(); }

  /// `given`: a hit or a token comes. `best`: what was asked for kMemoryStages clocks ago.
  void clock(bool given, const ValidHit<F>& hit, const RayHits<F>& best) noexcept {
    const ValidHit<F>& front = queue_.front();
    const std::uint32_t place = front.bank << (2 * kLineBits) | front.ray;
    const bool token = queue_.valid() && front.token;
    const bool issue = queue_.valid() && !front.token && !issue_.blocked(place);
    const Gone& gone = line_.out();  // s2
    NearestHit<F> decided{{}, gone.valid && gone.hit.token, gone.hit.bank, gone.hit.ray};
    if (gone.valid && !gone.hit.token) {
      decided.kept = keep_hit(gone.hit.hit, best);
    }
    decided_.clock(decided);
    line_.clock({issue || token, front});
    issue_.clock(issue, place);
    queue_.clock(given, hit, issue || token);
  }

 private:
  struct Gone {
    bool valid = false;
    ValidHit<F> hit;
  };

  Fifo<ValidHit<F>, kDepth> queue_;
  PairIssue issue_;
  Delay<Gone, kMemoryStages> line_;
  Delay<NearestHit<F>, kMulStages> decided_;
};

}  // namespace raplas
