// Measures a unit's latency on the RTL: operands A are held until the outputs are still, then operands B
// are held, and the rising edges are counted until the outputs change from A's result to B's.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "bridge/dut.hpp"

namespace raplas {

/// A value of a port, least significant word first.
struct PortValue {
  PortId port;
  std::vector<std::uint32_t> words;
};

/// Operands of a unit and the result they lead to.
struct Operands {
  std::vector<PortValue> inputs;
  std::vector<PortValue> outputs;
};

/// Do the two lead to different results?
bool differ(const Operands& a, const Operands& b);

/// A port's value from a number.
inline PortValue port_value(const char* name, std::uint32_t value) { return {dut().port(name), {value}}; }
/// A port's value from a packed word.
template <std::size_t kWords>
PortValue port_value(const char* name, const std::array<std::uint32_t, kWords>& words) {
  return {dut().port(name), {words.begin(), words.end()}};
}

/// Operands from `make`, each with another result than the one before.
template <typename Make>
std::vector<Operands> operands_in_turn(std::size_t count, Make make) {
  std::vector<Operands> operands;
  while (operands.size() < count) {
    Operands next = make();
    if (operands.empty() || differ(operands.back(), next)) {
      operands.push_back(std::move(next));
    }
  }
  return operands;
}

/// Steps from each operands to the next and counts the clocks to the new result; the outputs must keep the
/// old result until then and the new one from then on. The count must be `stages` in every step. Prints it,
/// and writes it as a figure into the file that RAPLAS_FIGURES names, if it does.
void check_latency(const std::vector<Operands>& operands, int stages);

}  // namespace raplas
