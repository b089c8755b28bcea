// Certified hits, and the exact device that is made of them: docs/exact.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "encode_fixed_source.hpp"
#include "exact_hit.hpp"
#include "raplas/device.hpp"
#include "raplas/encode.hpp"
#include "raplas/pencil.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

/// What docs/exact.md allows t'/d to be off by, as a share of t.
constexpr double kSureError = 0.0028;
constexpr double kRoughError = 0.0112;

std::uint64_t cases(std::uint64_t usual) {
  const char* wanted = std::getenv("RAPLAS_CASES");  // NOLINT(concurrency-mt-unsafe)
  return wanted == nullptr ? usual : std::strtoull(wanted, nullptr, 10);
}

/// A triangle of any size and shape within the unit ball.
Triangle some_triangle(Source& source) {
  for (;;) {
    const double size = std::exp2(source.uniform(-12, 0));
    const double aspect = std::exp2(source.below(2) == 0 ? 0.0 : source.uniform(-10, 0));
    const Triangle t{source.uniform(0, 1) * source.on_sphere(), size * source.on_sphere(),
                     size * aspect * source.on_sphere()};
    const double reach = std::max({glm::length(t.v0), glm::length(t.v0 + t.e1), glm::length(t.v0 + t.e2)});
    if (reach < 0.999 && glm::length(glm::cross(t.e1, t.e2)) > 1e-3 * size * size * aspect) {
      return t;
    }
  }
}

/// A point of the triangle, often on its border or near it.
glm::dvec3 some_point(Source& source, const Triangle& t) {
  double u = source.uniform(0, 1);
  double v = source.uniform(0, 1 - u);
  const double near = source.below(3) == 0 ? 0 : std::exp2(source.uniform(-30, -4));
  switch (source.below(4)) {
    case 0:
      u = near;
      break;
    case 1:
      v = near;
      break;
    case 2:
      v = std::max(0.0, 1 - u - near);
      break;
    default:
      break;
  }
  return t.v0 + u * t.e1 + v * t.e2;
}

/// A pencil of one ray from somewhere in the ball to the point, its axis up to 75 degrees aside.
Pencil ray_to(Source& source, const glm::dvec3& point, const Triangle& t) {
  glm::dvec3 origin = source.uniform(0, 1) * source.on_sphere();
  if (source.below(3) == 0) {  // from nearby, or almost along the triangle's plane
    const glm::dvec3 normal = glm::normalize(glm::cross(t.e1, t.e2));
    const glm::dvec3 away =
        source.below(2) == 0 ? source.on_sphere()
                             : glm::normalize(any_across(normal) + std::exp2(source.uniform(-8, 0)) * normal);
    origin = point + std::exp2(source.uniform(-10, 0)) * away;
  }
  if (glm::length(origin) > 1 || glm::distance(origin, point) < 1e-6) {
    return ray_to(source, point, t);
  }
  const glm::dvec3 direction = glm::normalize(point - origin);
  const glm::dvec3 axis = glm::normalize(direction + source.uniform(0, 3) * any_across(direction));
  const glm::dvec3 across = any_across(axis);
  const glm::dvec3 target = origin + direction / glm::dot(axis, direction);
  return make_pencil(origin, {target, 0.01 * across, 0.01 * glm::cross(axis, across), 1, 1});
}

