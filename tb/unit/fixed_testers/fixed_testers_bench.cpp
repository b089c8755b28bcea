// fixed_testers against exact integers, and against the model.
#include <deque>
#include <random>

#include "raplas/fixed_point.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kStages = kPlaneTestStages + kDepthCodeStages;
constexpr int kLines = kMaxRows + kMaxColumns;
constexpr int kNear = kLines;
constexpr int kDepth = kLines + 1;
constexpr std::int64_t kLimit = std::int64_t{1} << (kCoordinateBits - 1);
constexpr std::int64_t kOffsetLimit = std::int64_t{1} << (kOffsetBits - 1);
const int kObjects = Dut::simulator() == "ghdl" ? 150 : 12'000;
const int kReloads = Dut::simulator() == "ghdl" ? 100 : 6'000;
const PortStage kPortStages[]{{"rows_meet_o", kStages},    {"rows_above_o", kStages},
                              {"columns_meet_o", kStages}, {"columns_above_o", kStages},
                              {"near_o", kStages},         {"z_o", kStages}};

FixedPlane& plane_of(FixedPlanes& planes, int line) {
  const auto k = static_cast<std::size_t>(line);
  if (line < kMaxRows) {
    return planes.rows[k];
  }
  if (line < kLines) {
    return planes.columns[k - kMaxRows];
  }
  return line == kNear ? planes.near : planes.depth;
}

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

/// An object under test: the planes that count for it, and the lines whose plane changes meanwhile.
struct Expected {
  FixedPlanes planes;
  Object object;
  std::uint64_t changed = 0;
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

  Object some_object() {
    Object object{point(static_cast<int>(between(0, 3))), 0, 0};
    std::int64_t reach = between(0, 2 * kLimit - 1) >> between(0, 17);
    const int aim = static_cast<int>(between(-8, kDepth));
    if (aim >= 0) {  // one of the planes is touched, or just missed
      const std::int64_t d = plane_sum(plane_of(planes_, aim), object.centre);
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
    for (int line = 0; line < kLines; ++line) {
      const std::int64_t d = distance(plane_of(planes, line), object.centre);
      const std::uint32_t bit = 1U << line % kMaxRows;
      if (-reach <= d && d <= reach) {
        (line < kMaxRows ? test.rows_meet : test.columns_meet) |= bit;
      }
      if (d >= 0) {
        (line < kMaxRows ? test.rows_above : test.columns_above) |= bit;
      }
    }
    test.near = distance(planes.near, object.centre) >= -reach;
    std::int64_t depth = distance(planes.depth, object.centre) - reach;
    if (depth >= 1 << 14) {
      std::uint32_t exponent = 1;
      while (depth >= 1 << 15) {  // keeps 15 bits: the top one, 10 of the code, 4 below
        depth /= 2;
        ++exponent;
      }
      test.z = exponent * 1024 + static_cast<std::uint32_t>(depth / 16) - 1024 - kDepthMargin;
    }
    return test;
  }

  /// One clock with an object, and with a plane loaded if `line` is one.
  void clock(const Object& object, int line = -1, const FixedPlane& plane = {}) {
    dut().set(load_, line >= 0 ? 1 : 0);
    dut().set(line_, static_cast<std::uint64_t>(line >= 0 ? line : between(0, 63)));
    dut().set(plane_, line >= 0 ? plane.pack() : some_plane().pack());
    dut().set(object_, object.pack());
    dut().set(slack_, object.slack);
    under_test_.push_back({planes_, object});
    if (line >= 0 && line < kNumFixedPlanes) {
      plane_of(planes_, line) = plane;
      const std::size_t given = under_test_.size();
      for (std::size_t k = given < 2 ? 0 : given - 2; k < given; ++k) {  // this one and the one before
        under_test_[k].changed |= std::uint64_t{1} << line;
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
    const auto lines = [&](PortId port, std::uint32_t expected, int shift, const char* name) {
      const auto mixed = static_cast<std::uint32_t>(of.changed >> shift) & 0xffffU;
      const auto seen = static_cast<std::uint32_t>(dut().get(port));
      expect_port(port, (expected & ~mixed) | (seen & mixed), name);
    };
    lines(rows_meet_, test.rows_meet, 0, "rows_meet_o");
    lines(rows_above_, test.rows_above, 0, "rows_above_o");
    lines(columns_meet_, test.columns_meet, kMaxRows, "columns_meet_o");
    lines(columns_above_, test.columns_above, kMaxRows, "columns_above_o");
    if ((of.changed >> kNear & 1) == 0) {
      expect_port(near_, test.near ? 1 : 0, "near_o");
    }
    if ((of.changed >> kDepth & 1) == 0) {
      expect_port(z_, test.z, "z_o");
    }
  }

  void load_all() {
    for (int line = 0; line < kNumFixedPlanes; ++line) {
      clock(some_object(), line, some_plane());
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
  PortId plane_ = dut().port("plane_i");
  PortId line_ = dut().port("line_i");
  PortId object_ = dut().port("object_i");
  PortId slack_ = dut().port("slack_i");
  PortId rows_meet_ = dut().port("rows_meet_o");
  PortId rows_above_ = dut().port("rows_above_o");
  PortId columns_meet_ = dut().port("columns_meet_o");
  PortId columns_above_ = dut().port("columns_above_o");
  PortId near_ = dut().port("near_o");
  PortId z_ = dut().port("z_o");
};

TEST_F(FixedTesters, TestsAnObjectEachClock) {
  for (int k = 0; k < kObjects && !HasFatalFailure(); ++k) {
    clock(some_object());
    if (k % 200 == 199) {
      load_all();
    }
  }
}

TEST_F(FixedTesters, TakesAPlaneFromTheNextObjectOn) {
  for (int k = 0; k < kReloads && !HasFatalFailure(); ++k) {
    const bool load = between(0, 1) == 0;
    clock(some_object(), load ? static_cast<int>(between(0, kNumFixedPlanes - 1)) : -1, some_plane());
  }
}

TEST_F(FixedTesters, EveryBitOfAnOffsetCounts) {
  for (int k = 0; k < kReloads && !HasFatalFailure(); ++k) {
    const int line = static_cast<int>(k % 4 == 0 ? kDepth : between(0, kNear));
    const Object object = some_object();
    FixedPlane plane{point(static_cast<int>(between(1, 8))), 0};
    const std::int64_t reach = std::int64_t{object.radius + object.slack} << kCoordinateFraction;
    std::int64_t rim = line == kNear || between(0, 1) == 0 ? -reach : reach;
    if (line == kDepth) {  // the least depth of some code
      rim = reach + ((1024 + between(0, 1023)) << between(4, 24));
    }
    const std::int64_t offset = rim + between(-1, 1) - distance(plane, object.centre);
    plane.offset = std::clamp(offset, -kOffsetLimit, kOffsetLimit - 1);
    clock(some_object(), line, plane);
    clock(object);
  }
}

TEST_F(FixedTesters, LoadsNothingAtOtherNumbers) {
  for (int line = kNumFixedPlanes; line < 64 && !HasFatalFailure(); ++line) {
    clock(some_object(), line, some_plane());
    clock(some_object());
  }
  for (int k = 0; k < 2 * kStages && !HasFatalFailure(); ++k) {
    clock(some_object());
  }
}

}  // namespace
}  // namespace raplas
