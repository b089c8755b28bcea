// The walk through the sphere tree, clock by clock: entity traversal.
#pragma once

#include <array>
#include <cstdint>

#include "raplas/constants.hpp"

namespace raplas {

/// A range of spheres.
struct SphereRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// A sphere address and plane set for the testers.
struct SphereRequest {
  bool valid = false;
  bool first_set = false;
  bool last_set = false;
  std::uint32_t address = 0;
  int set = 0;
};

/// Stack and range counter; see rtl/traversal/traversal.vhd for the rules.
class Traversal {
 public:
  /// The request of this clock, given the words in the leaf queue.
  [[nodiscard]] SphereRequest request(int last_set, int leaves) const noexcept {
    const bool room = set_ != 0 || under_test_ + leaves < kLeafFifoDepth;
    return {active_ && room, set_ == 0, set_ == last_set, address_, set_};
  }
  [[nodiscard]] bool idle() const noexcept { return !active_ && level_ == 0 && under_test_ == 0; }
  [[nodiscard]] int level() const noexcept { return level_; }

  /// One clock. `request` is what request() gave in this clock.
  void clock(bool start, SphereRange root, const SphereRequest& request, bool push, SphereRange children,
             bool decided) noexcept {
    const bool was_active = active_;
    const bool alone = !active_ && under_test_ == 0;
    const bool relaxed = level_ < kStackWatermark;
    bool ending = false;
    if (request.valid) {
      if (request.last_set) {
        ending = left_ == 1;
        set_ = 0;
        ++address_;
        --left_;
      } else {
        ++set_;
      }
    }
    under_test_ += (request.valid && request.first_set ? 1 : 0) - (decided ? 1 : 0);

    if (start) {
      take(root);
      active_ = root.count != 0;
    } else if ((ending || !was_active) && relaxed && push) {
      take(children);
    } else if ((((ending || !was_active) && relaxed) || alone) && level_ != 0) {
      --level_;
      take(stack_[static_cast<std::size_t>(level_)]);
    } else {
      if (ending) {
        active_ = false;
      }
      if (push) {
        stack_[static_cast<std::size_t>(level_ % kStackDepth)] = children;
        ++level_;
      }
    }
  }

 private:
  void take(SphereRange range) noexcept {
    active_ = true;
    address_ = range.first;
    left_ = range.count;
  }

  bool active_ = false;
  std::uint32_t address_ = 0;
  std::uint32_t left_ = 0;
  int set_ = 0;
  int level_ = 0;
  int under_test_ = 0;
  std::array<SphereRange, kStackDepth> stack_{};
};

}  // namespace raplas
