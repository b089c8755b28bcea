// Metamorphic cases: what is done to a scene must not change what is seen.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <numeric>
#include <utility>

#include "raplas/normalise.hpp"
#include "raplas/pencil.hpp"
#include "stress_cases.hpp"

namespace raplas {
namespace {

/// A pencil to be: grids go through the same maps as points do.
struct View {
  glm::dvec3 origin;
  Grid grid;
};

/// A scene in its file's coordinates.
struct RawScene {
  std::vector<std::array<glm::dvec3, 3>> corners;
  std::vector<View> views;
};

using Map = std::function<glm::dvec3(const glm::dvec3&)>;
using Linear = std::function<glm::dvec3(const glm::dvec3&)>;

/// A turned torus, a sphere in its hole and random triangles around them.
RawScene raw_scene(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles = triangles_of(torus(0.9, 20, 10));
  for (const auto& more : {triangles_of(icosphere(0.25, 1)), random_triangles(60, 0.3, dice)}) {
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  const auto point = [&](const glm::dvec3& p) { return glm::dvec3(turned * glm::dvec4(p, 1)); };
  RawScene raw;
  for (const Triangle& t : triangles) {
    raw.corners.push_back({point(t.v0), point(t.v0 + t.e1), point(t.v0 + t.e2)});
  }
  while (raw.views.size() < pencils_of(rays)) {
    const glm::dvec3 origin = dice.on_sphere() * 0.95;
    const glm::dvec3 forward = dice.in_ball(0.5) - origin;
    const auto [down, right] = any_across(forward, dice);
    const double step = 0.02;
    raw.views.push_back(
        {origin,
         {origin + forward - 7.5 * step * (down + right), down * step, right * step, kMaxRows, kMaxColumns}});
  }
  return raw;
}

/// What load_scene() makes of it.
StressScene placed(const RawScene& raw) {
  std::vector<glm::dvec3> points;
  for (const auto& corners : raw.corners) {
    points.insert(points.end(), corners.begin(), corners.end());
  }
  for (const View& view : raw.views) {
    points.push_back(view.origin);
  }
  const Placement place = place_in_ball(points);
  StressScene scene;
  for (const auto& [a, b, c] : raw.corners) {
    scene.triangles.push_back(place.triangle({a, b - a, c - a}));
  }
  for (const View& view : raw.views) {
    const Grid& grid = view.grid;
    scene.pencils.push_back(
        make_pencil(place.point(view.origin), {place.point(grid.first), grid.row_step * place.scale,
                                               grid.column_step * place.scale, grid.rows, grid.columns}));
  }
  return scene;
}

std::vector<std::uint32_t> identity(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

/// All points by `point`, all differences by `vector`.
StressInput mapped(std::size_t rays, Dice& dice, const Map& point, const Linear& vector) {
  RawScene raw = raw_scene(rays, dice);
  StressInput input;
  input.base = placed(raw);
  for (auto& corners : raw.corners) {
    std::transform(corners.begin(), corners.end(), corners.begin(), point);
  }
  for (View& view : raw.views) {
    view = {point(view.origin),
            {point(view.grid.first), vector(view.grid.row_step), vector(view.grid.column_step),
             view.grid.rows, view.grid.columns}};
  }
  input.scene = placed(raw);
  input.base_of = identity(input.scene.triangles.size());
  return input;
}

StressCase translated(int power) {
  const double far = std::pow(10.0, power);
  return {.name = fmt::format("moved.translated_1e{}", power),
          .trap = fmt::format("10^{} extents away from zero before it is loaded", power),
          .property = Property::moved,
          .make = [far](std::size_t rays, Dice& dice) {
            const glm::dvec3 by = far * glm::dvec3(1, -0.7, 0.4);
            return mapped(
                rays, dice, [by](const glm::dvec3& p) { return p + by; },
                [](const glm::dvec3& v) { return v; });
          }};
}

StressCase linear(std::string name, std::string trap, const glm::dmat3& matrix) {
  return {.name = "moved." + std::move(name),
          .trap = std::move(trap),
          .property = Property::moved,
          .make = [matrix](std::size_t rays, Dice& dice) {
            const auto by = [matrix](const glm::dvec3& p) { return matrix * p; };
            return mapped(rays, dice, by, by);
          }};
}

StressCase scaled(int power) {
  return linear(fmt::format("scaled_1e{}", power),
                fmt::format("10^{} times as large before it is loaded", power),
                glm::dmat3(std::pow(10.0, power)));
}

StressCase rotated(double degrees) {
  const glm::dmat4 turn =
      glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(glm::dvec3(1, -2, 0.5)));
  return linear(fmt::format("rotated_{}", degrees), fmt::format("turned by {} degrees", degrees),
                glm::dmat3(turn));
}

/// Corners of each triangle in another order.
StressCase reordered(std::string name, std::string trap, const std::array<std::size_t, 3>& order) {
  return {.name = "moved." + std::move(name),
          .trap = std::move(trap),
          .property = Property::moved,
          .make = [order](std::size_t rays, Dice& dice) {
            RawScene raw = raw_scene(rays, dice);
            StressInput input;
            input.base = placed(raw);
            for (auto& corners : raw.corners) {
              corners = {corners[order[0]], corners[order[1]], corners[order[2]]};
            }
            input.scene = placed(raw);
            input.base_of = identity(input.scene.triangles.size());
            return input;
          }};
}

StressInput shuffled(std::size_t rays, Dice& dice) {
  StressInput input;
  input.base = placed(raw_scene(rays, dice));
  input.scene = input.base;
  input.base_of = identity(input.scene.triangles.size());
  for (std::size_t k = input.base_of.size(); k > 1; --k) {
    std::swap(input.base_of[k - 1], input.base_of[dice.below(k)]);
  }
  for (std::size_t k = 0; k < input.base_of.size(); ++k) {
    input.scene.triangles[k] = input.base.triangles[input.base_of[k]];
  }
  return input;
}

StressInput other_tree(std::size_t rays, Dice& dice) {
  StressInput input;
  input.base = placed(raw_scene(rays, dice));
  input.scene = input.base;
  input.scene.tree.builder = TreeBuilder::median;
  input.scene.tree.leaf_size = 1;
  input.scene.tree.width = 2;
  input.base_of = identity(input.scene.triangles.size());
  return input;
}

}  // namespace

std::vector<StressCase> moved_cases() {
  const glm::dmat3 permuted(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0));
  const glm::dmat3 mirrored(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1));
  return {translated(0),
          translated(3),
          translated(5),
          translated(7),
          scaled(-6),
          scaled(-3),
          scaled(3),
          scaled(6),
          rotated(1),
          rotated(30),
          rotated(45),
          rotated(90),
          linear("axes_permuted", "x, y, z become y, z, x", permuted),
          linear("mirrored", "x becomes -x", mirrored),
          reordered("corners_rotated", "each triangle starts at its next corner", {1, 2, 0}),
          reordered("winding_reversed", "each triangle seen from its other side", {0, 2, 1}),
          {.name = "moved.triangles_permuted",
           .trap = "triangles in another order",
           .property = Property::same_hits,
           .make = shuffled},
          {.name = "moved.other_tree",
           .trap = "another builder, one triangle a leaf",
           .property = Property::same_hits,
           .make = other_tree}};
}

}  // namespace raplas