TEST(CertifiedHits, EveryHitIsPossibleAndItsDepthAsGoodAsClaimed) {
  Source source(61);
  std::uint64_t hits = 0;
  std::uint64_t plain_lost = 0;    // by the test without a band
  std::uint64_t quarter_lost = 0;  // by a band of a quarter
  std::uint64_t sure = 0;
  std::uint64_t rough = 0;
  double sure_error = 0;
  double rough_error = 0;
  const std::uint64_t count = cases(30'000);
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::vector<Triangle> triangles{some_triangle(source)};
    const Triangle& t = triangles[0];
    const Pencil pencil = ray_to(source, some_point(source, t), t);
    if (!exact_hit(pencil.origin, pencil.directions[0], t.v0, t.e1, t.e2)) {
      continue;  // the point was rounded to the outside
    }
    const FixedScene scene = encode_fixed(one_leaf(triangles), true);
    ASSERT_TRUE(scene.uncertain.empty());
    ASSERT_TRUE(can_certify(pencil));
    const FixedPencilMemory<Fp24> words = encode_fixed(pencil, scene.vertex_error, true).memory;
    const auto solved = [&](Fp24 band) {
      return solve(scene.memory.triangles[0], words.pencil.origin, words.rays[0], band);
    };
    const Fp24 band = Fp24::from_bits(words.limits.band);
    const Solution<Fp24> s = solved(band);
    ++hits;
    ASSERT_TRUE(s.hit) << "case " << k;
    plain_lost += solved({}).hit ? 0U : 1U;
    quarter_lost += solved(Fp24::from_double(band.to_double() / 4)).hit ? 0U : 1U;
    if (s.unsure) {
      continue;
    }
    const glm::dvec3 normal = glm::cross(t.e1, t.e2);
    const double depth = glm::dot(normal, t.v0 - pencil.origin) / glm::dot(normal, pencil.directions[0]) *
                         glm::dot(pencil.axis, pencil.directions[0]);
    const double error = std::abs(s.t.to_double() / s.d.to_double() / depth - 1);
    (s.rough ? rough : sure) += 1;
    (s.rough ? rough_error : sure_error) = std::max(s.rough ? rough_error : sure_error, error);
  }
  std::printf(
      "%llu hits; without a band %llu lost, with a quarter of it %llu; depths off by at most %.2g "
      "(%llu), rough ones %.2g (%llu)\n",
      static_cast<unsigned long long>(hits), static_cast<unsigned long long>(plain_lost),
      static_cast<unsigned long long>(quarter_lost), sure_error, static_cast<unsigned long long>(sure),
      rough_error, static_cast<unsigned long long>(rough));
  EXPECT_GT(hits, count / 4);
  EXPECT_GT(plain_lost, 100U) << "no case is near an edge";
  EXPECT_GT(quarter_lost, 0U) << "the band is far too wide";
  EXPECT_GT(sure, count / 20);
  EXPECT_GT(rough, count / 100);
  EXPECT_LT(sure_error, kSureError);
  EXPECT_LT(rough_error, kRoughError);
}

/// Triangles all over, some of them in stacks of nearly the same, some with common edges.
std::vector<Triangle> some_scene(Source& source) {
  std::vector<Triangle> triangles;
  const std::uint32_t count = 2 + source.below(60);
  while (triangles.size() < count) {
    const Triangle t = some_triangle(source);
    triangles.push_back(t);
    const std::uint32_t kind = source.below(4);
    for (std::uint32_t k = source.below(4); k > 0; --k) {
      Triangle other = t;
      if (kind == 0) {  // the same again, or almost
        other.v0 += (source.below(2) == 0 ? 0.0 : std::exp2(source.uniform(-40, -8))) * source.on_sphere();
      } else if (kind == 1) {  // the neighbour across E1
        other = {t.v0, t.e1, 0.5 * t.e1 - t.e2};
      } else {
        break;
      }
      if (std::max({glm::length(other.v0), glm::length(other.v0 + other.e1),
                    glm::length(other.v0 + other.e2)}) < 0.999) {
        triangles.push_back(other);
      }
    }
  }
  return triangles;
}

/// A pencil to somewhere at one of the triangles, of some degrees or very wide.
Pencil some_pencil(Source& source, const std::vector<Triangle>& triangles) {
  const Triangle& t = triangles[source.below(static_cast<std::uint32_t>(triangles.size()))];
  const glm::dvec3 target = some_point(source, t);
  const glm::dvec3 origin = source.uniform(0, 0.99) * source.on_sphere();
  const glm::dvec3 axis = glm::normalize(target - origin + 0.2 * source.in_cube());
  const glm::dvec3 u = any_across(axis);
  const glm::dvec3 v = glm::cross(axis, u);
  const int rows = 1 + static_cast<int>(source.below(kMaxRows));
  const int columns = 1 + static_cast<int>(source.below(kMaxColumns));
  const double width = std::exp2(source.uniform(-14, source.below(20) == 0 ? 5 : 0));
  const glm::dvec3 first = target - width * (0.5 * rows * u + 0.5 * columns * v);
  Pencil pencil = make_pencil(origin, {first, width * u, width * v, rows, columns});
  pencil.any_hit = source.below(3) == 0;
  if (source.below(3) == 0) {
    pencil.far =
        glm::dot(pencil.axis, target - origin) * (source.below(2) == 0 ? 1.0 : source.uniform(0.5, 1.5));
  }
  return pencil;
}

