// No plane that meets a sphere may be lost by the plane-sphere tester's rounding: near-tangent cases of
// several families, and the proved bounds against the stored radius. RAPLAS_CASES: cases of both adders
// together, for a long run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exact_distance.hpp"
#include "figures.hpp"
#include "random.hpp"
#include "raplas/conservative.hpp"
#include "raplas/encode.hpp"
#include "raplas/float.hpp"
#include "raplas/pencil.hpp"

namespace raplas {
namespace {

constexpr std::uint64_t kCases = 20'000'000;

/// What is hard about a case.
enum class Family : int {
  tangent,
  far_origin,
  tiny_radius,
  huge_radius,
  needle,
  axis,
  edge_of_scene,
  underflow,
  climb
};
constexpr std::array kFamilyNames{"tangent", "far_origin",    "tiny_radius", "huge_radius", "needle",
                                  "axis",    "edge_of_scene", "underflow",   "climb"};
constexpr int kFamilies = static_cast<int>(kFamilyNames.size());

/// Of one adder in one family.
struct Tally {
  std::uint64_t cases = 0;
  std::uint64_t lost = 0;       ///< true hits that the enlarged radius loses
  std::uint64_t lost_bare = 0;  ///< true hits that the bare radius, rounded up, loses
  double used = 0;              ///< largest error as a share of the enlargement

  Tally& operator+=(const Tally& other) {
    cases += other.cases;
    lost += other.lost;
    lost_bare += other.lost_bare;
    used = std::max(used, other.used);
    return *this;
  }
};

template <typename F>
PlaneWord<F> encode_plane(const Plane& plane) {
  return {encode<F>(plane.normal, "normal"), F::from_double(plane.offset)};
}

/// The tester's distance, exactly as a double.
template <typename F>
double distance_to(const PlaneWord<F>& plane, const Vec3<F>& c) {
  return std::abs(plane_distance(plane, c).to_double());
}

/// distance <= the radius rounded up to fp24; distance is an fp24 number.
bool meets(double distance, double radius) {
  return distance <= radius || distance <= Fp24::from_double_up(radius).to_double();
}

/// A plane, and how far from zero its pencil's origin may be.
struct TestPlane {
  Plane plane;
  double max_origin = 1;
};

class Cases {
 public:
  explicit Cases(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  std::uint32_t choice(std::uint32_t count) { return random_.below(count); }
  double sign() { return choice(2) == 0 ? 1 : -1; }

  /// +-2^low .. 2^high, all binades alike.
  double scaled(int low, int high) {
    return sign() *
           std::ldexp(uniform(1, 2), low + static_cast<int>(choice(static_cast<std::uint32_t>(high - low))));
  }

  glm::dvec3 direction() {
    glm::dvec3 v;
    double length2 = 0;
    do {
      v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      length2 = glm::dot(v, v);
    } while (length2 < 0.01 || length2 > 1);
    return v / std::sqrt(length2);
  }

  glm::dvec3 axis() {
    glm::dvec3 v(0);
    v[static_cast<int>(choice(3))] = sign();
    return v;
  }

  /// Planes of a pencil of this family.
  void planes(Family family, std::vector<TestPlane>& out) {
    out.clear();
    glm::dvec3 forward = direction();
    glm::dvec3 right = glm::normalize(glm::cross(forward, direction()));
    double reach = 1;
    double step = uniform(0.001, 0.2);
    double shift = uniform(0, 16);
    if (family == Family::far_origin) {
      reach = std::abs(scaled(4, 30));
    } else if (family == Family::underflow) {
      reach = std::abs(scaled(-63, -40));
    } else if (family == Family::needle) {
      step = std::abs(scaled(-40, -10));
    } else if (family == Family::axis) {
      forward = axis();
      const glm::dvec3 other = axis();
      right = glm::dot(other, forward) == 0 ? other : glm::dvec3(forward.y, forward.z, forward.x);
      shift = 8;
    }
    const glm::dvec3 origin = choice(8) == 0   ? glm::dvec3(0)
                              : choice(4) == 0 ? axis() * (reach * uniform(0, 1))
                              : choice(2) == 0 ? direction() * reach
                                               : direction() * (reach * uniform(0, 1));
    const glm::dvec3 down = glm::cross(forward, right);
    const Pencil pencil = make_pencil(origin, {origin + reach * (forward - shift * step * (right + down)),
                                               reach * down * step, reach * right * step, 8, 8});
    for (const auto& set : {pencil.row_planes, pencil.column_planes}) {
      for (const Plane& plane : set) {
        // at large distances the double n and p are of the exact plane to 2^-40 relative, as is claimed
        out.push_back({plane, reach});
      }
    }
  }

  /// A centre near the plane, at a distance that suits the family.
  glm::dvec3 centre(Family family, const TestPlane& t) {
    const Plane& plane = t.plane;
    const glm::dvec3 foot = -plane.offset * plane.normal;
    const glm::dvec3 along = glm::cross(plane.normal, direction());
    double reach = 1;
    double height = scaled(-40, 0);
    switch (family) {
      case Family::far_origin:
        reach = choice(2) == 0 ? 1 : t.max_origin;
        height = scaled(-30, 30);
        break;
      case Family::tiny_radius:
        height = choice(16) == 0 ? 0 : scaled(-60, -20);
        break;
      case Family::huge_radius:
        reach = std::abs(scaled(0, 40));
        height = scaled(0, 40);
        break;
      case Family::underflow:
        reach = t.max_origin;
        height = choice(4) == 0 ? 0 : scaled(-64, -40);
        break;
      default:
        break;
    }
    const bool far =
        family == Family::edge_of_scene;  // as far from zero as a scene goes, where errors are largest
    const double stretch =
        far ? sign() * std::sqrt(std::max(0.0, 1 - plane.offset * plane.offset)) : uniform(-1, 1);
    return foot + along * (reach * stretch) + height * plane.normal;
  }

  /// A centre that differs a little.
  Vec3<Fp24> changed(Vec3<Fp24> v) {
    for (std::uint32_t count = 1 + choice(2); count != 0; --count) {
      Fp24& x = choice(3) == 0 ? v.x : choice(2) == 0 ? v.y : v.z;
      const std::uint32_t bits = choice(8) == 0 ? 0x800000U : std::uint32_t{1} << choice(17);
      const std::uint32_t step = choice(std::uint32_t{1} << (1 + choice(16)));
      const std::uint32_t moved = choice(2) == 0   ? x.bits() ^ bits
                                  : choice(2) == 0 ? x.bits() + step
                                                   : x.bits() - step;
      // not beyond 2, nor from one end of the range to the other
      x = ((moved ^ x.bits()) & 0x400000U) == 0 && (moved & 0x7fffffU) < 0x400000U
              ? Fp24::from_bits(moved & 0xffffffU)
              : x;
    }
    return v;
  }

  /// Sometimes with fractions of zeros and ones at their ends.
  Vec3<Fp24> words(const glm::dvec3& c) {
    Vec3<Fp24> v = encode<Fp24>(c, "centre");
    if (choice(4) == 0) {
      Fp24& x = choice(3) == 0 ? v.x : choice(2) == 0 ? v.y : v.z;
      const std::uint32_t low = 0xffffU >> choice(16);
      x = Fp24::from_bits(choice(2) == 0 ? x.bits() | low : x.bits() & ~low);
    }
    return v;
  }

 private:
  Xoshiro random_;
};

/// A sphere that the plane touches: what each adder makes of it.
struct Contact {
  double radius;
  double enlarged;

