// Do the scripts of formal/bounds have the model's operations, and do normalised words keep to what they take
// for granted?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "datapath_script.hpp"
#include "normalised.hpp"
#include "raplas/plane_sphere.hpp"
#include "raplas/ray_triangle.hpp"

namespace raplas {
namespace {

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
  EXPECT_EQ(plane_distance(plane, symbols("c")).term, DatapathScript("plane_sphere").term("d"));
}

TEST(Bounds, RayTriangleScriptHasTheModelsOperations) {
  const DatapathScript script("ray_triangle");
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

/// What a script takes for granted must hold for the words that its theorem is about.
template <typename Case>
void check_hypotheses(std::uint64_t seed) {
  const DatapathScript script(Case::kFile);
  Operands<Case> operands(seed);
  std::map<std::string, double> largest;
  for (int k = 0; k < 30'000; ++k) {
    const auto words = operands.fresh();
    std::map<std::string, double> value;
    for (std::size_t i = 0; i < words.size(); ++i) {
      value[Case::kWords[i]] = value_of(words[i]);
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
