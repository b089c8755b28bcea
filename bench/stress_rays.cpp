// Rays that are hard to decide, spheres that are hard to meet, and numbers from the ends of fp24's range.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <utility>

#include "raplas/normalise.hpp"
#include "raplas/pencil.hpp"
#include "stress_cases.hpp"

namespace raplas {
namespace {

constexpr double kCell = 1.0 / 16;  ///< of the tiles below

/// The square -0.5 .. 0.5 across z at `z`, in 16 x 16 cells of two triangles; all its numbers are fp24.
std::vector<Triangle> tiles(double z) {
  std::vector<Triangle> triangles;
  const glm::dvec3 right(kCell, 0, 0);
  const glm::dvec3 up(0, kCell, 0);
  for (int y = -8; y < 8; ++y) {
    for (int x = -8; x < 8; ++x) {
      const glm::dvec3 corner(x * kCell, y * kCell, z);
      triangles.push_back({corner, right, right + up});
      triangles.push_back({corner, right + up, up});
    }
  }
  return triangles;
}

/// Rays through points of the tiles: `first` from a corner, in steps along x and y, all in cells.
StressCase on_tiles(std::string name, std::string trap, const glm::dvec2& first, const glm::dvec2& step) {
  return {.name = "rays." + std::move(name),
          .trap = std::move(trap),
          .make = [first, step](std::size_t rays, Dice& dice) {
            std::vector<Pencil> pencils;
            while (pencils.size() < pencils_of(rays)) {
              const double x = static_cast<double>(dice.below(20)) - 10;
              const double y = static_cast<double>(dice.below(20)) - 10;
              const glm::dvec3 origin(static_cast<double>(dice.below(16)) / 16 - 0.5,
                                      static_cast<double>(dice.below(16)) / 16 - 0.5, -0.5);
              pencils.push_back(make_pencil(
                  origin, {kCell * glm::dvec3(x + first.x, y + first.y, 8), kCell * glm::dvec3(0, step.y, 0),
                           kCell * glm::dvec3(step.x, 0, 0), kMaxRows, kMaxColumns}));
            }
            return input_of(tiles(0.5), std::move(pencils));
          }};
}

/// Rays in the line of an edge, towards it, and beside it.
StressInput along_edges(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles = triangles_of(icosphere(0.6, 1));
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays, 5, 5)) {
    const Triangle& t = triangles[dice.below(triangles.size())];
    const glm::dvec3 origin = t.v0 - t.e1 * dice.uniform(0.1, 0.6);
    const auto [down, right] = any_across(t.e1, dice);
    const double step = std::pow(10.0, dice.uniform(-6, -2)) * glm::length(t.e1);
    const glm::dvec3 first = t.v0 + t.e1 - 2 * step * (down + right);
    pencils.push_back(make_pencil(origin, {first, down * step, right * step, 5, 5}));
  }
  return input_of(std::move(triangles), std::move(pencils));
}

/// Rays that come down on the tiles under an angle of 10^-power, turned at random.
StressCase grazing(int power) {
  const double slope = std::pow(10.0, -power);
  return {.name = fmt::format("rays.grazing_1e-{}", power),
          .trap = fmt::format("rays come down under an angle of 10^-{}", power),
          .make = [slope](std::size_t rays, Dice& dice) {
            std::vector<Pencil> pencils;
            while (pencils.size() < pencils_of(rays)) {
              const double turn = dice.uniform(0, 2 * glm::radians(180.0));
              const glm::dvec3 along(std::cos(turn), std::sin(turn), 0);
              const glm::dvec3 side(-along.y, along.x, 0);
              const glm::dvec3 target(dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.3), 0.125);
              const glm::dvec3 origin = target - 0.5 * along + glm::dvec3(0, 0, 0.5 * slope);
              // 1/2 to 3/2 of the angle from row to row
              const glm::dvec3 down(0, 0, -slope / 32);
              pencils.push_back(make_pencil(
                  origin, {target - 0.1 * side - 8.0 * down, down, side / 75.0, kMaxRows, kMaxColumns}));
            }
            return input_of(tiles(0.125), std::move(pencils));
          }};
}

