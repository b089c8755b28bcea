// Pencils in fixed point: limits, scales, what is behind, what is refused, and the slack of a scene's
// pencils.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "encode_fixed_source.hpp"
#include "raplas/encode.hpp"
#include "raplas/pencil.hpp"
#include "raplas/renderer.hpp"
#include "raplas/scene.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

/// A pencil of 2 x 3 rays along z.
Pencil plain_pencil(const glm::dvec3& origin) {
  return make_pencil(origin, {origin + glm::dvec3(-0.1, -0.1, 0.5), {0, 0.1, 0}, {0.1, 0, 0}, 2, 3});
}

TEST(EncodeFixed, PencilsKeepTheirLimitsAndScaleRaysToTheAxis) {
  Pencil pencil = plain_pencil({0.1, -0.2, -0.7});
  EXPECT_EQ(pencil.axis, glm::dvec3(0, 0, 1));
  FixedPencil words = encode_fixed(pencil);
  EXPECT_FALSE(words.memory.limits.any_hit);
  EXPECT_EQ(words.memory.limits.far, 0x7fffU);
  EXPECT_EQ(words.memory.pencil.rows, 2U);
  EXPECT_EQ(words.memory.pencil.columns, 3U);
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t ray = r * kMaxColumns + c;
      EXPECT_EQ(words.memory.rays[ray].z.to_double(), 1);
      EXPECT_NEAR(words.t_scale[ray], glm::length(decode(words.memory.rays[ray])), 1e-5);
    }
  }
  // lines that the pencil doesn't have are never met, whatever the sphere
  const FixedTest test =
      test_object(words.memory.planes, {}, (1U << kCoordinateBits) - 1 - kMaxSlack, kMaxSlack);
  EXPECT_EQ(test.rows_meet, 0x3U);
  EXPECT_EQ(test.columns_meet, 0x7U);
  EXPECT_EQ(test.rows_above >> 2, 0x3fffU);
  for (const FixedPlane& plane : words.memory.planes.rows) {
    EXPECT_LE(glm::length(glm::dvec3(plane.normal[0], plane.normal[1], plane.normal[2])), 0x1p17);
  }

  pencil.far = 0.5;
  pencil.any_hit = true;
  words = encode_fixed(pencil);
  EXPECT_TRUE(words.memory.limits.any_hit);
  EXPECT_EQ(words.memory.limits.far, depth_code(std::int64_t{1} << 33));
  pencil.far = 1e30;
  EXPECT_EQ(encode_fixed(pencil).memory.limits.far, 0x7fffU);
  pencil.far = 0;
  EXPECT_EQ(encode_fixed(pencil).memory.limits.far, 0U);
}

TEST(EncodeFixed, RefusesPencilsThatDoNotFit) {
  Pencil pencil = plain_pencil({0, 0, -3});
  EXPECT_THROW((void)encode_fixed(pencil), std::range_error);
  pencil = plain_pencil({0, 0, -0.5});
  pencil.axis = glm::dvec3(0);
  EXPECT_THROW((void)encode_fixed(pencil), std::invalid_argument);
  pencil.axis = {0, 0, -1};
  EXPECT_THROW((void)encode_fixed(pencil), std::invalid_argument);
}

TEST(EncodeFixed, TheSurfaceThatRaysLeaveIsBehind) {
  const auto is_near = [](const Pencil& pencil, const glm::dvec3& point) {
    const FixedPencil words = encode_fixed(pencil);
    FixedVec3 vertex{};
    for (int k = 0; k < 3; ++k) {
      vertex[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(std::lrint(point[k] / kUnit));
    }
    return test_object(words.memory.planes, vertex, 0, words.memory.limits.slack).near;
  };
  Pencil pencil = plain_pencil({0.1, -0.2, -0.7});
  // a wall of normal -x, past which the pencil's last column goes
  const glm::dvec3 wall = pencil.origin + glm::dvec3(0x1p-10, 0, 0.3);
  EXPECT_TRUE(is_near(pencil, wall));
  pencil.front = {-1, 0, 0};
  EXPECT_TRUE(is_near(pencil, wall));
  const glm::dvec3 aside = pencil.origin - glm::dvec3(0.5, 0.1, -0.5);
  pencil = make_pencil(pencil.origin, {aside, {0, 0.1, 0}, {0.1, 0, 0}, 2, 3});
  EXPECT_TRUE(is_near(pencil, wall));
  pencil.front = {-1, 0, 0};
  EXPECT_FALSE(is_near(pencil, wall));
  EXPECT_TRUE(is_near(pencil, wall - glm::dvec3(0x1p-9, 0, 0)));
}

TEST(EncodeFixed, RaysAlongTheGridLeaveDepthsOut) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
  const glm::dvec3 u = any_across(axis);
  const glm::dvec3 v = glm::cross(axis, u);
  const FixedPencil words =
      encode_fixed(make_pencil({0, 0, 0}, {0.5 * u + axis * 0x1p-22, 0.1 * v, 0.1 * (u + v), 4, 4}));
  const FixedTest test = test_object(words.memory.planes, {-17000, -35000, -52000}, 0, 0);
  EXPECT_TRUE(test.near);
  EXPECT_EQ(test.z, 0U);
}

