// vertex_grid against its definition and its clocked model, and against the exact quotient.
//
// A known point's number is `across` / depth in units of 2^-kGridFraction lines. With D the depth, m = D /
// 2^k in [1, 2) and x = across / 2^(kLeastShift + shift), the exact one is y = x 2^17 / m / 2^19. The unit
// has floor(floor(x) r / 2^19), r < 2^17 near 2^17 / m. That is never above x r / 2^19, and below it by less
// than 1 + r / 2^19 < 5/4. r is 2^17 / m' rounded, m' = 1 + (index + 1/2) / 2^10. So |m / m' - 1| <= 2^-11 /
// m', and rounding is m' 2^-18 of r or less: x r / 2^19 = y (1 + e) with |e| <= 2^-11 / m' + m' 2^-18 + 2^-29
// < 2^-11 (1 + 2^-7), as m' >= 1 + 2^-11. The first test compares that with all reciprocals.
#include <array>
#include <random>
#include <vector>

#include "raplas/pair_selection.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

__extension__ using Int128 = __int128;

const int kClocks = Dut::simulator() == "ghdl" ? 20'000 : 200'000;
const PortStage kStage{"points_o", kVertexGridStages};

constexpr int kPointBits = 1 + 2 * kGridBits;
constexpr int kLeastShift = 8;
constexpr int kMaxShift = 15;
constexpr int kFactorBits = 18;
constexpr std::int64_t kSumLimit = std::int64_t{1} << (kPlaneSumBits - 1);
constexpr int kErrorBits = 18;  // |e| <= kError / 2^kErrorBits
constexpr std::int64_t kError = (1 << 7) + 1;

/// What is at the ports in a clock.
struct Vertex {
  bool valid = true;
  std::uint32_t slot = 0;
  std::int64_t across = 0;
  std::int64_t down = 0;
  std::int64_t depth = 0;  ///< the sum whose code it is; 0: only the code is known
  std::uint32_t code = 0;
  LimitsWord limits;
};

/// As project(): may the point be known?
bool definition_knows(const Vertex& vertex) {
  const int exponent = static_cast<int>(vertex.code) / (1 << kDepthFractionBits);
  const int shift = exponent - static_cast<int>(vertex.limits.scale);
  if (exponent < static_cast<int>(vertex.limits.least) || shift < 0 || shift > kMaxShift) {
    return false;
  }
  const std::int64_t limit = std::int64_t{1} << (kLeastShift + shift + kFactorBits - 1);
  return -limit <= vertex.across && vertex.across < limit && -limit <= vertex.down && vertex.down < limit;
}

/// The bounds above, everything times depth 2^kErrorBits: no division.
void expect_near(std::int32_t number, std::int64_t sum, const Vertex& vertex) {
  const Int128 unit = Int128{vertex.depth} << kErrorBits;
  const Int128 exact = (Int128{sum} << (vertex.limits.scale + 3)) << kErrorBits;
  const Int128 error = (exact < 0 ? -exact : exact) / (1 << kErrorBits) * kError;
  const Int128 seen = unit * number;
  EXPECT_TRUE(seen <= exact + error) << "too high: " << number << " of " << sum << " / " << vertex.depth;
  EXPECT_TRUE(4 * (exact - error - seen) < 5 * unit)
      << "too low: " << number << " of " << sum << " / " << vertex.depth;
}

