// Triangles that are hard to hit, and sets of them that are hard to tell apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "raplas/normalise.hpp"
#include "stress_cases.hpp"

namespace raplas {
namespace {

/// A case of random triangles: `one` makes a triangle from a corner in the ball of radius 0.6.
template <typename One>
StressCase shaped(const std::string& name, const std::string& trap, std::size_t count, double width,
                  const One& one) {
  return {.name = "shape." + name, .trap = trap, .make = [count, width, one](std::size_t rays, Dice& dice) {
            std::vector<Triangle> triangles;
            while (triangles.size() < count) {
              const Triangle t = one(dice.in_ball(0.6), dice);
              if (!is_degenerate(t)) {
                triangles.push_back(t);
              }
            }
            std::vector<Pencil> pencils = pencils_at(triangles, rays, width, dice);
            return input_of(std::move(triangles), std::move(pencils));
          }};
}

/// Longest edge 0.3, `aspect` times as long as high, its third corner at the share `foot` of that edge.
Triangle thin(const glm::dvec3& corner, double aspect, double foot, Dice& dice) {
  constexpr double kLength = 0.3;
  const glm::dvec3 along = dice.on_sphere();
  const glm::dvec3 across = any_across(along, dice)[0];
  return {corner, along * kLength, along * (foot * kLength) + across * (kLength / aspect)};
}

StressCase needles(int power) {
  const double aspect = std::pow(10.0, power);
  return shaped(fmt::format("needles_1e{}", power), fmt::format("10^{} times as long as wide", power), 100,
                0.25,
                [aspect](const glm::dvec3& corner, Dice& dice) { return thin(corner, aspect, 0.02, dice); });
}

StressCase small(int power) {
  const double size = std::ldexp(1.0, power);
  return shaped(fmt::format("small_2^{}", power), fmt::format("edges of 2^{} anywhere in the scene", power),
                200, 4, [size](const glm::dvec3& corner, Dice& dice) {
                  return Triangle{corner, dice.on_sphere() * size, dice.on_sphere() * size};
                });
}

/// Squares of 2 triangles across z, one behind the other.
std::vector<Triangle> layers(std::size_t count, double distance, double tilt) {
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k < count; ++k) {
    const double z = 0.27182 + distance * static_cast<double>(k);
    const glm::dvec3 right(1, 0, tilt * static_cast<double>(k));
    const glm::dvec3 up(0, 1, -tilt * static_cast<double>(k));
    const glm::dvec3 corner = glm::dvec3(-0.5, -0.5, z);
    triangles.push_back({corner, right, right + up});
    triangles.push_back({corner, right + up, up});
  }
  return triangles;
}

/// Looks at squares around (0, 0, 0.25) from below and above.
std::vector<Pencil> facing(std::size_t rays, Dice& dice) {
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays)) {
    const double side = dice.below(2) == 0 ? -0.5 : 0.85;
    const glm::dvec3 origin(dice.uniform(-0.4, 0.4), dice.uniform(-0.4, 0.4), side);
    const glm::dvec3 target(dice.uniform(-0.4, 0.4), dice.uniform(-0.4, 0.4), 0.25);
    pencils.push_back(pencil_towards(origin, target, 0.2, kMaxRows, kMaxColumns, dice));
  }
  return pencils;
}

StressCase layered(int power) {
  const double distance = std::ldexp(1.0, power);
  return {.name = fmt::format("shape.layers_2^{}", power),
          .trap = fmt::format("8 parallel squares 2^{} apart", power),
          .make = [distance](std::size_t rays, Dice& dice) {
            return input_of(layers(8, distance, 0), facing(rays, dice));
          }};
}

StressInput huge_next_to_small(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles{{{-0.9, -0.3, 0.2}, {1.7, 0.1, 0.1}, {0.8, 0.9, -0.2}},
                                  {{0.2, -0.9, -0.3}, {-0.3, 1.7, 0.2}, {0.5, 0.8, 0.4}}};
  const std::vector<Triangle> huge = triangles;
  for (int k = 0; k < 300; ++k) {
    const glm::dvec3 at = point_in(huge[dice.below(2)], dice) + dice.in_ball(0.01);
    triangles.push_back({at, dice.on_sphere() * 0x1p-9, dice.on_sphere() * 0x1p-9});
  }
  std::vector<Pencil> pencils = pencils_at({triangles.begin() + 2, triangles.end()}, rays, 10, dice);
  return input_of(std::move(triangles), std::move(pencils));
}

