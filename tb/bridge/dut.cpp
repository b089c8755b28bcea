// Class Dut: names, checks and traces; the simulator's part is behind backend.hpp.
#include "bridge/dut.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "bridge/backend.hpp"
#include "bridge/checked.hpp"
#include "trace/trace_writer.hpp"

namespace raplas {
namespace {

constexpr unsigned kWordBits = 32;

std::unique_ptr<TraceWriter> seen_trace;      // NOLINT: one unit a process
std::unique_ptr<TraceWriter> expected_trace;  // NOLINT
std::map<std::size_t, std::string> expected;  // NOLINT: by port, for the line of this clock
std::uint64_t results_checked = 0;            // NOLINT

std::vector<std::pair<std::string_view, int>>& stages() {
  static std::vector<std::pair<std::string_view, int>> list;
  return list;
}

[[noreturn]] void stop(const std::string& message) {
  std::fprintf(stderr, "bench of %s: %s\n", std::string(Dut::unit()).c_str(), message.c_str());
  std::abort();
}

const PortInfo& info(PortId port) { return backend::ports()[port.index]; }

void check(PortId port, bool fits, const char* what) {
  if (!fits) stop(std::string("port ").append(info(port).name).append(": ").append(what));
}

bool fits(unsigned width, std::span<const std::uint32_t> words) {
  const unsigned used = width % kWordBits;
  return used == 0 || (words.back() >> used) == 0;
}

int stage_of(const PortInfo& port) {
  const auto& list = stages();
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& s) { return s.first == port.name; });
  return found != list.end() ? found->second : port.is_input ? 0 : kUnknownStage;
}

}  // namespace

Dut& dut() {
  static Dut instance;
  return instance;
}

PortId Dut::port(std::string_view name) const {
  const auto ports = backend::ports();
  std::string list;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (ports[i].name == name) return PortId{i};
    list.append(" ").append(ports[i].name);
  }
  stop(std::string("no port ").append(name).append(", but:").append(list));
}

unsigned Dut::width(PortId port) const { return info(port).width; }

void Dut::set(PortId port, std::uint64_t value) {
  const std::array<std::uint32_t, 2> words{static_cast<std::uint32_t>(value),
                                           static_cast<std::uint32_t>(value >> kWordBits)};
  const unsigned width = info(port).width;
  check(port, info(port).is_input, "set() of an output");
  if (width < 64 && (value >> width) != 0) {
    stop(std::string(info(port).name).append(": value ").append(trace_hex(words, {}, 64)) + " does not fit");
  }
  check(port, width <= 64, "wider than 64 bits: use words");
  backend::write(port.index, words.data());
}

void Dut::set(PortId port, std::span<const std::uint32_t> words) {
  check(port, info(port).is_input, "set() of an output");
  check(port, words.size() == info(port).words(), "wrong number of words");
  check(port, fits(info(port).width, words), "value does not fit");
  backend::write(port.index, words.data());
}

std::uint64_t Dut::get(PortId port) const {
  check(port, info(port).width <= 64, "wider than 64 bits: use words");
  std::array<std::uint32_t, 2> words{};
  backend::read(port.index, words.data(), nullptr);
  return words[0] | (std::uint64_t{words[1]} << kWordBits);
}

void Dut::get(PortId port, std::span<std::uint32_t> words) const {
  check(port, words.size() == info(port).words(), "wrong number of words");
  backend::read(port.index, words.data(), nullptr);
}

bool Dut::has_unknown(PortId port) const {
  std::vector<std::uint32_t> words(info(port).words());
  return backend::read(port.index, words.data(), nullptr);
}

void Dut::settle() { backend::settle(); }

void Dut::clock() {
  trace_line();
  backend::clock();
  ++cycles_;
}

std::string_view Dut::unit() { return backend::unit(); }
std::string_view Dut::simulator() { return backend::simulator(); }

namespace {

std::unique_ptr<TraceWriter> open_trace(const std::string& path) {
  std::vector<TraceField> fields;
  for (const PortInfo& port : backend::ports()) {
    fields.push_back({std::string(port.name), port.width, stage_of(port)});
  }
  return std::make_unique<TraceWriter>(path, std::string(Dut::unit()), std::move(fields));
}

}  // namespace

void Dut::trace_to(const std::string& path) { seen_trace = open_trace(path); }
void Dut::trace_expected_to(const std::string& path) { expected_trace = open_trace(path); }
void Dut::waves_to(const std::string& path) { backend::waves_to(path); }

void Dut::expect(PortId port, std::span<const std::uint32_t> words) {
  if (expected_trace) expected[port.index] = trace_hex(words, {}, info(port).width);
}

void Dut::trace_line() {
  if (!seen_trace && !expected_trace) return;
  backend::settle();
  std::vector<std::string> seen_values;
  std::vector<std::string> expected_values;
  for (std::size_t i = 0; i < backend::ports().size(); ++i) {
    const PortInfo& port = backend::ports()[i];
    std::vector<std::uint32_t> words(port.words());
    std::vector<std::uint32_t> unknown(port.words());
    backend::read(i, words.data(), unknown.data());
    seen_values.push_back(trace_hex(words, unknown, port.width));
    const auto known = expected.find(i);
    expected_values.push_back(port.is_input             ? seen_values.back()
                              : known != expected.end() ? known->second
                                                        : std::string((port.width + 3) / 4, 'x'));
  }
  expected.clear();
  if (seen_trace) seen_trace->line(cycles_, seen_values);
  if (expected_trace) expected_trace->line(cycles_, expected_values);
}

PortStage::PortStage(std::string_view port, int stage) { stages().emplace_back(port, stage); }

void count_checked(std::uint64_t results) { results_checked += results; }
std::uint64_t checked() { return results_checked; }

}  // namespace raplas
