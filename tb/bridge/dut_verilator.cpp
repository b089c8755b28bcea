// Backend: the unit's exported Verilog in Verilator.
//
// Verilator's port types (8 to 64 bits, or an array of 32-bit words) are all plain
// little-endian memory, so a port is an address and a size. Registers without an
// initial value start at random (fixed seed): nothing may rely on zeros. A netlist with
// mutants (formal/mutants.py) runs the one that RAPLAS_MUTANT names, or none.
#include <verilated.h>

#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>

#include "bench_ports.hpp"
#include "bridge/backend.hpp"
#include RAPLAS_MODEL_HEADER

static_assert(std::endian::native == std::endian::little, "ports are copied as little-endian memory");

namespace raplas::backend {
namespace {

constexpr int kRandomStart = 2;  // Verilated::randReset: random initial values
constexpr int kSeed = 1;

#define RAPLAS_INFO(name, width, is_input, first) PortInfo{#name, width, is_input},
constexpr std::array kPorts{RAPLAS_PORTS(RAPLAS_INFO)};

struct Storage {
  void* data;
  std::size_t bytes;
};

struct Model {
  VerilatedContext context;
  RAPLAS_MODEL_CLASS unit;
  std::array<Storage, kPorts.size()> storage;

  Model() : context(), unit((context.randReset(kRandomStart), context.randSeed(kSeed), &context)) {
#define RAPLAS_STORAGE(name, width, is_input, first) Storage{&unit.name, sizeof(unit.name)},
    storage = {RAPLAS_PORTS(RAPLAS_STORAGE)};
    for (std::size_t i = 0; i < kPorts.size(); ++i) {
      if (kPorts[i].is_input) std::memset(storage[i].data, 0, storage[i].bytes);
    }
#if RAPLAS_HAS_MUTANTS
    const char* mutant = std::getenv("RAPLAS_MUTANT");
    using Number = std::remove_reference_t<decltype(unit.mutant_i)>;
    unit.mutant_i = static_cast<Number>(mutant != nullptr ? std::atoi(mutant) : 0);
#endif
    set_clock(0);
    unit.eval();
  }

  void set_clock([[maybe_unused]] unsigned char value) {
#if RAPLAS_HAS_CLOCK
    unit.clk_i = value;
#endif
  }
};

Model& model() {
  static Model instance;
  return instance;
}

}  // namespace

std::string_view simulator() { return "verilator"; }
std::string_view unit() { return RAPLAS_UNIT; }
std::span<const PortInfo> ports() { return kPorts; }

void write(std::size_t port, const std::uint32_t* words) {
  const Storage& storage = model().storage[port];
  std::memcpy(storage.data, words, storage.bytes);
}

bool read(std::size_t port, std::uint32_t* words, std::uint32_t* unknown) {
  const Storage& storage = model().storage[port];
  words[kPorts[port].words() - 1] = 0;
  std::memcpy(words, storage.data, storage.bytes);
  if (unknown != nullptr) std::memset(unknown, 0, kPorts[port].words() * sizeof(std::uint32_t));
  return false;
}

void waves_to(const std::string& path) {
  std::fprintf(stderr, "bench of %s: waves into %s: only the ghdl benches write waves\n", RAPLAS_UNIT,
               path.c_str());
  std::exit(2);
}

void settle() { model().unit.eval(); }

void clock() {
  Model& m = model();
  m.set_clock(0);
  m.unit.eval();
  m.set_clock(1);
  m.unit.eval();
}

}  // namespace raplas::backend