/// Row 8 of each pencil is in the plane of the tiles, the others around it.
StressInput in_plane(std::size_t rays, Dice& dice) {
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays)) {
    const double y = dice.uniform(-0.5, 0.5);
    const glm::dvec3 down(0, 0, std::ldexp(1.0, -2 - static_cast<int>(dice.below(16))));
    pencils.push_back(
        make_pencil({-0.75, y, 0.125},
                    {{0.25, y - 0.25, 0.125 - 8 * down.z}, down, {0, 1.0 / 32, 0}, kMaxRows, kMaxColumns}));
  }
  return input_of(tiles(0.125), std::move(pencils));
}

/// Pencils of any direction from points that `origin` finds on a triangle of a scene.
template <typename Origin>
StressCase starting(const std::string& name, const std::string& trap, const Origin& origin) {
  return {.name = "rays." + name, .trap = trap, .make = [origin](std::size_t rays, Dice& dice) {
            std::vector<Triangle> triangles = random_triangles(200, 0.25, dice);
            std::vector<Pencil> pencils;
            while (pencils.size() < pencils_of(rays)) {
              const glm::dvec3 from = origin(triangles[dice.below(triangles.size())], dice);
              const glm::dvec3 to = glm::length(from) > 1 ? dice.in_ball(0.7) : from + 0.5 * dice.on_sphere();
              pencils.push_back(pencil_towards(from, to, 0.5, kMaxRows, kMaxColumns, dice));
            }
            return input_of(std::move(triangles), std::move(pencils));
          }};
}

/// Pencils of a whole angle between their outermost rows.
StressCase wide(std::string name, double angle) {
  return {.name = "rays.width_" + name,
          .trap = fmt::format("pencils {} wide", name),
          .make = [angle](std::size_t rays, Dice& dice) {
            std::vector<Triangle> triangles = random_triangles(200, 0.2, dice);
            std::vector<Pencil> pencils;
            while (pencils.size() < pencils_of(rays)) {
              const glm::dvec3 origin = dice.in_ball(0.9);
              const glm::dvec3 target = point_in(triangles[dice.below(triangles.size())], dice);
              pencils.push_back(pencil_towards(origin, target, angle, kMaxRows, kMaxColumns, dice));
            }
            return input_of(std::move(triangles), std::move(pencils));
          }};
}

StressCase sized(int rows, int columns) {
  return {.name = fmt::format("rays.pencil_{}x{}", rows, columns),
          .trap = fmt::format("pencils of {} x {} rays", rows, columns),
          .make = [rows, columns](std::size_t rays, Dice& dice) {
            std::vector<Triangle> triangles = random_triangles(200, 0.3, dice);
            std::vector<Pencil> pencils;
            // as many pencils as others have, at most
            while (pencils.size() < std::max(pencils_of(rays), pencils_of(rays / 4, rows, columns))) {
              const glm::dvec3 target = point_in(triangles[dice.below(triangles.size())], dice);
              pencils.push_back(pencil_towards(dice.in_ball(0.9), target, 0.3, rows, columns, dice));
            }
            return input_of(std::move(triangles), std::move(pencils));
          }};
}

/// Two layers of tiles; `far` is at the first one's depth, or 2^-4 .. 2^-20 of it before or behind.
StressInput far_at_surface(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles = tiles(0.25);
  for (const Triangle& t : tiles(0.375)) {
    triangles.push_back(t);
  }
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays)) {
    const glm::dvec3 origin(dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.3), -0.5);
    Pencil pencil = make_pencil(
        origin, {{origin.x - 0.3, origin.y - 0.3, 0.25}, {0, 0.04, 0}, {0.04, 0, 0}, kMaxRows, kMaxColumns});
    const double off =
        std::ldexp(static_cast<double>(dice.below(3)) - 1, -4 - static_cast<int>(dice.below(17)));
    pencil.far = 0.75 * (1 + off);
    pencil.any_hit = dice.below(2) == 0;
    pencils.push_back(pencil);
  }
  return input_of(std::move(triangles), std::move(pencils));
}

StressInput any_hit(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles = random_triangles(200, 0.25, dice);
  std::vector<Pencil> pencils = pencils_at(triangles, rays, 2, dice);
  for (Pencil& pencil : pencils) {
    pencil.any_hit = true;
    pencil.far = dice.uniform(0.1, 2);
  }
  return input_of(std::move(triangles), std::move(pencils));
}

