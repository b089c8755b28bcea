// A pencil's words in fixed point, with a slack that covers every rounding: docs/fixed_encoding.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "raplas/encode.hpp"
#include "raplas/encode_fixed.hpp"

namespace raplas {
namespace {

constexpr double kUnit = 1.0 / (1 << kCoordinateFraction);
constexpr double kOffsetUnit = kUnit * kUnit;

/// Rays end on the sphere of this radius around zero: more than the corners of triangles as stored.
constexpr double kReach = 1 + 0x1p-12;

/// More than the errors of double precision in sums of a few terms below 4.
constexpr double kDoubleError = 0x1p-44;

glm::dvec3 value_of(const FixedVec3& v) { return glm::dvec3(v[0], v[1], v[2]) * kUnit; }

/// The largest t > 0 at which origin + t * direction is inside the ball, rounded up, or 0.
double last_inside(const glm::dvec3& origin, const glm::dvec3& direction) {
  const double length = glm::length(direction);
  const glm::dvec3 unit = direction / length;
  const double half = glm::dot(origin, unit);
  const double discriminant = half * half - glm::dot(origin, origin) + kReach * kReach + 0x1p-40;
  if (discriminant < 0) {
    return 0;
  }
  return std::max(0.0, (std::sqrt(discriminant) - half) * (1 + 0x1p-40) + 0x1p-40) / length;
}

/// The lattice vector nearest to `unit`; one that is too long, or has a component of +1, is made from a
/// vector shorter by a unit, which rounding makes longer by less than that.
FixedVec3 lattice_normal(const glm::dvec3& unit) {
  constexpr std::int64_t kOne = 1 << kCoordinateFraction;
  FixedVec3 normal{};
  for (std::int64_t length = kOne; length >= kOne - 1; --length) {
    std::int64_t square = 0;
    bool fits = true;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t component = std::lrint(unit[k] * static_cast<double>(length));
      normal[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(component);
      fits = fits && component < kOne;
      square += component * component;
    }
    if (fits && square <= kOne * kOne) {
      break;
    }
  }
  return normal;
}

class PencilEncoder {
 public:
  PencilEncoder(const Pencil& pencil, double vertex_error) : pencil_(pencil), vertex_error_(vertex_error) {}

  FixedPencil run() {
    words_.pencil = {static_cast<std::uint32_t>(pencil_.rows), static_cast<std::uint32_t>(pencil_.columns),
                     encode<Fp24>(pencil_.origin, "pencil origin")};
    origin_ = decode(words_.pencil.origin);
    encode_rays();
    encode_lines();
    encode_depths();
    words_.limits.any_hit = pencil_.any_hit;
    words_.limits.far = far_code();
    return {words_, t_scale_};
  }

 private:
  static std::size_t index(int row, int column) {
    return static_cast<std::size_t>(row) * kMaxColumns + static_cast<std::size_t>(column);
  }

  void encode_rays() {
    if (!(std::abs(glm::length(pencil_.axis) - 1) < 1e-9)) {
      throw std::invalid_argument("a pencil's axis has length 1");
    }
    std::size_t next = 0;
    for (int r = 0; r < pencil_.rows; ++r) {
      for (int c = 0; c < pencil_.columns; ++c) {
        const glm::dvec3& unit = pencil_.directions[next++];
        const double along = glm::dot(pencil_.axis, unit);
        if (!(along > 0)) {
          throw std::invalid_argument("a ray doesn't go along its pencil's axis");
        }
        const std::size_t ray = index(r, c);
        words_.rays[ray] = encode<Fp24>(unit / along, "ray direction");
        t_scale_[ray] = 1 / along;
        const glm::dvec3 direction = decode(words_.rays[ray]);
        // a hit whose quotient code is below far's has t < far (1 + 2^-8)
        const double last = std::min(last_inside(origin_, direction), pencil_.far * (1 + 0x1p-8));
        way_[ray] = last * direction;
        directions_[ray] = direction;
      }
    }
  }