/// Every other triangle has no area: a point, or all corners on a line. They are dropped as load_scene()
/// does.
StressInput degenerate_dropped(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : random_triangles(150, 0.3, dice)) {
    triangles.insert(triangles.end(), {t, {t.v0, t.e1, t.e1 * 0.5}, {t.v0, glm::dvec3(0), glm::dvec3(0)}});
    triangles.push_back({t.v0, t.e1 * 0x1p-40, t.e2 * 0x1p-40});
  }
  std::erase_if(triangles, is_degenerate);
  std::vector<Pencil> pencils = pencils_at(triangles, rays, 1, dice);
  return input_of(std::move(triangles), std::move(pencils));
}

/// Each triangle four times.
StressInput coincident(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : random_triangles(60, 0.4, dice)) {
    triangles.insert(triangles.end(), 4, t);
  }
  for (std::size_t k = triangles.size(); k > 1; --k) {
    std::swap(triangles[k - 1], triangles[dice.below(k)]);
  }
  std::vector<Pencil> pencils = pencils_at(triangles, rays, 1, dice);
  return input_of(std::move(triangles), std::move(pencils));
}

/// Triangles of one plane over each other; corners are exact, so that ties are.
StressInput coplanar(std::size_t rays, Dice& dice) {
  const auto lattice = [&dice] { return std::round(dice.uniform(-0.6, 0.6) * 1024) / 1024; };
  std::vector<Triangle> triangles;
  while (triangles.size() < 40) {
    const double x = lattice();
    const double y = lattice();
    const Triangle t{{x, y, 0.25}, {lattice() - x, lattice() - y, 0}, {lattice() - x, lattice() - y, 0}};
    if (!is_degenerate(t)) {
      triangles.push_back(t);
    }
  }
  return input_of(std::move(triangles), facing(rays, dice));
}

/// Pairs of triangles that cross each other under a small angle: rays look at where they do.
StressInput interpenetrating(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : random_triangles(50, 0.4, dice)) {
    const glm::dvec3 normal = glm::normalize(glm::cross(t.e1, t.e2));
    const double tilt = std::pow(10.0, dice.uniform(-5, 0)) * glm::length(t.e1);
    triangles.push_back(t);
    triangles.push_back({t.v0 + tilt * normal, t.e1 - 2 * tilt * normal, t.e2 - tilt * normal});
  }
  std::erase_if(triangles, is_degenerate);
  std::vector<Pencil> pencils = pencils_at(triangles, rays, 1, dice);
  return input_of(std::move(triangles), std::move(pencils));
}

/// A square over another one that is tilted by 2^-14, so that they cross.
StressInput nearly_coplanar(std::size_t rays, Dice& dice) {
  return input_of(layers(4, 0, 0x1p-14), facing(rays, dice));
}

}  // namespace

std::vector<StressCase> shape_cases() {
  return {
      needles(3),
      needles(4),
      needles(5),
      needles(6),
      shaped("slivers", "two short edges, angles of 10^-2 to 10^-5", 100, 0.5,
             [](const glm::dvec3& corner, Dice& dice) {
               return thin(corner, std::pow(10.0, dice.uniform(2, 5)), dice.uniform(0, 1), dice);
             }),
      shaped("caps", "an angle of nearly 180 degrees: height 10^-3 of the base", 100, 0.5,
             [](const glm::dvec3& corner, Dice& dice) { return thin(corner, 1000, 0.5, dice); }),
      small(-8),
      small(-12),
      small(-16),
      small(-20),
      {.name = "shape.huge_next_to_small",
       .trap = "two triangles of the scene's size among some of 2^-9",
       .make = huge_next_to_small},
      {.name = "shape.degenerate_dropped",
       .trap = "points, lines and triangles too small for fp24 between others",
       .make = degenerate_dropped},
      {.name = "shape.coincident",
       .trap = "each triangle four times",
       .property = Property::lower_id,
       .make = coincident},
      {.name = "shape.coplanar", .trap = "overlapping triangles of one plane", .make = coplanar},
      {.name = "shape.interpenetrating",
       .trap = "pairs that cross under angles down to 10^-5",
       .make = interpenetrating},
      {.name = "shape.nearly_coplanar", .trap = "squares tilted by 2^-14, crossing", .make = nearly_coplanar},
      layered(-8),
      layered(-12),
      layered(-16),
      layered(-20),
  };
}

}  // namespace raplas
