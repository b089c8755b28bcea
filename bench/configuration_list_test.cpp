#include "configuration_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "plane_sweep.hpp"
#include "raplas/pencil.hpp"
#include "raplas/sphere_tree.hpp"
#include "ray_errors.hpp"
#include "recorded.hpp"

namespace raplas {
namespace {

constexpr int kSide = 48;  // pixels

Settings cornell(Structure structure) {
  Settings settings;
  settings.scene = RAPLAS_SCENES "/cornell_teapot.json";
  settings.flat = structure == Structure::flat;
  if (structure != Structure::tree) {
    settings.tree.longest_edge = kWholeTriangles;
  }
  return settings;
}

Recorded recorded(int pencil) { return record(prepare(cornell(Structure::tree)), {kSide, kSide, pencil, 4}); }

std::vector<std::vector<Hit>> hits_of(const Configuration& c, const Recorded& pencils) {
  const Prepared prepared = prepare(cornell(c.structure));
  const auto device = c.make();
  device->load(prepared.tree.scene);
  auto hits = device->trace(pencils.camera);
  to_scene_triangles(prepared.tree.source, hits);
  return hits;
}

TEST(UnitDevice, GivesTheBitsOfTheClockedModelAndItsClocks) {
  DeviceOptions options;
  options.profile = Profile::paper;
  const auto model = make_device("model", options);
  UnitDevice<Fp24Paper> device;
  const DeviceScene scene = prepare(cornell(Structure::flat)).tree.scene;
  ASSERT_GT(scene.nodes.size(), 64U) << "several levels of groups";
  model->load(scene);
  device.load(scene);
  const Recorded pencils = recorded(4);
  ASSERT_FALSE(pencils.shadow.empty());
  for (const std::vector<Pencil>& kind : {pencils.camera, pencils.shadow}) {
    EXPECT_EQ(device.trace(kind), model->trace(kind));
  }
  RayClocks clocks = unit_clocks<Fp24Paper>(scene, {4, 4}, pencils.camera);
  EXPECT_EQ(clocks.rays, std::size_t{kSide * kSide});
  clocks.clocks += unit_clocks<Fp24Paper>(scene, {4, 4}, pencils.shadow).clocks;
  EXPECT_EQ(clocks.clocks, model->counters()[static_cast<std::size_t>(Counter::cycles)]);
}

TEST(Configurations, AllSeeAlmostTheSamePicture) {
  for (const Configuration& c : configurations()) {
    const Recorded pencils = recorded(c.pencil);
    const RayErrors errors = compare_rays(prepare(cornell(Structure::tree)), pencils.camera,
                                          pencils.camera_hits, hits_of(c, pencils));
    EXPECT_EQ(errors.rays, std::uint64_t{kSide * kSide});
    EXPECT_LE(errors.wrong(), 10U) << c.name;
    ASSERT_TRUE(errors.t_relative);
    const bool exact = c.name == "double" || c.name == "exact";
    EXPECT_LE(errors.t_relative->largest, exact ? 0 : 1e-3) << c.name;
    EXPECT_EQ(errors.t_relative->largest == 0, exact) << c.name;
    EXPECT_LT(errors.t_relative->median, c.netlist.empty() ? 1e-7 : 1e-5) << c.name;
  }
}

TEST(CompareRays, CountsWhatIsMissedFalseAndAnotherTriangle) {
  const Prepared prepared = prepare(cornell(Structure::tree));
  const Recorded pencils = recorded(kMaxRows);
  auto hits = pencils.camera_hits;
  const auto errors = [&] { return compare_rays(prepared, pencils.camera, pencils.camera_hits, hits); };
  EXPECT_EQ(errors().wrong(), 0U);
  // a pencil in the middle of the picture, all of whose rays hit
  std::vector<Hit>& middle = hits[hits.size() / 2];
  ASSERT_TRUE(std::all_of(middle.begin(), middle.end(), [](const Hit& hit) { return hit.hit; }));
  middle[0] = {};
  EXPECT_EQ(errors().missed, 1U);
  middle[1].triangle = middle[1].triangle == 0 ? 1 : 0;
  EXPECT_EQ(errors().other, 1U);
  middle[2].t_scaled *= 2;
  EXPECT_DOUBLE_EQ(errors().t_relative->largest, 1);
  EXPECT_EQ(errors().wrong(), 2U);
  auto shadow = pencils.shadow_hits;
  for (Hit& hit : shadow[0]) {
    hit = hit.hit ? Hit{} : Hit{true, 0, 1, 1, 0, 0};
  }
  const RayErrors turned = compare_rays(prepared, pencils.shadow, pencils.shadow_hits, shadow);
  EXPECT_EQ(turned.missed + turned.false_hits, shadow[0].size());
  EXPECT_EQ(turned.other, 0U);
}

TEST(ComparePictures, MeasuresBytes) {
  const std::vector<std::uint8_t> black(12, 0);
  std::vector<std::uint8_t> other = black;
  const PictureErrors equal = compare_pictures(black, black);
  EXPECT_EQ(equal.rmse, 0);
  EXPECT_FALSE(equal.psnr);
  other[4] = 30;
  other[5] = 40;
  const PictureErrors errors = compare_pictures(black, other);
  EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(2500.0 / 12));
  EXPECT_DOUBLE_EQ(errors.psnr.value(), 20 * std::log10(255 / errors.rmse));
  EXPECT_DOUBLE_EQ(errors.pixels_percent, 25);
}

TEST(PlaneSweep, LosesNothingWithItsMarginAndSomethingWithout) {
  const Prepared prepared = prepare(cornell(Structure::tree));
  const PlaneSweep sweep =
      sweep_planes(prepared.tree.scene, recorded(kMaxRows).camera, [](double /*share*/) {});
  ASSERT_EQ(sweep.testers.size(), 2U + kMostWidth - kLeastWidth + 1);
  std::uint64_t last = sweep.tests;
  for (const PlaneTester& tester : sweep.testers) {
    EXPECT_EQ(tester.conservative.lost, 0U) << tester.key;
    if (tester.key.front() == 'w') {
      EXPECT_LE(tester.conservative.false_meets, last) << tester.key;
      last = tester.conservative.false_meets;
    }
  }
  const auto coarse = std::find_if(sweep.testers.begin(), sweep.testers.end(),
                                   [](const PlaneTester& t) { return t.key == "w10"; });
  EXPECT_GT(coarse->bare.lost, 0U);
  EXPECT_GT(coarse->conservative.false_meets, coarse->bare.false_meets);
}

TEST(PlaneSweep, TakesTheDsp48OfTheHardwareAndMoreForWiderWords) {
  EXPECT_EQ(fixed_plane_dsp48(10), 4);
  EXPECT_EQ(fixed_plane_dsp48(18), 4) << "entity dsp_plane_test";
  EXPECT_EQ(fixed_plane_dsp48(19), 13);
  EXPECT_EQ(fixed_plane_dsp48(24), 14);
}

}  // namespace
}  // namespace raplas
