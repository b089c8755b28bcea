// The proved error bounds (formal/bounds): do the scripts have the model's operations, and how large do
// errors get? RAPLAS_CASES: cases of each datapath, both adders together.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "figures.hpp"
#include "random.hpp"
#include "raplas/plane_sphere.hpp"
#include "raplas/ray_triangle.hpp"

namespace raplas {
namespace {

constexpr std::uint64_t kCases = 1'000'000;
const std::filesystem::path kBounds = RAPLAS_BOUNDS;

/// A file of formal/bounds/*.g.in; the notation is described in formal/bounds.py.
struct Datapath {
  struct Operation {
    std::string name;
    std::string a;
    std::string operation;
    std::string b;
  };
  std::map<std::string, double> words;
  std::vector<Operation> operations;
  std::map<std::string, double> exact;
  std::vector<std::pair<std::vector<std::string>, double>> sums;
  std::vector<std::pair<std::vector<std::string>, double>> norms;

  explicit Datapath(const std::string& name) {
    std::ifstream file(kBounds / (name + ".g.in"));
    EXPECT_TRUE(file.good()) << name;
    for (std::string line; std::getline(file, line);) {
      std::istringstream stream(line.substr(0, line.find('#')));
      std::vector<std::string> fields;
      for (std::string field; stream >> field;) {
        fields.push_back(field);
      }
      if (fields.empty() || fields[0] == "bound" || fields[0] == "error") {
        continue;
      }
      if (fields[0] == "sum" || fields[0] == "norm") {
        (fields[0] == "sum" ? sums : norms)
            .push_back({{fields.begin() + 1, fields.end() - 1}, std::stod(fields.back())});
        continue;
      }
      if (fields[0] == "word") {
        for (std::size_t k = 1; k + 1 < fields.size(); ++k) {
          words[fields[k]] = std::stod(fields.back());
        }
      } else if (fields[0] == "exact") {
        exact[fields[1]] = std::stod(fields[2]);
      } else {
        operations.push_back({fields[0], fields[2], fields[3], fields[4]});
      }
    }
  }

  /// A value as a term of words.
  [[nodiscard]] std::string term(const std::string& name) const {
    for (const Operation& o : operations) {
      if (o.name == name) {
        return "(" + term(o.a) + " " + o.operation + " " + term(o.b) + ")";
      }
    }
    EXPECT_TRUE(words.contains(name)) << name;
    return name;
  }
};

/// A number that remembers how it was computed.
struct Symbol {
  std::string term;
  static inline std::vector<std::string> compared;

