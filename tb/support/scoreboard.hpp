// Checks a unit of fixed latency on every clock: what goes in now must come out kLatency clocks later.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <utility>

#include "bridge/dut.hpp"

namespace raplas {

/// Expected results on their way through a pipeline.
template <typename T>
class Scoreboard {
 public:
  explicit Scoreboard(int latency) : latency_(static_cast<std::size_t>(latency)) {}

  /// Clocks the unit with inputs whose result is `expected`; gives the result due at the outputs now.
  std::optional<T> clock(T expected) {
    line_.push_back(std::move(expected));
    dut().clock();
    if (line_.size() < latency_) {
      return std::nullopt;
    }
    T due = std::move(line_.front());
    line_.pop_front();
    return due;
  }

 private:
  std::size_t latency_;
  std::deque<T> line_;
};

/// A port of up to 64 bits must be known and hold `expected`; counts the check.
inline void expect_port(PortId port, std::uint64_t expected, const char* name) {
  const std::array<std::uint32_t, 2> words{static_cast<std::uint32_t>(expected),
                                           static_cast<std::uint32_t>(expected >> 32)};
  dut().expect(port, std::span(words).first(dut().width(port) > 32 ? 2 : 1));
  ASSERT_FALSE(dut().has_unknown(port)) << name << " is unknown in clock " << dut().cycles();
  ASSERT_EQ(dut().get(port), expected) << name << std::hex << " in clock 0x" << dut().cycles()
                                       << ": expected 0x" << expected << ", seen 0x" << dut().get(port);
  count_checked();
}

/// A wide port must be known and hold `expected`; counts the check.
template <std::size_t kWords>
void expect_port(PortId port, const std::array<std::uint32_t, kWords>& expected, const char* name) {
  dut().expect(port, expected);
  ASSERT_FALSE(dut().has_unknown(port)) << name << " is unknown in clock " << dut().cycles();
  std::array<std::uint32_t, kWords> seen{};
  dut().get(port, seen);
  ASSERT_EQ(seen, expected) << name << " in clock " << dut().cycles();
  count_checked();
}

/// Holds rst_i for a few clocks.
inline void reset_dut() {
  const PortId reset = dut().port("rst_i");
  dut().set(reset, 1);
  for (int k = 0; k < 4; ++k) {
    dut().clock();
  }
  dut().set(reset, 0);
}

/// A unit with valid_i, valid_o and a pipeline of `stages`: after a clock of rst_i nothing that was inside
/// comes out.
inline void expect_empty_after_reset(int stages) {
  const auto clocks = [](int count) {
    for (int k = 0; k < count; ++k) {
      dut().clock();
    }
  };
  reset_dut();
  dut().set(dut().port("valid_i"), 1);
  clocks(2 * stages);
  expect_port(dut().port("valid_o"), 1, "valid_o");
  dut().set(dut().port("rst_i"), 1);
  clocks(1);
  dut().set(dut().port("rst_i"), 0);
  dut().set(dut().port("valid_i"), 0);
  for (int k = 0; k < 2 * stages; ++k) {
    expect_port(dut().port("valid_o"), 0, "valid_o");
    clocks(1);
  }
}

}  // namespace raplas
