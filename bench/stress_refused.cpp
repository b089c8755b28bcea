// Input that no device can take: it must end with one line, or, on devices with a larger range, in right
// answers.
#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <utility>

#include "raplas/normalise.hpp"
#include "raplas/pencil.hpp"
#include "stress_cases.hpp"

namespace raplas {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What load_scene() makes of triangles; may throw.
std::vector<Triangle> placed(const std::vector<Triangle>& triangles) {
  std::vector<glm::dvec3> points;
  for (const Triangle& t : triangles) {
    points.insert(points.end(), {t.v0, t.v0 + t.e1, t.v0 + t.e2});
  }
  const Placement place = place_in_ball(points);
  std::vector<Triangle> result;
  std::transform(triangles.begin(), triangles.end(), std::back_inserter(result),
                 [&](const Triangle& t) { return place.triangle(t); });
  return result;
}

/// Random triangles of which `spoil` changes one, then normalised.
template <typename Spoil>
StressCase spoilt(const std::string& name, const std::string& trap, const Spoil& spoil) {
  return {.name = "refused." + name,
          .trap = trap,
          .property = Property::refused,
          .make = [spoil](std::size_t rays, Dice& dice) {
            std::vector<Triangle> triangles = random_triangles(20, 0.3, dice);
            std::vector<Pencil> pencils = pencils_at(triangles, rays, 1, dice);
            spoil(triangles);
            return input_of(placed(triangles), std::move(pencils));
          }};
}

/// Random triangles and pencils, of which `spoil` changes something.
template <typename Spoil>
StressCase given(const std::string& name, const std::string& trap, const Spoil& spoil) {
  return {.name = "refused." + name,
          .trap = trap,
          .property = Property::refused,
          .make = [spoil](std::size_t rays, Dice& dice) {
            std::vector<Triangle> triangles = random_triangles(200, 0.3, dice);
            StressInput input;
            input.scene.pencils = pencils_at(triangles, rays, 1, dice);
            input.scene.triangles = std::move(triangles);
            spoil(input.scene);
            return input;
          }};
}

}  // namespace

std::vector<StressCase> refused_cases() {
  return {
      spoilt("nan_vertex", "a coordinate that is no number", [](auto& t) { t[7].v0.y = kNan; }),
      spoilt("infinite_vertex", "an infinite coordinate", [](auto& t) { t[7].v0.y = kInfinity; }),
      spoilt("overflowing_extent", "an extent whose square is infinite", [](auto& t) { t[7].v0.y = 1e300; }),
      spoilt("no_extent", "all corners in one point",
             [](auto& triangles) {
               for (Triangle& t : triangles) {
                 t = {glm::dvec3(0.25), glm::dvec3(0), glm::dvec3(0)};
               }
             }),
      given("no_triangles", "an empty scene", [](StressScene& s) { s.triangles.clear(); }),
      given("beyond_fp24", "a coordinate of 10^20", [](StressScene& s) { s.triangles[7].v0.y = 1e20; }),
      given("outside_ball", "a vertex 3 from zero", [](StressScene& s) { s.triangles[7].v0.y = 3; }),
      given("origin_far_away", "rays start 100 from zero",
            [](StressScene& s) {
              for (Pencil& pencil : s.pencils) {
                const glm::dvec3 away = 100.0 * glm::normalize(pencil.origin);
                pencil = make_pencil(away, {-0.01 * away, {0.02, 0, 0}, {0, 0.02, 0.001}, 16, 16});
              }
            }),
      given("against_axis", "rays that go against their pencil's axis",
            [](StressScene& s) { s.pencils[0].axis = -s.pencils[0].axis; }),
      given("axis_not_unit", "an axis of length 2", [](StressScene& s) { s.pencils[0].axis *= 2; }),
      given("leaf_too_large", "127 triangles with different corners a leaf", [](StressScene& s) {
        s.tree.leaf_size = 127;
        s.tree.builder = TreeBuilder::median;
      })};
}

}  // namespace raplas
