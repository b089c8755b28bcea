// The whole unit of profile raplas beside its clocked model. Pencils stream through the banks: while some
// run, one is loaded and the results of another are read.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <type_traits>
#include <vector>

#include "possible_hits.hpp"
#include "random_fixed_scenes.hpp"
#include "raplas/host_port.hpp"
#include "raplas/raplas_unit.hpp"
#include "support/scoreboard.hpp"

namespace raplas {

using F = Fp24;
const bool kSlow = Dut::simulator() == "ghdl";

class RaplasUnitBench : public testing::Test {
 protected:
  void SetUp() override {
    dut().set(dut().port("write_i"), 0);
    dut().set(dut().port("start_i"), 0);
    reset_dut();
  }

  /// `scene` must outlive the pencils.
  void load(const FixedSceneMemory<F>& scene, const FixedPlaces& from = {}) {
    // what idle units read must be known: address 0, and the word after the last one
    const auto put = [](Target target, const auto& words, std::size_t first, std::size_t last) {
      const auto word = [&words](std::size_t k) {
        return k < words.size() ? words[k] : typename std::decay_t<decltype(words)>::value_type{};
      };
      if (first != 0) {
        write(host_word(target, 0, word(0).pack()));
      }
      for (std::size_t k = first; k < last; ++k) {
        write(host_word(target, k % (1U << kIdBits), word(k).pack()));
      }
    };
    put(Target::sphere, scene.nodes, from.nodes, scene.nodes.size() + 1);
    put(Target::vertex, scene.vertices, from.vertices, scene.vertices.size() + 1);
    put(Target::triangle, scene.triangles, from.triangles, scene.triangles.size());
    write(host_word(Target::scene, 0, scene.scene.pack()));
    model_.load(&scene);
    scene_ = &scene;
  }

  /// What the hits must be. Of certified hits they are the model's, with what PossibleHits wants.
  enum class Oracle {
    walk,        ///< those of FixedTrace; and the model's edges on every clock
    model,       ///< the model's, of scenes that are none; and its edges on every clock
    definition,  ///< those of FixedTrace without a skip; differences are counted
  };

