#include "error_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raplas {
namespace {

/// Double precision computes the values of a band: what it loses goes into the bounds too.
constexpr double kHere = 0x1p-52;

/// z <= q is certain for a t that is rounded down by less than this share: docs/fixed_point.md takes
/// DEPTH_MARGIN = 4 codes off z, docs/ray_triangle.md 3 off q, and a code is 2^-11 at least.
constexpr double kDepthShare = 0x1p-11;

/// A number, and how far a device's number may be from it.
struct Bounded {
  double value;
  double error;

  [[nodiscard]] bool surely_above() const { return value > error; }
  [[nodiscard]] bool surely_below() const { return value < -error; }
  [[nodiscard]] double most() const { return std::abs(value) + error; }
};

Bounded operator-(const Bounded& x) { return {-x.value, x.error}; }

using Vector = std::array<Bounded, 3>;

/// The operations of one arithmetic.
class Arithmetic {
 public:
  explicit Arithmetic(const ErrorModel& model) : model_(model) {}

  [[nodiscard]] Bounded input(const Bounded& x) const {
    return {x.value, x.error + model_.input * x.most() + model_.tiny};
  }
  [[nodiscard]] Vector input(const glm::dvec3& v) const {
    return {input({v.x, 0}), input({v.y, 0}), input({v.z, 0})};
  }
  [[nodiscard]] Bounded add(const Bounded& a, const Bounded& b) const {
    const double cut = model_.cut * std::max(a.most(), b.most());
    return rounded({a.value + b.value, a.error + b.error + cut});
  }
  [[nodiscard]] Bounded multiply(const Bounded& a, const Bounded& b) const {
    const double error = std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error;
    return rounded({a.value * b.value, error});
  }
  [[nodiscard]] Vector subtract(const Vector& a, const Vector& b) const {
    return {add(a[0], -b[0]), add(a[1], -b[1]), add(a[2], -b[2])};
  }
  [[nodiscard]] Bounded dot(const Vector& a, const Vector& b) const {
    return add(add(multiply(a[0], b[0]), multiply(a[1], b[1])), multiply(a[2], b[2]));
  }
  [[nodiscard]] Vector cross(const Vector& a, const Vector& b) const {
    const auto term = [&](std::size_t k, std::size_t l) {
      return add(multiply(a[k], b[l]), -multiply(a[l], b[k]));
    };
    return {term(1, 2), term(2, 0), term(0, 1)};
  }

 private:
  [[nodiscard]] Bounded rounded(const Bounded& x) const {
    return {x.value, (x.error + model_.operation * x.most() + kHere * std::abs(x.value)) * (1 + 8 * kHere) +
                         model_.tiny};
  }

  ErrorModel model_;
};

/// Of anything the vector may be.
double norm1(const Vector& v) { return v[0].most() + v[1].most() + v[2].most(); }

/// The four dot products; signs are not yet turned round.
struct Products {
  Bounded n_d;
  Bounded n_t;
  Bounded dxt_e1;
  Bounded dxt_e2;
};

Products products_of(const ErrorModel& model, const Triangle& triangle, const glm::dvec3& origin,
                     const glm::dvec3& direction) {
  const Arithmetic device(model);
  const Arithmetic host(kDoubleErrors);
  const Vector e1 = device.input(triangle.e1);
  const Vector e2 = device.input(triangle.e2);
  const Vector d = device.input(direction);
  const Vector cross = host.cross(e1, e2);  // of the edges as stored
  const Vector n{device.input(cross[0]), device.input(cross[1]), device.input(cross[2])};
  const Vector t = device.subtract(device.input(triangle.v0), device.input(origin));
  const Vector dxt = device.cross(d, t);
  // a border is an error of the sums that are compared with 0
  const auto bordered = [&model](const Bounded& x, double factors) {
    return Bounded{x.value, x.error + model.border * factors * (1 + 8 * kHere)};
  };
  return {bordered(device.dot(n, d), norm1(e1) * norm1(e2)), device.dot(n, t),
          bordered(device.dot(dxt, e1), norm1(t) * norm1(e1)),
          bordered(device.dot(dxt, e2), norm1(t) * norm1(e2))};
}

/// The sign of N.D is not certain: a miss if no sign of it gives a hit.
Band edge_on(const Products& p) {
  const double most = p.n_d.most();
  const auto away = [most](const Bounded& x) { return std::abs(x.value) - x.error > most * (1 + 0x1p-15); };
  const auto alike = [](const Bounded& a, const Bounded& b) {
    return (a.surely_above() && b.surely_above()) || (a.surely_below() && b.surely_below());
  };
  Band band;
  band.deep_enough = false;
  band.t_low = std::max(0.0, std::abs(p.n_t.value) - p.n_t.error) / most;
  band.t_high = std::numeric_limits<double>::infinity();
  // t' has the sign of N.D, u' = -+(D x T).E2 and v' = +-(D x T).E1 too
  if (away(p.dxt_e1) || away(p.dxt_e2) || alike(p.dxt_e1, p.dxt_e2) || alike(p.n_t, p.dxt_e2) ||
      alike(p.n_t, -p.dxt_e1)) {
    band.verdict = Verdict::miss;
  }
  return band;
}

}  // namespace

Band error_band(const ErrorModel& model, const Triangle& triangle, const glm::dvec3& origin,
                const glm::dvec3& direction) {
  const Products p = products_of(model, triangle, origin, direction);
  if (!p.n_d.surely_above() && !p.n_d.surely_below()) {
    return edge_on(p);
  }
  const auto turned = [&](const Bounded& x) { return p.n_d.value < 0 ? -x : x; };
  const Bounded d = turned(p.n_d);
  const Bounded t = turned(p.n_t);
  const Bounded u = turned(-p.dxt_e2);
  const Bounded v = turned(p.dxt_e1);
  const Bounded sum = Arithmetic(model).add(u, v);
  const Bounded rest{d.value - sum.value, d.error + sum.error + kHere * (d.most() + sum.most())};
  const std::array<Bounded, 4> conditions{t, u, v, rest};
  Band band;
  if (std::any_of(conditions.begin(), conditions.end(), [](const Bounded& x) { return x.surely_below(); })) {
    band.verdict = Verdict::miss;
  } else if (std::all_of(conditions.begin(), conditions.end(),
                         [](const Bounded& x) { return x.surely_above(); })) {
    band.verdict = Verdict::hit;
  }
  band.t_low = std::max(0.0, t.value - t.error) / d.most();
  band.t_high = (t.value + t.error) / (d.value - d.error);
  band.deep_enough = !model.depth_codes || band.t_low >= band.t_high * (1 - kDepthShare);
  return band;
}

}  // namespace raplas