TEST(EncodeFixed, AResultIsAlongTheUnitDirection) {
  const Pencil pencil = plain_pencil({0, 0, -0.5});
  const FixedPencil words = encode_fixed(pencil);
  ResultWord<Fp24> word;
  word.hit = true;
  word.triangle = 5;
  word.t = Fp24::from_double(0.5);
  word.d = Fp24::from_double(2);
  word.u = Fp24::from_double(0.25);
  const Hit hit = decode_fixed(word, words, 0);
  const double length = std::sqrt(1 + 0.2 * 0.2 * 2);
  EXPECT_NEAR(hit.t(), 0.25 * length, 1e-12);
  EXPECT_EQ(hit.u_scaled / hit.d, 0.125);
  EXPECT_EQ(decode_fixed({}, words, 0), Hit());
}

/// Notes the slack of the pencils that go through, and how long their encoding takes.
class Observer final : public IntersectionDevice {
 public:
  void load(const DeviceScene& scene) override {
    device_->load(scene);
    vertex_error_ = encode_fixed(scene).vertex_error;
  }
  std::vector<std::vector<Hit>> trace(std::span<const Pencil> all) override {
    for (const Pencil& pencil : all) {
      observe(pencil);
    }
    return device_->trace(all);
  }
  void observe(const Pencil& pencil) {
    const auto start = std::chrono::steady_clock::now();
    const FixedPencil words = encode_fixed(pencil, vertex_error_);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::size_t kind = pencil.rows == 16 ? 0 : 1;
    ++pencils.at(kind);
    total.at(kind) += words.memory.limits.slack;
    most.at(kind) = std::max(most.at(kind), words.memory.limits.slack);
    EXPECT_LE(words.memory.limits.slack, most_slack(pencil, vertex_error_));
  }
  [[nodiscard]] Counters counters() const override { return {}; }

  std::array<std::uint64_t, 2> pencils{};  ///< camera, shadow
  std::array<std::uint64_t, 2> total{};    ///< of the slacks
  std::array<std::uint32_t, 2> most{};
  double seconds = 0;

 private:
  std::unique_ptr<IntersectionDevice> device_ = make_device("reference", {});
  double vertex_error_ = 0;
};

/// Prints what a scene's words take; with RAPLAS_CASES set, of the bunny.
TEST(EncodeFixed, SlackAndWordsOfAScene) {
  const bool large = std::getenv("RAPLAS_CASES") != nullptr;
  const std::string file = large ? std::string(RAPLAS_MESHES) + "/bunny_69k.obj"
                                 : std::string(RAPLAS_SCENES) + "/cornell_teapot.json";
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << file << " is missing";
  }
  const Scene scene = load_scene(file);
  SphereTree tree = build_tree(scene.triangles);
  tree.scene.max_origin = scene.max_origin;
  const FixedScene words = encode_fixed(tree.scene);
  fmt::print("encode_fixed.words_per_triangle {:.3f}\n",
             double(words.memory.vertices.size()) / double(words.memory.triangles.size()));
  fmt::print("encode_fixed.vertex_error {:.3f} units\n", words.vertex_error / kUnit);
  EXPECT_LE(words.vertex_error / kUnit, most_vertex_error(tree.scene.triangles));
  Observer observer;
  observer.load(tree.scene);
  RenderOptions options;
  options.width = options.height = large ? 256 : 64;
  (void)render(scene, tree.source, observer, options);
  for (const std::size_t kind : {0U, 1U}) {
    fmt::print("encode_fixed.slack_{} mean {:.2f}, most {} units, {} pencils\n",
               kind == 0 ? "camera" : "shadow", double(observer.total[kind]) / double(observer.pencils[kind]),
               observer.most[kind], observer.pencils[kind]);
  }
  fmt::print("encode_fixed.microseconds_per_pencil {:.1f}\n",
             1e6 * observer.seconds / double(observer.pencils[0] + observer.pencils[1]));
}

}  // namespace
}  // namespace raplas
