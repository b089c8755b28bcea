// plane_sphere_decoder against its clocked model, for pencils of every size. ROWS and COLUMNS are its
// testers.
#include <algorithm>
#include <random>

#include "raplas/plane_sphere.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kSpheresPerSize = 20;
const PortStage kStages[]{
    {"decided_o", 1}, {"leaf_o", 1}, {"push_o", 1}, {"row_mask_o", 1}, {"column_mask_o", 1}};

class Decoder : public testing::Test {
 protected:
  void run(int bubble_percent) {
    std::mt19937 random(41);
    reset_dut();
    PlaneSphereDecoder model(ROWS, COLUMNS);
    const auto sparse = [&random](int bits) { return random() & random() & ((1U << bits) - 1U); };
    for (int size = 0; size < kMaxRows * kMaxColumns; ++size) {
      const int rows = size / kMaxColumns + 1;
      const int columns = size % kMaxColumns + 1;
      const int last_set = std::max((rows - 1) / ROWS, (columns - 1) / COLUMNS);
      dut().set(dut().port("rows_i"), static_cast<std::uint64_t>(rows));
      dut().set(dut().port("columns_i"), static_cast<std::uint64_t>(columns));
      for (int sphere = 0; sphere < kSpheresPerSize; ++sphere) {
        for (int set = 0; set <= last_set;) {
          const bool valid = static_cast<int>(random() % 100) >= bubble_percent;
          const bool leaf = sphere % 2 == 0;
          const PlaneFlags flags{static_cast<std::uint32_t>(sparse(ROWS)),
                                 static_cast<std::uint32_t>(sparse(COLUMNS))};
          dut().set(dut().port("valid_i"), valid ? 1 : 0);
          dut().set(dut().port("set_i"), static_cast<std::uint64_t>(set));
          dut().set(dut().port("last_i"), set == last_set ? 1 : 0);
          dut().set(dut().port("leaf_i"), leaf ? 1 : 0);
          dut().set(dut().port("row_flags_i"), flags.rows);
          dut().set(dut().port("column_flags_i"), flags.columns);
          dut().clock();
          model.clock(rows, columns, valid, set, set == last_set, leaf, flags);
          const Decision& due = model.out();
          ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("decided_o"), due.decided ? 1 : 0, "decided_o"));
          ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("leaf_o"), due.leaf ? 1 : 0, "leaf_o"));
          ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("push_o"), due.push ? 1 : 0, "push_o"));
          if (due.decided) {
            ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("row_mask_o"), due.row_mask, "row_mask_o"));
            ASSERT_NO_FATAL_FAILURE(
                expect_port(dut().port("column_mask_o"), due.column_mask, "column_mask_o"));
          }
          set += valid ? 1 : 0;
        }
      }
    }
  }
};

TEST_F(Decoder, JoinsThePlaneSetsOfEveryPencilSize) { run(0); }
TEST_F(Decoder, JoinsThemAcrossBubbles) { run(50); }

TEST_F(Decoder, SetsWithoutPlanesChangeNothing) {
  std::mt19937 random(42);
  reset_dut();
  dut().set(dut().port("rows_i"), kMaxRows);
  dut().set(dut().port("columns_i"), kMaxColumns);
  dut().set(dut().port("valid_i"), 1);
  dut().set(dut().port("leaf_i"), 1);
  const int sets = std::max(kMaxRows / ROWS, kMaxColumns / COLUMNS);
  for (int k = 0; k < 50 * (16 - sets); ++k) {
    std::uint32_t row_mask = 0;
    std::uint32_t column_mask = 0;
    for (int set = 0; set <= sets; ++set) {  // the last one is beyond all planes
      const std::uint64_t row_flags = random() & ((1U << ROWS) - 1U);
      const std::uint64_t column_flags = random() & ((1U << COLUMNS) - 1U);
      row_mask |= set * ROWS < kMaxRows ? static_cast<std::uint32_t>(row_flags << (set * ROWS)) : 0U;
      column_mask |=
          set * COLUMNS < kMaxColumns ? static_cast<std::uint32_t>(column_flags << (set * COLUMNS)) : 0U;
      dut().set(dut().port("set_i"), static_cast<std::uint64_t>(set < sets ? set : sets + k % (16 - sets)));
      dut().set(dut().port("last_i"), set == sets ? 1 : 0);
      dut().set(dut().port("row_flags_i"), row_flags);
      dut().set(dut().port("column_flags_i"), column_flags);
      dut().clock();
    }
    ASSERT_NO_FATAL_FAILURE(
        expect_port(dut().port("leaf_o"), row_mask != 0 && column_mask != 0 ? 1 : 0, "leaf_o"));
    ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("row_mask_o"), row_mask, "row_mask_o"));
    ASSERT_NO_FATAL_FAILURE(expect_port(dut().port("column_mask_o"), column_mask, "column_mask_o"));
  }
}

TEST_F(Decoder, MasksAreTheFlagsOfTheSetsInOrder) {
  reset_dut();
  dut().set(dut().port("rows_i"), 16);
  dut().set(dut().port("columns_i"), 16);
  dut().set(dut().port("valid_i"), 1);
  dut().set(dut().port("leaf_i"), 1);
  std::uint32_t row_mask = 0;
  std::uint32_t column_mask = 0;
  const int sets = std::max(kMaxRows / ROWS, kMaxColumns / COLUMNS);
  for (int set = 0; set < sets; ++set) {
    const std::uint64_t row_flags = static_cast<std::uint64_t>(set + 1) & ((1U << ROWS) - 1U);
    const std::uint64_t column_flags = static_cast<std::uint64_t>(15 - set) & ((1U << COLUMNS) - 1U);
    row_mask |= set * ROWS < kMaxRows ? static_cast<std::uint32_t>(row_flags << (set * ROWS)) : 0U;
    column_mask |=
        set * COLUMNS < kMaxColumns ? static_cast<std::uint32_t>(column_flags << (set * COLUMNS)) : 0U;
    dut().set(dut().port("set_i"), static_cast<std::uint64_t>(set));
    dut().set(dut().port("last_i"), set == sets - 1 ? 1 : 0);
    dut().set(dut().port("row_flags_i"), row_flags);
    dut().set(dut().port("column_flags_i"), column_flags);
    dut().clock();
  }
  expect_port(dut().port("leaf_o"), 1, "leaf_o");
  expect_port(dut().port("row_mask_o"), row_mask, "row_mask_o");
  expect_port(dut().port("column_mask_o"), column_mask, "column_mask_o");
}

}  // namespace
}  // namespace raplas
