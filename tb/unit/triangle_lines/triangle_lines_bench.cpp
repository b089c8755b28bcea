// triangle_lines against what vertices on a line's two sides say, and against its clocked model.
#include <optional>
#include <random>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kVertices = 20'000;
const PortStage kStages[]{{"valid_o", 1}, {"rows_o", 1}, {"columns_o", 1}, {"z_o", 1}, {"triangle_o", 1}};

/// Distances of a vertex from the pencil's lines, and its reach.
struct Vertex {
  std::array<int, kMaxRows> rows{};
  std::array<int, kMaxColumns> columns{};
  int near = 0;
  std::uint32_t z = 0;
};
constexpr int kReach = 1;

template <std::size_t kLines, typename Rule>
LineMask mask_of(const std::array<int, kLines>& distances, Rule rule) {
  LineMask mask = 0;
  for (std::size_t k = 0; k < kLines; ++k) {
    mask |= (rule(distances[k]) ? 1U : 0U) << k;
  }
  return mask;
}

FixedTest test_of(const Vertex& vertex) {
  const auto meets = [](int d) { return std::abs(d) <= kReach; };
  const auto above = [](int d) { return d >= 0; };
  return {mask_of(vertex.rows, meets),
          mask_of(vertex.rows, above),
          mask_of(vertex.columns, meets),
          mask_of(vertex.columns, above),
          vertex.near >= 0,
          vertex.z};
}

/// The lines that the hull of three vertices, each grown by the reach, has points of.
template <std::size_t kLines>
LineMask crossed(const std::array<int, kLines>& a, const std::array<int, kLines>& b,
                 const std::array<int, kLines>& c) {
  LineMask mask = 0;
  for (std::size_t k = 0; k < kLines; ++k) {
    const auto [least, most] = std::minmax({a[k], b[k], c[k]});
    mask |= (least - kReach <= 0 && most + kReach >= 0 ? 1U : 0U) << k;
  }
  return mask;
}

struct Triangle {
  LineMask rows = 0;
  LineMask columns = 0;
  std::uint32_t z = 0;
  std::uint32_t id = 0;
};

class TriangleLinesBench : public testing::Test {
 protected:
  /// Vertices most of whose lines are far away, so that triangles often cross one line, or none.
  Vertex vertex() {
    Vertex vertex;
    const int side = random_() % 2 == 0 ? 5 : -5;
    const unsigned crossing = random_() % 4 == 0 ? 2 : 24;
    const auto distance = [&] {
      return random_() % crossing == 0 ? static_cast<int>(random_() % 9) - 4 : side_ * side;
    };
    for (int& d : vertex.rows) {
      d = distance();
    }
    for (int& d : vertex.columns) {
      d = distance();
    }
    vertex.near = random_() % 4 == 0 ? 1 : -1;
    vertex.z = static_cast<std::uint32_t>(random_() >> (random_() % 15)) & 0x7fff;
    return vertex;
  }

  LineMask mask() {
    const auto bits = static_cast<LineMask>(random_() & 0xffff);
    return random_() % 3 == 0 ? 1U << (random_() % 16) : (random_() % 8 == 0 ? 0 : bits);
  }

  void give(bool valid, std::size_t slot, bool emit, const FixedTest& test, LineMask rows, LineMask columns,
            std::uint32_t triangle) {
    dut().set(dut().port("valid_i"), valid ? 1 : 0);
    dut().set(dut().port("slot_i"), slot);
    dut().set(dut().port("emit_i"), emit ? 1 : 0);
    dut().set(dut().port("rows_meet_i"), test.rows_meet);
    dut().set(dut().port("rows_above_i"), test.rows_above);
    dut().set(dut().port("columns_meet_i"), test.columns_meet);
    dut().set(dut().port("columns_above_i"), test.columns_above);
    dut().set(dut().port("near_i"), test.near ? 1 : 0);
    dut().set(dut().port("z_i"), test.z);
    dut().set(dut().port("rows_i"), rows);
    dut().set(dut().port("columns_i"), columns);
    dut().set(dut().port("triangle_i"), triangle);
  }

