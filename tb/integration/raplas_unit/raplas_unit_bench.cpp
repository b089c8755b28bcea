// The whole unit of profile raplas: every edge between the units on every clock as in the model, and the hits
// of the walk without clocks for every pencil.
#include "integration/raplas_unit/fixture.hpp"

namespace raplas {
namespace {

// stages of the objects count from request_o, those of the pairs from issue_o
constexpr int kFoundStage = kMemoryStages + kPlaneTestStages + kDepthCodeStages + 1;
constexpr int kPairStage = kMemoryStages + kRayTriangleStages - kMulStages;
const PortStage kStages[]{{"request_o", 0},
                          {"vertex_o", 0},
                          {"object_o", 0},
                          {"push_o", kFoundStage - 1},
                          {"triangle_found_o", kFoundStage},
                          {"found_triangle_o", kFoundStage},
                          {"found_rows_o", kFoundStage},
                          {"found_columns_o", kFoundStage},
                          {"found_z_o", kFoundStage},
                          {"issue_o", 0},
                          {"ray_o", 0},
                          {"triangle_o", 0},
                          {"hit_o", kPairStage},
                          {"result_o", kMemoryStages}};

TEST_F(RaplasUnitBench, StreamsPencilsOfEverySizeThroughTrees) {
  FixedScenes<F> scenes(221);
  for (int k = 0; k < (kSlow ? 1 : 30); ++k) {
    const auto any_place = [&scenes] { return scenes.below(600); };
    const FixedPlaces places{any_place(), any_place(), any_place()};
    const FixedSceneMemory<F> scene =
        moved(scenes.scene(1 + scenes.below(kSlow ? 40 : 300), 2 + scenes.below(5)), places);
    load(scene, places);
    std::vector<FixedPencilMemory<F>> pencils;
    for (int p = 0; p < (kSlow ? 5 : 16); ++p) {
      const bool full = scenes.below(3) == 0;
      const auto lines = [&] { return full ? 16 : 1 + scenes.below(16); };
      pencils.push_back(scenes.certified(scenes.pencil(lines(), lines()), 3));
    }
    ASSERT_NO_FATAL_FAILURE(stream(pencils, kSlow ? 4 : 1 + scenes.below(kPencilBanks)));
  }
  EXPECT_GT(hits_, kSlow ? 5U : 5000U);
  EXPECT_GE(rivals_, kSlow ? 0U : 500U);
  EXPECT_GE(crowds_, kSlow ? 0U : 50U);
}

TEST_F(RaplasUnitBench, EndsThePencilsOfAnEmptyScene) {
  FixedScenes<F> scenes(222);
  const FixedSceneMemory<F> full = scenes.scene(kSlow ? 10 : 40);
  load(full);
  const std::uint32_t lines = kSlow ? 5 : 16;
  const std::vector<FixedPencilMemory<F>> pencils{scenes.pencil(lines, lines), scenes.pencil(lines, 16)};
  ASSERT_NO_FATAL_FAILURE(stream(pencils));
  FixedSceneMemory<F> empty;
  empty.triangles.resize(1);
  load(empty);
  ASSERT_NO_FATAL_FAILURE(stream(pencils));
}

constexpr std::uint32_t kTriangles = 90;

/// A strip before all rays of FixedScenes::ahead().
FixedSceneMemory<F> strip(double z, double step) {
  FixedSceneMemory<F> scene;
  for (std::uint32_t v = 0; v < kTriangles + 2; ++v) {
    constexpr std::array<std::array<double, 2>, 3> kCorners{{{-0.9, -0.9}, {0.9, -0.9}, {0, 0.9}}};
    const auto fixed = [](double x) { return static_cast<std::int32_t>(x * 0x1p17); };
    const std::uint32_t slot = v % 3;
    VertexWord vertex{
        {fixed(kCorners[slot][0]), fixed(kCorners[slot][1]), fixed(z + step * v)}, slot, v >= 2, 0};
    if (vertex.emit) {
      vertex.triangle = v - 2;
      std::array<FixedVec3, 3> corners;
      corners[slot] = vertex.point;
      for (std::uint32_t back = 1; back < 3; ++back) {
        const VertexWord& before = scene.vertices[v - back];
        corners[before.slot] = before.point;
      }
      scene.triangles.push_back(FixedScenes<F>::triangle(corners));
    }
    scene.vertices.push_back(vertex);
  }
  NodeWord all;
  all.radius = 0x20000;
  all.leaf = true;
  all.count = kTriangles + 2;
  scene.nodes = {all};
  scene.scene = {1, 1, 0};
  return scene;
}

TEST_F(RaplasUnitBench, WaitsForRoomInTheTriangleQueue) {  // a strip before all rays, the nearest one last
  FixedScenes<F> scenes(224);
  const FixedSceneMemory<F> scene = strip(0.5, -0.005);
  load(scene);
  std::vector<FixedPencilMemory<F>> pencils;
  for (const std::uint32_t lines :
       kSlow ? std::vector<std::uint32_t>{2} : std::vector<std::uint32_t>{1, 2, 3, 5, 16}) {
    pencils.push_back(scenes.ahead(lines, lines));
    pencils.push_back(pencils.back());
    pencils.back().limits.any_hit = true;  // most pairs are dropped
    pencils.push_back(scenes.certified(pencils.front()));
  }
  const std::uint64_t before = model_.counters()[static_cast<std::size_t>(Counter::pairs_tested)];
  ASSERT_NO_FATAL_FAILURE(stream(pencils));
  EXPECT_GE(model_.counters()[static_cast<std::size_t>(Counter::pairs_tested)] - before, kTriangles * 4);
}

TEST_F(RaplasUnitBench,
       TestsWhatIsNearlyAsNearAsACertifiedHit) {  // pieces of one triangle, the nearest first
  FixedScenes<F> scenes(225);
  FixedSceneMemory<F> scene = strip(0.1, 0.0003);
  for (VertexWord& vertex : scene.vertices) {
    vertex.triangle = 0;
  }
  load(scene);
  const auto pairs = [this] { return model_.counters()[static_cast<std::size_t>(Counter::pairs_tested)]; };
  FixedPencilMemory<F> pencil = scenes.ahead(2, 2);
  ASSERT_NO_FATAL_FAILURE(stream({pencil}));
  const std::uint64_t plain = pairs();
  pencil.limits.band = kBandExponent << kFractionBits;
  ASSERT_NO_FATAL_FAILURE(stream({pencil}));
  EXPECT_GE(pairs() - plain, plain + 40);
}

TEST_F(RaplasUnitBench, StartsAfreshAfterAResetInTheMiddle) {
  FixedScenes<F> scenes(223);
  const FixedSceneMemory<F> scene = scenes.scene(kSlow ? 15 : 60);
  load(scene);
  const std::vector<FixedPencilMemory<F>> pencils{scenes.pencil(kSlow ? 6 : 16, kSlow ? 6 : 16),
                                                  scenes.certified(scenes.pencil(4, 7))};
  for (const int clocks :
       kSlow ? std::vector<int>{60} : std::vector<int>{1, 5, 20, 30, 50, 70, 90, 120, 200}) {
    for (std::size_t bank = 0; bank < pencils.size(); ++bank) {
      for (std::size_t word = 0; word < pencil_words(pencils[bank]); ++word) {
        write(pencil_word(pencils[bank], bank, word));
      }
      dut().set(dut().port("bank_i"), bank);
      dut().set(dut().port("start_i"), 1);
      dut().clock();
      dut().set(dut().port("start_i"), 0);
    }
    for (int k = 0; k < clocks; ++k) {
      dut().clock();
    }
    reset_dut();
    model_ = RaplasUnit<F>();
    model_.load(&scene);
    ASSERT_NO_FATAL_FAILURE(stream(pencils)) << "after " << clocks << " clocks";
  }
}

}  // namespace
}  // namespace raplas
