// Class Dut: names, checks and traces; the simulator's part is behind backend.hpp.
#include "bridge/dut.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "bridge/backend.hpp"
#include "bridge/checked.hpp"
#include "trace/trace_writer.hpp"

namespace raplas {
namespace {

constexpr unsigned kWordBits = 32;

std::unique_ptr<TraceWriter> trace;  // NOLINT: one unit a process
std::uint64_t results_checked = 0;   // NOLINT

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
  backend::clock();
  if (trace) trace_line();
  ++cycles_;
}

std::string_view Dut::unit() { return backend::unit(); }
std::string_view Dut::simulator() { return backend::simulator(); }

void Dut::trace_to(const std::string& path) {
  std::vector<TraceField> fields;
  for (const PortInfo& port : backend::ports()) {
    fields.push_back({std::string(port.name), port.width, stage_of(port)});
  }
  trace = std::make_unique<TraceWriter>(path, std::string(unit()), std::move(fields));
}

void Dut::trace_line() {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < backend::ports().size(); ++i) {
    const PortInfo& port = backend::ports()[i];
    std::vector<std::uint32_t> words(port.words());
    std::vector<std::uint32_t> unknown(port.words());
    backend::read(i, words.data(), unknown.data());
    values.push_back(trace_hex(words, unknown, port.width));
  }
  trace->line(cycles_, values);
}

PortStage::PortStage(std::string_view port, int stage) { stages().emplace_back(port, stage); }

void count_checked(std::uint64_t results) { results_checked += results; }
std::uint64_t checked() { return results_checked; }

}  // namespace raplas
