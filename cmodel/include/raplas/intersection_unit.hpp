// The whole accelerator: value-exact (trace_pencil) and clock by clock (IntersectionUnit).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raplas/clocked.hpp"
#include "raplas/plane_sphere.hpp"
#include "raplas/ray_triangle.hpp"
#include "raplas/selector.hpp"
#include "raplas/traversal.hpp"
#include "raplas/words.hpp"

namespace raplas {

/// Sphere and Triangle memories and the scene register.
template <typename F>
struct SceneMemory {
  std::vector<SphereWord<F>> spheres;
  std::vector<TriangleWord<F>> triangles;
  SceneWord scene;
};

/// One bank of the Plane and Ray memories and its pencil register.
template <typename F>
struct PencilMemory {
  PencilWord<F> pencil;
  std::array<PlaneWord<F>, kMaxRows> rows;
  std::array<PlaneWord<F>, kMaxColumns> columns;
  std::array<Vec3<F>, kMaxRays> rays;  ///< ray (r, c) at r * kMaxColumns + c
};

/// One bank of the Result Memory.
template <typename F>
using ResultMemory = std::array<ResultWord<F>, kMaxRays>;

/// Number of testers.
struct Testers {
  int rows = 4;
  int columns = 4;
};

/// The hits of a pencil and the counters that don't depend on the clock (cycles and stall_cycles stay 0):
/// what the clocked model and the RTL must give whatever their timing.
template <typename F>
void trace_pencil(const SceneMemory<F>& scene, const PencilMemory<F>& pencil, ResultMemory<F>& results,
                  EventCounters& counters) {
  results.fill({});
  counters.fill(0);
  const auto count = [&counters](Counter c) -> std::uint32_t& {
    return counters[static_cast<std::size_t>(c)];
  };
  count(Counter::spheres_skipped) = scene.scene.spheres;
  std::vector<SphereRange> ranges{{scene.scene.first, scene.scene.count}};
  while (!ranges.empty()) {
    const SphereRange range = ranges.back();
    ranges.pop_back();
    for (std::uint32_t id = range.first; id < range.first + range.count; ++id) {
      const SphereWord<F>& sphere = scene.spheres[id];
      Leaf leaf{sphere.first, sphere.count, 0, 0};
      for (std::uint32_t k = 0; k < pencil.pencil.rows; ++k) {
        leaf.row_mask |= (plane_meets_sphere(pencil.rows[k], sphere.centre, sphere.radius) ? 1U : 0U) << k;
      }
      for (std::uint32_t k = 0; k < pencil.pencil.columns; ++k) {
        leaf.column_mask |= (plane_meets_sphere(pencil.columns[k], sphere.centre, sphere.radius) ? 1U : 0U)
                            << k;
      }
      ++count(Counter::spheres_tested);
      --count(Counter::spheres_skipped);
      count(Counter::plane_tests) += pencil.pencil.rows + pencil.pencil.columns;
      if (leaf.row_mask == 0 || leaf.column_mask == 0) {
        continue;
      }
      if (!sphere.leaf) {
        ranges.push_back({sphere.first, sphere.count});
        continue;
      }
      for (std::uint32_t k = 0; k < leaf.count; ++k) {
        for (std::uint32_t ray = 0; ray < kMaxRays; ++ray) {
          if (((leaf.row_mask >> (ray / kMaxColumns)) & (leaf.column_mask >> (ray % kMaxColumns)) & 1U) ==
              0) {
            continue;
          }
          ++count(Counter::pairs_tested);
          const std::uint32_t triangle = leaf.first + k;
          const auto s = solve(scene.triangles[triangle], pencil.pencil.origin, pencil.rays[ray]);
          ResultWord<F>& best = results[ray];
          if (s.hit && nearer(s.t, s.d, triangle, best)) {
            count(Counter::hits) += best.hit ? 0 : 1;
            best = {true, triangle, s.t, s.d, s.u, s.v};
          }
        }
      }
    }
  }
}

/// What the units say to each other in one clock: the last port group of entity intersection_unit.
template <typename F>
struct UnitEdges {
  SphereRequest request;
  int stack_level = 0;
  Decision decision;
  bool pair_waits = false;
  bool issue = false;
  bool stall = false;
  Pair pair;
  bool pair_done = false;
  bool hit = false;
  bool stored = false;
  std::uint32_t stored_ray = 0;
  ResultWord<F> result;
};

/// Entity intersection_unit, clock by clock. The scene must stay alive and unchanged while a pencil runs.
template <typename F>
class IntersectionUnit {
 public:
  explicit IntersectionUnit(Testers testers = {})
      : testers_(testers), decoder_(testers.rows, testers.columns) {}

