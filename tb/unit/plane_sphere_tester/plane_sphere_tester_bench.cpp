// plane_sphere_tester against the six operations done by MPFR. GUARD_BITS is the unit's generic.
#include "operands.hpp"
#include "oracle.hpp"
#include "raplas/plane_sphere.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kRandomCases = 30'000;
const int kRimCases = Dut::simulator() == "ghdl" ? 2'000 : 30'000;
const PortStage kStage{"meets_o", kTesterStages};

std::uint32_t sum(std::uint32_t a, std::uint32_t b) {
  return GUARD_BITS == 0 ? oracle::add_cut(a, b, 0) : oracle::add(a, b);
}

struct Case {
  std::array<std::uint32_t, 4> plane;  // nx ny nz p
  std::array<std::uint32_t, 4> ball;   // cx cy cz r

  [[nodiscard]] std::uint32_t distance() const {
    const std::uint32_t xy = sum(oracle::multiply(plane[0], ball[0]), oracle::multiply(plane[1], ball[1]));
    const std::uint32_t zp = sum(oracle::multiply(plane[2], ball[2]), plane[3]);
    return sum(xy, zp) & 0x7fffffU;
  }
  [[nodiscard]] bool meets() const {
    return mpfr_cmpabs(oracle::Real(distance()).get(), oracle::Real(ball[3]).get()) <= 0;
  }
};

PackedWord<96> pack(const std::array<std::uint32_t, 4>& words) {
  PackedWord<96> packed{};
  for (int k = 0; k < 4; ++k) {
    insert(packed, {72 - 24 * k, 24}, words[static_cast<std::size_t>(k)]);
  }
  return packed;
}

class PlaneSphereTester : public testing::Test {
 protected:
  void check(const Case& c) {
    dut().set(plane_, pack(c.plane));
    dut().set(ball_, pack(c.ball));
    if (const auto due = board_.clock(c.meets())) {
      expect_port(meets_, *due ? 1 : 0, "meets_o");
    }
  }
  void TearDown() override {  // the last results leave the pipeline
    for (int k = 1; k < kTesterStages; ++k) {
      check({});
    }
  }

  PortId plane_ = dut().port("plane_i");
  PortId ball_ = dut().port("ball_i");
  PortId meets_ = dut().port("meets_o");
  Scoreboard<bool> board_{kTesterStages};
};

TEST_F(PlaneSphereTester, DecidesRandomCases) {
  OperandPairs pairs(21);
  for (int k = 0; k < kRandomCases; ++k) {
    Case c{};
    for (std::size_t i = 0; i < 4; ++i) {
      const int spread = k % 3 == 0 ? 64 : 4;
      c.plane[i] = pairs.word(63 + pairs.between(-spread, spread / 4));
      c.ball[i] = pairs.word(63 + pairs.between(-spread, spread / 4));
    }
    c.ball[3] &= 0x7fffffU;
    ASSERT_NO_FATAL_FAILURE(check(c));
  }
}

TEST_F(PlaneSphereTester, DecidesCorners) {
  OperandPairs pairs(23);
  const auto corner = [&pairs] {
    return kCorners[static_cast<std::size_t>(pairs.between(0, static_cast<int>(kCorners.size()) - 1))];
  };
  for (int k = 0; k < kRimCases; ++k) {
    Case c{};
    for (std::size_t i = 0; i < 4; ++i) {
      c.plane[i] = k % 2 == 0 || pairs.bits(1) == 0 ? corner() : 0;
      c.ball[i] = corner();
    }
    c.ball[3] &= 0x7fffffU;
    ASSERT_NO_FATAL_FAILURE(check(c));
    const std::uint32_t d = c.distance();
    c.ball[3] = d == 0 ? 0 : d - (d > 0x010000U ? 1U : 0U);  // the rim itself, and an ulp outside
    ASSERT_NO_FATAL_FAILURE(check(c));
    c.ball[3] = d;
    ASSERT_NO_FATAL_FAILURE(check(c));
  }
}

TEST_F(PlaneSphereTester, IsExactAtTheRimWhateverIsAdded) {
  OperandPairs pairs(24);
  for (int k = 0; k < kRimCases; ++k) {
    Case c{};
    const int product = 63 + pairs.between(-40, 40);  // about the exponent of all products and of p
    for (std::size_t i = 0; i < 3; ++i) {
      const int e = pairs.between(30, 90);
      const int apart = k % 2 == 0 ? pairs.between(-2, 2) : pairs.between(-20, 20);
      c.plane[i] = pairs.word(e);
      c.ball[i] = pairs.word(63 + product - e + apart);
    }
    c.plane[3] = pairs.word(product + pairs.between(-2, 2));
    if (k % 3 == 1) {  // what is added last but one, or first, nearly cancels
      c.plane[3] = (oracle::multiply(c.plane[2], c.ball[2]) ^ 0x800000U) + pairs.bits(k % 2 == 0 ? 2 : 14);
    } else if (k % 3 == 2) {
      c.plane[1] = c.plane[0] ^ 0x800000U;
      c.ball[1] = (c.ball[0] & 0xffff00U) | pairs.bits(8);
    }
    c.plane[3] &= 0xffffffU;
    const std::uint32_t d = c.distance();
    if (d < 0x010002U || d > 0x7ffffdU) {
      continue;
    }
    c.ball[3] = d - (k % 4 < 2 ? 0U : 1U);  // on the rim, and one ulp outside
    ASSERT_NO_FATAL_FAILURE(check(c));
  }
}

TEST_F(PlaneSphereTester, IsExactAtTheRim) {
  OperandPairs pairs(22);
  for (int k = 0; k < kRandomCases; ++k) {
    Case c{};
    for (std::size_t i = 0; i < 4; ++i) {
      c.plane[i] = pairs.word(63 + pairs.between(-4, 0));
      c.ball[i] = pairs.word(63 + pairs.between(-4, 0));
    }
    const std::uint32_t d = c.distance();
    if (d < 0x010002U || d > 0x7ffffdU) {
      continue;
    }
    c.ball[3] =
        d + static_cast<std::uint32_t>(pairs.between(-1, 1));  // one ulp inside, on and outside the rim
    ASSERT_NO_FATAL_FAILURE(check(c));
  }
}

}  // namespace
}  // namespace raplas
