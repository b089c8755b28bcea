// The whole unit against its clocked model, every edge between the units on every clock, and against the
// value-exact walk at the end of each pencil. Random scenes and pencils; words, addresses and ranges that
// need every bit of their way. GUARD_BITS, ROWS and COLUMNS are its generics.
#include <algorithm>
#include <limits>
#include <random>

#include "operands.hpp"
#include "random_scenes.hpp"
#include "raplas/intersection_unit.hpp"
#include "support/scoreboard.hpp"

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

using F = std::conditional_t<GUARD_BITS == 0, Fp24Paper, Fp24>;
constexpr Testers kTesters{ROWS, COLUMNS};
const bool kSlow = Dut::simulator() == "ghdl";
const std::uint32_t kPencils = kSlow ? 3 : 40;
constexpr std::uint32_t kDepth = 1U << 12;  // of Sphere and Triangle memory

class IntersectionUnitBench : public testing::Test {
 protected:
  void SetUp() override {
    dut().set(dut().port("write_i"), 0);
    dut().set(dut().port("start_i"), 0);
    reset_dut();
  }

  template <std::size_t kWords>
  void write(Target target, std::size_t address, const std::array<std::uint32_t, kWords>& word) {
    std::array<std::uint32_t, TriangleLayout::kBits / 32> data{};
    std::copy(word.begin(), word.end(), data.begin());
    dut().set(dut().port("write_i"), 1);
    dut().set(dut().port("target_i"), static_cast<std::uint64_t>(target));
    dut().set(dut().port("address_i"), address);
    dut().set(dut().port("data_i"), data);
    dut().clock();
    dut().set(dut().port("write_i"), 0);
  }

  void load(const SceneMemory<F>& scene) {
    // what idle units read (address 0, and the sphere after the last) must be known: see load() of pencils
    write(Target::sphere, 0, SphereWord<F>{}.pack());
    write(Target::triangle, 0, TriangleWord<F>{}.pack());
    for (std::size_t k = scene.scene.first; k < scene.spheres.size(); ++k) {
      write(Target::sphere, k, scene.spheres[k].pack());
    }
    write(Target::sphere, scene.spheres.size(),
          SphereWord<F>{}.pack());  // read, not tested: known all the same
    for (std::size_t k = scene.scene.first; k < scene.triangles.size(); ++k) {
      write(Target::triangle, k, scene.triangles[k].pack());
    }
    write(Target::scene, 0, scene.scene.pack());
    model_.load(&scene);
  }

  /// Loads a bank, unused planes and rays too: in GHDL an unknown operand spoils its neighbour in the shared
  /// C port.
  void load(const PencilMemory<F>& pencil, std::size_t bank) {
    write(Target::pencil, bank, pencil.pencil.pack());
    for (std::size_t r = 0; r < kMaxRows; ++r) {
      write(Target::plane, bank * 32 + r, pencil.rows[r].pack());
      write(Target::plane, bank * 32 + 16 + r, pencil.columns[r].pack());
    }
    for (std::size_t ray = 0; ray < kMaxRays; ++ray) {
      write(Target::ray, bank * kMaxRays + ray, pack_ray(pencil.rays[ray]));
    }
    model_.pencil(bank) = pencil;
  }

  /// Starts the pencil of a bank and compares every edge on every clock until the unit is idle, or for
  /// `clocks`.
  void run(std::size_t bank, int clocks = std::numeric_limits<int>::max()) {
    int clock = 0;
    for (bool first = true; (first || model_.busy()) && clock < clocks; first = false, ++clock) {
      write_nowhere();
      const bool disturb = !first && random_() % 4 == 0;  // start_i while busy: ignored
      const bool start = first || disturb;
      dut().set(dut().port("start_i"), start ? 1 : 0);
      dut().set(dut().port("bank_i"), disturb ? 1 - bank : bank);
      dut().settle();
      ASSERT_NO_FATAL_FAILURE(compare(model_.edges()));
      dut().clock();
      model_.clock(start, disturb ? 1 - bank : bank);
    }
    dut().set(dut().port("start_i"), 0);
    dut().set(dut().port("write_i"), 0);
    dut().set(dut().port("bank_i"), bank);
    dut().settle();
    ASSERT_NO_FATAL_FAILURE(expect("busy_o", model_.busy() ? 1 : 0));
  }