  void load(const SceneMemory<F>* scene) noexcept { scene_ = scene; }
  [[nodiscard]] PencilMemory<F>& pencil(std::size_t bank) noexcept { return pencils_[bank]; }
  [[nodiscard]] const ResultMemory<F>& results(std::size_t bank) const noexcept { return results_[bank]; }
  [[nodiscard]] bool busy() const noexcept { return busy_; }
  [[nodiscard]] const EventCounters& counters() const noexcept { return counters_; }

  /// What crosses the edges between the units in the clock that comes next.
  [[nodiscard]] UnitEdges<F> edges() const {
    UnitEdges<F> e;
    e.request = traversal_.request(last_set(), static_cast<int>(leaves_.count()));
    e.stack_level = traversal_.level();
    e.decision = decoder_.out();
    e.pair_waits = pairs_.valid();
    e.pair = pairs_.front();
    e.stall = e.pair_waits && issue_.blocked(e.pair.ray);
    e.issue = e.pair_waits && !e.stall;
    const Tested& done = solver_.out();
    e.pair_done = done.valid;
    e.hit = done.valid && done.solution.hit;
    e.stored_ray = done.pair.ray;
    e.stored =
        e.hit && nearer(done.solution.t, done.solution.d, done.pair.triangle, results_[bank_][done.pair.ray]);
    e.result = {e.hit,           done.pair.triangle, done.solution.t,
                done.solution.d, done.solution.u,    done.solution.v};
    return e;
  }

  /// One clock; `start` begins the pencil of `bank` unless the unit is busy.
  void clock(bool start, std::size_t bank) {
    if (!busy_ && !start && idle()) {
      return;
    }
    const UnitEdges<F> e = edges();
    const bool was_idle = idle();
    const bool first_hit = e.hit && !results_[bank_][e.stored_ray].hit;
    count(e, first_hit);
    if (e.stored) {
      results_[bank_][e.stored_ray] = e.result;
    }

    const bool selector_takes = pairs_.ready();
    const bool leaf_taken = selector_.ready(selector_takes);
    const bool pair_made = selector_.valid();
    const Pair pair = selector_.pair();
    selector_.clock(leaves_.valid(), leaves_.front(), selector_takes);
    pairs_.clock(pair_made, pair, e.issue);
    issue_.clock(e.issue, e.pair.ray);
    in_pipe_ += (e.issue ? 1 : 0) - (e.pair_done ? 1 : 0);
    solver_.clock(e.issue ? solve_pair(e.pair) : Tested{});

    const SphereRange children{node_.first, node_.count};
    leaves_.clock(e.decision.leaf,
                  {children.first, children.count, e.decision.row_mask, e.decision.column_mask}, leaf_taken);
    const bool starting = starting_;
    traversal_.clock(starting, {scene_->scene.first, scene_->scene.count}, e.request, e.decision.push,
                     children, e.decision.decided);
    const Flagged flagged = testers_line_.out();
    node_ = flagged.node;
    const PencilWord<F>& size = pencils_[bank_].pencil;
    decoder_.clock(static_cast<int>(size.rows), static_cast<int>(size.columns), flagged.valid, flagged.set,
                   flagged.last, flagged.node.leaf, flagged.flags);
    testers_line_.clock(e.request.valid ? test(e.request) : Flagged{});

    starting_ = start && !busy_;
    if (start && !busy_) {
      busy_ = true;
      bank_ = bank;
    } else if (was_idle) {
      busy_ = false;
    }
    if (starting) {
      results_[bank_].fill({});
    }
  }

