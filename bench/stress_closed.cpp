// Closed meshes: no ray gets through, and none that leaves the surface of a convex one meets it again.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "raplas/pencil.hpp"
#include "raplas/scene.hpp"
#include "stress_cases.hpp"

namespace raplas {
namespace {

constexpr double kRadius = 0.75;
constexpr double kLargest = 0.97;

using Points = std::function<glm::dvec3(Dice&)>;

struct Shape {
  const char* name;
  std::vector<Triangle> triangles;
  Points inside;         ///< points not too near the surface
  glm::dvec3 middle{0};  ///< a point inside
};

Points in_ball(double radius) {
  return [radius](Dice& dice) { return dice.in_ball(radius * kRadius); };
}

constexpr double kRing = kRadius / 1.5;  ///< of the torus

glm::dvec3 in_tube(Dice& dice) {
  const double turn = dice.uniform(0, 2 * glm::radians(180.0));
  return kRing * glm::dvec3(std::cos(turn), std::sin(turn), 0) + dice.in_ball(0.4 * kRing);
}

std::vector<Shape> shapes() {
  return {{"tetrahedron", triangles_of(tetrahedron(kRadius)), in_ball(0.3)},
          {"cube", triangles_of(cube(kRadius)), in_ball(0.5)},
          {"icosphere", triangles_of(icosphere(kRadius, 2)), in_ball(0.9)},
          {"uv_sphere", triangles_of(uv_sphere(kRadius, 12, 20)), in_ball(0.9)},
          {"torus", triangles_of(torus(kRadius, 24, 12)), in_tube, glm::dvec3(kRing, 0, 0)}};
}

bool faces(const Triangle& t, const glm::dvec3& origin) {
  const glm::dvec3 normal = glm::normalize(glm::cross(t.e1, t.e2));
  return glm::dot(normal, origin - t.v0) > 0.05;
}

StressCase closed(const Shape& shape, bool inside, bool aligned) {
  const auto make = [shape, inside, aligned](std::size_t rays, Dice& dice) {
    const std::vector<Triangle>& triangles = shape.triangles;
    std::vector<Pencil> pencils;
    while (pencils.size() < pencils_of(rays)) {
      // every other aligned pencil starts in the middle, where all is symmetrical
      const bool middle = aligned && pencils.size() % 2 == 0;
      const glm::dvec3 within = middle ? shape.middle : shape.inside(dice);
      const glm::dvec3 origin = inside ? within : dice.uniform(0.85, 0.97) * dice.on_sphere();
      const Triangle& triangle = triangles[dice.below(triangles.size())];
      if (!aligned) {
        pencils.push_back(pencil_towards(origin, point_in(triangle, dice), 0.4, kMaxRows, kMaxColumns, dice));
      } else if (inside || faces(triangle, origin)) {
        pencils.push_back(aligned_pencil(origin, triangle));
      }
    }
    return input_of(triangles, std::move(pencils));
  };
  return {.name = fmt::format("closed.{}_{}_{}", shape.name, inside ? "inside" : "outside",
                              aligned ? "aligned" : "random"),
          .trap = fmt::format("{} from {}, {}", shape.name, inside ? "inside" : "outside",
                              aligned ? "rays exactly through edges and vertices" : "random rays"),
          .property = inside ? Property::inside : Property::outside,
          .aligned = aligned,
          .make = make};
}

double longest_edge(const std::vector<Triangle>& triangles) {
  double longest = 0;
  for (const Triangle& t : triangles) {
    longest = std::max(longest, longest_edge_of(t));
  }
  return longest;
}

/// Half of them near a corner or an edge, where rounding of edges and normal matters most.
glm::dvec3 point_to_leave(const Triangle& t, Dice& dice) {
  const glm::dvec3 point = point_in(t, dice);
  const std::array<glm::dvec3, 3> corners{t.v0, t.v0 + t.e1, t.v0 + t.e2};
  const glm::dvec3 corner = corners[dice.below(3)];
  return dice.below(2) == 0 ? point : glm::mix(corner, point, std::pow(10.0, dice.uniform(-4, 0)));
}

/// Rays that go up from points of a convex surface, lifted by a share of surface_offset(). Row k of a pencil
/// rises by k + 1 of a step of 10^-4 .. 1/2, or, for grazing ones, by k of a step of 10^-5 .. 1/2: row 0 is
/// parallel to the surface. Only the former say which surface they leave.
StressInput rays_up(const std::vector<Triangle>& triangles, double share, bool grazing, std::size_t rays,
                    Dice& dice) {
  const double longest = longest_edge(triangles);
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays)) {
    const Triangle& t = triangles[dice.below(triangles.size())];
    const glm::dvec3 up = glm::normalize(glm::cross(t.e1, t.e2));
    const glm::dvec3 point = point_to_leave(t, dice);
    const glm::dvec3 origin = point + share * surface_offset(glm::length(point), longest) * up;
    const auto [along, side] = any_across(up, dice);
    const glm::dvec3 step = std::pow(10.0, dice.uniform(grazing ? -5 : -4, -0.3)) * up;
    const glm::dvec3 first = origin + along - 0.5 * side + (grazing ? glm::dvec3(0) : step);
    Pencil pencil = make_pencil(origin, {first, step, side / 15.0, kMaxRows, kMaxColumns});
    pencil.front = grazing ? glm::dvec3(0) : up;
    pencil.any_hit = true;
    pencils.push_back(std::move(pencil));
  }
  return input_of(triangles, std::move(pencils));
}