  friend Symbol operator+(const Symbol& a, const Symbol& b) { return {"(" + a.term + " + " + b.term + ")"}; }
  friend Symbol operator-(const Symbol& a, const Symbol& b) { return {"(" + a.term + " - " + b.term + ")"}; }
  friend Symbol operator*(const Symbol& a, const Symbol& b) { return {"(" + a.term + " * " + b.term + ")"}; }
  [[nodiscard]] Symbol negated() const { return {"-" + term}; }
  [[nodiscard]] bool sign() const { return false; }
  [[nodiscard]] bool is_zero() const { return false; }
  [[nodiscard]] int magnitude() const {
    compared.push_back(term);
    return 0;
  }
};

using SymbolVec = Vec3<Symbol>;

SymbolVec symbols(const std::string& name) { return {{name + "x"}, {name + "y"}, {name + "z"}}; }

TEST(Bounds, PlaneSphereScriptHasTheModelsOperations) {
  const PlaneWord<Symbol> plane{symbols("n"), {"p"}};
  EXPECT_EQ(plane_distance(plane, symbols("c")).term, Datapath("plane_sphere").term("d"));
}

TEST(Bounds, RayTriangleScriptHasTheModelsOperations) {
  const Datapath script("ray_triangle");
  const TriangleWord<Symbol> triangle{symbols("v0"), symbols("e1"), symbols("e2"), symbols("n")};
  // The model's conditions are evaluated in their order up to the first that fails: v' must not seem
  // negative.
  Symbol::compared.clear();
  const Vec3<Symbol> t = triangle.v0 - symbols("o");
  const Vec3<Symbol> dxt = cross(symbols("d"), t);
  EXPECT_EQ(t.x.term, script.term("tx"));
  EXPECT_EQ(dxt.z.term, script.term("cz"));
  const Solution<Symbol> s = solve(triangle, symbols("o"), symbols("d"));
  EXPECT_EQ(s.t.term, script.term("t"));
  EXPECT_EQ(s.d.term, script.term("nd"));
  EXPECT_EQ(s.u.term, "-" + script.term("u"));
  EXPECT_EQ(s.v.term, script.term("v"));
  // u' + v' is compared with d; the script writes v - u
  EXPECT_EQ(script.term("uv"), "(" + script.term("v") + " - " + script.term("u") + ")");
  const std::vector<std::string> expected{"(-" + script.term("u") + " + " + script.term("v") + ")",
                                          script.term("nd")};
  EXPECT_EQ(Symbol::compared, expected);
}

template <typename Real>
using Vector = std::array<Real, 3>;

template <typename Real>
[[gnu::always_inline]] inline Real dot3(const Vector<Real>& a, const Vector<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename Real>
[[gnu::always_inline]] inline Vector<Real> minus(const Vector<Real>& a, const Vector<Real>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Vector k of a case's words.
template <typename Real>
[[gnu::always_inline]] inline Vector<Real> vector_of(std::span<const std::uint32_t> words, std::size_t k) {
  return {static_cast<Real>(fp24_value(words[k])), static_cast<Real>(fp24_value(words[k + 1])),
          static_cast<Real>(fp24_value(words[k + 2]))};
}

template <typename F>
Vec3<F> model_vector(std::span<const std::uint32_t> words, std::size_t k) {
  return {F::from_bits(words[k]), F::from_bits(words[k + 1]), F::from_bits(words[k + 2])};
}

[[gnu::always_inline]] inline bool within(std::span<const std::uint32_t> words, std::size_t k, double limit) {
  const auto v = vector_of<double>(words, k);
  return dot3(v, v) <= limit * limit;
}

constexpr double kUnit = 1 + 0x1p-17;  // length of a unit vector that was rounded

[[gnu::always_inline]] inline bool is_unit(std::span<const std::uint32_t> words, std::size_t k) {
  return within(words, k, kUnit) &&
         std::max({words[k] & 0x7fffffU, words[k + 1] & 0x7fffffU, words[k + 2] & 0x7fffffU}) <= 0x3f0000U;
}

/// n.c + p of a normalised scene.
struct PlaneSphere {
  using Words = std::array<std::uint32_t, 7>;  // n c p
  static constexpr const char* kFile = "plane_sphere";
  static constexpr std::array kNames{"distance"};
  static constexpr Words kTops{62, 62, 62, 62, 62, 62, 62};  // largest exponents
  static constexpr std::array kWords{"nx", "ny", "nz", "cx", "cy", "cz", "p"};

  /// Is the vector at k one of a normalised scene?
  static bool valid(const Words& w, std::size_t k) {
    return k == 0   ? is_unit(w, k)
           : k == 3 ? within(w, k, 127.0 / 128)
                    : std::abs(fp24_value(w[k])) <= 255.0 / 256;
  }

  template <typename Real>
  static std::array<Real, 1> exact(const Words& w) {
    return {dot3(vector_of<Real>(w, 0), vector_of<Real>(w, 3)) + static_cast<Real>(fp24_value(w[6]))};
  }

  template <typename F>
  static std::array<double, 1> computed(const Words& w) {
    const PlaneWord<F> plane{model_vector<F>(w, 0), F::from_bits(w[6])};
    return {fp24_value(plane_distance(plane, model_vector<F>(w, 3)).bits())};
  }
};

/// N.D, N.T, u', v', u' + v' of a normalised scene, without the sign rule (which is exact).
struct RayTriangle {
  using Words = std::array<std::uint32_t, 18>;  // V0 O D E1 E2 N
  static constexpr const char* kFile = "ray_triangle";
  static constexpr std::array kNames{"nd", "t", "u", "v", "uv"};
  static constexpr Words kTops{62, 62, 62, 62, 62, 62, 62, 62, 62, 63, 63, 63, 63, 63, 63, 64, 64, 64};
  static constexpr std::array kWords{"v0x", "v0y", "v0z", "ox",  "oy",  "oz",  "dx", "dy", "dz",
                                     "e1x", "e1y", "e1z", "e2x", "e2y", "e2z", "nx", "ny", "nz"};

  /// Is the vector at k one of a normalised scene?
  static bool valid(const Words& w, std::size_t k) {
    constexpr std::array kLimits{0.985, 255.0 / 256, kUnit, 1.97, 1.97, 2.53};
    if (k == 6) {
      return is_unit(w, k);
    }
    if (!within(w, k, kLimits[k / 3])) {
      return false;
    }
    if (k != 9 && k != 12) {
      return true;
    }
    const auto third = minus(vector_of<double>(w, 9), vector_of<double>(w, 12));
    return dot3(third, third) <= 1.97 * 1.97;
  }

  template <typename Real>
  static std::array<Real, 5> exact(const Words& w) {
    const auto d = vector_of<Real>(w, 6);
    const auto n = vector_of<Real>(w, 15);
    const auto t = minus(vector_of<Real>(w, 0), vector_of<Real>(w, 3));
    const Vector<Real> cross{d[1] * t[2] - d[2] * t[1], d[2] * t[0] - d[0] * t[2], d[0] * t[1] - d[1] * t[0]};
    const Real u = dot3(cross, vector_of<Real>(w, 12));
    const Real v = dot3(cross, vector_of<Real>(w, 9));
    return {dot3(n, d), dot3(n, t), u, v, v - u};
  }

  template <typename F>
  static std::array<double, 5> computed(const Words& w) {
    const TriangleWord<F> triangle{model_vector<F>(w, 0), model_vector<F>(w, 9), model_vector<F>(w, 12),
                                   model_vector<F>(w, 15)};
    const Solution<F> s = solve(triangle, model_vector<F>(w, 3), model_vector<F>(w, 6));
    // The sign rule undone: whether it flipped is seen in N.D, which the test computes once more.
    const bool flipped = dot(triangle.n, model_vector<F>(w, 6)).sign();
    const double sign = flipped ? -1 : 1;
    return {sign * fp24_value(s.d.bits()), sign * fp24_value(s.t.bits()), -sign * fp24_value(s.u.bits()),
            sign * fp24_value(s.v.bits()), sign * fp24_value((s.u + s.v).bits())};
  }
};

/// Words of a datapath: random ones, and small changes.
template <typename Datapath>
class Operands {
 public:
  using Words = typename Datapath::Words;

  explicit Operands(std::uint64_t seed) : random_(seed) {}

  /// One vector after the other, each until it is short enough; zeros are valid.
  Words fresh() {
    Words words{};
    for (std::size_t k = 0; k < words.size(); k += 3) {
      do {
        for (std::size_t i = k; i < std::min(k + 3, words.size()); ++i) {
          words[i] = word(i);
        }
      } while (!Datapath::valid(words, k));
    }
    return words;
  }

  /// One to three words changed.
  Words changed(Words words) {
    for (std::uint32_t count = 1 + random_.below(3); count != 0; --count) {
      const std::uint32_t k = random_.below(static_cast<std::uint32_t>(words.size()));
      const std::size_t first = k / 3 * 3;
      const Words before = words;
      do {
        words = before;
        change(words, k);
      } while (!Datapath::valid(words, first));
    }
    return words;
  }

 private:
  std::uint32_t fraction() {
    const std::uint64_t random = random_();
    const auto uniform = static_cast<std::uint32_t>(random & 0xffff);
    const std::uint32_t shift = (random >> 16) & 15;
    switch ((random >> 20) & 7) {
      case 0:  // sparse
        return (uniform << shift) & 0xffffU;
      case 1:  // ends in ones
        return uniform | (0xffffU >> shift);
      case 2:  // just below a power of two
        return 0xffffU - (uniform >> 12);
      case 3:  // just above one
        return uniform >> 12;
      default:
        return uniform;
    }
  }

  std::uint32_t word(std::size_t k) {
    const std::uint64_t random = random_();
    const auto down = static_cast<std::uint32_t>(std::countr_zero(random | (std::uint64_t{1} << 60)));
    const std::uint32_t sign = static_cast<std::uint32_t>(random >> 63) << 23;
    return sign | ((Datapath::kTops[k] - std::min(down, Datapath::kTops[k])) << 16) | fraction();
  }

  void change(Words& words, std::uint32_t k) {
    std::uint32_t& w = words[k];
    switch (random_.below(8)) {
      case 0:
        w = word(k);
        break;
      case 1:
        w = (w & 0xff0000U) | fraction();
        break;
      case 2:
        w ^= 0x800000U;
        break;
      case 3:  // exchanged within a vector
        std::swap(w, words[k / 3 * 3 + (k + 1) % 3 < words.size() ? k / 3 * 3 + (k + 1) % 3 : k]);
        break;
      case 4:
        w ^= std::uint32_t{1} << random_.below(16);
        break;
      default: {  // a step up or down, of any size
        const std::uint32_t step = random_.below(std::uint32_t{1} << (1 + random_.below(16))) + 1;
        const std::uint32_t magnitude = w & 0x7fffffU;
        const bool up = random_.below(2) != 0;
        const std::uint32_t moved = up ? magnitude + step : magnitude - std::min(step, magnitude);
        w = (w & 0x800000U) | std::min(moved, 0x7fffffU);
      }
    }
  }

  Xoshiro random_;
};

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

nlohmann::json proven() { return nlohmann::json::parse(std::ifstream(kBounds / "bounds.json")); }

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

/// What a script takes for granted must hold for the words that its theorem is about.
template <typename Case>
void check_hypotheses(std::uint64_t seed) {
  const Datapath script(Case::kFile);
  Operands<Case> operands(seed);
  std::map<std::string, double> largest;
  for (int k = 0; k < 30'000; ++k) {
    const auto words = operands.fresh();
    std::map<std::string, double> value;
    for (std::size_t i = 0; i < words.size(); ++i) {
      value[Case::kWords[i]] = fp24_value(words[i]);
    }
    for (const auto& [name, a, operation, b] : script.operations) {
      const double x = value.at(a);
      const double y = value.at(b);
      value[name] = operation == "*" ? x * y : operation == "+" ? x + y : x - y;
    }
    const auto check = [&largest](const std::string& name, double magnitude, double limit) {
      ASSERT_LE(magnitude, limit) << name;
      largest[name] = std::max(largest[name], magnitude / limit);
    };
    for (const auto& limits : {script.words, script.exact}) {
      for (const auto& [name, limit] : limits) {
        check(name, std::abs(value.at(name)), limit);
      }
    }
    for (const auto& groups : {script.sums, script.norms}) {
      for (const auto& [names, limit] : groups) {
        double sum = 0;
        std::string group;
        for (const std::string& name : names) {
          const std::size_t minus = name.find('-');
          sum += std::abs(value.at(name.substr(0, minus)) -
                          (minus == std::string::npos ? 0 : value.at(name.substr(minus + 1))));
          group += (group.empty() ? "" : " ") + name;
        }
        check(group, sum, limit);
      }
    }
    ASSERT_FALSE(testing::Test::HasFailure());
  }
  for (const auto& [name, share] : largest) {
    EXPECT_GT(share, 0.6) << name << ": hardly tested";
  }
}

TEST(Bounds, NormalisedWordsMeetTheScriptsHypotheses) {
  check_hypotheses<PlaneSphere>(5);
  check_hypotheses<RayTriangle>(6);
}

}  // namespace
}  // namespace raplas