  /// A line's plane; the slack grows to what it needs. `step` leads from ray to ray of the line.
  FixedPlane encode_line(const Plane& line, std::size_t first, std::size_t step, int count) {
    const std::size_t last = first + step * static_cast<std::size_t>(count - 1);
    FixedPlane plane{lattice_normal(line.normal), 0};
    const glm::dvec3 normal = value_of(plane.normal);
    double low = 0;
    double high = 0;
    for (std::size_t ray = first; ray <= last; ray += step) {
      const double change = glm::dot(normal, way_[ray]);
      low = std::min(low, change);
      high = std::max(high, change);
    }
    const double at_origin = glm::dot(normal, origin_);
    plane.offset = offset_of(-at_origin - (low + high) / 2);
    const double start = at_origin + static_cast<double>(plane.offset) * kOffsetUnit;
    error_ = std::max({error_, std::abs(start + low), std::abs(start + high)});
    return plane;
  }

  void encode_lines() {
    constexpr FixedPlane kNowhere{{}, (std::int64_t{1} << (kOffsetBits - 1)) - 1};
    words_.planes.rows.fill(kNowhere);
    words_.planes.columns.fill(kNowhere);
    for (int r = 0; r < pencil_.rows; ++r) {
      const auto k = static_cast<std::size_t>(r);
      words_.planes.rows[k] = encode_line(pencil_.row_planes[k], index(r, 0), 1, pencil_.columns);
    }
    for (int c = 0; c < pencil_.columns; ++c) {
      const auto k = static_cast<std::size_t>(c);
      words_.planes.columns[k] =
          encode_line(pencil_.column_planes[k], index(0, c), kMaxColumns, pencil_.rows);
    }
    const double slack = std::ceil((error_ + vertex_error_ + kDoubleError) / kUnit);
    if (!(slack <= kMaxSlack)) {
      throw std::range_error(fmt::format("a pencil's slack is {} units, at most {} fit", slack, kMaxSlack));
    }
    words_.limits.slack = static_cast<std::uint32_t>(slack);
  }

  /// Near and depth plane. Where rounding spoils the axis (rays nearly across it), both are left out: n = 0,
  /// p = 0 calls nothing behind, and nothing deep.
  void encode_depths() {
    const FixedVec3 axis = lattice_normal(pencil_.axis);
    const glm::dvec3 normal = value_of(axis);
    double least = 1;
    double most = 1;
    for (int r = 0; r < pencil_.rows; ++r) {
      for (int c = 0; c < pencil_.columns; ++c) {
        const double along = glm::dot(normal, directions_[index(r, c)]);
        least = std::min(least, along);
        most = std::max(most, along);
      }
    }
    if (least < 0.5 || most > 2) {
      return;
    }
    const double slack = words_.limits.slack * kUnit;
    const double at_origin = glm::dot(normal, origin_);
    const double longest = kReach + glm::length(origin_);
    words_.planes.near = {axis, offset_of(vertex_error_ - at_origin - slack + kOffsetUnit + kDoubleError)};
    words_.planes.depth = {axis, offset_of(slack - at_origin - vertex_error_ - longest * (most - 1) -
                                           kOffsetUnit - kDoubleError)};
  }

  static std::int64_t offset_of(double offset) {
    const double units = std::round(offset / kOffsetUnit);
    if (!(std::abs(units) < std::ldexp(1.0, kOffsetBits - 1))) {
      throw std::range_error("a pencil's origin is too far from the scene");
    }
    return static_cast<std::int64_t>(units);
  }

  [[nodiscard]] std::uint32_t far_code() const {
    const double units = std::floor(pencil_.far / kOffsetUnit);
    if (!(units < std::ldexp(1.0, 39))) {
      return kNoBound;
    }
    return std::min(kNoBound, depth_code(static_cast<std::int64_t>(std::max(0.0, units))));
  }

  const Pencil& pencil_;
  double vertex_error_;
  glm::dvec3 origin_{0};                           ///< as stored
  std::array<glm::dvec3, kMaxRays> way_{};         ///< from the origin to a ray's last point
  std::array<glm::dvec3, kMaxRays> directions_{};  ///< as stored
  double error_ = 0;                               ///< farthest that a ray gets from one of its planes
  FixedPencilMemory<Fp24> words_;
  std::array<double, kMaxRays> t_scale_{};
};

}  // namespace

FixedPencil encode_fixed(const Pencil& pencil, double vertex_error) {
  return PencilEncoder(pencil, vertex_error).run();
}

Hit decode_fixed(const ResultWord<Fp24>& word, const FixedPencil& pencil, std::size_t ray) {
  Hit hit = decode(word);
  hit.t_scale = hit.hit ? pencil.t_scale[ray] : 1;
  return hit;
}

}  // namespace raplas
