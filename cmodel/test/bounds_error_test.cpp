// How large do errors of the datapaths get, against the proved bounds (formal/bounds/bounds.json)?
// RAPLAS_CASES: cases of each datapath, both adders together.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "figures.hpp"
#include "normalised.hpp"

namespace raplas {
namespace {

constexpr std::uint64_t kCases = 1'000'000;

/// The largest errors of a datapath with one adder.
template <typename Datapath>
struct Worst {
  static constexpr std::size_t kTargets = Datapath::kNames.size();
  std::array<double, kTargets> error{};
  std::uint64_t cases = 0;
};

/// An eighth of the cases random, the others climbs: small changes that are kept if they don't make the error
/// of one result smaller, from a random case or from the worst one so far.
template <typename Datapath, typename F>
Worst<Datapath> search(std::uint64_t cases, std::uint64_t seed) {
  using Words = typename Datapath::Words;
  constexpr std::size_t kTargets = Worst<Datapath>::kTargets;
  constexpr std::uint64_t kClimb = 3000;
  Operands<Datapath> operands(seed);
  Worst<Datapath> worst;
  std::array<Words, kTargets> worst_words{};
  const auto errors = [&](const Words& words) {
    const auto exact = Datapath::template exact<double>(words);  // to 2^-50, far below any bound
    const auto computed = Datapath::template computed<F>(words);
    ++worst.cases;
    std::array<double, kTargets> error;
    for (std::size_t k = 0; k < kTargets; ++k) {
      error[k] = std::abs(computed[k] - exact[k]);
      if (error[k] > worst.error[k]) {
        const auto precise = Datapath::template exact<long double>(words);
        worst.error[k] = static_cast<double>(std::abs(computed[k] - precise[k]));
        worst_words[k] = words;
      }
    }
    return error;
  };
  while (worst.cases < cases / 8) {
    errors(operands.fresh());
  }
  for (std::uint64_t climb = 0; worst.cases < cases; ++climb) {
    const std::size_t target = climb % kTargets;
    Words here = climb / kTargets % 2 == 0 ? operands.fresh() : worst_words[target];
    double height = errors(here)[target];
    for (std::uint64_t step = 0; step < kClimb && worst.cases < cases; ++step) {
      const Words next = operands.changed(here);
      const double error = errors(next)[target];
      if (error >= height) {
        here = next;
        height = error;
      }
    }
  }
  return worst;
}

nlohmann::json proven() {
  return nlohmann::json::parse(std::ifstream(std::filesystem::path(RAPLAS_BOUNDS) / "bounds.json"));
}

template <typename Datapath, typename F>
void measure(const char* variant, const char* suffix, std::uint64_t seed, Figures& figures) {
  const std::uint64_t cases = number_of_cases(kCases) / 2;
  const auto start = std::chrono::steady_clock::now();
  const Worst<Datapath> worst = search<Datapath, F>(cases, seed);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const nlohmann::json bounds = proven();
  for (std::size_t k = 0; k < worst.error.size(); ++k) {
    const std::string name = Datapath::kNames[k];
    const double bound = bounds.at(name).at(variant);
    const double ratio = worst.error[k] / bound;
    std::printf("bound.%s%s proven %.4e worst_seen %.4e ratio %.3f\n", name.c_str(), suffix, bound,
                worst.error[k], ratio);
    EXPECT_LE(ratio, 1) << name;
    EXPECT_GT(ratio, 0.25) << name << ": the cases are too easy, or the bound is far too large";
    figures.add("bound." + name + suffix + ".proven", bound, "scene units");
    figures.add("bound." + name + suffix + ".worst_seen", worst.error[k], "scene units");
    figures.add("bound." + name + suffix + ".ratio", ratio, "of the bound");
  }
  std::printf("%s %s: checked %llu cases, %.1f M/s\n", Datapath::kFile, variant,
              static_cast<unsigned long long>(worst.cases),
              static_cast<double>(worst.cases) / seconds.count() * 1e-6);
  EXPECT_GE(worst.cases, cases);
  figures.add("bound." + std::string(Datapath::kFile) + suffix + ".cases", worst.cases, "cases");
}

TEST(Bounds, NoErrorExceedsItsBound) {
  Figures figures;
  measure<PlaneSphere, Fp24>("guarded", "", 1, figures);
  measure<PlaneSphere, Fp24Paper>("paper", "_paper", 2, figures);
  measure<RayTriangle, Fp24>("guarded", "", 3, figures);
  measure<RayTriangle, Fp24Paper>("paper", "_paper", 4, figures);
  figures.write();
}

}  // namespace
}  // namespace raplas
