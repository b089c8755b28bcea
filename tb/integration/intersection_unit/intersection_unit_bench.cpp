// The whole unit against its clocked and its value-exact model: random scenes and pencils, banks, resets.
#include "integration/intersection_unit/fixture.hpp"

namespace raplas {
namespace {

// stages of the spheres count from request_o, those of the pairs from issue_o
constexpr int kDecisionStage = kMemoryStages + kTesterStages + 1;
constexpr int kPairStage = kMemoryStages + kRayTriangleStages;
const PortStage kStages[]{{"request_o", 0},
                          {"sphere_o", 0},
                          {"set_o", 0},
                          {"decided_o", kDecisionStage},
                          {"leaf_o", kDecisionStage},
                          {"push_o", kDecisionStage},
                          {"row_mask_o", kDecisionStage},
                          {"column_mask_o", kDecisionStage},
                          {"issue_o", 0},
                          {"stall_o", 0},
                          {"ray_o", 0},
                          {"triangle_o", 0},
                          {"pair_done_o", kPairStage},
                          {"hit_o", kPairStage},
                          {"stored_o", kPairStage},
                          {"stored_ray_o", kPairStage},
                          {"stored_result_o", kPairStage},
                          {"result_o", kMemoryStages}};

const std::uint32_t kPencils = kSlow ? 3 : 40;

TEST_F(IntersectionUnitBench, TracesAPencilOfEverySizeThroughATree) {
  Scenes<F> scenes(121);
  const SceneMemory<F> scene = scenes.scene(3, 3, 0xb57);
  load(scene);
  for (std::uint32_t k = 0; k < kPencils; ++k) {
    const PencilMemory<F> pencil =
        scenes.pencil(k == 0 ? 16 : 1 + scenes.below(16), k == 0 ? 16 : 1 + scenes.below(16));
    load(pencil, k % 2);
    ASSERT_NO_FATAL_FAILURE(run(k % 2));
    ASSERT_NO_FATAL_FAILURE(check(scene, pencil, k % 2));
  }
  EXPECT_GT(total_[static_cast<std::size_t>(Counter::hits)], kPencils);
  EXPECT_GT(total_[static_cast<std::size_t>(Counter::stall_cycles)], 0U);
  if (Dut::simulator() != "ghdl") {  // its few pencils may skip nothing
    EXPECT_GT(total_[static_cast<std::size_t>(Counter::spheres_skipped)], 0U);
  }
}

TEST_F(IntersectionUnitBench, TracesTheFlatListOfThePaper) {
  Scenes<F> scenes(122);
  for (std::uint32_t k = 0; k < kPencils; ++k) {
    const SceneMemory<F> scene = scenes.scene(0, 20 + scenes.below(60));
    load(scene);
    const PencilMemory<F> pencil = scenes.pencil(4, 4);
    load(pencil, 0);
    ASSERT_NO_FATAL_FAILURE(run(0));
    ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 0));
  }
  EXPECT_EQ(total_[static_cast<std::size_t>(Counter::spheres_skipped)], 0U);
}

TEST_F(IntersectionUnitBench, EndsAPencilOfAnEmptySceneWithItsHitsCleared) {
  Scenes<F> scenes(124);
  const SceneMemory<F> full = scenes.scene(0, 30);
  const PencilMemory<F> pencil = scenes.pencil(4, 4);
  load(full);
  load(pencil, 0);
  load(pencil, 1);
  ASSERT_NO_FATAL_FAILURE(run(0));
  SceneMemory<F> empty;
  empty.spheres.resize(1);  // the address that the idle unit reads
  load(empty);
  ASSERT_NO_FATAL_FAILURE(run(0));
  ASSERT_NO_FATAL_FAILURE(run(1));  // at once: the first bank must be clear by then
  ASSERT_NO_FATAL_FAILURE(check(empty, pencil, 0));
}

TEST_F(IntersectionUnitBench, StartsAfreshAfterAResetInTheMiddleOfAPencil) {
  Scenes<F> scenes(125);
  const SceneMemory<F> scene = scenes.scene(2, 4);
  const std::array<PencilMemory<F>, 2> pencils{scenes.pencil(16, 16), scenes.pencil(4, 7)};
  load(scene);
  load(pencils[0], 0);
  load(pencils[1], 1);
  for (int clocks = 1; clocks < 90; clocks += Dut::simulator() == "ghdl" ? 29 : 1) {
    dut().set(dut().port("bank_i"), 0);
    dut().set(dut().port("start_i"), 1);
    dut().clock();
    dut().set(dut().port("start_i"), 0);
    for (int k = 0; k < clocks; ++k) {
      dut().clock();
    }
    reset_dut();
    model_ = IntersectionUnit<F>(kTesters);
    model_.load(&scene);
    model_.pencil(1) = pencils[1];
    ASSERT_NO_FATAL_FAILURE(run(1)) << "after " << clocks << " clocks";
    ASSERT_NO_FATAL_FAILURE(check(scene, pencils[1], 1)) << "after " << clocks << " clocks";
  }
}

TEST_F(IntersectionUnitBench, TakesSetsTimesSpheresAnd17ClocksForAListThatIsMissed) {
  Scenes<F> scenes(126);
  constexpr std::uint32_t kSpheres = 37;
  SceneMemory<F> scene;
  const SphereWord<F> aside{{F::from_double(0.9), F::from_double(0.9), F::from_double(-2)}, F(), true, 1, 0};
  scene.spheres.assign(kSpheres, aside);
  scene.triangles.resize(1);
  scene.scene = {kSpheres, kSpheres, 0};
  const PencilMemory<F> pencil = scenes.pencil(16, 3);
  load(scene);
  load(pencil, 0);
  ASSERT_NO_FATAL_FAILURE(run(0));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 0));
  const std::uint32_t sets = std::max(16 / ROWS, (3 + COLUMNS - 1) / COLUMNS);
  EXPECT_EQ(total_[static_cast<std::size_t>(Counter::cycles)], kSpheres * sets + 17);
}

TEST_F(IntersectionUnitBench, LoadsTheOtherBankWhileAPencilRuns) {
  Scenes<F> scenes(123);
  const SceneMemory<F> scene = scenes.scene(3, 6);
  load(scene);
  const std::array<PencilMemory<F>, 2> pencils{scenes.pencil(16, 16), scenes.pencil(5, 16)};
  load(pencils[0], 0);
  dut().set(dut().port("bank_i"), 0);
  dut().set(dut().port("start_i"), 1);
  dut().clock();
  dut().set(dut().port("start_i"), 0);
  model_.clock(true, 0);
  const std::uint64_t before = dut().cycles();
  load(pencils[1], 1);
  ASSERT_EQ(dut().get(dut().port("busy_o")), 1U) << "the pencil is too short for this test";
  for (std::uint64_t k = 0; k < dut().cycles() - before; ++k) {
    model_.clock(false, 0);
  }
  while (dut().get(dut().port("busy_o")) != 0) {
    dut().clock();
    model_.clock(false, 0);
  }
  EXPECT_FALSE(model_.busy());
  ASSERT_NO_FATAL_FAILURE(check(scene, pencils[0], 0));
  ASSERT_NO_FATAL_FAILURE(run(1));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencils[1], 1));
}

}  // namespace
}  // namespace raplas
