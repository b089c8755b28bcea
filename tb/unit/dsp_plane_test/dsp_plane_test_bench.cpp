// dsp_plane_test against exact integers. MODE is the unit's generic.
#include <random>
#include <vector>

#include "raplas/constants.hpp"
#include "support/scoreboard.hpp"

namespace raplas {
namespace {

constexpr int kYSkew = 1;  // clocks from x_i to y_i, and so on
constexpr int kZSkew = 2;
constexpr int kPSkew = 1;
constexpr int kRSkew = 4;
const int kClocks = Dut::simulator() == "ghdl" ? 6'000 : 40'000;
const PortStage kStages[]{
    {"above_o", kPlaneTestStages}, {"meets_o", kPlaneTestStages}, {"sum_o", kPlaneTestStages}};

constexpr std::int64_t kLimit = std::int64_t{1} << (kCoordinateBits - 1);
constexpr std::int64_t kOffsetLimit = std::int64_t{1} << (kOffsetBits - 1);
constexpr std::uint64_t kMask48 = (std::uint64_t{1} << 48) - 1;

/// The bits of a signed number.
std::uint64_t bits_of(std::int64_t value, int bits) {
  return static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << bits) - 1);
}

/// What is at the ports in a clock; the coordinates and R of the object whose x comes in this clock.
struct Clock {
  bool load = false;
  std::array<std::int64_t, 3> normal{};
  std::int64_t offset = 0;
  std::array<std::int64_t, 3> centre{};
  std::int64_t reach = 0;
};

class DspPlaneTest : public testing::Test {
 protected:
  std::int64_t between(std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random_);
  }

  /// A word of 18 bits: the ends, small, or anything.
  std::int64_t coordinate() {
    switch (between(0, 7)) {
      case 0:
        return -kLimit + between(0, 1);
      case 1:
        return kLimit - 1 - between(0, 1);
      case 2:
        return between(-2, 2);
      default:
        return between(-kLimit, kLimit - 1) >> between(0, 6);
    }
  }

  Clock clock(bool load) {
    Clock c;
    c.load = load;
    for (std::size_t k = 0; k < 3; ++k) {
      c.normal[k] = coordinate();
      c.centre[k] = coordinate();
    }
    c.offset = between(0, 15) == 0 ? (between(0, 1) == 0 ? -kOffsetLimit : kOffsetLimit - 1)
                                   : between(-kOffsetLimit, kOffsetLimit - 1) >> between(0, 30);
    c.reach = between(0, 7) == 0 ? (between(0, 1) == 0 ? 0 : 2 * kLimit - 1)
                                 : between(0, 2 * kLimit - 1) >> between(0, 17);
    return c;
  }

  /// The clock up to t whose plane is loaded then.
  [[nodiscard]] const Clock& loaded(std::size_t t) const {
    while (!stream_[t].load) {
      --t;
    }
    return stream_[t];
  }

  [[nodiscard]] std::int64_t products(std::size_t t) const {
    const auto& c = stream_[t].centre;
    return loaded(t).normal[0] * c[0] + loaded(t + kYSkew).normal[1] * c[1] +
           loaded(t + kZSkew).normal[2] * c[2];
  }

  /// Lets n.c + p be `wanted` by the offset loaded for this object alone, if it has one and p fits.
  void aim(std::size_t t, std::int64_t wanted) {
    const std::int64_t offset = wanted - products(t);
    if (stream_[t + kPSkew].load && -kOffsetLimit <= offset && offset < kOffsetLimit) {
      stream_[t + kPSkew].offset = offset;
    }
  }

  void check_sum(std::int64_t d, std::int64_t reach) const {
    const bool minus = MODE == 2 || (MODE == 0 && d >= 0);
    const std::int64_t sum = minus ? d - reach - (MODE == 0 ? 1 : 0) : d + reach;
    const bool meets = MODE == 0 ? std::abs(d) <= reach : sum >= 0;
    expect_port(above_, d >= 0 ? 1 : 0, "above_o");
    expect_port(meets_, meets ? 1 : 0, "meets_o");
    expect_port(sum_, static_cast<std::uint64_t>(sum) & kMask48, "sum_o");
  }

  /// Runs the stream; its first clock loads a plane.
  void run() {
    for (std::size_t t = 0; t < stream_.size() && !HasFatalFailure(); ++t) {
      const auto before = [&](int skew) -> const Clock& {
        const auto age = static_cast<std::size_t>(skew);
        return stream_[t < age ? 0 : t - age];
      };
      const Clock& now = stream_[t];
      dut().set(load_, now.load ? 1 : 0);
      for (std::size_t k = 0; k < 3; ++k) {
        dut().set(normal_[k], bits_of(now.normal[k], kCoordinateBits));
      }
      dut().set(offset_, bits_of(now.offset, kOffsetBits));
      dut().set(centre_[0], bits_of(now.centre[0], kCoordinateBits));
      dut().set(centre_[1], bits_of(before(kYSkew).centre[1], kCoordinateBits));
      dut().set(centre_[2], bits_of(before(kZSkew).centre[2], kCoordinateBits));
      dut().set(reach_, static_cast<std::uint64_t>(before(kRSkew).reach));
      dut().clock();
      if (t + 1 >= kPlaneTestStages) {
        const std::size_t of = t + 1 - kPlaneTestStages;
        check_sum(products(of) + loaded(of + kPSkew).offset, stream_[of].reach << kCoordinateFraction);
      }
    }
  }

  std::mt19937_64 random_{31};
  std::vector<Clock> stream_;
  PortId load_ = dut().port("load_i");
  std::array<PortId, 3> normal_{dut().port("nx_i"), dut().port("ny_i"), dut().port("nz_i")};
  PortId offset_ = dut().port("p_i");
  std::array<PortId, 3> centre_{dut().port("x_i"), dut().port("y_i"), dut().port("z_i")};
  PortId reach_ = dut().port("r_i");
  PortId above_ = dut().port("above_o");
  PortId meets_ = dut().port("meets_o");
  PortId sum_ = dut().port("sum_o");
};

TEST_F(DspPlaneTest, IsExactAndKeepsItsPlane) {
  for (int t = 0; t < kClocks; ++t) {
    stream_.push_back(clock(t == 0 || between(0, 3) == 0));
  }
  run();
}

TEST_F(DspPlaneTest, IsExactAtTheRim) {
  for (int t = 0; t < kClocks; ++t) {
    stream_.push_back(clock(t == 0 || between(0, 7) != 0));
  }
  for (std::size_t t = 0; t + kPlaneTestStages < stream_.size(); ++t) {
    const std::int64_t reach = stream_[t].reach << kCoordinateFraction;
    const std::int64_t off = between(-2, 2);
    if (between(0, 3) == 0) {
      aim(t, off);  // about the plane
    } else {
      aim(t, (between(0, 1) == 0 ? reach : -reach) + off);
    }
  }
  run();
}

}  // namespace
}  // namespace raplas
