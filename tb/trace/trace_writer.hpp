// Cycle traces: text that the RTL benches and the model write alike, so that two
// of them can be compared line by line (raplas_trace_compare).
//
//   # unit fp_add clock a_i:24@0 b_i:24@0 sum_o:24@4      name:width@stage, @- when unknown
//   0 a_i=3f0000 b_i=3f0000 sum_o=xxxxxx
//   1 a_i=...
//
// A line shows the inputs of a clock and the outputs that settle with them, before its rising
// edge. An x digit is an unknown value; in an expected trace: do not compare.
#pragma once

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace raplas {

constexpr int kUnknownStage = -1;

struct TraceField {
  std::string name;
  unsigned width;
  int stage;  // registers between the unit's inputs and this value, or kUnknownStage
};

/// Hexadecimal digits of a value; a digit with an unknown bit is x.
/// @param words,unknown ceil(width / 32) words each, least significant first; unknown may be empty
[[nodiscard]] std::string trace_hex(std::span<const std::uint32_t> words,
                                    std::span<const std::uint32_t> unknown, unsigned width);

class TraceWriter {
 public:
  /// Opens the file and writes the header; stops the program when that fails.
  TraceWriter(const std::string& path, const std::string& unit, std::vector<TraceField> fields);

  /// Writes one clock: a hexadecimal text for each field (trace_hex, or x digits for "any value").
  void line(std::uint64_t clock, std::span<const std::string> values);

 private:
  std::vector<TraceField> fields_;
  std::ofstream file_;
};

}  // namespace raplas
