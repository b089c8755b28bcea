// fixed_testers against exact integers, and against the model.
#include <deque>
#include <random>

#include "raplas/fixed_point.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kStages = kPlaneTestStages + kDepthCodeStages;
constexpr int kNear = 16;  // indices of the row side
constexpr int kDown = 17;
constexpr int kDepth = 16;  // and of the column side
constexpr int kAcross = 17;
constexpr int kIndices = 18;  // of a side
constexpr std::uint64_t kSumMask = (std::uint64_t{1} << 40) - 1;
constexpr std::int64_t kLimit = std::int64_t{1} << (kCoordinateBits - 1);
constexpr std::int64_t kOffsetLimit = std::int64_t{1} << (kOffsetBits - 1);
const int kObjects = Dut::simulator() == "ghdl" ? 150 : 12'000;
const int kReloads = Dut::simulator() == "ghdl" ? 100 : 6'000;
const PortStage kPortStages[]{
    {"rows_meet_o", kStages},     {"rows_above_o", kStages}, {"columns_meet_o", kStages},
    {"columns_above_o", kStages}, {"near_o", kStages},       {"z_o", kStages},
    {"down_sum_o", kStages},      {"across_sum_o", kStages}, {"depth_sum_code_o", kStages}};

enum class Side { row, column };

FixedPlane& plane_of(FixedPlanes& planes, Side side, int index) {
  const auto k = static_cast<std::size_t>(index);
  if (side == Side::row) {
    return index < 16 ? planes.rows[k] : index == kNear ? planes.near : planes.down;
  }
  return index < 16 ? planes.columns[k] : index == kDepth ? planes.depth : planes.across;
}

/// Planes to be loaded; none if there is no such index.
struct Load {
  int index = -1;
  FixedPlane row;
  FixedPlane column;
};

struct Object {
  FixedVec3 centre{};
  std::uint32_t radius = 0;
  std::uint32_t slack = 0;

  [[nodiscard]] PackedWord<4 * kCoordinateBits> pack() const {
    PackedWord<4 * kCoordinateBits> word{};
    for (int k = 0; k < 3; ++k) {
      insert(word, {(3 - k) * kCoordinateBits, kCoordinateBits},
             static_cast<std::uint32_t>(centre[static_cast<std::size_t>(k)]));
    }
    insert(word, {0, kCoordinateBits}, radius);
    return word;
  }
};

/// An object under test: the planes that count for it, and a bit for each index whose planes change
/// meanwhile.
struct Expected {
  FixedPlanes planes;
  Object object;
  std::uint32_t changed = 0;
};

