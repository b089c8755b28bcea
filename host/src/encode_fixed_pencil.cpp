// A pencil's words in fixed point, with a slack that covers every rounding: docs/fixed_encoding.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "certified_band.hpp"
#include "raplas/encode.hpp"
#include "raplas/encode_fixed.hpp"
#include "raplas/scan_lines.hpp"

namespace raplas {
namespace {

constexpr double kUnit = 1.0 / (1 << kCoordinateFraction);
constexpr double kOffsetUnit = kUnit * kUnit;

/// Units of a place on the grid.
constexpr double kPerLine = 1 << kGridFraction;

/// Of vertices near the middle of the grid, in these units: what their places are rounded by.
constexpr double kPlaceError = 3;

/// A depth code's exponent: vertices nearer than that may be left without a place on the grid.
constexpr double kUsualDepth = kDepthBias - 3;

constexpr double kNone = std::numeric_limits<double>::infinity();

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
  PencilEncoder(const Pencil& pencil, double vertex_error, bool certify)
      : pencil_(pencil), vertex_error_(vertex_error), certify_(certify) {}

  FixedPencil run() {
    words_.pencil = {static_cast<std::uint32_t>(pencil_.rows), static_cast<std::uint32_t>(pencil_.columns),
                     encode<Fp24>(pencil_.origin, "pencil origin")};
    origin_ = certify_ ? pencil_.origin : decode(words_.pencil.origin);
    encode_rays();
    encode_lines();
    encode_depths();
    encode_front();
    encode_grid();
    words_.limits.any_hit = pencil_.any_hit;
    words_.limits.far = far_code();
    if (certify_) {
      encode_band();
    }
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
        const glm::dvec3 direction = certify_ ? unit / along : decode(words_.rays[ray]);
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
    words_.planes.near = {axis, near_offset(normal)};
    words_.planes.depth = {axis, offset_of(slack - at_origin - vertex_error_ - longest * (most - 1) -
                                           kOffsetUnit - kDoubleError)};
  }

  /// The near plane lies across `front` instead, if all rays as stored go along it.
  void encode_front() {
    const FixedVec3 front = lattice_normal(pencil_.front);
    const glm::dvec3 normal = value_of(front);
    for (int r = 0; r < pencil_.rows; ++r) {
      for (int c = 0; c < pencil_.columns; ++c) {
        const glm::dvec3& direction = directions_[index(r, c)];
        if (!(glm::dot(normal, direction) > kDoubleError * glm::length(direction))) {
          return;
        }
      }
    }
    words_.planes.near = {front, near_offset(normal)};
  }

  /// What is not near is behind the origin, whatever rounding has done to it.
  [[nodiscard]] std::int64_t near_offset(const glm::dvec3& normal) const {
    const double slack = words_.limits.slack * kUnit;
    return offset_of(vertex_error_ - glm::dot(normal, origin_) - slack + kOffsetUnit + kDoubleError);
  }

  /// Planes and register of the scan lines: docs/scan_lines.md. A pencil of one row or one column, or whose
  /// lines are too narrow for the vertices' words, goes without.
  void encode_grid() {
    if (pencil_.rows < 2 || pencil_.columns < 2 || words_.planes.depth.normal == FixedVec3{}) {
      return;
    }
    const glm::dvec3 first = ray_at(0, 0);
    const glm::dvec3 row_step = (ray_at(pencil_.rows - 1, 0) - first) / (pencil_.rows - 1.0);
    const glm::dvec3 column_step = (ray_at(0, pencil_.columns - 1) - first) / (pencil_.columns - 1.0);
    // of the ray (r, c), at a depth of 1: its row, or column, from the middle of the grid
    const auto place = [&](const glm::dvec3& step, const glm::dvec3& other) {
      const glm::dvec3 normal = glm::cross(other, first);
      return normal / glm::dot(normal, step) - double(kGridOrigin) * pencil_.axis;
    };
    const glm::dvec3 down = place(row_step, column_step);
    const glm::dvec3 across = place(column_step, row_step);
    const double longest = std::max(glm::length(down), glm::length(across)) * (1 + 0x1p-14);
    const int scale = std::max(0, std::ilogb(longest) + 1);
    if (!(longest < std::ldexp(1.0, kNoGrid - kGridScaleBias))) {  // so is none
      return;
    }
    words_.planes.down = grid_plane(down, scale);
    words_.planes.across = grid_plane(across, scale);
    words_.limits.scale = static_cast<std::uint32_t>(scale + kGridScaleBias);
    const PlaceError off = place_error(scale);
    for (std::uint32_t error = 0; error < 1U << kGridErrorBits; ++error) {
      const double allowed = (std::ldexp(4.0, static_cast<int>(error)) - kPlaceError) / kPerLine;
      const double depth = allowed > off.anywhere ? off.at_depth_1 / (allowed - off.anywhere) : kNone;
      const double least = std::max<double>(words_.limits.scale, std::ceil(std::log2(depth)) + kDepthBias);
      if (least < kNoGrid) {
        words_.limits.least = static_cast<std::uint32_t>(least);
        words_.limits.error = error;
        if (least <= kUsualDepth) {
          return;
        }
      }
    }
  }