  Contact(const TestPlane& t, const glm::dvec3& c) {
    const auto [distance, magnitudes] = exact_distance(t.plane, c);
    // The least double that is certainly not below the distance: the plane meets the sphere, and hardly.
    const auto touching = static_cast<double>(distance + magnitudes * 0x1p-61L);
    radius = std::nextafter(touching, HUGE_VAL);
    enlarged = conservative_radius(c, radius, t.max_origin);
  }

  /// Returns the share of the enlargement that the error used.
  double judge(double computed, Tally& tally) const {
    tally.cases += 1;
    tally.lost += meets(computed, enlarged) ? 0U : 1U;
    tally.lost_bare += meets(computed, radius) ? 0U : 1U;
    const double used = (computed - radius) / (enlarged - radius);
    tally.used = std::max(tally.used, used);
    return used;
  }
};

TEST(ConservativeRadius, LosesNoTrueHitWithAndWithoutGuardBits) {
  const std::uint64_t cases = number_of_cases(kCases) / 2;  // each for both adders
  std::array<Tally, kFamilies> guarded;
  std::array<Tally, kFamilies> paper;
  Cases random(1);
  std::vector<TestPlane> planes;
  for (std::uint64_t done = 0, pencil = 0; done < cases; ++pencil) {
    const auto family = static_cast<Family>(pencil % kFamilies);
    random.planes(family, planes);
    int repeats = 4;
    if (family ==
        Family::climb) {  // one plane, and a centre that is changed as long as errors don't get smaller
      planes.resize(1);
      repeats = 512;
    }
    for (const TestPlane& t : planes) {
      const auto plane = encode_plane<Fp24>(t.plane);
      const auto plane_paper = encode_plane<Fp24Paper>(t.plane);
      Vec3<Fp24> best{};
      double height = -HUGE_VAL;
      for (int repeat = 0; repeat < repeats; ++repeat, ++done) {
        const bool climbs = family == Family::climb && repeat > 0;
        const Vec3<Fp24> c = climbs ? random.changed(best) : random.words(random.centre(family, t));
        const Vec3<Fp24Paper> c_paper{Fp24Paper::from_bits(c.x.bits()), Fp24Paper::from_bits(c.y.bits()),
                                      Fp24Paper::from_bits(c.z.bits())};
        const Contact contact(t, decode(c));
        const double used = contact.judge(distance_to(plane, c), guarded[pencil % kFamilies]);
        const double used_paper = contact.judge(distance_to(plane_paper, c_paper), paper[pencil % kFamilies]);
        const double here = pencil % 2 == 0 ? used : used_paper;
        if (here >= height) {
          best = c;
          height = here;
        }
      }
    }
  }
  Figures figures;
  Tally both;
  for (const auto& [adder, tallies] : {std::pair{"guarded", guarded}, std::pair{"paper", paper}}) {
    Tally total;
    for (std::size_t k = 0; k < tallies.size(); ++k) {
      const Tally& t = tallies[k];
      fmt::print(
          "radius {:8} {:14} cases {:10} lost_hits {} without the enlargement {:9} bound_used {:.3f}\n",
          adder, kFamilyNames[k], t.cases, t.lost, t.lost_bare, t.used);
      EXPECT_GT(t.cases, 0U);
      EXPECT_EQ(t.lost, 0U);
      EXPECT_GT(t.lost_bare, 0U) << "too easy: nothing is lost without the enlargement either";
      EXPECT_LE(t.used, 1.0);
      total += t;
    }
    EXPECT_GE(total.cases, cases);
    const std::string prefix = std::string("radius.") + adder;
    figures.add(prefix + ".cases", total.cases, "near-tangent cases");
    figures.add(prefix + ".lost_hits", total.lost, "hits");
    figures.add(prefix + ".bound_used", total.used, "of the enlargement");
    both += total;
  }
  for (std::size_t k = 0; k < guarded.size(); ++k) {
    figures.add(std::string("radius.cases.") + kFamilyNames[k], guarded[k].cases + paper[k].cases,
                "near-tangent cases");
  }
  fmt::print("checked {} cases\n", both.cases);
  figures.add("radius.cases", both.cases, "near-tangent cases");
  figures.add("radius.lost_hits", both.lost, "hits");
  figures.add("radius.lost_hits_unenlarged", both.lost_bare, "hits");
  figures.write();
}

TEST(ConservativeRadius, CoversUnderflowToZero) {
  // Everything is below the smallest normal number, so the tester finds d = 0 or a flushed sum.
  const Plane plane{{1, 0, 0}, 0x1p-62};
  const glm::dvec3 c(0x1.8p-62, 0, 0);
  const double radius = conservative_radius(c, 0x1.4p-61, 1);
  EXPECT_TRUE(meets(distance_to(encode_plane<Fp24>(plane), encode<Fp24>(c, "centre")), radius));
  EXPECT_TRUE(meets(distance_to(encode_plane<Fp24Paper>(plane), encode<Fp24Paper>(c, "centre")), radius));
  EXPECT_GT(conservative_radius(glm::dvec3(0), 0, 0), 0);
}

TEST(ConservativeRadius, DominatesTheProvenErrors) {
  std::ifstream file(std::filesystem::path(RAPLAS_BOUNDS) / "bounds.json");
  const nlohmann::json bounds = nlohmann::json::parse(file);
  const double factor = bounds.at("radius_factor").at("both");
  const double underflow = bounds.at("radius_underflow").at("both");
  const double underflow_normal = bounds.at("radius_underflow_normal").at("both");
  Cases random(2);
  for (int k = 0; k < 1'000'000; ++k) {
    const glm::dvec3 c = random.direction() * random.scaled(-70, 50);
    const double max_origin = std::abs(random.scaled(-70, 50));
    // radii that leave the enlargement most of its bits
    const double radius = random.choice(2) == 0 ? 0 : std::abs(random.scaled(-80, -10)) * glm::length(c);
    const double norm1 = std::abs(c.x) + std::abs(c.y) + std::abs(c.z);
    const double needed = factor * (glm::length(c) + std::min(max_origin, radius + glm::length(c))) +
                          (underflow + underflow_normal * norm1) * 0x1p-62;
    // 2^-20: what n and p in double precision, and this sum, are not exact by (docs/radius.md)
    ASSERT_GE(conservative_radius(c, radius, max_origin) - radius, needed * (1 + 0x1p-20))
        << c.x << " " << c.y << " " << c.z << " r " << radius << " max_origin " << max_origin;
  }
}

}  // namespace
}  // namespace raplas