 private:
  struct Node {
    bool leaf = false;
    std::uint32_t count = 0;
    std::uint32_t first = 0;
  };
  struct Flagged {
    bool valid = false;
    bool last = false;
    int set = 0;
    Node node;
    PlaneFlags flags;
  };
  struct Tested {
    bool valid = false;
    Pair pair;
    Solution<F> solution;
  };

  [[nodiscard]] bool idle() const noexcept {
    return traversal_.idle() && !starting_ && !leaves_.valid() && !selector_.valid() && !pairs_.valid() &&
           in_pipe_ == 0;
  }

  [[nodiscard]] int last_set() const noexcept {
    const PencilWord<F>& size = pencils_[bank_].pencil;
    return std::max((static_cast<int>(size.rows) - 1) / testers_.rows,
                    (static_cast<int>(size.columns) - 1) / testers_.columns);
  }

  [[nodiscard]] Flagged test(const SphereRequest& request) const {
    const SphereWord<F>& sphere = scene_->spheres[request.address];
    const PencilMemory<F>& pencil = pencils_[bank_];
    Flagged result{true, request.last_set, request.set, {sphere.leaf, sphere.count, sphere.first}, {}};
    const auto flags = [&](const auto& planes, int testers, std::uint32_t lines) {
      std::uint32_t bits = 0;
      for (int k = 0; k < testers; ++k) {
        const auto line = static_cast<std::size_t>(request.set) * static_cast<std::size_t>(testers) +
                          static_cast<std::size_t>(k);
        if (line < lines && plane_meets_sphere(planes[line], sphere.centre, sphere.radius)) {
          bits |= 1U << k;
        }
      }
      return bits;
    };
    result.flags = {flags(pencil.rows, testers_.rows, pencil.pencil.rows),
                    flags(pencil.columns, testers_.columns, pencil.pencil.columns)};
    return result;
  }

  [[nodiscard]] Tested solve_pair(Pair pair) const {
    const PencilMemory<F>& pencil = pencils_[bank_];
    return {true, pair, solve(scene_->triangles[pair.triangle], pencil.pencil.origin, pencil.rays[pair.ray])};
  }

  void count(const UnitEdges<F>& e, bool first_hit) noexcept {
    const auto add = [this](Counter c, std::uint32_t n) { counters_[static_cast<std::size_t>(c)] += n; };
    if (starting_) {
      counters_.fill(0);
      add(Counter::spheres_skipped, scene_->scene.spheres);
    }
    add(Counter::cycles, busy_ ? 1 : 0);
    if (e.request.valid && e.request.first_set) {
      const PencilWord<F>& size = pencils_[bank_].pencil;
      add(Counter::spheres_tested, 1);
      add(Counter::spheres_skipped, ~std::uint32_t{0});
      add(Counter::plane_tests, size.rows + size.columns);
    }
    add(Counter::pairs_tested, e.issue ? 1 : 0);
    add(Counter::hits, first_hit ? 1 : 0);
    add(Counter::stall_cycles, e.stall ? 1 : 0);
  }

  Testers testers_;
  const SceneMemory<F>* scene_ = nullptr;
  std::array<PencilMemory<F>, 2> pencils_{};
  std::array<ResultMemory<F>, 2> results_{};
  EventCounters counters_{};
  std::size_t bank_ = 0;
  bool busy_ = false;
  bool starting_ = false;
  int in_pipe_ = 0;
  Traversal traversal_;
  Delay<Flagged, kMemoryStages + kTesterStages> testers_line_;
  PlaneSphereDecoder decoder_;
  Node node_;
  Fifo<Leaf, kLeafFifoDepth> leaves_;
  Selector selector_;
  Fifo<Pair, kPairFifoDepth> pairs_;
  PairIssue issue_;
  Delay<Tested, kMemoryStages + kRayTriangleStages> solver_;
};

}  // namespace raplas
