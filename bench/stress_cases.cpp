#include "stress_cases.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <utility>

namespace raplas {

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all;
  for (const auto group :
       {closed_cases, moved_cases, shape_cases, ray_cases, sphere_cases, exponent_cases, refused_cases}) {
    std::vector<StressCase> cases = group();
    std::move(cases.begin(), cases.end(), std::back_inserter(all));
  }
  return all;
}

std::size_t pencils_of(std::size_t rays, int rows, int columns) {
  return std::max(std::size_t{1}, rays / static_cast<std::size_t>(rows * columns));
}

double longest_edge_of(const Triangle& t) {
  return std::max({glm::length(t.e1), glm::length(t.e2), glm::distance(t.e1, t.e2)});
}

std::vector<Pencil> pencils_at(const std::vector<Triangle>& triangles, std::size_t rays, double width,
                               Dice& dice) {
  constexpr double kOrigins = 0.95;  // radius of the ball of origins
  constexpr double kNear = 0x1p-8;   // no origin is nearer to its target
  constexpr double kNarrowest = 1e-9;
  std::vector<Pencil> pencils;
  while (pencils.size() < pencils_of(rays)) {
    const Triangle& triangle = triangles[dice.below(triangles.size())];
    const glm::dvec3 target = point_in(triangle, dice);
    const glm::dvec3 origin = dice.in_ball(kOrigins);
    const double distance = glm::distance(origin, target);
    if (distance < kNear) {
      continue;
    }
    const double longest = longest_edge_of(triangle);
    const double height = glm::length(glm::cross(triangle.e1, triangle.e2)) / longest;
    const double size = dice.below(2) == 0 ? longest : height;
    const double angle = std::max(kNarrowest, 2 * std::atan(width * size / 2 / distance));
    pencils.push_back(pencil_towards(origin, target, angle, kMaxRows, kMaxColumns, dice));
  }
  return pencils;
}

StressInput input_of(std::vector<Triangle> triangles, std::vector<Pencil> pencils, const TreeOptions& tree) {
  StressInput input;
  input.scene = {std::move(triangles), std::move(pencils), tree};
  return input;
}

}  // namespace raplas