/// Rays that touch leaves' bounding spheres, or the vertices that those touch.
StressInput tangent(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles = random_triangles(300, 0.1, dice);
  TreeOptions single;
  single.leaf_size = 1;
  const SphereTree tree = build_tree(triangles, single);
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays)) {
    const SphereNode& node = tree.scene.nodes[dice.below(tree.scene.nodes.size())];
    const glm::dvec3 out = dice.on_sphere();
    const glm::dvec3 touch = node.centre + node.radius * out;
    const glm::dvec3 along = any_across(out, dice)[0];
    const double width = std::pow(10.0, dice.uniform(-6, -1));
    pencils.push_back(pencil_towards(touch - 0.5 * along, touch, width, kMaxRows, kMaxColumns, dice));
  }
  return input_of(std::move(triangles), std::move(pencils), single);
}

StressInput huge_and_tiny_spheres(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles = random_triangles(8, 0.9, dice);
  for (const Triangle& t : random_triangles(200, 0x1p-10, dice)) {
    triangles.push_back(t);
  }
  std::vector<Pencil> pencils = pencils_at(triangles, rays, 3, dice);
  return input_of(std::move(triangles), std::move(pencils));
}

/// Triangles halve from one to the next towards a point, each in a leaf of its own.
StressInput deep_tree(std::size_t rays, Dice& dice) {
  TreeOptions options;
  options.leaf_size = 1;
  options.width = 2;
  options.root_width = 2;
  const glm::dvec3 end(0.3, -0.2, 0.1);
  std::vector<Triangle> triangles;
  for (int k = 0; k < 300; ++k) {
    const double size = std::ldexp(1.0, -(k % 20));
    const glm::dvec3 at = end + 0.4 * size * dice.on_sphere();
    triangles.push_back({at, 0.2 * size * dice.on_sphere(), 0.2 * size * dice.on_sphere()});
  }
  std::erase_if(triangles, is_degenerate);
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays)) {
    const double width = std::pow(10.0, dice.uniform(-5, 0));
    pencils.push_back(pencil_towards(dice.on_sphere() * 0.9, end, width, kMaxRows, kMaxColumns, dice));
  }
  return input_of(std::move(triangles), std::move(pencils), options);
}

/// 40 triangles of different vertices a leaf: 120 words, a leaf's count reaches 127.
StressInput full_leaves(std::size_t rays, Dice& dice) {
  TreeOptions options;
  options.leaf_size = 40;
  options.builder = TreeBuilder::median;
  std::vector<Triangle> triangles = random_triangles(400, 0.15, dice);
  std::vector<Pencil> pencils = pencils_at(triangles, rays, 1, dice);
  return input_of(std::move(triangles), std::move(pencils), options);
}

StressInput one_triangle(std::size_t rays, Dice& dice) {
  std::vector<Triangle> triangles = random_triangles(1, 0.5, dice);
  std::vector<Pencil> pencils = pencils_at(triangles, rays, 1.5, dice);
  return input_of(std::move(triangles), std::move(pencils));
}

/// Triangles with edges of about `first` and `second` at a distance of about `from` from zero, where the rays
/// start.
StressCase exponents(std::string name, std::string trap, double from, double first, double second) {
  return {.name = "exponent." + std::move(name),
          .trap = std::move(trap),
          .make = [from, first, second](std::size_t rays, Dice& dice) {
            std::vector<Triangle> triangles;
            while (triangles.size() < 60) {
              const Triangle t{from * dice.on_sphere(), first * dice.on_sphere() * dice.uniform(0.5, 1),
                               second * dice.on_sphere() * dice.uniform(0.5, 1)};
              if (!is_degenerate(t)) {
                triangles.push_back(t);
              }
            }
            std::vector<Pencil> pencils;
            while (pencils.size() < pencils_of(rays)) {
              const Triangle& t = triangles[dice.below(triangles.size())];
              // as wide as the longer edge, or as the shorter one
              const double size = dice.below(2) == 0 ? std::max(first, second) : std::min(first, second);
              const double width = std::max(1e-9, 2 * std::atan(size / 2 / from));
              pencils.push_back(pencil_towards(from * 0x1p-4 * dice.on_sphere(), point_in(t, dice), width,
                                               kMaxRows, kMaxColumns, dice));
            }
            return input_of(std::move(triangles), std::move(pencils));
          }};
}

}  // namespace