  /// Streams pencils through the unit, at most `most` of them loaded or running, or running or read, at a
  /// time.
  void stream(const std::vector<FixedPencilMemory<F>>& pencils, std::size_t most = kPencilBanks,
              Oracle oracle = Oracle::walk) {
    constexpr std::uint64_t kMostClocks = 20'000;
    constexpr std::size_t kRays = std::size_t{kMaxRows} * kMaxColumns;
    const std::size_t step = kSlow ? 5 : 1;  // from one ray that is read to the next
    struct Reading {
      std::size_t pencil;
      std::size_t ray;
    };
    std::size_t loaded = 0;  // pencils whose words are all written
    std::size_t word = 0;    // next one of the pencil after them
    std::size_t started = 0;
    std::size_t finished = 0;  // the unit is done with them
    std::size_t read = 0;
    std::deque<Reading> reading;  // rays asked for, the youngest last
    std::size_t next_ray = 0;
    FixedTrace<F>::Results expected{};
    const std::uint64_t deadline = dut().cycles() + kMostClocks * pencils.size();
    while (read < pencils.size()) {
      ASSERT_LT(dut().cycles(), deadline) << "the unit hangs";
      // host: write
      if (loaded < pencils.size() && loaded - finished < most) {
        const FixedPencilMemory<F>& pencil = pencils[loaded];
        apply(pencil_word(pencil, loaded % kPencilBanks, word));
        if (++word == pencil_words(pencil)) {
          model_.pencil(loaded % kPencilBanks) = pencil;
          ++loaded;
          word = 0;
        }
      } else {
        write_nowhere();
      }
      // host: read
      if (read < finished) {
        if (next_ray == 0) {
          const std::uint64_t rows = dut().get(dut().port("hit_rows_o"));
          ASSERT_EQ(rows >> (read % kPencilBanks * kMaxRows) & 0xffffU, model_.hit_rows(read % kPencilBanks));
          const bool certified = pencils[read].limits.band != 0;
          expected = oracle == Oracle::model || certified ? model_.results(read % kPencilBanks)
                     : oracle == Oracle::walk             ? FixedTrace<F>(*scene_, pencils[read]).results()
                                              : FixedTrace<F>(*scene_, pencils[read], kNoSkips).results();
          if (certified && oracle != Oracle::model) {
            ASSERT_NO_FATAL_FAILURE(expect_possible(pencils[read], expected));
          }
        }
        dut().set(dut().port("result_ray_i"), read % kPencilBanks * kRays + next_ray % kRays);
        reading.push_back({read, next_ray});
        next_ray += step;
      }
      // host: start, sometimes a bank that is busy
      const bool start = started < ready_ && started - read < most;
      const bool disturb = !start && started > finished && random_() % 4 == 0;
      const std::size_t bank = (disturb ? finished : started) % kPencilBanks;
      dut().set(dut().port("start_i"), start || disturb ? 1 : 0);
      dut().set(dut().port("bank_i"), bank);
      if (oracle != Oracle::definition) {
        dut().settle();
        ASSERT_NO_FATAL_FAILURE(compare(model_.edges()));
      }
      dut().clock();
      model_.clock(start || disturb, bank);
      started += start ? 1 : 0;
      ready_ = loaded;
      ASSERT_EQ(dut().get(dut().port("busy_o")), model_.busy()) << "in clock " << dut().cycles();
      while (finished < started && (model_.busy() >> (finished % kPencilBanks) & 1U) == 0) {
        ++finished;
      }
      if (reading.size() == kMemoryStages) {
        const Reading done = reading.front();
        reading.pop_front();
        const FixedPencilMemory<F>& pencil = pencils[done.pencil];
        if (oracle == Oracle::definition) {
          differences_ += same_result(pencil, expected[done.ray]) ? 0U : 1U;
        } else {
          ASSERT_TRUE(same_result(pencil, expected[done.ray])) << "ray " << done.ray;
        }
        if (done.ray + step >= kRays) {
          reading.clear();
          next_ray = 0;
          ++read;
        }
      }
    }
    ready_ = 0;
    dut().set(dut().port("write_i"), 0);
    dut().set(dut().port("start_i"), 0);
    dut().settle();
    ASSERT_NO_FATAL_FAILURE(expect("busy_o", 0));
    ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("counters_o"), model_.counters(), "counters_o"));
  }

  RaplasUnit<F> model_;
  std::mt19937 random_{5};

  static constexpr Skips kNoSkips{false, false, false, false, false, false, false, false};

  static void write(const HostWord& word) {
    apply(word);
    dut().clock();
    dut().set(dut().port("write_i"), 0);
  }

  std::uint64_t hits_ = 0;
  std::uint64_t rivals_ = 0;  ///< of certified hits
  std::uint64_t crowds_ = 0;
  std::uint64_t differences_ = 0;  ///< of Oracle::definition

 private:
  static void apply(const HostWord& word) {
    dut().set(dut().port("write_i"), 1);
    dut().set(dut().port("target_i"), static_cast<std::uint64_t>(word.target));
    dut().set(dut().port("address_i"), word.address);
    dut().set(dut().port("data_i"), word.data);
  }

  /// What the write port must not take.
  void write_nowhere() {
    HostWord word{static_cast<Target>(random_() % 8), random_() & kLastId, {}};
    std::generate(word.data.begin(), word.data.end(),
                  [this] { return static_cast<std::uint32_t>(random_()); });
    apply(word);
    dut().set(dut().port("write_i"), 0);
  }

  /// The words hold what they must of the triangles that the rays may hit.
  void expect_possible(const FixedPencilMemory<F>& pencil, const FixedTrace<F>::Results& words) {
    const PossibleHits<F> possible(*scene_, pencil);
    for (std::uint32_t ray = 0; ray < words.size(); ++ray) {
      ASSERT_EQ(possible.wrong(ray, words[ray]), "") << "ray " << ray;
      rivals_ += words[ray].rival ? 1U : 0U;
      crowds_ += words[ray].crowd ? 1U : 0U;
    }
  }

  /// What is read of a ray is what is expected.
  bool same_result(const FixedPencilMemory<F>& pencil, const RayHits<F>& expected) {
    PackedWord<RayHitsLayout::kBits> word{};
    dut().get(dut().port("result_o"), word);
    const auto seen = RayHits<F>::unpack(word);
    const bool hit = seen.nearest.hit;
    hits_ += hit ? 1 : 0;
    count_checked();
    return hit == expected.nearest.hit && !(hit && dut().has_unknown(dut().port("result_o"))) &&
           (!hit || (pencil.limits.any_hit && pencil.limits.band == 0) || seen == expected);
  }

  static void expect(const char* name, std::uint64_t value) { expect_port(dut().port(name), value, name); }

  static void expect_points(const std::array<GridPoint, 3>& points) {
    PackedWord<3 * QueuedTriangle::kPointBits> word{};
    dut().get(dut().port("found_points_o"), word);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const int lsb = static_cast<int>(2 - k) * QueuedTriangle::kPointBits;
      const auto place = [](std::int32_t x) { return static_cast<std::uint32_t>(x) & 0xffffU; };
      ASSERT_EQ(extract(word, {lsb + 2 * kGridBits, 1}), points[k].known ? 1U : 0U) << "found_points_o";
      if (points[k].known) {
        ASSERT_EQ(extract(word, {lsb + kGridBits, kGridBits}), place(points[k].across)) << "found_points_o";
        ASSERT_EQ(extract(word, {lsb, kGridBits}), place(points[k].down)) << "found_points_o";
      }
    }
  }

  void compare(const RaplasEdges<F>& e) {
    ASSERT_NO_FATAL_FAILURE(expect("busy_o", model_.busy()));
    ASSERT_NO_FATAL_FAILURE(expect("request_o", e.request.valid ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stack_level_o", static_cast<std::uint64_t>(e.stack_level)));
    if (e.request.valid) {
      ASSERT_NO_FATAL_FAILURE(expect("vertex_o", e.request.vertex ? 1 : 0));
      ASSERT_NO_FATAL_FAILURE(expect("object_o", e.request.address));
    }
    ASSERT_NO_FATAL_FAILURE(expect("push_o", e.push ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("triangle_found_o", e.triangle_found ? 1 : 0));
    if (e.triangle_found) {
      ASSERT_NO_FATAL_FAILURE(expect("found_triangle_o", e.found.triangle));
      ASSERT_NO_FATAL_FAILURE(expect("found_rows_o", e.found.rows));
      ASSERT_NO_FATAL_FAILURE(expect("found_columns_o", e.found.columns));
      ASSERT_NO_FATAL_FAILURE(expect("found_z_o", e.found.z));
      ASSERT_NO_FATAL_FAILURE(expect_points(e.found.points));
    }
    ASSERT_NO_FATAL_FAILURE(expect("issue_o", e.issue ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stall_o", e.stall ? 1 : 0));
    if (e.issue) {
      ASSERT_NO_FATAL_FAILURE(expect("ray_o", e.ray));
      ASSERT_NO_FATAL_FAILURE(expect("triangle_o", e.triangle));
    }
    ASSERT_NO_FATAL_FAILURE(expect("hit_o", e.hit ? 1 : 0));
    ASSERT_NO_FATAL_FAILURE(expect("stored_o", e.stored.kept.write ? 1 : 0));
    if (e.stored.kept.write) {
      ASSERT_NO_FATAL_FAILURE(expect("stored_ray_o", e.stored.ray));
      ASSERT_NO_FATAL_FAILURE(
          expect_port(dut().port("stored_result_o"), e.stored.kept.word.pack(), "stored_result_o"));
    }
  }

  const FixedSceneMemory<F>* scene_ = nullptr;
  std::size_t ready_ = 0;  ///< pencils that may start in this clock
};

}  // namespace raplas
