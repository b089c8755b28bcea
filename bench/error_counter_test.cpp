#include "error_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "exact_hit.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

/// In the plane z = 1, with the right angle at (0, 0).
const Triangle kTriangle{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
const glm::dvec3 kForward{0, 0, 1};

Verdict verdict(const glm::dvec3& origin, const glm::dvec3& direction) {
  return reference_pair(kTriangle, 0, origin, direction).verdict;
}

/// `count` small triangles in the cube -0.5 .. 0.5.
std::vector<Triangle> random_triangles(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  const auto vector = [&] {
    const double x = uniform(random);
    const double y = uniform(random);
    return glm::dvec3(x, y, uniform(random));
  };
  std::vector<Triangle> triangles;
  for (int k = 0; k < count; ++k) {
    const glm::dvec3 v0 = vector();
    const glm::dvec3 e1 = vector() * 0.4;
    triangles.push_back({v0, e1, vector() * 0.4});
  }
  return triangles;
}

const Camera kCamera{{0.1, 0.2, -2}, {0, 0, 0}, {0, 1, 0}, 30};

Sample sample_of(const DeviceScene& scene, int width, int height) {
  return make_sample(scene, kCamera, width, height, [](double /*share*/) {});
}

TEST(Quantiles, AreNearestRanks) {
  std::vector<double> values(200);
  std::iota(values.rbegin(), values.rend(), 1.0);  // 200 .. 1
  const auto q = quantiles(values);
  ASSERT_TRUE(q);
  EXPECT_EQ(q->median, 100);
  EXPECT_EQ(q->percent_99, 198);
  EXPECT_EQ(q->largest, 200);
}

TEST(Quantiles, OfOneNumberAreThatNumberAndOfNoneNothing) {
  const auto q = quantiles({0.5});
  ASSERT_TRUE(q);
  EXPECT_EQ(q->median, 0.5);
  EXPECT_EQ(q->percent_99, 0.5);
  EXPECT_EQ(q->largest, 0.5);
  EXPECT_FALSE(quantiles({}));
}

TEST(ReferencePair, DecidesHitsAndMissesOfBothFacings) {
  const ReferencePair hit = reference_pair(kTriangle, 7, {0.25, 0.5, -1}, kForward);
  EXPECT_EQ(hit.verdict, Verdict::hit);
  EXPECT_EQ(hit.triangle, 7U);
  EXPECT_EQ(hit.t, 2);
  EXPECT_GT(hit.t_error, 0);
  EXPECT_LT(hit.t_error, 1e-12);
  EXPECT_EQ(verdict({0.25, 0.5, 2}, -kForward), Verdict::hit);
  EXPECT_EQ(verdict({0.25, 0.5, 2}, kForward), Verdict::miss) << "behind the origin";
  EXPECT_EQ(verdict({0.6, 0.6, 0}, kForward), Verdict::miss) << "u + v > 1";
  EXPECT_EQ(verdict({-1e-9, 0.5, 0}, kForward), Verdict::miss) << "u < 0";
  EXPECT_EQ(verdict({0.5, -1e-9, 0}, kForward), Verdict::miss) << "v < 0";
}

TEST(ReferencePair, LeavesRimsAndParallelRaysUndecided) {
  EXPECT_EQ(verdict({0, 0.5, 0}, kForward), Verdict::undecided) << "u = 0";
  EXPECT_EQ(verdict({0.5, 0, 0}, kForward), Verdict::undecided) << "v = 0";
  EXPECT_EQ(verdict({0.5, 0.5, 0}, kForward), Verdict::undecided) << "u + v = 1";
  EXPECT_EQ(verdict({0.25, 0.25, 1}, kForward), Verdict::undecided) << "t = 0";
  EXPECT_EQ(verdict({0, 0, 0}, {1, 0, 0}), Verdict::undecided) << "d = 0";
  EXPECT_EQ(verdict({0, 2, 0}, kForward), Verdict::miss) << "on the line of an edge, outside of it";
}

TEST(ReferencePair, IsDecidedAsInExactArithmetic) {
  // rays through points of an edge, moved off it by up to 2^-52, .. 2^-29 of the triangle
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::array<int, 3> verdicts{};
  for (const Triangle& triangle : random_triangles(3000)) {
    const double off =
        std::ldexp(1.0, -52 + static_cast<int>(uniform(random) * 24)) * (uniform(random) - 0.5);
    const double along = uniform(random);
    const double u = uniform(random) < 0.5 ? off : along;
    const double v = u == off ? along : 1 - along + off;
    const glm::dvec3 origin = kCamera.eye;
    const glm::dvec3 to = triangle.v0 + (u * triangle.e1 + v * triangle.e2);
    const glm::dvec3 direction = glm::normalize(to - origin);
    const Verdict decided = reference_pair(triangle, 0, origin, direction).verdict;
    const bool hit = exact_hit(origin, direction, triangle.v0, triangle.e1, triangle.e2).has_value();
    ++verdicts[static_cast<std::size_t>(decided)];
    if (decided != Verdict::undecided) {
      ASSERT_EQ(decided == Verdict::hit, hit);
    }
  }
  for (const int seen : verdicts) {
    EXPECT_GT(seen, 100);
  }
}

TEST(CompareNearest, TellsTheErrorsOfRaysApart) {
  const ReferencePair near{1, Verdict::hit, 1, 1e-15};
  const ReferencePair as_near{2, Verdict::hit, 1 + 1e-15, 1e-15};
  const ReferencePair farther{3, Verdict::hit, 2, 1e-15};
  const ReferencePair miss{4, Verdict::miss};
  EXPECT_EQ(compare_nearest(nullptr, nullptr), RayVerdict::right);
  EXPECT_EQ(compare_nearest(&near, &near), RayVerdict::right);
  EXPECT_EQ(compare_nearest(&near, &as_near), RayVerdict::right);
  EXPECT_EQ(compare_nearest(&near, nullptr), RayVerdict::missed);
  EXPECT_EQ(compare_nearest(nullptr, &miss), RayVerdict::false_hit);
  EXPECT_EQ(compare_nearest(&near, &farther), RayVerdict::other);
  EXPECT_EQ(compare_nearest(&near, &miss), RayVerdict::other);
}

TEST(Sample, HoldsTheHitsOfTheReferenceDevice) {
  const DeviceScene scene = build_tree(random_triangles(500)).scene;
  const Sample sample = sample_of(scene, 40, 24);  // the last pencils are smaller
  const auto device = make_device("reference", {});
  device->load(scene);
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  for (const SampledPencil& sampled : sample.pencils) {
    Pencil pencil;
    pencil.origin = sampled.origin;
    pencil.axis = kForward;
    for (const SampledRay& ray : sampled.rays) {
      pencil.directions.push_back(ray.direction);
    }
    const std::vector<Hit> expected = device->trace(pencil);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const ReferencePair* nearest = nearest_hit(sampled.rays[k].pairs);
      ASSERT_EQ(nearest != nullptr, expected[k].hit);
      ++rays;
      if (nearest != nullptr) {
        ++hits;
        EXPECT_EQ(nearest->triangle, expected[k].triangle);
        EXPECT_NEAR(nearest->t, expected[k].t(), nearest->t_error);
      }
    }
  }
  EXPECT_EQ(rays, 40U * 24U);
  EXPECT_GT(hits, 100U);
  EXPECT_EQ(count(sample).rays, rays);
  EXPECT_EQ(count(sample).rays_hit, hits);
}