  /// The ray's direction of depth 1, before it is rounded.
  [[nodiscard]] glm::dvec3 ray_at(int row, int column) const {
    const std::size_t ray = index(row, column);
    const auto unrounded = static_cast<std::size_t>(row) * static_cast<std::size_t>(pencil_.columns) +
                           static_cast<std::size_t>(column);
    return pencil_.directions[unrounded] * t_scale_[ray];
  }

  /// The testers add a vertex' reach, which is the slack, to the distance from this plane.
  [[nodiscard]] FixedPlane grid_plane(const glm::dvec3& place, int scale) const {
    FixedPlane plane;
    for (std::size_t k = 0; k < 3; ++k) {
      plane.normal[k] =
          static_cast<std::int32_t>(std::lrint(std::ldexp(place[static_cast<int>(k)], -scale) / kUnit));
    }
    const double slack = words_.limits.slack * kUnit;
    plane.offset = offset_of(-glm::dot(value_of(plane.normal), origin_) - slack);
    return plane;
  }

  /// In lines: what a place is off by is at most at_depth_1 / depth + anywhere.
  struct PlaceError {
    double at_depth_1;
    double anywhere;
  };

  /// How far a point that lies within vertex_error of a ray comes from this ray's place on the grid. The
  /// words' own rounding is in it, that of the unit isn't.
  [[nodiscard]] PlaceError place_error(int scale) const {
    const double slack = words_.limits.slack * kUnit;
    const auto start = [&](const FixedPlane& plane) {
      return glm::dot(value_of(plane.normal), origin_) + static_cast<double>(plane.offset) * kOffsetUnit;
    };
    const glm::dvec3 axis = value_of(words_.planes.depth.normal);
    const double depth_start = start(words_.planes.depth) - slack;
    PlaceError most{0, 0};
    const auto grow = [&](const FixedPlane& plane, const glm::dvec3& direction, int line) {
      // a ray's point of tested depth z: plane_start + (z - depth_start) slope, a place off by that less line
      // z
      const glm::dvec3 normal = std::ldexp(1.0, scale) * value_of(plane.normal);
      const double plane_start = std::ldexp(start(plane) + slack, scale);
      const double slope = glm::dot(normal, direction) / glm::dot(axis, direction);
      const double apart = std::abs(plane_start - depth_start * slope);
      const double ends = vertex_error_ * (glm::length(normal) + std::abs(slope));
      most.at_depth_1 = std::max(most.at_depth_1, apart + ends + kDoubleError);
      most.anywhere = std::max(most.anywhere, std::abs(slope - line) + kDoubleError);
    };
    for (int r = 0; r < pencil_.rows; ++r) {
      for (int c = 0; c < pencil_.columns; ++c) {
        grow(words_.planes.down, directions_[index(r, c)], r - kGridOrigin);
        grow(words_.planes.across, directions_[index(r, c)], c - kGridOrigin);
      }
    }
    return most;
  }

  /// Certified hits: the band, and far beyond what the quotient's code may be off by.
  void encode_band() {
    double longest = 0;
    for (int r = 0; r < pencil_.rows; ++r) {
      for (int c = 0; c < pencil_.columns; ++c) {
        longest = std::max(longest, glm::length(directions_[index(r, c)]));
      }
    }
    const double band = kRounding * longest * kBandError * kBandMargin;
    words_.limits.band = Fp24::from_double_up(band, "error band").bits();
    words_.limits.far = std::min(kNoBound, words_.limits.far + 1 + kDepthCodeError);
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
  bool certify_;
  glm::dvec3 origin_{0};                           ///< as stored, or to certify as it is
  std::array<glm::dvec3, kMaxRays> way_{};         ///< from the origin to a ray's last point
  std::array<glm::dvec3, kMaxRays> directions_{};  ///< likewise
  double error_ = 0;                               ///< farthest that a ray gets from one of its planes
  FixedPencilMemory<Fp24> words_;
  std::array<double, kMaxRays> t_scale_{};
};

}  // namespace

FixedPencil encode_fixed(const Pencil& pencil, double vertex_error, bool certify) {
  if (certify && !can_certify(pencil)) {
    throw std::invalid_argument("hits of this pencil cannot be certified");
  }
  return PencilEncoder(pencil, vertex_error, certify).run();
}

bool can_certify(const Pencil& pencil) {
  return glm::length(pencil.origin) <= kFarthestOrigin &&
         std::all_of(pencil.directions.begin(), pencil.directions.end(), [&pencil](const glm::dvec3& unit) {
           return glm::dot(pencil.axis, unit) * kLongestRay >= 1;
         });
}

Hit decode_fixed(const ResultWord<Fp24>& word, const FixedPencil& pencil, std::size_t ray) {
  Hit hit = decode(word);
  hit.t_scale = hit.hit ? pencil.t_scale[ray] : 1;
  return hit;
}

}  // namespace raplas
