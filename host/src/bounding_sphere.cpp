// The smallest ball around points.
#include "raplas/bounding_sphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

namespace raplas {
namespace {

constexpr int kMostSteps = 1000;  ///< a dozen are usual

double square(double x) { return x * x; }

double distance2(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = a - b;
  return glm::dot(d, d);
}

/// Up to 5 points.
struct Support {
  std::array<glm::dvec3, 5> points{};
  std::size_t count = 0;

  void add(const glm::dvec3& p) { points[count++] = p; }
  [[nodiscard]] std::span<const glm::dvec3> span() const { return {points.data(), count}; }
};

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

struct Farthest {
  std::size_t index;
  double distance2;
};

Farthest farthest(std::span<const glm::dvec3> points, const glm::dvec3& from) {
  Farthest best{0, -1};
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double d2 = distance2(from, points[k]);
    if (d2 > best.distance2) {
      best = {k, d2};
    }
  }
  return best;
}

struct Supported {
  Ball ball;
  Support support;
};

/// The smallest ball around `old` (1 .. 4 points) and a point outside their ball, which is hence on its
/// surface. Of the balls through it and a subset of the others, it is the one whose centre is nearest to the
/// farthest of all points.
Supported enlarged(const Support& old, const glm::dvec3& point) {
  Support all = old;
  all.add(point);
  Supported best;
  for (unsigned subset = 1; subset < (1U << old.count) && subset != 15; ++subset) {
    Support chosen;
    chosen.add(point);
    for (std::size_t k = 0; k < old.count; ++k) {
      if ((subset >> k & 1U) != 0) {
        chosen.add(old.points[k]);
      }
    }
    const Ball ball = circumscribed(chosen.span());
    if (ball.radius < 0) {
      continue;
    }
    const double radius = std::sqrt(farthest(all.span(), ball.centre).distance2);
    if (best.ball.radius < 0 || radius < best.ball.radius) {
      best = {{ball.centre, radius}, chosen};
    }
  }
  return best;
}

}  // namespace

Ball bounding_ball(std::span<const glm::dvec3> points) {
  if (points.empty()) {
    return {};
  }
  Supported state;
  state.support.add(points[farthest(points, points[0]).index]);
  state.ball = {state.support.points[0], 0};
  Ball best;
  for (int step = 0; step < kMostSteps; ++step) {
    const Farthest next = farthest(points, state.ball.centre);
    const double radius = std::sqrt(next.distance2);
    if (best.radius < 0 || radius < best.radius) {
      best = {state.ball.centre, radius};
    }
    if (radius <= state.ball.radius * (1 + 1e-13)) {
      break;
    }
    const Supported larger = enlarged(state.support, points[next.index]);
    if (!(larger.ball.radius > state.ball.radius)) {
      break;  // only rounding is left
    }
    state = larger;
  }
  return best;
}

double enclosing_radius(std::span<const glm::dvec3> points, const glm::dvec3& centre) {
  if (points.empty()) {
    return 0;
  }
  const double radius = std::sqrt(farthest(points, centre).distance2);
  return radius * (1 + std::ldexp(1.0, -48)) + std::ldexp(1.0, -500);
}

}  // namespace raplas
