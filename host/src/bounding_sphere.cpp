// Small balls around points.
#include "raplas/bounding_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <vector>

namespace raplas {
namespace {

constexpr std::size_t kExactLimit = 16;  ///< more points than these are approximated
constexpr std::size_t kLarge = 4096;     ///< more points than these get fewer steps
constexpr int kSteps = 24;
constexpr int kStepsLarge = 6;

double square(double x) { return x * x; }

double distance2(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = a - b;
  return glm::dot(d, d);
}

/// The smallest ball with all `support` points (1 .. 4) on its surface; a negative radius if they are
/// dependent.
Ball circumscribed(std::span<const glm::dvec3> support) {
  const glm::dvec3& o = support[0];
  if (support.size() == 1) {
    return {o, 0};
  }
  const glm::dvec3 a = support[1] - o;
  glm::dvec3 offset = a * 0.5;
  if (support.size() == 3) {
    const glm::dvec3 b = support[2] - o;
    const glm::dvec3 n = glm::cross(a, b);
    const double n2 = glm::dot(n, n);
    if (!(n2 > 1e-24 * glm::dot(a, a) * glm::dot(b, b))) {
      return {};
    }
    offset = (glm::dot(b, b) * glm::cross(n, a) + glm::dot(a, a) * glm::cross(b, n)) / (2 * n2);
  } else if (support.size() == 4) {
    const glm::dvec3 b = support[2] - o;
    const glm::dvec3 c = support[3] - o;
    const double volume = glm::dot(a, glm::cross(b, c));
    if (!(square(volume) > 1e-24 * glm::dot(a, a) * glm::dot(b, b) * glm::dot(c, c))) {
      return {};
    }
    offset = (glm::dot(a, a) * glm::cross(b, c) + glm::dot(b, b) * glm::cross(c, a) +
              glm::dot(c, c) * glm::cross(a, b)) /
             (2 * volume);
  }
  return {o + offset, glm::length(offset)};
}

bool outside(const Ball& ball, const glm::dvec3& p) {
  return ball.radius < 0 || distance2(ball.centre, p) > square(ball.radius) * (1 + 1e-12) + 1e-300;
}

/// Welzl's recursion over the first `count` points, with `support` on the surface. Points that enlarged the
/// ball move to the front.
Ball welzl(std::vector<glm::dvec3>& points, std::size_t count, std::vector<glm::dvec3>& support) {
  Ball ball = support.empty() ? Ball{} : circumscribed(support);
  if (support.size() == 4) {
    return ball;
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (!outside(ball, points[k])) {
      continue;
    }
    support.push_back(points[k]);
    const Ball larger = welzl(points, k, support);
    support.pop_back();
    if (larger.radius >= 0) {
      ball = larger;
      const auto here = points.begin() + static_cast<std::ptrdiff_t>(k);
      std::rotate(points.begin(), here, here + 1);
    }
  }
  return ball;
}

Ball measured(std::span<const glm::dvec3> points, const glm::dvec3& centre) {
  double radius2 = 0;
  for (const glm::dvec3& p : points) {
    radius2 = std::max(radius2, distance2(centre, p));
  }
  return {centre, std::sqrt(radius2)};
}

const glm::dvec3& farthest(std::span<const glm::dvec3> points, const glm::dvec3& from) {
  std::size_t best = 0;
  double best2 = -1;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double d2 = distance2(from, points[k]);
    if (d2 > best2) {
      best = k;
      best2 = d2;
    }
  }
  return points[best];
}

/// Ritter's start, then steps towards the farthest point that get smaller.
Ball approximate(std::span<const glm::dvec3> points) {
  const glm::dvec3& a = farthest(points, points[0]);
  const glm::dvec3& b = farthest(points, a);
  Ball best = measured(points, (a + b) * 0.5);
  glm::dvec3 centre = best.centre;
  const int steps = points.size() > kLarge ? kStepsLarge : kSteps;
  for (int step = 0; step < steps; ++step) {
    const glm::dvec3& p = farthest(points, centre);
    const double radius = glm::distance(p, centre);
    if (radius < best.radius) {
      best = {centre, radius};
    }
    centre += (p - centre) * (0.25 / (1 + step));
  }
  return best;
}

}  // namespace

Ball bounding_ball(std::span<const glm::dvec3> points) {
  if (points.empty()) {
    return {};
  }
  const Ball fallback = approximate(points);
  if (points.size() > kExactLimit) {
    return fallback;
  }
  std::vector<glm::dvec3> scratch(points.begin(), points.end());
  std::vector<glm::dvec3> support;
  const Ball smallest = welzl(scratch, scratch.size(), support);
  if (smallest.radius < 0) {
    return fallback;
  }
  const Ball exact = measured(points, smallest.centre);
  return exact.radius < fallback.radius ? exact : fallback;
}

double enclosing_radius(std::span<const glm::dvec3> points, const glm::dvec3& centre) {
  return measured(points, centre).radius * (1 + std::ldexp(1.0, -48)) + std::ldexp(1.0, -500);
}

}  // namespace raplas