  /// Counters and results against the clocked model and the value-exact walk.
  void check(const SceneMemory<F>& scene, const PencilMemory<F>& pencil, std::size_t bank) {
    ResultMemory<F> results;
    PencilCounters exact{};
    trace_pencil(scene, pencil, results, exact);
    PencilCounters counters{};
    dut().get(dut().port("counters_o"), counters);
    for (std::size_t k = 0; k < counters.size(); ++k) {
      ASSERT_EQ(counters[k], model_.counters()[k]) << kCounterNames[k];
      const auto counter = static_cast<Counter>(k);
      if (counter != Counter::cycles && counter != Counter::stall_cycles) {
        ASSERT_EQ(counters[k], exact[k]) << kCounterNames[k];
      }
      total_[k] += counters[k];
    }
    // a ray each clock, those outside the pencil too: they are never hit
    for (std::size_t clock = 0; clock < kMaxRays + kMemoryStages; ++clock) {
      dut().set(dut().port("result_ray_i"), bank * kMaxRays + clock % kMaxRays);
      dut().clock();
      if (clock + 1 < kMemoryStages) {
        continue;
      }
      const std::size_t ray = (clock + 1 - kMemoryStages) % kMaxRays;
      PackedWord<ResultLayout::kBits> word{};
      dut().get(dut().port("result_o"), word);
      const auto seen = ResultWord<F>::unpack(word);
      ASSERT_EQ(seen.hit, results[ray].hit) << "ray " << ray;
      if (seen.hit) {
        ASSERT_EQ(seen, results[ray]) << "ray " << ray;
      }
      ASSERT_EQ(model_.results(bank)[ray], results[ray]) << "ray " << ray;
      count_checked();
    }
  }

  IntersectionUnit<F> model_{kTesters};
  std::mt19937 random_{5};
  std::array<std::uint64_t, kNumCounters> total_{};

 private:
  /// What the write port must not take: words without write_i, and targets that there are not.
  void write_nowhere() {
    const bool write = random_() % 2 == 0;
    PackedWord<TriangleLayout::kBits> data{};
    std::generate(data.begin(), data.end(), [this] { return static_cast<std::uint32_t>(random_()); });
    dut().set(dut().port("write_i"), write ? 1 : 0);
    dut().set(dut().port("target_i"), write ? 6 + random_() % 2 : random_() % 8);
    dut().set(dut().port("address_i"), random_() & 0xfffffU);
    dut().set(dut().port("data_i"), data);
  }

  static void expect(const char* name, std::uint64_t value) { expect_port(dut().port(name), value, name); }