  void run(unsigned valid_percent, unsigned emit_percent) {
    reset_dut();
    TriangleLines model;
    std::array<Vertex, 3> slots;
    std::size_t dropped = 0;
    std::size_t seen = 0;
    for (int k = 0; k < kVertices && !HasFailure(); ++k) {
      const bool filled = k >= 3;
      side_ = random_() % 16 == 0 ? -side_ : side_;
      const Vertex given = vertex();
      const bool valid = !filled || random_() % 100 < valid_percent;
      const bool emit = filled && random_() % 100 < emit_percent;
      const std::size_t slot = filled ? random_() % 3 : static_cast<std::size_t>(k);
      const LineMask rows = mask();
      const LineMask columns = mask();
      const auto id = static_cast<std::uint32_t>(random_() & kLastId);
      give(valid, slot, emit, test_of(given), rows, columns, id);
      std::optional<Triangle> expected;
      if (valid) {
        slots[slot] = given;
      }
      if (valid && emit) {
        const auto& [a, b, c] = slots;
        const Triangle triangle{rows & crossed(a.rows, b.rows, c.rows),
                                columns & crossed(a.columns, b.columns, c.columns), std::min({a.z, b.z, c.z}),
                                id};
        if (triangle.rows != 0 && triangle.columns != 0 && std::max({a.near, b.near, c.near}) >= 0) {
          expected = triangle;
        }
        ++(expected ? seen : dropped);
      }
      dut().clock();
      model.clock(valid, slot, emit, test_of(given), rows, columns, id);
      expect_port(dut().port("valid_o"), expected ? 1 : 0, "valid_o");
      EXPECT_EQ(model.out().valid, expected.has_value());
      if (expected) {
        expect_port(dut().port("rows_o"), expected->rows, "rows_o");
        expect_port(dut().port("columns_o"), expected->columns, "columns_o");
        expect_port(dut().port("z_o"), expected->z, "z_o");
        expect_port(dut().port("triangle_o"), expected->id, "triangle_o");
        EXPECT_EQ(model.out().rows, expected->rows);
        EXPECT_EQ(model.out().columns, expected->columns);
        EXPECT_EQ(model.out().z, expected->z);
        EXPECT_EQ(model.out().triangle, expected->id);
      }
    }
    EXPECT_GT(seen, 500U);
    EXPECT_GT(dropped, 500U);
  }

 private:
  std::mt19937 random_{71};
  int side_ = 1;
};

TEST_F(TriangleLinesBench, CrossesTheLinesOfTheHullOfItsVertices) { run(100, 100); }
TEST_F(TriangleLinesBench, KeepsVerticesWhileNoneComes) { run(40, 50); }

TEST_F(TriangleLinesBench, EachLineAloneKeepsTheTriangleWhicheverVertexCrossesIt) {
  reset_dut();
  for (std::size_t slot = 0; slot < 3; ++slot) {
    for (std::size_t line = 0; line < 32; ++line) {
      for (const bool meets : {false, true}) {
        for (std::size_t k = 0; k < 3; ++k) {
          FixedTest test{0, 0, 0, 0, false, 100};
          const bool odd = k == slot;  // this vertex differs from the other two
          (meets ? test.rows_meet : test.rows_above) = odd ? 1U << (line % 16) : 0U;
          (meets ? test.columns_meet : test.columns_above) = odd ? 1U << (15 - line % 16) : 0U;
          test.near = odd;
          test.z = odd ? 7 : 100;
          give(true, k, k == 2, test, line < 16 ? 0xffff : 1U << (line % 16), 0xffff, 5);
          dut().clock();
        }
        expect_port(dut().port("valid_o"), 1, "valid_o");
        expect_port(dut().port("rows_o"), 1U << (line % 16), "rows_o");
        expect_port(dut().port("columns_o"), 1U << (15 - line % 16), "columns_o");
        expect_port(dut().port("z_o"), 7, "z_o");
      }
    }
  }
}

TEST_F(TriangleLinesBench, GivesNoTriangleAfterAReset) {
  give(false, 0, true, {0xffff, 0, 0xffff, 0, true, 1}, 0xffff, 0xffff, 1);
  expect_empty_after_reset(1);
}

}  // namespace
}  // namespace raplas