TEST(ExactDevice, HasTheHitsOfDoublePrecision) {
  Source source(62);
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  Retests retests;
  const std::uint64_t count = cases(400);
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::vector<Triangle> triangles = some_scene(source);
    TreeOptions options;
    options.extra_pieces = source.below(2);
    const DeviceScene scene = build_tree(triangles, options).scene;
    const auto reference = make_device("reference", {});
    DeviceOptions exact_options;
    exact_options.exact = true;
    const auto exact = make_device("model", exact_options);
    reference->load(scene);
    exact->load(scene);
    std::vector<Pencil> pencils;
    for (int p = 0; p < 10; ++p) {
      pencils.push_back(some_pencil(source, triangles));
    }
    const auto expected = reference->trace(pencils);
    const auto seen = exact->trace(pencils);
    for (std::size_t p = 0; p < pencils.size(); ++p) {
      for (std::size_t ray = 0; ray < expected[p].size(); ++ray) {
        ++rays;
        hits += expected[p][ray].hit ? 1U : 0U;
        ASSERT_EQ(seen[p][ray].hit, expected[p][ray].hit)
            << "scene " << k << " pencil " << p << " ray " << ray;
        if (!pencils[p].any_hit) {
          ASSERT_EQ(seen[p][ray], expected[p][ray]) << "scene " << k << " pencil " << p << " ray " << ray;
        }
      }
    }
    retests.rays += exact->retests().rays;
    retests.rivals += exact->retests().rivals;
    retests.traced += exact->retests().traced;
  }
  std::printf("%llu rays, %llu hit, %llu with a rival, %llu traced in double precision\n",
              static_cast<unsigned long long>(rays), static_cast<unsigned long long>(hits),
              static_cast<unsigned long long>(retests.rivals),
              static_cast<unsigned long long>(retests.traced));
  EXPECT_EQ(retests.rays, rays);
  EXPECT_GT(hits, rays / 20);
  EXPECT_GT(retests.rivals, rays / 1000);
  EXPECT_LT(retests.traced, rays / 4) << "nothing is left to the unit";
}

TEST(ExactDevice, TestsTrianglesThatAreTooThinItself) {
  // N is 2^-41 of what it is for a triangle of this size
  const std::vector<Triangle> triangles{{{-0.5, 0, 0.5}, {1, 0, 0}, {0.5, 0x1p-41, 0}},
                                        {{-0.5, -0.5, 0.7}, {1, 0, 0}, {0, 1, 0}}};
  const DeviceScene scene = build_tree(triangles).scene;
  EXPECT_EQ(encode_fixed(scene, true).uncertain.size(), 1U);
  DeviceOptions options;
  options.exact = true;
  const auto exact = make_device("model", options);
  exact->load(scene);
  const auto reference = make_device("reference", {});
  reference->load(scene);
  const glm::dvec3 inside{0, 0x1p-42, 0.5};
  const Pencil pencil = make_pencil({0, 0, 0}, {inside, {0, 0x1p-42, 0}, {0.01, 0, 0}, 3, 4});
  const auto expected = reference->trace(pencil);
  EXPECT_EQ(exact->trace(pencil), expected);
  EXPECT_LT(expected[0].t(), 0.6) << "the thin triangle isn't hit";
}

TEST(ExactDevice, PencilsThatCannotBeCertifiedAreTracedInDoublePrecision) {
  const DeviceScene scene =
      build_tree(std::vector<Triangle>{{{-0.5, -0.5, 0.5}, {1, 0, 0}, {0, 1, 0}}}).scene;
  DeviceOptions options;
  options.exact = true;
  const auto exact = make_device("model", options);
  exact->load(scene);
  const Pencil outside = make_pencil({0, 0, -1.5}, {{-0.2, -0.2, 0}, {0, 0.1, 0}, {0.1, 0, 0}, 4, 4});
  EXPECT_FALSE(can_certify(outside));
  EXPECT_TRUE(exact->trace(outside)[0].hit);
  EXPECT_EQ(exact->retests().traced, 16U);
  EXPECT_THROW((void)encode_fixed(outside, 0x1p-17, true), std::invalid_argument);
}

TEST(ExactDevice, ProfilePaperHasNone) {
  DeviceOptions options;
  options.exact = true;
  options.profile = Profile::paper;
  EXPECT_EQ(complaint([&] { (void)make_device("model", options); }),
            "profile paper has no certified hits: only profile raplas can be exact");
}

}  // namespace
}  // namespace raplas
