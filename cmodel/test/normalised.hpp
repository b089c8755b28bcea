// Words of a normalised scene: their ranges, which the theorems of formal/bounds are about, and random ones.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "random.hpp"
#include "raplas/plane_sphere.hpp"
#include "raplas/ray_triangle.hpp"

namespace raplas {

// largest magnitudes and lengths of stored words
constexpr double kMaxCentre = 127.0 / 128;
constexpr double kMaxOrigin = 255.0 / 256;  ///< of a pencil
constexpr double kMaxOffset = 255.0 / 256;  ///< p of a plane
constexpr double kMaxUnit = 1 + 0x1p-17;    ///< n and D: unit vectors, rounded
constexpr double kMaxVertex = 0.985;        ///< V0
constexpr double kMaxEdge = 1.97;           ///< E1, E2, E1 - E2
constexpr double kMaxNormal = 2.53;         ///< N

[[gnu::always_inline]] inline double value_of(std::uint32_t word) {
  return Fp24::from_bits(word).to_double();
}

template <typename Real>
using Vector = std::array<Real, 3>;

template <typename Real>
[[gnu::always_inline]] inline Real dot3(const Vector<Real>& a, const Vector<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename Real>
[[gnu::always_inline]] inline Vector<Real> minus(const Vector<Real>& a, const Vector<Real>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Vector k of a case's words.
template <typename Real>
[[gnu::always_inline]] inline Vector<Real> vector_of(std::span<const std::uint32_t> words, std::size_t k) {
  return {static_cast<Real>(value_of(words[k])), static_cast<Real>(value_of(words[k + 1])),
          static_cast<Real>(value_of(words[k + 2]))};
}

template <typename F>
Vec3<F> model_vector(std::span<const std::uint32_t> words, std::size_t k) {
  return {F::from_bits(words[k]), F::from_bits(words[k + 1]), F::from_bits(words[k + 2])};
}

[[gnu::always_inline]] inline bool within(std::span<const std::uint32_t> words, std::size_t k, double limit) {
  const auto v = vector_of<double>(words, k);
  return dot3(v, v) <= limit * limit;
}

[[gnu::always_inline]] inline bool is_unit(std::span<const std::uint32_t> words, std::size_t k) {
  return within(words, k, kMaxUnit) &&
         std::max({words[k] & 0x7fffffU, words[k + 1] & 0x7fffffU, words[k + 2] & 0x7fffffU}) <= 0x3f0000U;
}

/// n.c + p of a normalised scene.
struct PlaneSphere {
  using Words = std::array<std::uint32_t, 7>;  // n c p
  static constexpr const char* kFile = "plane_sphere";
  static constexpr std::array kNames{"distance"};
  static constexpr Words kTops{62, 62, 62, 62, 62, 62, 62};  // largest exponents
  static constexpr std::array kWords{"nx", "ny", "nz", "cx", "cy", "cz", "p"};

  /// Is the vector at k one of a normalised scene?
  static bool valid(const Words& w, std::size_t k) {
    return k == 0   ? is_unit(w, k)
           : k == 3 ? within(w, k, kMaxCentre)
                    : std::abs(value_of(w[k])) <= kMaxOffset;
  }

  template <typename Real>
  static std::array<Real, 1> exact(const Words& w) {
    return {dot3(vector_of<Real>(w, 0), vector_of<Real>(w, 3)) + static_cast<Real>(value_of(w[6]))};
  }

  template <typename F>
  static std::array<double, 1> computed(const Words& w) {
    const PlaneWord<F> plane{model_vector<F>(w, 0), F::from_bits(w[6])};
    return {plane_distance(plane, model_vector<F>(w, 3)).to_double()};
  }
};

/// N.D, N.T, u', v', u' + v' of a normalised scene, without the sign rule (which is exact).
struct RayTriangle {
  using Words = std::array<std::uint32_t, 18>;  // V0 O D E1 E2 N
  static constexpr const char* kFile = "ray_triangle";
  static constexpr std::array kNames{"nd", "t", "u", "v", "uv"};
  static constexpr Words kTops{62, 62, 62, 62, 62, 62, 62, 62, 62, 63, 63, 63, 63, 63, 63, 64, 64, 64};
  static constexpr std::array kWords{"v0x", "v0y", "v0z", "ox",  "oy",  "oz",  "dx", "dy", "dz",
                                     "e1x", "e1y", "e1z", "e2x", "e2y", "e2z", "nx", "ny", "nz"};

  /// Is the vector at k one of a normalised scene?
  static bool valid(const Words& w, std::size_t k) {
    constexpr std::array kLimits{kMaxVertex, kMaxOrigin, kMaxUnit, kMaxEdge, kMaxEdge, kMaxNormal};
    if (k == 6) {
      return is_unit(w, k);
    }
    if (!within(w, k, kLimits[k / 3])) {
      return false;
    }
    if (k != 9 && k != 12) {
      return true;
    }
    const auto third = minus(vector_of<double>(w, 9), vector_of<double>(w, 12));
    return dot3(third, third) <= kMaxEdge * kMaxEdge;
  }

  template <typename Real>
  static std::array<Real, 5> exact(const Words& w) {
    const auto d = vector_of<Real>(w, 6);
    const auto n = vector_of<Real>(w, 15);
    const auto t = minus(vector_of<Real>(w, 0), vector_of<Real>(w, 3));
    const Vector<Real> cross{d[1] * t[2] - d[2] * t[1], d[2] * t[0] - d[0] * t[2], d[0] * t[1] - d[1] * t[0]};
    const Real u = dot3(cross, vector_of<Real>(w, 12));
    const Real v = dot3(cross, vector_of<Real>(w, 9));
    return {dot3(n, d), dot3(n, t), u, v, v - u};
  }

  template <typename F>
  static std::array<double, 5> computed(const Words& w) {
    const TriangleWord<F> triangle{model_vector<F>(w, 0), model_vector<F>(w, 9), model_vector<F>(w, 12),
                                   model_vector<F>(w, 15)};
    const Solution<F> s = solve(triangle, model_vector<F>(w, 3), model_vector<F>(w, 6));
    // The sign rule undone: whether it flipped is seen in N.D, which the test computes once more.
    const bool flipped = dot(triangle.n, model_vector<F>(w, 6)).sign();
    const double sign = flipped ? -1 : 1;
    return {sign * s.d.to_double(), sign * s.t.to_double(), -sign * s.u.to_double(), sign * s.v.to_double(),
            sign * (s.u + s.v).to_double()};
  }
};

/// Words of a datapath: random ones, and small changes.
template <typename Datapath>
class Operands {
 public:
  using Words = typename Datapath::Words;

  explicit Operands(std::uint64_t seed) : random_(seed) {}

  /// One vector after the other, each until it is short enough; zeros are valid.
  Words fresh() {
    Words words{};
    for (std::size_t k = 0; k < words.size(); k += 3) {
      do {
        for (std::size_t i = k; i < std::min(k + 3, words.size()); ++i) {
          words[i] = word(i);
        }
      } while (!Datapath::valid(words, k));
    }
    return words;
  }

  /// One to three words changed.
  Words changed(Words words) {
    for (std::uint32_t count = 1 + random_.below(3); count != 0; --count) {
      const std::uint32_t k = random_.below(static_cast<std::uint32_t>(words.size()));
      const std::size_t first = k / 3 * 3;
      const Words before = words;
      do {
        words = before;
        change(words, k);
      } while (!Datapath::valid(words, first));
    }
    return words;
  }

 private:
  std::uint32_t fraction() {
    const std::uint64_t random = random_();
    const auto uniform = static_cast<std::uint32_t>(random & 0xffff);
    const std::uint32_t shift = (random >> 16) & 15;
    switch ((random >> 20) & 7) {
      case 0:  // sparse
        return (uniform << shift) & 0xffffU;
      case 1:  // ends in ones
        return uniform | (0xffffU >> shift);
      case 2:  // just below a power of two
        return 0xffffU - (uniform >> 12);
      case 3:  // just above one
        return uniform >> 12;
      default:
        return uniform;
    }
  }

  std::uint32_t word(std::size_t k) {
    const std::uint64_t random = random_();
    const auto down = static_cast<std::uint32_t>(std::countr_zero(random | (std::uint64_t{1} << 60)));
    const std::uint32_t sign = static_cast<std::uint32_t>(random >> 63) << 23;
    return sign | ((Datapath::kTops[k] - std::min(down, Datapath::kTops[k])) << 16) | fraction();
  }

  void change(Words& words, std::uint32_t k) {
    std::uint32_t& w = words[k];
    switch (random_.below(8)) {
      case 0:
        w = word(k);
        break;
      case 1:
        w = (w & 0xff0000U) | fraction();
        break;
      case 2:
        w ^= 0x800000U;
        break;
      case 3:  // exchanged within a vector
        std::swap(w, words[k / 3 * 3 + (k + 1) % 3 < words.size() ? k / 3 * 3 + (k + 1) % 3 : k]);
        break;
      case 4:
        w ^= std::uint32_t{1} << random_.below(16);
        break;
      default: {  // a step up or down, of any size
        const std::uint32_t step = random_.below(std::uint32_t{1} << (1 + random_.below(16))) + 1;
        const std::uint32_t magnitude = w & 0x7fffffU;
        const bool up = random_.below(2) != 0;
        const std::uint32_t moved = up ? magnitude + step : magnitude - std::min(step, magnitude);
        w = (w & 0x800000U) | std::min(moved, 0x7fffffU);
      }
    }
  }

  Xoshiro random_;
};

}  // namespace raplas