class VertexGridBench : public testing::Test {
 protected:
  std::int64_t between(std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random_);
  }
  bool one_in(int n) { return between(1, n) == 1; }

  /// A sum that fits after `shift` more bits than kLeastShift, or just doesn't, or anything.
  std::int64_t sum(int shift) {
    constexpr std::int64_t kLimit = std::int64_t{1} << (kFactorBits - 1);
    if (one_in(8)) {
      return one_in(4) ? (one_in(2) ? -kSumLimit : kSumLimit - 1) : between(-kSumLimit, kSumLimit - 1);
    }
    const std::int64_t factor = one_in(4)   ? (one_in(2) ? -kLimit : kLimit) - between(0, 1)
                                : one_in(4) ? between(-2, 2)
                                            : between(-kLimit, kLimit - 1) >> between(0, kFactorBits);
    const std::int64_t step = std::int64_t{1} << (kLeastShift + shift);
    const std::int64_t low = one_in(4) ? (one_in(2) ? 0 : step - 1) : between(0, step - 1);
    return std::clamp(factor * step + low, -kSumLimit, kSumLimit - 1);
  }

  /// A vertex whose depth has `exponent` and this fraction (anything below it), with a grid that mostly
  /// permits.
  Vertex vertex(std::uint32_t exponent, std::uint32_t fraction, int shift) {
    constexpr std::uint32_t kLastExponent = (1U << kGridExponentBits) - 1;
    Vertex v;
    v.slot = static_cast<std::uint32_t>(between(0, 2));
    v.code = exponent << kDepthFractionBits | fraction;
    const int low_bits =
        static_cast<int>(exponent) + 2 * kCoordinateFraction - kDepthBias - kDepthFractionBits;
    if (exponent != 0 && low_bits + kDepthFractionBits < kPlaneSumBits - 1) {
      const std::int64_t step = std::int64_t{1} << low_bits;
      const std::int64_t low = one_in(4) ? (one_in(2) ? 0 : step - 1) : between(0, step - 1);
      v.depth = ((std::int64_t{1} << kDepthFractionBits) + fraction) * step + low;
    }
    v.limits.scale = static_cast<std::uint32_t>(static_cast<int>(exponent) - shift) & kLastExponent;
    v.limits.least = one_in(8) ? static_cast<std::uint32_t>(between(0, kLastExponent))
                               : (one_in(4) ? exponent : static_cast<std::uint32_t>(between(0, exponent)));
    v.across = sum(std::clamp(shift, 0, kMaxShift));
    v.down = sum(std::clamp(shift, 0, kMaxShift));
    return v;
  }
  std::uint32_t fraction() {
    return static_cast<std::uint32_t>(one_in(8) ? (one_in(2) ? 0 : 1023) : between(0, 1023));
  }

  void check(const Vertex& v) {
    if (v.depth != 0) {
      ASSERT_EQ(depth_code(v.depth), v.code);
    }
    const GridPoint point = project(v.across, v.down, v.code, v.limits);
    ASSERT_EQ(point.known, definition_knows(v));
    if (point.known && v.depth != 0) {
      expect_near(point.across, v.across, v);
      expect_near(point.down, v.down, v);
      ++(v.valid ? near_ : ignored_);
    }
    ++(point.known ? known_ : unknown_);

    dut().set(dut().port("valid_i"), v.valid ? 1 : 0);
    dut().set(dut().port("slot_i"), v.slot);
    dut().set(dut().port("across_i"), static_cast<std::uint64_t>(v.across) & (2 * kSumLimit - 1));
    dut().set(dut().port("down_i"), static_cast<std::uint64_t>(v.down) & (2 * kSumLimit - 1));
    dut().set(dut().port("depth_i"), v.code);
    dut().set(dut().port("scale_i"), v.limits.scale);
    dut().set(dut().port("least_i"), v.limits.least);
    if (v.valid && v.slot < slots_.size()) {
      slots_[v.slot] = point;
      filled_ |= 1U << v.slot;
    }
    model_.clock(v.valid, v.slot, v.across, v.down, v.code, v.limits);
    if (const auto due = board_.clock(filled_ == 7 ? slots_ : Points{}); due && *due != Points{}) {
      ASSERT_EQ(model_.points(), *due);
      expect_points(*due);
    }
  }

  using Points = VertexGrid::Points;

  /// Known points are equal, others are not known and may have any numbers.
  void expect_points(const Points& points) {
    std::array<std::uint32_t, (3 * kPointBits + 31) / 32> seen{};
    dut().get(points_, seen);
    std::array<std::uint32_t, seen.size()> expected = seen;
    for (int k = 0; k < 3; ++k) {
      const auto& [known, across, down] = points[static_cast<std::size_t>(k)];
      const int lsb = (2 - k) * kPointBits;
      insert(expected, {lsb + 2 * kGridBits, 1}, known ? 1 : 0);
      if (known) {
        insert(expected, {lsb + kGridBits, kGridBits}, static_cast<std::uint32_t>(across));
        insert(expected, {lsb, kGridBits}, static_cast<std::uint32_t>(down));
      }
    }
    expect_port(points_, expected, "points_o");
  }

  void TearDown() override {  // the last points leave the pipeline
    Vertex bubble;
    bubble.valid = false;
    for (int k = 1; k < kVertexGridStages; ++k) {
      check(bubble);
    }
  }

  PortId points_ = dut().port("points_o");
  std::mt19937_64 random_{171};
  VertexGrid model_;
  Points slots_{};
  unsigned filled_ = 0;
  Scoreboard<Points> board_{kVertexGridStages};
  int known_ = 0;
  int unknown_ = 0;
  int near_ = 0;
  int ignored_ = 0;
};

