// The whole accelerator of profile raplas, clock by clock: entity raplas_unit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "raplas/clocked.hpp"
#include "raplas/edge_setup.hpp"
#include "raplas/fixed_trace.hpp"
#include "raplas/hit_queue.hpp"
#include "raplas/pair_selection.hpp"
#include "raplas/pencil_control.hpp"
#include "raplas/tree_walk.hpp"

namespace raplas {

/// What the units say to each other in one clock: the last port group of entity raplas_unit.
template <typename F>
struct RaplasEdges {
  WalkRequest request;
  int stack_level = 0;
  bool push = false;
  bool triangle_found = false;
  QueuedTriangle found;
  bool issue = false;
  std::uint32_t ray = 0;
  std::uint32_t triangle = 0;
  bool stall = false;
  bool hit = false;
  NearestHit<F> stored;
};

/// Entity raplas_unit. The scene must stay alive and unchanged while a pencil runs, and a bank while it is
/// busy.
template <typename F>
class RaplasUnit {
 public:
  void load(const FixedSceneMemory<F>* scene) noexcept { scene_ = scene; }
  [[nodiscard]] FixedPencilMemory<F>& pencil(std::size_t bank) noexcept { return pencils_[bank]; }
  [[nodiscard]] const typename FixedTrace<F>::Results& results(std::size_t bank) const noexcept {
    return results_[bank];
  }
  /// Rows of which a ray has a hit.
  [[nodiscard]] LineMask hit_rows(std::size_t bank) const noexcept { return hit_rows_[bank]; }
  /// A bit for each bank that was started and isn't done.
  [[nodiscard]] std::uint32_t busy() const noexcept { return control_.busy(); }
  /// Since reset.
  [[nodiscard]] const EventCounters& counters() const noexcept { return counters_; }
  /// Whose objects are tested, and whose pairs.
  [[nodiscard]] std::size_t walk_bank() const noexcept { return control_.bank(); }
  [[nodiscard]] std::size_t pair_bank() const noexcept { return columns_.row().bank; }

  /// What crosses the edges between the units in the clock that comes next.
  [[nodiscard]] RaplasEdges<F> edges() const {
    RaplasEdges<F> e;
    e.request = walk_.request(static_cast<int>(triangles_.count()) + kReserve);
    e.stack_level = walk_.level();
    e.push = decision(testers_.out()).push;
    e.found = found_.out().word;
    e.found.points = grid_.points();
    e.triangle_found = found_.out().valid && !e.found.last;
    e.stall = hits_.stall();
    e.issue = columns_.issue(e.stall);
    e.ray = columns_.ray();
    e.triangle = columns_.row().triangle;
    e.hit = solver_.out().hit;
    e.stored = hits_.out();
    return e;
  }

  /// One clock; `start` begins the pencil of `bank` unless that bank is busy.
  void clock(bool start, std::size_t bank) {
    const RaplasEdges<F> e = edges();
    const std::size_t turn = control_.bank();
    const std::size_t cleared = control_.clear_bank();
    const FixedPencilMemory<F>& pencil = pencils_[turn];
    const PencilControl::Out control = control_.out();
    count(e, control.walk);

    // results
    const RayHits<F> best = bests_.out();
    bests_.clock(results_[hits_.asks().bank][hits_.asks().ray]);
    if (control.clear) {
      results_[cleared].fill({});
      hit_rows_[cleared] = 0;
    }
    const KeptHit<F>& kept = e.stored.kept;
    if (kept.write) {
      results_[e.stored.bank][e.stored.ray] = kept.word;
      hit_rows_[e.stored.bank] |= LineMask{1} << (e.stored.ray / kMaxColumns);
    }
    const Solved solved = solver_.out();
    hits_.clock(solved.hit || solved.word.token, solved.word, best);

    // pairs
    solver_.clock(e.issue || columns_.last(e.stall) ? solve_pair(e.issue) : Solved{});
    const bool row_taken = columns_.ready(e.stall);
    columns_.clock(rows_.valid(), rows_.front(), e.stall);
    const std::size_t row_count = rows_.count();
    const RayBounds::Read read = selector_.read();
    const bool cut_taken = selector_.ready(cuts_.valid(), cuts_.front(), row_count);
    rows_.clock(selector_.row_valid(), selector_.row(), row_taken);
    selector_.clock(cuts_.valid(), cuts_.front(), bounds_.bounds(), row_count);
    const std::size_t cut_count = cuts_.count();
    cuts_.clock(edges_.valid(), edges_.word(), cut_taken);
    const QueuedTriangle& front = triangles_.front();
    const LineBounds& front_bounds = bounds_.row_bounds(front.bank);
    const bool word_taken = edges_.ready(triangles_.valid(), front, front_bounds, cut_count);
    edges_.clock(triangles_.valid(), front, front_bounds, pencils_[front.bank].limits.error, cut_count);
    const bool token_ready = triangles_.count() + kReserve < std::size_t{1} << kTriangleFifoDepthLog2;
    const bool token = control.token && token_ready;
    triangles_.clock(found_.out().valid, e.found, word_taken);

    // spheres
    const Tested tested = testers_.out();
    const bool walk_idle = walk_.idle();
    const bool walk_spent = walk_.spent();
    const bool vertex = tested.request.valid && tested.request.vertex;
    const CrossingTriangle& crossing = lines_.out();
    found_.clock({crossing.valid || token,
                  {token,
                   static_cast<std::uint32_t>(turn),
                   crossing.triangle,
                   crossing.z,
                   crossing.rows,
                   crossing.columns,
                   {}}});
    lines_.clock(vertex, tested.vertex.slot, tested.vertex.emit, tested.test, tested.request.rows,
                 tested.request.columns, tested.vertex.triangle);
    grid_.clock(vertex, tested.vertex.slot, tested.test.across, tested.test.down, tested.test.depth,
                pencil.limits);
    const SceneWord& root = scene_->scene;
    walk_.clock(control.walk && root.count != 0,
                {false, root.count, root.first, first_lines(pencil.pencil.rows),
                 first_lines(pencil.pencil.columns), 0},
                e.request, bounds_.row_bounds(turn), decision(tested));
    testers_.clock(e.request.valid ? test(e.request, pencil) : Tested{});
    const FixedPencilMemory<F>& prepared = pencils_[cleared];
    bounds_.clock(
        {control.clear, cleared, prepared.pencil.rows, prepared.pencil.columns, prepared.limits.far},
        {kept.write && kept.bounds, e.stored.bank, e.stored.ray, kept.bound}, read);

    control_.clock(start, bank, prepared.pencil.rows, prepared.pencil.columns, walk_spent, walk_idle,
                   token_ready, e.stored.done, e.stored.bank);
  }