  void compare(const UnitEdges<F>& e) {
    ASSERT_NO_FATAL_FAILURE(expect("busy_o", model_.busy() ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("request_o", e.request.valid ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stack_level_o", static_cast<std::uint64_t>(e.stack_level)));
    if (e.request.valid) {
      ASSERT_NO_FATAL_FAILURE(expect("sphere_o", e.request.address));
      ASSERT_NO_FATAL_FAILURE(expect("set_o", static_cast<std::uint64_t>(e.request.set)));
    }
    ASSERT_NO_FATAL_FAILURE(expect("decided_o", e.decision.decided ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("leaf_o", e.decision.leaf ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("push_o", e.decision.push ? 1 : 0));
    if (e.decision.decided) {
      ASSERT_NO_FATAL_FAILURE(expect("row_mask_o", e.decision.row_mask));
      ASSERT_NO_FATAL_FAILURE(expect("column_mask_o", e.decision.column_mask));
    }
    ASSERT_NO_FATAL_FAILURE(expect("issue_o", e.issue ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stall_o", e.stall ? 1 : 0));
    if (e.pair_waits) {
      ASSERT_NO_FATAL_FAILURE(expect("ray_o", e.pair.ray));
      ASSERT_NO_FATAL_FAILURE(expect("triangle_o", e.pair.triangle));
    }
    ASSERT_NO_FATAL_FAILURE(expect("pair_done_o", e.pair_done ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("hit_o", e.hit ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stored_o", e.stored ? 1 : 0));
    if (e.pair_done) {
      ASSERT_NO_FATAL_FAILURE(expect("stored_ray_o", e.stored_ray));
      ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("stored_result_o"), e.result.pack(), "stored_result_o"));
    }
  }
};

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

TEST_F(IntersectionUnitBench, NeedsEveryBitOfEveryWord) {
  OperandPairs words(127);
  for (std::uint32_t k = 0; k < (kSlow ? 1 : 8); ++k) {
    const auto number = [&words, spread = k % 4 == 3 ? 16 : 2] {
      return F::from_bits(words.word(63 + words.between(-spread, spread)));
    };
    const auto vector = [&number] { return Vec3<F>{number(), number(), number()}; };
    PencilMemory<F> pencil;
    pencil.pencil = {16, 16, vector()};
    for (std::size_t line = 0; line < kMaxRows; ++line) {
      pencil.rows[line] = {vector(), number()};
      pencil.columns[line] = {vector(), number()};
    }
    std::generate(pencil.rays.begin(), pencil.rays.end(), vector);
    SceneMemory<F> scene;
    scene.triangles.resize(kSlow ? 64 : kDepth);
    for (TriangleWord<F>& triangle : scene.triangles) {
      triangle = {vector(), vector(), vector(), vector()};
    }
    const std::uint32_t spheres = kSlow ? 40 : 128;
    for (std::uint32_t s = 0; s < spheres; ++s) {
      const std::size_t line = s / 2 % kMaxRows;
      const PlaneWord<F>& plane = s % 2 == 0 ? pencil.rows[line] : pencil.columns[line];
      // touches one plane exactly, or misses it by an ulp; a few leaves, with one triangle or many
      SphereWord<F> sphere{vector(), F(), s % 8 == 0, 1, spheres};
      const std::uint32_t distance = plane_distance(plane, sphere.centre).magnitude();
      sphere.radius = F::from_bits(distance - (distance > 0x010000U ? words.bits(1) : 0U));
      if (sphere.leaf) {
        sphere.count = s % 64 == 0 ? 1 + words.bits(kSlow ? 3 : 6) : 1;
        sphere.first = words.bits(12) % (static_cast<std::uint32_t>(scene.triangles.size()) - sphere.count);
      }
      scene.spheres.push_back(sphere);
    }
    scene.spheres.emplace_back();  // the only child: a point
    scene.scene = {words.bits(21), spheres, 0};
    load(scene);
    load(pencil, k % 2);
    ASSERT_NO_FATAL_FAILURE(run(k % 2));
    ASSERT_NO_FATAL_FAILURE(check(scene, pencil, k % 2));
  }
  EXPECT_GT(total_[static_cast<std::size_t>(Counter::hits)], 0U);
}

TEST_F(IntersectionUnitBench, TakesIdentifiersOfAllTheirBits) {  // the memories take them modulo their depth
  Scenes<F> scenes(128);
  for (int bit = 0; bit < kIdBits; bit += kSlow ? 19 : 1) {
    const std::size_t bank = bit % 2 == 0 ? 0 : 1;
    SceneMemory<F> scene = scenes.scene(1, 3, bank == 0 ? 1U << bit : ~(1U << bit) & 0xffdffU);
    scene.scene.spheres = bit % 4 == 0 ? 0 : scenes.below(2U << kIdBits);  // from 0 it counts beyond
    load(scene);
    const PencilMemory<F> pencil = scenes.pencil(1 + scenes.below(8), 1 + scenes.below(8));
    load(pencil, bank);
    ASSERT_NO_FATAL_FAILURE(run(bank));
    ASSERT_NO_FATAL_FAILURE(check(scene, pencil, bank));
  }
}

TEST_F(IntersectionUnitBench, ReadsSpheresAndTrianglesToTheLastWord) {
  Scenes<F> scenes(129);
  constexpr std::uint32_t kSpheres = 24;
  constexpr std::uint32_t kFirst = kDepth - kSpheres;
  SceneMemory<F> scene = scenes.scene(0, kSpheres, kFirst);
  const auto beyond = static_cast<std::uint32_t>(scene.triangles.size() - kDepth);
  scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + beyond);
  for (std::uint32_t k = kFirst; k < kDepth; ++k) {
    scene.spheres[k].first -= beyond;
    scene.spheres[k].radius = F::from_double(2);  // all are met
  }
  const PencilMemory<F> pencil = scenes.pencil(3, 4);
  load(scene);
  for (std::uint32_t k = kFirst - beyond; k < kFirst; ++k) {
    write(Target::triangle, k, scene.triangles[k].pack());
  }
  load(pencil, 1);
  ASSERT_NO_FATAL_FAILURE(run(1));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 1));
}

TEST_F(IntersectionUnitBench, TakesARootRangeOfAnyLength) {
  Scenes<F> scenes(130);
  SceneMemory<F> scene;
  const SphereWord<F> aside{{F::from_double(0.9), F::from_double(0.9), F::from_double(-2)}, F(), true, 1, 0};
  constexpr int kLeast = 19;  // clocks of a range of one
  const int clocks = kSlow ? 2 * kLeast : 300;
  scene.spheres.assign(static_cast<std::size_t>(clocks), aside);
  scene.triangles.resize(1);
  const PencilMemory<F> pencil = scenes.pencil(4, 2);
  load(pencil, 1);
  for (int bit = 0; bit <= kIdBits; bit += kSlow ? 10 : 1) {
    scene.scene = {1U << bit, 1U << bit, 0};
    load(scene);
    ASSERT_NO_FATAL_FAILURE(run(1, clocks));
    EXPECT_EQ(model_.busy(), 1 << bit > clocks - kLeast) << "a range of 2^" << bit;
    reset_dut();  // nobody waits for a million spheres
    model_ = IntersectionUnit<F>(kTesters);
    model_.load(&scene);
    model_.pencil(1) = pencil;
  }
}

TEST_F(IntersectionUnitBench, CountsALongList) {  // the memory modulo its depth: many times the same spheres
  Scenes<F> scenes(132);
  SceneMemory<F> scene;
  SphereWord<F> met{{F(), F(), F()}, F::from_double(2), true, 1, 0};
  const SphereWord<F> aside{{F::from_double(0.9), F::from_double(0.9), F::from_double(-2)}, F(), true, 1, 0};
  const std::uint32_t spheres = kSlow ? 300 : 3 * kDepth;
  for (std::uint32_t k = 0; k < spheres; ++k) {
    met.first = k % 128;
    scene.spheres.push_back(k % kDepth % 3 == 0 ? met : aside);
  }
  const SceneMemory<F> triangles = scenes.scene(0, 100);
  scene.triangles.assign(triangles.triangles.begin(), triangles.triangles.begin() + 128);
  scene.scene = {kSlow ? spheres : kDepth, spheres, 0};
  const PencilMemory<F> pencil = scenes.pencil(2, 1);
  load(scene);
  write(Target::sphere, 0, scene.spheres[0].pack());  // which the word after the last one hit
  load(pencil, 1);
  ASSERT_NO_FATAL_FAILURE(run(1));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 1));
}

TEST_F(IntersectionUnitBench, StacksAsManyRangesAsThereIsRoomFor) {
  Scenes<F> scenes(131);
  const F far = F::from_double(0.9);
  SceneMemory<F> scene;
  constexpr std::uint32_t kRanges = kStackDepth;
  for (std::uint32_t k = 0; k < kRanges; ++k) {  // all met: each gives a range
    scene.spheres.push_back({{F(), F(), F()}, F::from_double(2), false, 1 + k % 2, kRanges + 2 * k});
  }
  for (std::uint32_t k = 0; k < 2 * kRanges; ++k) {
    scene.spheres.push_back({{far, far, F::from_double(-2)}, F(), true, 1, 0});
  }
  scene.triangles.resize(1);
  scene.scene = {3 * kRanges, kRanges, 0};
  const PencilMemory<F> pencil = scenes.pencil(2, 2);
  load(scene);
  load(pencil, 0);
  ASSERT_NO_FATAL_FAILURE(run(0));
  ASSERT_NO_FATAL_FAILURE(check(scene, pencil, 0));
}

}  // namespace
}  // namespace raplas