class FixedTesters : public testing::Test {
 protected:
  std::int64_t between(std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random_);
  }

  FixedVec3 point(int shift) {
    FixedVec3 p{};
    for (auto& coordinate : p) {
      coordinate = static_cast<std::int32_t>(between(-kLimit, kLimit - 1) >> shift);
    }
    return p;
  }

  /// A plane not far from the middle of the scene; now and then any words.
  FixedPlane some_plane() {
    if (between(0, 7) == 0) {
      return {point(0), between(-kOffsetLimit, kOffsetLimit - 1)};
    }
    return {point(1), between(-kOffsetLimit, kOffsetLimit - 1) >> between(2, 8)};
  }

  Side some_side() { return between(0, 1) == 0 ? Side::row : Side::column; }

  Object some_object() {
    Object object{point(static_cast<int>(between(0, 3))), 0, 0};
    std::int64_t reach = between(0, 2 * kLimit - 1) >> between(0, 17);
    const int aim = static_cast<int>(between(-4, kIndices - 1));
    if (aim >= 0) {  // one of the planes is touched, or just missed
      const std::int64_t d = plane_sum(plane_of(planes_, some_side(), aim), object.centre);
      reach =
          std::clamp<std::int64_t>((std::abs(d) >> kCoordinateFraction) + between(-1, 1), 0, 2 * kLimit - 1);
    }
    object.slack = static_cast<std::uint32_t>(between(0, reach));
    object.radius = static_cast<std::uint32_t>(reach) - object.slack;
    return object;
  }

  /// d, exactly; written without the model.
  static std::int64_t distance(const FixedPlane& plane, const FixedVec3& c) {
    return std::int64_t{plane.normal[0]} * c[0] + std::int64_t{plane.normal[1]} * c[1] +
           std::int64_t{plane.normal[2]} * c[2] + plane.offset;
  }

  static FixedTest exact(FixedPlanes& planes, const Object& object) {
    const std::int64_t reach = std::int64_t{object.radius + object.slack} << 17;
    FixedTest test;
    for (std::size_t k = 0; k < 16; ++k) {
      const std::int64_t row = distance(planes.rows[k], object.centre);
      const std::int64_t column = distance(planes.columns[k], object.centre);
      test.rows_meet |= (-reach <= row && row <= reach ? 1U : 0U) << k;
      test.rows_above |= (row >= 0 ? 1U : 0U) << k;
      test.columns_meet |= (-reach <= column && column <= reach ? 1U : 0U) << k;
      test.columns_above |= (column >= 0 ? 1U : 0U) << k;
    }
    test.near = distance(planes.near, object.centre) >= -reach;
    test.down = distance(planes.down, object.centre) + reach;
    test.across = distance(planes.across, object.centre) + reach;
    std::int64_t depth = distance(planes.depth, object.centre) - reach;
    if (depth >= 1 << 14) {
      std::uint32_t exponent = 1;
      while (depth >= 1 << 15) {  // keeps 15 bits: the top one, 10 of the code, 4 below
        depth /= 2;
        ++exponent;
      }
      test.depth = exponent * 1024 + static_cast<std::uint32_t>(depth / 16) - 1024;
      test.z = test.depth - kDepthMargin;
    }
    return test;
  }

  /// Any planes for an index.
  Load some_load(int index) { return {index, some_plane(), some_plane()}; }

  /// One clock with an object, and with planes loaded if there is an index for them.
  void clock(const Object& object, const Load& load = {}) {
    const bool loading = load.index >= 0;
    dut().set(load_, loading ? 1 : 0);
    dut().set(index_, static_cast<std::uint64_t>(loading ? load.index : between(0, 31)));
    dut().set(row_plane_, loading ? load.row.pack() : some_plane().pack());
    dut().set(column_plane_, loading ? load.column.pack() : some_plane().pack());
    dut().set(object_, object.pack());
    dut().set(slack_, object.slack);
    under_test_.push_back({planes_, object});
    if (loading && load.index < kIndices) {
      plane_of(planes_, Side::row, load.index) = load.row;
      plane_of(planes_, Side::column, load.index) = load.column;
      const std::size_t given = under_test_.size();
      for (std::size_t k = given < 2 ? 0 : given - 2; k < given; ++k) {  // this one and the one before
        under_test_[k].changed |= 1U << load.index;
      }
    }
    dut().clock();
    if (under_test_.size() >= kStages) {
      check(under_test_.front());
      under_test_.pop_front();
    }
  }

  void check(Expected& of) {
    if (!loaded_) {
      return;
    }
    const FixedTest test = exact(of.planes, of.object);
    ASSERT_EQ(test, test_object(of.planes, of.object.centre, of.object.radius, of.object.slack))
        << "the model";
    const auto lines = [&](PortId port, std::uint32_t expected, const char* name) {
      const std::uint32_t mixed = of.changed & 0xffffU;
      const auto seen = static_cast<std::uint32_t>(dut().get(port));
      expect_port(port, (expected & ~mixed) | (seen & mixed), name);
    };
    lines(rows_meet_, test.rows_meet, "rows_meet_o");
    lines(rows_above_, test.rows_above, "rows_above_o");
    lines(columns_meet_, test.columns_meet, "columns_meet_o");
    lines(columns_above_, test.columns_above, "columns_above_o");
    static_assert(kNear == kDepth && kDown == kAcross);
    if ((of.changed >> kNear & 1) == 0) {
      expect_port(near_, test.near ? 1 : 0, "near_o");
      expect_port(z_, test.z, "z_o");
      expect_port(depth_code_, test.depth, "depth_sum_code_o");
    }
    if ((of.changed >> kDown & 1) == 0) {
      expect_port(down_, static_cast<std::uint64_t>(test.down) & kSumMask, "down_sum_o");
      expect_port(across_, static_cast<std::uint64_t>(test.across) & kSumMask, "across_sum_o");
    }
  }

  void load_all() {
    for (int index = 0; index < kIndices; ++index) {
      clock(some_object(), some_load(index));
    }
  }

  void SetUp() override {
    load_all();
    for (int k = 0; k <= kStages; ++k) {  // from now on no object that is under test saw less than all planes
      clock(some_object());
    }
    loaded_ = true;
  }

  std::mt19937_64 random_{51};
  FixedPlanes planes_;
  std::deque<Expected> under_test_;
  bool loaded_ = false;
  PortId load_ = dut().port("load_i");
  PortId row_plane_ = dut().port("row_plane_i");
  PortId column_plane_ = dut().port("column_plane_i");
  PortId index_ = dut().port("index_i");
  PortId object_ = dut().port("object_i");
  PortId slack_ = dut().port("slack_i");
  PortId rows_meet_ = dut().port("rows_meet_o");
  PortId rows_above_ = dut().port("rows_above_o");
  PortId columns_meet_ = dut().port("columns_meet_o");
  PortId columns_above_ = dut().port("columns_above_o");
  PortId near_ = dut().port("near_o");
  PortId z_ = dut().port("z_o");
  PortId depth_code_ = dut().port("depth_sum_code_o");
  PortId down_ = dut().port("down_sum_o");
  PortId across_ = dut().port("across_sum_o");
};