 private:
  /// Triangles between the walk's count of objects under test and the queue's of triangles.
  static constexpr int kReserve = kVertexGridStages + 1;
  static constexpr std::size_t kTestStages = kMemoryStages + kPlaneTestStages + kDepthCodeStages;
  static constexpr std::size_t kPairStages = kMemoryStages + kRaySolverStages;

  struct Tested {
    WalkRequest request;
    FixedTest test;
    NodeWord node;
    VertexWord vertex;
  };
  struct Found {
    bool valid = false;
    QueuedTriangle word;
  };
  struct Solved {
    bool hit = false;
    ValidHit<F> word;  ///< of a hit or a token
  };

  [[nodiscard]] Tested test(const WalkRequest& request, const FixedPencilMemory<F>& pencil) const {
    Tested tested{request, {}, {}, {}};
    const std::uint32_t slack = pencil.limits.slack;
    if (request.vertex) {
      tested.vertex = scene_->vertices[request.address];
      tested.test = test_object(pencil.planes, tested.vertex.point, 0, slack);
    } else {
      tested.node = scene_->nodes[request.address];
      tested.test = test_object(pencil.planes, tested.node.centre, tested.node.radius, slack);
    }
    return tested;
  }

  [[nodiscard]] static WalkDecision decision(const Tested& tested) noexcept {
    const WalkRequest& request = tested.request;
    WalkDecision d{request.valid, request.last, false, {}};
    if (request.valid && !request.vertex) {
      const NodeWord& node = tested.node;
      d.range = {node.leaf,
                 node.count,
                 node.first,
                 request.rows & tested.test.rows_meet,
                 request.columns & tested.test.columns_meet,
                 tested.test.z};
      d.push = tested.test.near && d.range.rows != 0 && d.range.columns != 0;
    }
    return d;
  }

  /// The pair, or the token, that goes in this clock.
  [[nodiscard]] Solved solve_pair(bool issue) const {
    const QueuedRow& row = columns_.row();
    if (!issue) {
      return {false, {true, row.bank, 0, {}}};
    }
    const FixedPencilMemory<F>& pencil = pencils_[row.bank];
    const std::uint32_t ray = columns_.ray();
    const auto s = solve(scene_->triangles[row.triangle], pencil.pencil.origin, pencil.rays[ray],
                         F::from_bits(pencil.limits.band));
    const CountedHit<F> counted = counted_hit(s, row.triangle, row.z, pencil.limits);
    return {counted.valid, {false, row.bank, ray, counted.hit}};
  }

  void count(const RaplasEdges<F>& e, bool walk) noexcept {
    const auto add = [this](Counter c, std::uint32_t n) { counters_[static_cast<std::size_t>(c)] += n; };
    add(Counter::spheres_skipped, walk ? scene_->scene.spheres : 0);
    add(Counter::cycles, busy() != 0 ? 1 : 0);
    if (e.request.valid) {
      const PencilWord<F>& size = pencils_[control_.bank()].pencil;
      add(Counter::plane_tests, size.rows + size.columns);
      add(e.request.vertex ? Counter::vertices_tested : Counter::spheres_tested, 1);
      add(Counter::spheres_skipped, e.request.vertex ? 0 : ~std::uint32_t{0});
    }
    add(Counter::pairs_tested, e.issue ? 1 : 0);
    add(Counter::hits, e.stored.kept.write && e.stored.kept.first ? 1 : 0);
    add(Counter::stall_cycles, e.stall ? 1 : 0);
  }

  const FixedSceneMemory<F>* scene_ = nullptr;
  std::array<FixedPencilMemory<F>, kPencilBanks> pencils_{};
  std::array<typename FixedTrace<F>::Results, kPencilBanks> results_{};
  std::array<LineMask, kPencilBanks> hit_rows_{};
  EventCounters counters_{};
  PencilControl control_;
  TreeWalk walk_;
  Delay<Tested, kTestStages> testers_;
  TriangleLines lines_;
  VertexGrid grid_;
  Delay<Found, kVertexGridStages - 1> found_;
  BlockFifo<QueuedTriangle, std::size_t{1} << kTriangleFifoDepthLog2> triangles_;
  EdgeSetup edges_;
  BlockFifo<CutTriangle, std::size_t{1} << kCutFifoDepthLog2> cuts_;
  RowSelector selector_;
  Fifo<QueuedRow, std::size_t{1} << kRowFifoDepthLog2> rows_;
  ColumnSelector columns_;
  RayBounds bounds_;
  Delay<Solved, kPairStages> solver_;
  HitQueue<F> hits_;
  Delay<RayHits<F>, kMemoryStages> bests_;
};

}  // namespace raplas
