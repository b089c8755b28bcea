#include "raplas/pencil.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

namespace raplas {
namespace {

/// Checks the pencil's planes and directions; returns the number of rays.
int check(const Pencil& pencil) {
  const auto rows = static_cast<std::size_t>(pencil.rows);
  const auto columns = static_cast<std::size_t>(pencil.columns);
  EXPECT_EQ(pencil.row_planes.size(), rows);
  EXPECT_EQ(pencil.column_planes.size(), columns);
  EXPECT_EQ(pencil.directions.size(), rows * columns);
  for (const auto& planes : {pencil.row_planes, pencil.column_planes}) {
    for (const Plane& plane : planes) {
      EXPECT_NEAR(glm::length(plane.normal), 1, 1e-14);
      EXPECT_NEAR(glm::dot(plane.normal, pencil.origin) + plane.offset, 0, 1e-15);
    }
  }
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const glm::dvec3& d = pencil.directions[r * columns + c];
      EXPECT_NEAR(glm::length(d), 1, 1e-14);
      EXPECT_LT(std::abs(glm::dot(pencil.row_planes[r].normal, d)), 1e-12);
      EXPECT_LT(std::abs(glm::dot(pencil.column_planes[c].normal, d)), 1e-12);
    }
  }
  return static_cast<int>(rows * columns);
}

Camera camera() { return {{0.1, 0.2, -0.9}, {0.05, -0.1, 0.3}, {0.1, 1, 0}, 40}; }

AreaLight light() { return {{-0.2, 0.6, -0.1}, {0.3, 0, 0}, {0, 0, 0.2}, {1, 1, 1}}; }

TEST(Pencil, CameraRaysLieInTheirRowAndColumnPlanes) {
  const CameraFrame frame(camera(), 100, 60);
  int rays = 0;
  for (int y = 0; y < 60; y += 16) {
    for (int x = 0; x < 100; x += 16) {
      rays += check(frame.pencil(x, y, std::min(16, 100 - x), std::min(16, 60 - y)));
    }
  }
  EXPECT_EQ(rays, 6000);
}

TEST(Pencil, ShadowRaysLieInTheirPlanesFromAnywhereBelowTheLight) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> aside(-0.9, 0.9);
  std::uniform_real_distribution<double> depth(-10, 0.3);
  int rays = 0;
  for (int k = 0; k < 2000; ++k) {
    // From 2^-10 below the light's plane on.
    const glm::dvec3 origin(aside(random), 0.6 - std::exp2(depth(random)), aside(random));
    rays += check(make_pencil(origin, light_grid(light(), 1 + k % 16, aside(random) / 2, aside(random) / 2)));
  }
  fmt::print("pencil.rays_checked {}\n", rays);
}

TEST(Pencil, CameraPixelsAreSquareCentredAndFromTheTopLeft) {
  const Camera camera{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90};
  const CameraFrame frame(camera, 4, 2);
  const Pencil pencil = frame.pencil(0, 0, 4, 2);
  // Vertical half angle 45 degrees: the image plane at 1 is 2 high and 4 wide, +x is to the left of a viewer
  // along +z.
  const glm::dvec3 first = pencil.directions[0] / pencil.directions[0].z;
  EXPECT_NEAR(first.x, 1.5, 1e-14);
  EXPECT_NEAR(first.y, 0.5, 1e-14);
  const glm::dvec3 last = pencil.directions[7] / pencil.directions[7].z;
  EXPECT_NEAR(last.x, -1.5, 1e-14);
  EXPECT_NEAR(last.y, -0.5, 1e-14);
}

TEST(Pencil, TilesGiveTheSameRaysAsOneAnother) {
  const CameraFrame frame(camera(), 32, 32);
  const Pencil whole = frame.pencil(8, 4, 16, 16);
  const Pencil part = frame.pencil(12, 8, 4, 4);
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_LT(glm::distance(whole.directions[(r + 4) * 16 + c + 4], part.directions[r * 4 + c]), 1e-14);
    }
  }
}

TEST(Pencil, LightSamplesStayInsideTheLight) {
  for (const double shift : {-0.5, 0.0, 0.499}) {
    for (int size = 1; size <= 16; ++size) {
      const Grid grid = light_grid(light(), size, shift, -shift);
      const glm::dvec3 last = grid.first + double(size - 1) * (grid.row_step + grid.column_step);
      for (const glm::dvec3& p : {grid.first, last}) {
        const glm::dvec3 q = p - light().corner;
        EXPECT_GE(q.x, -1e-15);
        EXPECT_LE(q.x, 0.3 + 1e-15);
        EXPECT_GE(q.z, -1e-15);
        EXPECT_LE(q.z, 0.2 + 1e-15);
      }
    }
  }
}

TEST(Pencil, RefusesAnOriginOnAGridLineAndWrongSizes) {
  const Grid grid{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2, 2};
  EXPECT_THROW((void)make_pencil({0.5, 0, 1}, grid), std::invalid_argument);
  EXPECT_THROW((void)make_pencil({0, 0, 0}, {grid.first, grid.row_step, grid.column_step, 17, 2}),
               std::invalid_argument);
  EXPECT_THROW((void)make_pencil({0, 0, 0}, {grid.first, grid.row_step, grid.column_step, 2, 0}),
               std::invalid_argument);
}

}  // namespace
}  // namespace raplas
