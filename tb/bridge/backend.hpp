// What a simulator does for class Dut, and the table of ports that it works on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace raplas {

/// One port, without clk_i. Words are 32 bits, least significant first.
struct PortInfo {
  std::string_view name;
  unsigned width;
  bool is_input;
  [[nodiscard]] constexpr std::size_t words() const { return (width + 31) / 32; }
};

namespace backend {

[[nodiscard]] std::string_view simulator();
[[nodiscard]] std::string_view unit();
[[nodiscard]] std::span<const PortInfo> ports();

/// Stores an input's words for the next settle() or clock(); bits above the width are 0.
void write(std::size_t port, const std::uint32_t* words);
/// Reads a port; `unknown` (may be null) gets a 1 for each metavalue. Returns whether there is one.
bool read(std::size_t port, std::uint32_t* words, std::uint32_t* unknown);
/// Before the first settle() or clock(): records waves, or stops the program if the simulator can't.
void waves_to(const std::string& path);
void settle();
void clock();

}  // namespace backend
}  // namespace raplas
