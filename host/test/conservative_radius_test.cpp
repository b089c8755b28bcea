// No plane that meets a sphere may be lost by the plane-sphere tester's rounding: near-tangent cases.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "raplas/conservative.hpp"
#include "raplas/float.hpp"
#include "raplas/pencil.hpp"

namespace raplas {
namespace {

constexpr std::uint64_t kCases = 10'000'000;
constexpr double kMaxOrigin = 1;
constexpr double kGap = 0x1p-12;

struct Tally {
  std::uint64_t cases = 0;
  std::uint64_t lost = 0;        ///< true hits that the enlarged radius loses
  std::uint64_t lost_bare = 0;   ///< true hits that the bare radius, rounded up, loses
  std::uint64_t false_hits = 0;  ///< spheres that end up to kGap short of the plane, yet are hit
  double used = 0;               ///< largest error as a share of the enlargement
};

/// The tester's arithmetic in its order, with an adder of format F.
template <typename F>
F distance_to(const Plane& plane, const glm::dvec3& c) {
  const auto product = [](double n, double x) { return F::from_double(n) * F::from_double(x); };
  const F sum_xy = product(plane.normal.x, c.x) + product(plane.normal.y, c.y);
  const F sum_zp = product(plane.normal.z, c.z) + F::from_double(plane.offset);
  return sum_xy + sum_zp;
}

template <typename F>
bool meets(F distance, double radius) {
  return distance.magnitude() <= F::from_double_up(radius).magnitude();
}

class Cases {
 public:
  explicit Cases(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int choice(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  glm::dvec3 direction() {
    glm::dvec3 v;
    do {
      v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    } while (glm::length(v) < 0.1);
    return glm::normalize(v);
  }

  /// Inside the ball of kMaxOrigin; some at zero, some on an axis.
  glm::dvec3 origin() {
    switch (choice(6)) {
      case 0:
        return glm::dvec3(0);
      case 1: {
        glm::dvec3 v(0);
        v[choice(3)] = uniform(-1, 1);
        return v;
      }
      default:
        return direction() * uniform(0, 1);
    }
  }

  /// Any grid, one with the axes, or a needle whose planes are nearly parallel.
  Pencil pencil() {
    const glm::dvec3 from = origin();
    const int kind = choice(4);
    glm::dvec3 forward = direction();
    glm::dvec3 right = glm::normalize(glm::cross(forward, direction()));
    if (kind == 0) {
      const int axis = choice(3);
      forward = glm::dvec3(0);
      right = glm::dvec3(0);
      forward[axis] = choice(2) == 0 ? 1 : -1;
      right[(axis + 1) % 3] = 1;
    }
    const glm::dvec3 down = glm::cross(forward, right);
    const double step = kind == 1 ? std::exp2(uniform(-30, -10)) : uniform(0.001, 0.2);
    const double shift = kind == 0 ? 8.0 : uniform(0, 16);
    return make_pencil(from,
                       {from + forward - shift * step * (right + down), down * step, right * step, 16, 16});
  }

  /// A centre of fp24 coordinates near the plane, at a distance of 2^-40 to 1 of it.
  glm::dvec3 centre(const Plane& plane) {
    const glm::dvec3 foot = -plane.offset * plane.normal;
    const glm::dvec3 along = glm::cross(plane.normal, direction());
    const double height = (choice(2) == 0 ? 1 : -1) * std::exp2(uniform(-40, 0));
    const glm::dvec3 c = foot + along * uniform(-1, 1) + height * plane.normal;
    return {Fp24::from_double(c.x).to_double(), Fp24::from_double(c.y).to_double(),
            Fp24::from_double(c.z).to_double()};
  }

 private:
  std::mt19937_64 random_;
};

/// |n.c + p| to 2^-61 of the sum of its terms' magnitudes, which is returned too.
std::pair<long double, long double> exact_distance(const Plane& plane, const glm::dvec3& c) {
  long double sum = plane.offset;
  long double magnitudes = std::abs(plane.offset);
  for (int k = 0; k < 3; ++k) {
    const long double term = static_cast<long double>(plane.normal[k]) * c[k];
    sum += term;
    magnitudes += std::abs(term);
  }
  return {std::abs(sum), magnitudes};
}

template <typename F>
void test_case(const Plane& plane, const glm::dvec3& c, double gap, Tally& tally) {
  const auto [distance, magnitudes] = exact_distance(plane, c);
  // The least double that is certainly not below the distance: the plane meets the sphere, and hardly.
  const long double error = magnitudes * 0x1p-61L;
  const double radius = std::nextafter(static_cast<double>(distance + error), 4.0);
  const F computed = distance_to<F>(plane, c);
  const double enlarged = conservative_radius(c, radius, kMaxOrigin);
  tally.cases += 1;
  tally.lost += meets(computed, enlarged) ? 0U : 1U;
  tally.lost_bare += meets(computed, radius) ? 0U : 1U;
  const double shorter = radius - gap;
  tally.false_hits += shorter > 0 && meets(computed, conservative_radius(c, shorter, kMaxOrigin)) ? 1U : 0U;
  const double overshoot = std::abs(computed.to_double()) - static_cast<double>(distance);
  tally.used = std::max(tally.used, overshoot / (enlarged - radius));
}

template <typename F>
Tally run(std::uint64_t seed) {
  Cases cases(seed);
  Tally tally;
  while (tally.cases < kCases) {
    const Pencil pencil = cases.pencil();
    for (const auto& planes : {pencil.row_planes, pencil.column_planes}) {
      for (const Plane& plane : planes) {
        for (int repeat = 0; repeat < 4; ++repeat) {
          test_case<F>(plane, cases.centre(plane), cases.uniform(0, kGap), tally);
        }
      }
    }
  }
  return tally;
}

void judge(const char* adder, const Tally& tally) {
  fmt::print("radius.cases {} ({} adder)\n", tally.cases, adder);
  fmt::print("radius.lost_hits {}\n", tally.lost);
  fmt::print("radius.lost_hits_bare {}\n", tally.lost_bare);
  fmt::print("radius.false_hits {} (spheres that end 0 to 2^-12 short of the plane)\n", tally.false_hits);
  fmt::print("radius.bound_used {:.3f}\n", tally.used);
  EXPECT_GE(tally.cases, kCases);
  EXPECT_EQ(tally.lost, 0U);
  EXPECT_GT(tally.lost_bare, 0U) << "the cases are too easy: nothing is lost without the enlargement either";
  EXPECT_LE(tally.used, 1.0);
}

/// Writes the figures of both adders together into the file that RAPLAS_FIGURES names, if it is set.
void write_figures(const Tally& a, const Tally& b) {
  const char* path = std::getenv("RAPLAS_FIGURES");
  if (path == nullptr) {
    return;
  }
  const auto figure = [](std::uint64_t value, const char* unit) {
    return nlohmann::ordered_json{{"value", value}, {"unit", unit}, {"command", "make sim"}};
  };
  nlohmann::ordered_json figures;
  figures["radius.cases"] = figure(a.cases + b.cases, "near-tangent cases");
  figures["radius.lost_hits"] = figure(a.lost + b.lost, "hits");
  figures["radius.lost_hits_unenlarged"] = figure(a.lost_bare + b.lost_bare, "hits");
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream file(path);
  file << figures.dump(2) << "\n";
  EXPECT_TRUE(file.good()) << path;
}

TEST(ConservativeRadius, LosesNoTrueHitWithAndWithoutGuardBits) {
  const Tally guarded = run<Fp24>(1);
  const Tally paper = run<Fp24Paper>(2);
  judge("guarded", guarded);
  judge("0 guard bits", paper);
  write_figures(guarded, paper);
}

TEST(ConservativeRadius, CoversUnderflowToZero) {
  // Everything is below the smallest normal number, so the tester finds d = 0 or a flushed sum.
  const Plane plane{{1, 0, 0}, 0x1p-62};
  const glm::dvec3 c(0x1.8p-62, 0, 0);
  const double radius = conservative_radius(c, 0x1.4p-61, kMaxOrigin);
  EXPECT_TRUE(meets(distance_to<Fp24>(plane, c), radius));
  EXPECT_TRUE(meets(distance_to<Fp24Paper>(plane, c), radius));
  EXPECT_GT(conservative_radius(glm::dvec3(0), 0, 0), 0);
}

}  // namespace
}  // namespace raplas
