// The unit under test, by port names: one class for Verilator and GHDL.
//
// A bench links this header's implementation with one of two backends: the
// unit's Verilog in Verilator, or its VHDL in GHDL. Time goes like this:
//
//   set(a, 5);          the value waits
//   settle();           inputs applied, outputs that depend on them directly are valid
//   clock();            inputs applied, time to settle, rising edge of clk_i, time to settle
//   get(q);             what the last settle() or clock() left
//
// After clock() the inputs are still applied. clk_i itself is no port here.
// A wrong name, direction or width stops the program with a message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace raplas {

/// Place of a port in the unit's port list.
struct PortId {
  std::size_t index;
};

class Dut {
 public:
  Dut(const Dut&) = delete;
  Dut& operator=(const Dut&) = delete;

  /// Finds a port; an unknown name stops the program and lists the ports.
  [[nodiscard]] PortId port(std::string_view name) const;
  [[nodiscard]] unsigned width(PortId port) const;

  /// Sets an input of up to 64 bits; the value must fit its width.
  void set(PortId port, std::uint64_t value);
  /// Sets an input of any width from ceil(width / 32) words, least significant first.
  void set(PortId port, std::span<const std::uint32_t> words);
  /// Value of a port of up to 64 bits; bits that are not 0 or 1 read as 0.
  [[nodiscard]] std::uint64_t get(PortId port) const;
  /// Reads a port of any width into ceil(width / 32) words, least significant first.
  void get(PortId port, std::span<std::uint32_t> words) const;
  /// True when a bit of the port is U, X, Z, W or '-' (GHDL only; false in Verilator).
  [[nodiscard]] bool has_unknown(PortId port) const;

  /// Applies the inputs and lets the outputs settle, without an edge.
  void settle();
  /// One rising edge of clk_i, with the inputs applied before it.
  void clock();
  /// Number of clock() calls so far.
  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }

  /// Name of the unit, and of the simulator: "verilator" or "ghdl".
  [[nodiscard]] static std::string_view unit();
  [[nodiscard]] static std::string_view simulator();

  /// What a port must hold in this clock, for the expected trace; checks nothing.
  void expect(PortId port, std::span<const std::uint32_t> words);
  /// From the next clock() on writes a trace of what the unit shows (tb/trace/trace_writer.hpp).
  void trace_to(const std::string& path);
  /// The same of what the bench expects: inputs as applied, outputs as told by expect(), x elsewhere.
  void trace_expected_to(const std::string& path);
  /// Writes the lines of the clock that has not come yet; clock() does it by itself.
  void trace_line();
  /// Before the first settle() or clock(): all signals into a GHW file for GTKWave (GHDL only).
  static void waves_to(const std::string& path);

 private:
  friend Dut& dut();
  Dut() = default;

  std::uint64_t cycles_ = 0;
};

/// The one unit of this process.
Dut& dut();

/// Pipeline stage of a port, for the trace's header: declare at namespace scope,
/// `const raplas::PortStage kSumStage{"sum_o", kAddStages};`. Inputs are at 0 by default.
struct PortStage {
  PortStage(std::string_view port, int stage);
};

/// Adds to the number of results that the bench has checked; a bench that checks nothing fails.
void count_checked(std::uint64_t results = 1);

}  // namespace raplas