TEST(Sample, NamesEachTriangleOfCutOnesOnce) {
  TreeOptions options;
  options.longest_edge = 0.1;
  options.extra_pieces = 10;
  const DeviceScene scene = build_tree(random_triangles(50), options).scene;
  ASSERT_GT(scene.piece_count(), 100U);
  for (const SampledPencil& pencil : sample_of(scene, 16, 16).pencils) {
    for (const SampledRay& ray : pencil.rays) {
      const auto twice = std::adjacent_find(
          ray.pairs.begin(), ray.pairs.end(),
          [](const ReferencePair& a, const ReferencePair& b) { return a.triangle >= b.triangle; });
      EXPECT_EQ(twice, ray.pairs.end());
    }
  }
}

TEST(FormatErrors, ShrinkWithTheFraction) {
  const DeviceScene scene = build_tree(random_triangles(500)).scene;
  const Sample sample = sample_of(scene, 48, 48);
  const FormatErrors coarse = measure<Float<Format{7, 6, Guard::exact, Rounding::toward_zero}>>(sample);
  const FormatErrors fine = measure<Float<Format{8, 23, Guard::exact, Rounding::nearest_even}>>(sample);
  EXPECT_GT(coarse.false_hits, 0U);
  EXPECT_GT(coarse.missed_hits, 0U);
  EXPECT_GT(coarse.rays_wrong(), 0U);
  EXPECT_LT(fine.misclassified(), coarse.misclassified());
  ASSERT_TRUE(coarse.t_relative && coarse.t_ulp && fine.t_relative);
  EXPECT_LT(fine.t_relative->largest, coarse.t_relative->median);
  EXPECT_GE(coarse.t_ulp->median, coarse.t_relative->median * 0x1p6) << "an ulp is 2^-6 of t at most";
  EXPECT_LE(coarse.t_ulp->median, coarse.t_relative->median * 0x1p7);
}

TEST(FormatErrors, AreAllHitsMissedWhenNormalsUnderflow) {
  std::vector<Triangle> small{kTriangle};
  small[0].e1 *= 0x1p-8;
  small[0].e2 *= 0x1p-8;
  const glm::dvec3 origin{0x1p-10, 0x1p-10, 0};
  const SampledRay ray{kForward, {reference_pair(small[0], 0, origin, kForward)}, 0};
  ASSERT_EQ(ray.pairs[0].verdict, Verdict::hit);
  const Sample sample{small, {{origin, {ray}}}};
  const FormatErrors errors = measure<Float<Format{5, 16, Guard::exact, Rounding::toward_zero}>>(sample);
  EXPECT_EQ(errors.missed_hits, 1U);
  EXPECT_EQ(errors.rays_missed, 1U);
  EXPECT_FALSE(errors.t_relative);
  EXPECT_EQ(measure<Fp24>(sample).misclassified(), 0U);
}

}  // namespace
}  // namespace raplas
