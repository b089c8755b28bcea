// Backend: the unit's VHDL in GHDL, steered from C++.
//
// The generated bench.vhd calls exchange() (here raplas_bridge_exchange) whenever it
// wants to know what to do next. The simulation runs as a coroutine with a stack of
// its own: exchange() leaves it, settle() and clock() enter it again. A bit is one
// byte, the position in std_ulogic (U X 0 1 Z W L H -), most significant bit first.
#include <sys/mman.h>
#include <ucontext.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "bench_ports.hpp"
#include "bridge/backend.hpp"

extern "C" int ghdl_main(int argc, char** argv);

namespace raplas::backend {
namespace {

constexpr std::size_t kStackBytes = std::size_t{64} << 20;
constexpr std::uint8_t kLogic0 = 2;  // position of '0'; '1' is the next one
constexpr unsigned kWordBits = 32;

enum class Action : std::int32_t { kSettle = 1, kClock = 2 };  // as in bench.vhd; 0 would end it

struct Port {
  PortInfo info;
  std::size_t first;  // byte of its most significant bit in din or dout
};
#define RAPLAS_PORT(name, width, is_input, first) Port{{#name, width, is_input}, first},
#define RAPLAS_INFO(name, width, is_input, first) PortInfo{#name, width, is_input},
constexpr std::array kPorts{RAPLAS_PORTS(RAPLAS_PORT)};
constexpr std::array kInfos{RAPLAS_PORTS(RAPLAS_INFO)};

std::string wave_file;  // NOLINT: one simulation a process

struct Simulation {
  std::array<std::uint8_t, RAPLAS_DIN_BITS> din;
  std::array<std::uint8_t, RAPLAS_DOUT_BITS> dout{};  // all 'U' until the first settle() or clock()
  Action action = Action::kSettle;
  ucontext_t bench{};
  ucontext_t simulator{};
  bool started = false;
  bool ended = false;

  Simulation() {
    din.fill(kLogic0);
    void* stack = mmap(nullptr, kStackBytes, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (stack == MAP_FAILED || getcontext(&simulator) != 0) std::abort();
    simulator.uc_stack.ss_sp = stack;
    simulator.uc_stack.ss_size = kStackBytes;
    simulator.uc_link = &bench;
    makecontext(&simulator, &Simulation::main, 0);
  }

  static void main();

  void enter() {
    swapcontext(&bench, &simulator);
    if (!ended) return;
    std::fprintf(stderr, "bench of %s: the simulation ended by itself\n", RAPLAS_UNIT);
    std::abort();
  }

  void run(Action next) {
    action = next;
    enter();
  }
};

Simulation& simulation() {
  static Simulation instance;  // its coroutine is never ended: the process just exits
  return instance;
}

void Simulation::main() {
  // numeric_std warns of metavalues before a pipeline is filled: has_unknown() is for that.
  std::vector<std::string> arguments{"bench", "--ieee-asserts=disable", "--assert-level=error"};
  if (!wave_file.empty()) arguments.push_back("--wave=" + wave_file);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ghdl_main(static_cast<int>(arguments.size()), argv.data());
  simulation().ended = true;
}

}  // namespace

std::string_view simulator() { return "ghdl"; }
std::string_view unit() { return RAPLAS_UNIT; }
std::span<const PortInfo> ports() { return kInfos; }
void waves_to(const std::string& path) { wave_file = path; }

void write(std::size_t port, const std::uint32_t* words) {
  const PortInfo& info = kPorts[port].info;
  std::uint8_t* bits = simulation().din.data() + kPorts[port].first;
  for (unsigned i = 0; i < info.width; ++i) {
    bits[info.width - 1 - i] =
        static_cast<std::uint8_t>(kLogic0 + ((words[i / kWordBits] >> (i % kWordBits)) & 1));
  }
}

bool read(std::size_t port, std::uint32_t* words, std::uint32_t* unknown) {
  const auto& [info, first] = kPorts[port];
  const Simulation& s = simulation();
  const std::uint8_t* bits = (info.is_input ? s.din.data() : s.dout.data()) + first;
  bool any = false;
  std::memset(words, 0, info.words() * sizeof *words);
  if (unknown != nullptr) std::memset(unknown, 0, info.words() * sizeof *unknown);
  for (unsigned i = 0; i < info.width; ++i) {
    const std::uint32_t bit = bits[info.width - 1 - i];
    const std::uint32_t known = (bit >> 1) & 1;  // 0, 1, L, H are at positions 2, 3, 6, 7
    words[i / kWordBits] |= (bit & known) << (i % kWordBits);
    if (unknown != nullptr) unknown[i / kWordBits] |= (known ^ 1) << (i % kWordBits);
    any |= known == 0;
  }
  return any;
}

void settle() { simulation().run(Action::kSettle); }
void clock() { simulation().run(Action::kClock); }

}  // namespace raplas::backend

/// Called by the simulation: takes its outputs, waits for the bench, gives it the inputs.
extern "C" void raplas_bridge_exchange(const std::uint8_t* dout, std::uint8_t* din, std::int32_t* action) {
  auto& s = raplas::backend::simulation();
  std::memcpy(s.dout.data(), dout, s.dout.size());
  if (s.started) swapcontext(&s.simulator, &s.bench);
  s.started = true;  // the first call comes at time 0 with an action already waiting
  std::memcpy(din, s.din.data(), s.din.size());
  *action = static_cast<std::int32_t>(s.action);
}
