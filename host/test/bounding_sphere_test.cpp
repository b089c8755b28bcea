// Balls against brute force over all sets of points that may lie on their surface.
#include "raplas/bounding_sphere.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <random>
#include <vector>

namespace raplas {
namespace {

using Points = std::vector<glm::dvec3>;

/// The ball with the points on its surface and its centre in their hull's plane, from the linear equations
/// 2 (p_k - p_0).(c - p_0) = |p_k - p_0|^2 with c - p_0 a sum of such differences. Radius -1 if singular.
Ball through(const Points& points) {
  const std::size_t n = points.size() - 1;
  std::array<glm::dvec3, 3> d{};
  for (std::size_t k = 0; k < n; ++k) {
    d.at(k) = points[k + 1] - points[0];
  }
  glm::dmat3 gram(1);
  glm::dvec3 right(0);
  for (std::size_t k = 0; k < n; ++k) {
    right[static_cast<int>(k)] = glm::dot(d.at(k), d.at(k)) / 2;
    for (std::size_t i = 0; i < n; ++i) {
      gram[static_cast<int>(k)][static_cast<int>(i)] = glm::dot(d.at(k), d.at(i));
    }
  }
  double scale = 1;
  for (std::size_t k = 0; k < n; ++k) {
    scale *= glm::dot(d.at(k), d.at(k));
  }
  if (!(std::abs(glm::determinant(gram)) > 1e-18 * scale)) {
    return {};
  }
  const glm::dvec3 weights = glm::inverse(gram) * right;
  const glm::dvec3 offset = weights.x * d[0] + weights.y * d[1] + weights.z * d[2];
  return {points[0] + offset, glm::length(offset)};
}

/// The smallest of the balls through 1 to 4 of the points that enclose all.
double brute_force_radius(const Points& points) {
  double best = std::numeric_limits<double>::infinity();
  const auto try_ball = [&](const Points& support) {
    const Ball ball = through(support);
    if (ball.radius < 0 || ball.radius >= best) {
      return;
    }
    for (const glm::dvec3& p : points) {
      if (glm::distance(p, ball.centre) > ball.radius + 1e-9) {
        return;
      }
    }
    best = ball.radius;
  };
  for (std::size_t a = 0; a < points.size(); ++a) {
    try_ball({points[a]});
    for (std::size_t b = 0; b < a; ++b) {
      try_ball({points[a], points[b]});
      for (std::size_t c = 0; c < b; ++c) {
        try_ball({points[a], points[b], points[c]});
        for (std::size_t d = 0; d < c; ++d) {
          try_ball({points[a], points[b], points[c], points[d]});
        }
      }
    }
  }
  return best;
}

TEST(BoundingBall, KnownShapesAndPointsOnASphere) {
  const Points pair{{0, 0, 0}, {2, 0, 0}};
  EXPECT_NEAR(bounding_ball(pair).radius, 1, 1e-12);
  const double h = std::sqrt(3.0);
  const Points triangle{{-1, 0, 0}, {1, 0, 0}, {0, h, 0}, {0, h / 3, 0.1}};
  EXPECT_NEAR(bounding_ball(triangle).radius, 2 / h, 1e-9);
  const Points obtuse{{-2, 0, 0}, {2, 0, 0}, {0, 0.1, 0}};
  EXPECT_NEAR(bounding_ball(obtuse).radius, 2, 1e-9);
  const Points tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(bounding_ball(tetrahedron).radius, h, 1e-9);
  EXPECT_NEAR(bounding_ball(Points(5, glm::dvec3(1, 2, 3))).radius, 0, 1e-12);

  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    // On a sphere of radius 1: from some points on no ball is much smaller.
    Points points;
    for (int i = 0; i < 5 + k; ++i) {
      points.push_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))) + 3.0);
    }
    const Ball ball = bounding_ball(points);
    EXPECT_LE(ball.radius, 1 + 1e-12);
    const double enclosing = enclosing_radius(points, ball.centre);
    for (const glm::dvec3& p : points) {
      EXPECT_LE(glm::distance(p, ball.centre), enclosing);
    }
  }
}

TEST(BoundingBall, IsAsSmallAsBruteForceFindsIt) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::uniform_int_distribution<int> coarse(-2, 2);
  int checked = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::size_t count = 1 + static_cast<std::size_t>(k) % 14;
    const int shape = k / 14 % 4;
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 p(uniform(random), uniform(random), uniform(random));
      switch (shape) {
        case 0:  // a cloud
          points.push_back(p);
          break;
        case 1:  // many on one sphere, in one plane or equal
          points.emplace_back(coarse(random), coarse(random), coarse(random));
          break;
        case 2:  // nearly flat
          points.emplace_back(p.x, p.y, p.z * 1e-7);
          break;
        default:  // nearly a line
          points.emplace_back(p.x, p.x + p.y * 1e-5, 0.5);
      }
    }
    const Ball ball = bounding_ball(points);
    EXPECT_NEAR(ball.radius, brute_force_radius(points), 1e-8) << "case " << k;
    for (const glm::dvec3& p : points) {
      EXPECT_LE(glm::distance(p, ball.centre), ball.radius * (1 + 1e-15));
    }
    ++checked;
  }
  fmt::print("bounding_sphere.balls_checked {}\n", checked);
}

TEST(BoundingBall, OfManyPointsTouchesPointsAllAround) {
  // A ball is the smallest one exactly if its centre is in the hull of the points on its surface: no
  // direction leads away from all of them.
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 20; ++k) {
    Points points;
    for (int i = 0; i < 20000; ++i) {
      points.emplace_back(normal(random), 2 * normal(random), 0.5 * normal(random));
    }
    const Ball ball = bounding_ball(points);
    Points surface;
    for (const glm::dvec3& p : points) {
      EXPECT_LE(glm::distance(p, ball.centre), ball.radius * (1 + 1e-15));
      if (glm::distance(p, ball.centre) > ball.radius * (1 - 1e-12)) {
        surface.push_back(p - ball.centre);
      }
    }
    EXPECT_GE(surface.size(), 2U);
    EXPECT_NEAR(brute_force_radius(surface), ball.radius, 1e-8);
  }
}

}  // namespace
}  // namespace raplas
