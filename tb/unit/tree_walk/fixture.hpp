// Drives tree_walk beside its clocked model, clock by clock.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "raplas/tree_walk.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
inline constexpr std::uint32_t kAddresses = 1U << kIdBits;
inline constexpr std::uint32_t kDepths = 1U << kDepthBits;
inline constexpr std::uint32_t kAllRows = (1U << kMaxRows) - 1;
inline constexpr std::uint32_t kWidest = (1U << kCountBits) - 1;
inline constexpr int kTriangleRoom = 1 << kTriangleFifoDepthLog2;
inline constexpr int kMostUnderTest = 32;  // that the environment may have

inline LineBounds all_bounds(std::uint32_t bound) {
  LineBounds bounds{};
  bounds.fill(bound);
  return bounds;
}

class TreeWalkBench : public testing::Test {
 protected:
  /// What goes in, in one clock.
  struct Inputs {
    bool start = false;
    WalkRange root{};
    LineBounds bounds = all_bounds(kDepths - 1);
    WalkDecision decision{};
    int triangles = 0;
  };

  void reset() {
    reset_dut();
    model_ = {};
  }

  static std::uint64_t number(bool bit) { return bit ? 1 : 0; }

  /// One clock of the unit and of its model; gives the request that both showed.
  WalkRequest clock(const Inputs& in) {
    dut().set(start_, number(in.start));
    dut().set(root_first_, in.root.first);
    dut().set(root_count_, in.root.count);
    dut().set(rows_, in.root.rows);
    dut().set(columns_, in.root.columns);
    dut().set(row_bounds_, pack(in.bounds));
    dut().set(push_, number(in.decision.push));
    dut().set(push_range_, in.decision.range.pack());
    dut().set(decided_, number(in.decision.decided));
    dut().set(last_sibling_, number(in.decision.last_sibling));
    dut().set(triangles_, static_cast<std::uint64_t>(in.triangles));
    dut().settle();
    const WalkRequest request = model_.request(in.triangles);
    expect_port(request_o_, number(request.valid), "request_o");
    expect_port(spent_o_, number(model_.spent()), "spent_o");
    expect_port(idle_o_, number(model_.idle()), "idle_o");
    expect_port(stack_level_o_, static_cast<std::uint64_t>(model_.level()), "stack_level_o");
    if (request.valid) {
      expect_port(vertex_o_, number(request.vertex), "vertex_o");
      expect_port(address_o_, request.address, "address_o");
      expect_port(rows_o_, request.rows, "rows_o");
      expect_port(columns_o_, request.columns, "columns_o");
      expect_port(last_o_, number(request.last), "last_o");
    }
    spent_ = dut().get(spent_o_) != 0;
    highest_ = std::max(highest_, model_.level());
    dut().clock();
    model_.clock(in.start, in.root, request, in.bounds, in.decision);
    return request;
  }

  TreeWalk model_;
  int highest_ = 0;
  bool spent_ = false;  ///< what the last clock showed

 private:
  PortId start_ = dut().port("start_i");
  PortId root_first_ = dut().port("root_first_i");
  PortId root_count_ = dut().port("root_count_i");
  PortId rows_ = dut().port("rows_i");
  PortId columns_ = dut().port("columns_i");
  PortId row_bounds_ = dut().port("row_bounds_i");
  PortId push_ = dut().port("push_i");
  PortId push_range_ = dut().port("push_range_i");
  PortId decided_ = dut().port("decided_i");
  PortId last_sibling_ = dut().port("last_sibling_i");
  PortId triangles_ = dut().port("triangles_i");
  PortId request_o_ = dut().port("request_o");
  PortId vertex_o_ = dut().port("vertex_o");
  PortId address_o_ = dut().port("address_o");
  PortId rows_o_ = dut().port("rows_o");
  PortId columns_o_ = dut().port("columns_o");
  PortId last_o_ = dut().port("last_o");
  PortId stack_level_o_ = dut().port("stack_level_o");
  PortId spent_o_ = dut().port("spent_o");
  PortId idle_o_ = dut().port("idle_o");
};

}  // namespace raplas
