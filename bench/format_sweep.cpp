#include "format_sweep.hpp"

#include <fmt/format.h>

#include <utility>

namespace raplas {
namespace {

using Measure = FormatErrors (*)(const Sample&);

template <std::size_t... kIndices>
constexpr std::array<Measure, kSweep.size()> table(std::index_sequence<kIndices...> /*all*/) {
  return {&measure<Float<kSweep[kIndices]>>...};
}

constexpr auto kMeasures = table(std::make_index_sequence<kSweep.size()>());

}  // namespace

const char* name_of(Guard guard) {
  constexpr std::array<const char*, 3> kNames{"none", "one", "exact"};
  return kNames[static_cast<std::size_t>(guard)];
}

const char* name_of(Rounding rounding) { return rounding == Rounding::toward_zero ? "truncate" : "nearest"; }

std::string name_of(const Format& format) {
  return fmt::format("fp_e{}_f{}_{}_{}", format.exponent_bits, format.fraction_bits, name_of(format.guard),
                     name_of(format.rounding));
}

FormatErrors measure_swept(std::size_t k, const Sample& sample) { return kMeasures[k](sample); }

}  // namespace raplas