TEST_F(FixedTesters, TestsAnObjectEachClock) {
  for (int k = 0; k < kObjects && !HasFatalFailure(); ++k) {
    clock(some_object());
    if (k % 200 == 199) {
      load_all();
    }
  }
}

TEST_F(FixedTesters, TakesPlanesFromTheNextObjectOn) {
  for (int k = 0; k < kReloads && !HasFatalFailure(); ++k) {
    const bool load = between(0, 1) == 0;
    clock(some_object(), load ? some_load(static_cast<int>(between(0, kIndices - 1))) : Load{});
  }
}

TEST_F(FixedTesters, EveryBitOfAnOffsetCounts) {
  for (int k = 0; k < kReloads && !HasFatalFailure(); ++k) {
    const Side side = k % 4 == 0 ? Side::column : some_side();
    const int index = k % 4 == 0 ? kDepth : static_cast<int>(between(0, kIndices - 1));
    const Object object = some_object();
    FixedPlane plane{point(static_cast<int>(between(1, 8))), 0};
    const std::int64_t reach = std::int64_t{object.radius + object.slack} << kCoordinateFraction;
    std::int64_t rim = between(0, 1) == 0 || (side == Side::row && index == kNear) ? -reach : reach;
    if (side == Side::column && index == kDepth) {  // the least depth of some code
      rim = reach + ((1024 + between(0, 1023)) << between(4, 24));
    }
    const std::int64_t offset = rim + between(-1, 1) - distance(plane, object.centre);
    plane.offset = std::clamp(offset, -kOffsetLimit, kOffsetLimit - 1);
    Load load = some_load(index);
    (side == Side::row ? load.row : load.column) = plane;
    clock(some_object(), load);
    clock(object);
  }
}

TEST_F(FixedTesters, SumsTakeTheWidestWords) {
  constexpr auto kMost = static_cast<std::int32_t>(kLimit - 1);
  constexpr auto kLeast = static_cast<std::int32_t>(-kLimit);
  constexpr std::uint32_t kReach = 2 * kLimit - 1;
  const auto any = [this](auto least, auto most) { return between(0, 1) == 0 ? least : most; };
  const auto corner = [&] { return FixedVec3{any(kLeast, kMost), any(kLeast, kMost), any(kLeast, kMost)}; };
  const auto plane = [&] { return FixedPlane{corner(), any(-kOffsetLimit, kOffsetLimit - 1)}; };
  for (int k = 0; k < kReloads && !HasFatalFailure(); ++k) {
    const FixedPlane row = plane();
    const FixedPlane column = plane();
    const std::uint32_t radius = any(0U, kReach);
    clock(some_object(), {kDown, row, column});
    clock({corner(), radius, any(0U, kReach - radius)}, {kDepth, row, column});
    clock({row.normal, kReach, 0});
  }
}

TEST_F(FixedTesters, LoadsNothingAtOtherIndices) {
  for (int index = kIndices; index < 32 && !HasFatalFailure(); ++index) {
    clock(some_object(), some_load(index));
    clock(some_object());
  }
  for (int k = 0; k < 2 * kStages && !HasFatalFailure(); ++k) {
    clock(some_object());
  }
}

}  // namespace
}  // namespace raplas
