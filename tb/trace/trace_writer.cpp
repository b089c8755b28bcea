#include "trace/trace_writer.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace raplas {
namespace {

constexpr unsigned kDigitBits = 4;
constexpr unsigned kWordBits = 32;

unsigned digit(std::span<const std::uint32_t> words, unsigned place) {
  const unsigned bit = place * kDigitBits;
  return (words[bit / kWordBits] >> (bit % kWordBits)) & 0xFU;
}

[[noreturn]] void stop(const std::string& message) {
  std::fprintf(stderr, "trace: %s\n", message.c_str());
  std::abort();
}

}  // namespace

std::string trace_hex(std::span<const std::uint32_t> words, std::span<const std::uint32_t> unknown,
                      unsigned width) {
  std::string text;
  for (unsigned place = (width + kDigitBits - 1) / kDigitBits; place-- > 0;) {
    const bool known = unknown.empty() || digit(unknown, place) == 0;
    text += known ? "0123456789abcdef"[digit(words, place)] : 'x';
  }
  return text;
}

TraceWriter::TraceWriter(const std::string& path, const std::string& unit, std::vector<TraceField> fields)
    : fields_(std::move(fields)), file_(path) {
  file_ << "# unit " << unit << " clock";
  for (const TraceField& field : fields_) {
    file_ << ' ' << field.name << ':' << field.width << '@'
          << (field.stage == kUnknownStage ? "-" : std::to_string(field.stage));
  }
  file_ << '\n';
  if (!file_) stop(std::string("cannot write ").append(path));
}

void TraceWriter::line(std::uint64_t clock, std::span<const std::string> values) {
  if (values.size() != fields_.size()) stop("wrong number of values");
  file_ << clock;
  for (std::size_t i = 0; i < values.size(); ++i) file_ << ' ' << fields_[i].name << '=' << values[i];
  file_ << '\n';
}

}  // namespace raplas
