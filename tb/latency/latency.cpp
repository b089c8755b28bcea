// The counting, and the figures file.
#include "latency.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace raplas {
namespace {

constexpr int kHold = 100;  // clocks: longer than any latency measured here

void apply(const Operands& operands) {
  for (const PortValue& input : operands.inputs) {
    dut().set(input.port, input.words);
  }
}

bool shows(const Operands& operands) {
  for (const PortValue& output : operands.outputs) {
    std::vector<std::uint32_t> seen(output.words.size());
    dut().get(output.port, seen);
    if (seen != output.words || dut().has_unknown(output.port)) {
      return false;
    }
  }
  return true;
}

/// Holds the inputs while the outputs must not change.
bool stays(const Operands& operands) {
  for (int k = 0; k < kHold; ++k) {
    if (!shows(operands)) {
      return false;
    }
    dut().clock();
  }
  return shows(operands);
}

/// Edges from `before`, whose result is shown, to the result of `after`; -1 when the test fails.
int step(const Operands& before, const Operands& after) {
  apply(after);
  dut().settle();
  int edges = 0;
  while (shows(before) && edges < kHold) {
    dut().clock();
    ++edges;
  }
  if (!shows(after)) {
    ADD_FAILURE() << "after " << edges << " clocks the outputs are neither the old nor the new result";
    return -1;
  }
  if (!stays(after)) {
    ADD_FAILURE() << "the result came after " << edges << " clocks and did not stay";
    return -1;
  }
  count_checked();
  return edges;
}

void report(int clocks) {
  const std::string unit(Dut::unit());
  std::printf("latency of %s: %d clocks\n", unit.c_str(), clocks);
  const char* name = std::getenv("RAPLAS_FIGURES");  // NOLINT: one thread
  if (name == nullptr) {
    return;
  }
  const std::filesystem::path path(name);
  if (path.has_parent_path()) {
    std::filesystem::create_directories(path.parent_path());
  }
  std::ofstream file(path);
  file << "{\"stages." << unit << "\": {\"value\": " << clocks
       << ", \"unit\": \"clocks\", \"command\": \"make figures\"}}\n";
  file.close();
  ASSERT_TRUE(file) << path << " cannot be written";
}

}  // namespace

bool differ(const Operands& a, const Operands& b) {
  for (std::size_t k = 0; k < a.outputs.size(); ++k) {
    if (a.outputs[k].words != b.outputs[k].words) {
      return true;
    }
  }
  return false;
}

void check_latency(const std::vector<Operands>& operands, int stages) {
  apply(operands.at(0));
  for (int k = 0; k < kHold; ++k) {
    dut().clock();
  }
  ASSERT_TRUE(stays(operands[0])) << "the first result never comes";
  int latency = -1;
  for (std::size_t k = 1; k < operands.size(); ++k) {
    ASSERT_TRUE(differ(operands[k - 1], operands[k])) << "equal results show no latency";
    latency = step(operands[k - 1], operands[k]);
    ASSERT_EQ(latency, stages) << "in step " << k;
  }
  report(latency);
}

}  // namespace raplas
