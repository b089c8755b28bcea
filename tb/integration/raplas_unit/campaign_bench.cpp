// A long campaign: RAPLAS_CASES pencils through random trees, every hit against its definition. Its figures
// go where RAPLAS_FIGURES says.
#include "figures.hpp"
#include "integration/raplas_unit/fixture.hpp"

namespace raplas {
namespace {

constexpr std::uint32_t kPencils = 100;  // of a scene

/// Scenes of all sizes that fit, anywhere in the memories.
FixedSceneMemory<F> any_scene(FixedScenes<F>& scenes, bool large, FixedPlaces& places) {
  const auto left = [](std::size_t depth, const auto& memory) {
    return static_cast<std::uint32_t>(depth - std::min(depth, memory.size()));
  };
  for (;;) {
    const std::uint32_t triangles =
        large ? 500 + scenes.below(3500) : 1 + scenes.below(1U << scenes.below(8));
    const FixedSceneMemory<F> scene = scenes.scene(triangles, 2 + scenes.below(5));
    const FixedPlaces room{left(1U << 12, scene.nodes), left(1U << 13, scene.vertices),
                           left(1U << 12, scene.triangles)};
    if (room.nodes != 0 && room.vertices != 0 && room.triangles != 0) {
      const auto place = [&](std::uint32_t most) { return scenes.below(3) == 0 ? most : scenes.below(most); };
      places = {place(room.nodes), place(room.vertices), place(room.triangles)};
      return moved(scene, places);
    }
  }
}

TEST_F(RaplasUnitBench, FindsTheHitsOfTheDefinition) {
  if (kSlow) {
    GTEST_SKIP() << "in Verilator only";
  }
  const std::uint64_t cases = number_of_cases(4 * kPencils);
  FixedScenes<F> scenes(231);
  std::uint64_t done = 0;
  for (int k = 1; done < cases; ++k) {
    FixedPlaces places;
    const FixedSceneMemory<F> scene = any_scene(scenes, k % 16 == 0, places);
    load(scene, places);
    std::vector<FixedPencilMemory<F>> pencils;
    while (pencils.size() < std::min<std::uint64_t>(kPencils, cases - done)) {
      const bool full = scenes.below(2) == 0;
      const auto lines = [&] { return full ? 16 : 1 + scenes.below(16); };
      pencils.push_back(scenes.certified(scenes.pencil(lines(), lines()), 3));
    }
    ASSERT_NO_FATAL_FAILURE(stream(pencils, kPencilBanks, Oracle::definition));
    done += pencils.size();
  }
  EXPECT_GT(hits_, cases);
  EXPECT_EQ(differences_, 0U);
  Figures figures("make soak");
  figures.add("unit_random.pencils", done, "pencils");
  figures.add("unit_random.hits", hits_, "hits");
  figures.add("unit_random.differences", differences_, "rays");
  figures.write();
}

}  // namespace
}  // namespace raplas