std::vector<StressCase> ray_cases() {
  const double degree = glm::radians(1.0);
  return {on_tiles("through_vertices", "each ray goes exactly through a vertex", {0, 0}, {1, 1}),
          on_tiles("through_edges", "each ray goes exactly through the middle of an edge", {0.5, 0}, {1, 1}),
          on_tiles("along_rows_of_edges", "each row goes exactly along edges", {0, 0}, {0.3125, 1}),
          on_tiles("through_diagonals", "each ray goes exactly through the middle of a diagonal", {0.5, 0.5},
                   {1, 1}),
          {.name = "rays.along_edges", .trap = "rays in the line of an edge", .make = along_edges},
          grazing(1),
          grazing(2),
          grazing(3),
          grazing(4),
          grazing(5),
          grazing(6),
          {.name = "rays.in_plane", .trap = "a row of rays in the triangles' plane", .make = in_plane},
          starting("from_surface", "rays start in the middle of a triangle",
                   [](const Triangle& t, Dice& dice) { return point_in(t, dice); }),
          starting("from_vertex", "rays start at a vertex",
                   [](const Triangle& t, Dice& /*dice*/) { return t.v0; }),
          starting("from_plane", "rays start beside a triangle, in its plane",
                   [](const Triangle& t, Dice& dice) {
                     return t.v0 - dice.uniform(0, 0.4) * t.e1 + dice.uniform(-0.4, 0.4) * t.e2;
                   }),
          starting("from_inside_spheres", "rays start inside a triangle's bounding sphere",
                   [](const Triangle& t, Dice& dice) {
                     return point_in(t, dice) + dice.in_ball(0.2 * glm::length(t.e1));
                   }),
          starting("from_outside", "rays start 1.9 from zero, far outside the scene",
                   [](const Triangle& /*t*/, Dice& dice) { return 1.9 * dice.on_sphere(); }),
          wide("1e-6_rad", 1e-6),
          wide("1e-4_rad", 1e-4),
          wide("1e-2_rad", 1e-2),
          wide("60_degrees", 60 * degree),
          wide("120_degrees", 120 * degree),
          wide("170_degrees", 170 * degree),
          wide("179.9_degrees", 179.9 * degree),
          sized(1, 1),
          sized(1, 16),
          sized(16, 1),
          {.name = "rays.far_at_surface",
           .trap = "`far` at, before and behind a surface",
           .make = far_at_surface},
          {.name = "rays.any_hit", .trap = "any-hit pencils with a random `far`", .make = any_hit}};
}

std::vector<StressCase> sphere_cases() {
  return {
      {.name = "spheres.tangent", .trap = "rays that touch bounding spheres", .make = tangent},
      {.name = "spheres.huge_and_tiny",
       .trap = "spheres of 0.9 around ones of 2^-10",
       .make = huge_and_tiny_spheres},
      {.name = "spheres.deep_tree", .trap = "spheres that halve 20 times, a binary tree", .make = deep_tree},
      {.name = "spheres.full_leaves", .trap = "120 vertex words a leaf", .make = full_leaves},
      {.name = "spheres.one_triangle", .trap = "nothing but one triangle", .make = one_triangle},
  };
}

std::vector<StressCase> exponent_cases() {
  return {exponents("edges_2^-24", "edges of 2^-24 around zero", 0x1p-22, 0x1p-24, 0x1p-24),
          exponents("edges_2^-30", "normals of 2^-60, 4 times the least fp24", 0x1p-28, 0x1p-30, 0x1p-30),
          exponents("edges_0.5_and_2^-58", "an edge of 1/2 and one near the least fp24", 0.5, 0.5, 0x1p-58),
          exponents("edges_2^-15_and_2^-45", "normals near the least fp24 from unequal edges", 0.25, 0x1p-15,
                    0x1p-45),
          exponents("largest", "edges nearly as long as the scene", 0.6, 0.35, 0.35)};
}

}  // namespace raplas
