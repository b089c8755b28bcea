// The theorem of docs/fixed_point.md with random integers: whatever a triangle crosses or reaches, each
// sphere that holds its vertices does too. And the order of the depth codes.
#include "raplas/fixed_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "random.hpp"

namespace raplas {
namespace {

const int kCases = [] {
  const char* cases = std::getenv("RAPLAS_CASES");  // NOLINT: one thread
  return cases == nullptr ? 20'000 : std::atoi(cases);
}();
constexpr double kUnit = 1 << kCoordinateFraction;

std::int64_t square(const FixedVec3& v) {
  std::int64_t sum = 0;
  for (const std::int64_t x : v) {
    sum += x * x;
  }
  return sum;
}

FixedVec3 plus(const FixedVec3& a, const FixedVec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

class Cases {
 public:
  explicit Cases(std::uint64_t seed) : random_(seed) {}

  std::uint32_t below(std::uint32_t limit) { return random_.below(limit); }

  /// Any direction, not scaled.
  std::array<double, 3> direction() {
    std::array<double, 3> d{};
    for (double& x : d) {
      x = static_cast<double>(below(1U << 24)) - static_cast<double>(1U << 23) + 0.5;
    }
    return d;
  }

  /// The longest integer vector in a direction, but for rounding toward zero: never longer than `length`.
  static FixedVec3 vector(const std::array<double, 3>& d, double length) {
    const double norm = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    FixedVec3 v{};
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = static_cast<std::int32_t>(d[k] / norm * length * (1 - 1e-12));
    }
    return v;
  }

  /// A vertex in the sphere: anywhere, or where it is nearest to one side of the plane.
  FixedVec3 vertex(const FixedVec3& centre, std::uint32_t radius, const FixedVec3& normal) {
    std::array<double, 3> d = direction();
    if (below(2) == 0) {
      const double sign = below(2) == 0 ? -1 : 1;
      d = {sign * normal[0], sign * normal[1], sign * normal[2]};
    }
    return plus(centre, vector(d, below(2) == 0 ? radius : below(radius + 1)));
  }

  FixedVec3 centre() {
    FixedVec3 c{};
    for (auto& x : c) {
      x = static_cast<std::int32_t>(below(1U << 16)) - (1 << 15);
    }
    return c;
  }

  /// A plane with |n| <= 1, often nearly 1, at most about `reach` from the point.
  FixedPlane plane(const FixedVec3& point, std::uint32_t reach) {
    FixedPlane plane;
    plane.normal = vector(direction(), below(4) == 0 ? below(1U << 17) : kUnit);
    const double off = (static_cast<double>(below(1U << 24)) / (1U << 23) - 1) * (reach + 2);
    plane.offset = -plane_sum(plane, point) + static_cast<std::int64_t>(off * kUnit);
    return plane;
  }

 private:
  Xoshiro random_;
};

struct Triangle {
  bool crossed = false;  ///< by the first row plane
  bool near = false;
  std::uint32_t z = ~0U;
};

/// What the hardware joins of three vertices.
Triangle join(const std::array<FixedTest, 3>& tests) {
  Triangle triangle;
  for (const FixedTest& test : tests) {
    triangle.crossed |= (test.rows_meet & 1) != 0 || ((test.rows_above ^ tests[0].rows_above) & 1) != 0;
    triangle.near |= test.near;
    triangle.z = std::min(triangle.z, test.z);
  }
  return triangle;
}

/// Cases in which something is true of the triangle and not of the sphere, with radii that are `less` too
/// small.
int count_lost(std::uint32_t less, int& crossed, int& touching) {
  Cases cases(7);
  int lost = 0;
  for (int k = 0; k < kCases; ++k) {
    const FixedVec3 centre = cases.centre();
    const std::uint32_t radius = 1 + cases.below(1U << (1 + cases.below(15)));
    const std::uint32_t slack = cases.below(3) == 0 ? 0 : cases.below(64);
    FixedPlanes planes;
    planes.rows[0] = cases.plane(centre, radius + slack);
    planes.near = cases.below(2) == 0 ? planes.rows[0] : cases.plane(centre, radius + slack);
    planes.depth = planes.rows[0];
    std::array<FixedTest, 3> tests;
    for (FixedTest& test : tests) {
      const FixedVec3 vertex = cases.vertex(centre, radius, planes.rows[0].normal);
      const FixedVec3 arm{vertex[0] - centre[0], vertex[1] - centre[1], vertex[2] - centre[2]};
      EXPECT_LE(square(arm), std::int64_t{radius} * radius);
      test = test_object(planes, vertex, 0, slack);
    }
    EXPECT_LE(square(planes.rows[0].normal), std::int64_t{1} << 34);
    const FixedTest sphere = test_object(planes, centre, radius - std::min(radius, less), slack);
    const Triangle triangle = join(tests);
    crossed += triangle.crossed ? 1 : 0;
    touching += triangle.crossed && sphere.rows_meet != 0 ? 1 : 0;
    lost += (triangle.crossed && sphere.rows_meet == 0) || (triangle.near && !sphere.near) ||
                    sphere.z > triangle.z
                ? 1
                : 0;
  }
  return lost;
}

TEST(FixedPoint, SpheresMeetWhateverTheirTrianglesCross) {
  int crossed = 0;
  int touching = 0;
  EXPECT_EQ(count_lost(0, crossed, touching), 0);
  EXPECT_GT(crossed, kCases / 10);
  EXPECT_LT(crossed, kCases * 9 / 10);
  EXPECT_EQ(touching, crossed);
  std::cout << kCases << " cases, " << crossed << " triangles crossed\n";
}

TEST(FixedPoint, RadiiThatAreTooSmallLoseTriangles) {
  int crossed = 0;
  int touching = 0;
  EXPECT_GT(count_lost(2, crossed, touching), 0) << "the cases are not near enough to the rim";
}

TEST(FixedPoint, DepthCodesKeepTheOrder) {
  Cases cases(8);
  for (int k = 0; k < kCases; ++k) {
    const auto distance = [&] {
      const std::int64_t d = (std::int64_t{cases.below(1U << 20)} << 20) | cases.below(1U << 20);
      return (cases.below(8) == 0 ? -d : d) >> cases.below(40);
    };
    const std::int64_t a = distance();
    const std::int64_t b = cases.below(2) == 0 ? a + cases.below(1U << cases.below(20)) : distance();
    ASSERT_LE(depth_code(std::min(a, b)), depth_code(std::max(a, b)));
    ASSERT_LE(depth_lower(a), depth_code(a));
    ASSERT_LE(depth_lower(std::min(a, b)), depth_lower(std::max(a, b)));
  }
}

}  // namespace
}  // namespace raplas