TEST(VertexGridReciprocal, IsRightForAllDepthsOfItsIndex) {
  constexpr std::int64_t kOne = std::int64_t{1} << (kDepthFractionBits + kReciprocalBits);
  for (std::uint32_t index = 0; index < 1U << kDepthFractionBits; ++index) {
    for (const std::uint32_t m : {index, index + 1}) {  // r m is monotonic in m: the ends are enough
      const std::int64_t one = reciprocal(index) * ((std::int64_t{1} << kDepthFractionBits) + m);
      EXPECT_LE(std::abs(one - kOne) << kErrorBits, kOne * kError) << index;
    }
    EXPECT_LT(reciprocal(index), std::int64_t{1} << kReciprocalBits);
  }
}

TEST_F(VertexGridBench, KnowsEveryReciprocal) {
  for (std::uint32_t index = 0; index < 1U << kDepthFractionBits; ++index) {
    for (int k = 0; k < 4; ++k) {
      Vertex v = vertex(20, index, 3);
      v.limits.least = 20;
      v.across = (k < 2 ? 131071 : -131072) * 2048LL;
      v.down = (k % 2 == 0 ? 131071 : -131072) * 2048LL;
      ASSERT_NO_FATAL_FAILURE(check(v));
    }
  }
}

TEST_F(VertexGridBench, DecidesEveryPairOfExponentAndScale) {
  for (std::uint32_t exponent = 0; exponent < 1U << kDepthExponentBits; ++exponent) {
    for (std::uint32_t scale = 0; scale < 1U << kGridExponentBits; ++scale) {
      for (std::uint32_t least = exponent; least <= std::min(exponent + 1, 31U); ++least) {
        Vertex v = vertex(exponent, fraction(), static_cast<int>(exponent) - static_cast<int>(scale));
        v.limits.scale = scale;
        v.limits.least = least;
        v.across = between(-2'000'000, 2'000'000);
        v.down = between(-2'000'000, 2'000'000);
        ASSERT_NO_FATAL_FAILURE(check(v));
      }
    }
  }
}

TEST_F(VertexGridBench, KnowsWhatFitsAndNothingElse) {
  for (int shift = 0; shift <= kMaxShift; ++shift) {
    const std::int64_t limit = std::int64_t{1} << (kLeastShift + shift + kFactorBits - 1);
    for (int bit = 0; bit < kPlaneSumBits - 1;
         ++bit) {  // 2^bit and -2^bit, and off by one: each sign bit alone
      for (const std::int64_t off : {-1, 0}) {
        for (const bool swapped : {false, true}) {
          Vertex v = vertex(26, fraction(), shift);
          v.limits.least = 0;
          v.across = (std::int64_t{1} << bit) + off;
          v.down = std::max(-limit, -kSumLimit);
          if (one_in(2)) {
            v.across = -1 - v.across;
          }
          if (swapped) {
            std::swap(v.across, v.down);
          }
          ASSERT_NO_FATAL_FAILURE(check(v));
          // a single bit that isn't the sign's
          (swapped ? v.down : v.across) = one_in(2) ? std::int64_t{1} << bit : ~(std::int64_t{1} << bit);
          ASSERT_NO_FATAL_FAILURE(check(v));
        }
      }
    }
  }
}

TEST_F(VertexGridBench, IsNearTheExactQuotientOnRandomVertices) {
  for (int k = 0; k < kClocks; ++k) {
    const auto exponent = static_cast<std::uint32_t>(between(0, 31));
    const int shift = static_cast<int>(one_in(16) ? between(-1, kMaxShift + 1) : between(0, kMaxShift));
    Vertex v = vertex(exponent, fraction(), shift);
    v.valid = k < 3 || !one_in(4);
    v.slot = static_cast<std::uint32_t>(k < 3 ? k : between(0, one_in(16) ? 3 : 2));
    ASSERT_NO_FATAL_FAILURE(check(v));
  }
  EXPECT_GT(near_, kClocks / 8);
  EXPECT_GT(known_, kClocks / 8);
  EXPECT_GT(unknown_, kClocks / 8);
}

TEST_F(VertexGridBench, KeepsPointsWhileNoneComes) {
  for (int k = 0; k < kClocks / 4; ++k) {
    Vertex v =
        vertex(static_cast<std::uint32_t>(between(8, 24)), fraction(), static_cast<int>(between(0, 7)));
    v.valid = k < 3 || one_in(6);
    v.slot = static_cast<std::uint32_t>(k < 3 ? k : between(0, 2));
    ASSERT_NO_FATAL_FAILURE(check(v));
  }
}

}  // namespace
}  // namespace raplas