StressCase leaving(const std::string& name, const std::vector<Triangle>& triangles) {
  return {
      .name = "leaves." + name,
      .trap = "rays leave a convex " + name,
      .property = Property::leaves,
      .make = [triangles](std::size_t rays, Dice& dice) { return rays_up(triangles, 1, false, rays, dice); }};
}

/// As before, but nothing is promised of rays that are parallel to the surface.
StressCase grazing(const std::string& name, const std::vector<Triangle>& triangles) {
  return {
      .name = "leaves.grazing_" + name,
      .trap = "also parallel to the surface, and without saying which it is",
      .property = Property::grazes,
      .make = [triangles](std::size_t rays, Dice& dice) { return rays_up(triangles, 1, true, rays, dice); }};
}

/// Origins that are too near the surface. What breaks the property is rare: 8 times the rays of other cases.
StressCase leaving_too_near(const std::string& name, const std::vector<Triangle>& triangles) {
  return {.name = fmt::format("leaves.{}_quarter", name),
          .trap = "grazing, from a quarter of the offset: must be noticed",
          .property = Property::grazes,
          .control = true,
          .make = [triangles](std::size_t rays, Dice& dice) {
            return rays_up(triangles, 1.0 / 4, true, 8 * rays, dice);
          }};
}

/// A cube with one face in 2 * 16 * 16 triangles: small triangles in the planes of large ones.
std::vector<Triangle> patched_cube() {
  constexpr int kParts = 16;
  const std::vector<Triangle> whole = triangles_of(cube(kRadius));
  std::vector<Triangle> triangles(whole.begin() + 1, whole.end());
  const Triangle& large = whole[0];
  for (int r = 0; r < kParts; ++r) {
    for (int c = 0; c < kParts - r; ++c) {
      const glm::dvec3 corner = large.v0 + (double(c) * large.e1 + double(r) * large.e2) / double(kParts);
      const glm::dvec3 right = large.e1 / double(kParts);
      const glm::dvec3 up = large.e2 / double(kParts);
      triangles.push_back({corner, right, up});
      if (r + c < kParts - 1) {
        triangles.push_back({corner + right, up, up - right});
      }
    }
  }
  return triangles;
}

}  // namespace

std::vector<StressCase> closed_cases() {
  std::vector<StressCase> cases;
  for (const bool aligned : {true, false}) {
    for (const Shape& shape : shapes()) {
      for (const bool inside : {true, false}) {
        cases.push_back(closed(shape, inside, aligned));
      }
    }
  }
  const std::vector<Shape> all = shapes();
  for (std::size_t k = 0; k < 4; ++k) {  // the torus is not convex
    cases.push_back(leaving(all[k].name, all[k].triangles));
  }
  const std::vector<Triangle> large = triangles_of(tetrahedron(kLargest));
  cases.push_back(leaving("patched_cube", patched_cube()));
  cases.push_back(leaving("fine_icosphere", triangles_of(icosphere(kLargest, 3))));
  cases.push_back(grazing(all[0].name, all[0].triangles));
  cases.push_back(grazing(all[2].name, all[2].triangles));
  cases.push_back(grazing("large_tetrahedron", large));
  cases.push_back(leaving_too_near("large_tetrahedron", large));
  return cases;
}

}  // namespace raplas
