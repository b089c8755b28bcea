#include "plane_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "raplas/encode.hpp"

namespace raplas {
namespace {

/// More than the errors of double precision in sums of a few terms below 4.
constexpr double kDoubleError = 0x1p-44;

/// A sphere and a plane met, by an arithmetic with its margin and without.
struct Answer {
  bool conservative;
  bool bare;
};

/// The lines of a pencil, rows first.
std::vector<Plane> lines_of(const Pencil& pencil) {
  std::vector<Plane> lines = pencil.row_planes;
  lines.insert(lines.end(), pencil.column_planes.begin(), pencil.column_planes.end());
  return lines;
}

bool meets(const Plane& plane, const SphereNode& node) {
  return std::abs(glm::dot(plane.normal, node.centre) + plane.offset) <= node.radius;
}

/// How far from zero a point of a sphere may be.
double reach_of(const DeviceScene& scene) {
  double reach = 0;
  for (const SphereNode& node : scene.nodes) {
    reach = std::max(reach, glm::length(node.centre) + node.radius);
  }
  return reach;
}

/// The planes of a pencil in fixed point, words of `width` bits with `width` - 1 of them fraction, offsets of
/// twice as many: entity dsp_plane_test, had it this width.
class FixedLines {
 public:
  FixedLines(int width, std::span<const Plane> lines, const glm::dvec3& origin, double reach)
      : fraction_(width - 1), unit_(std::ldexp(1.0, -fraction_)) {
    double error = 0;
    for (const Plane& plane : lines) {
      const Line line{lattice_normal(plane.normal), std::llrint(std::ldexp(plane.offset, 2 * fraction_))};
      // of a point x of the plane: normal.x + offset as stored is (normal - plane.normal).(x - origin) and
      // what it is at the origin
      const glm::dvec3 normal = value_of(line.normal);
      const double at_origin =
          glm::dot(normal, origin) + std::ldexp(static_cast<double>(line.offset), -2 * fraction_);
      const double away = reach + glm::length(origin);
      error = std::max(error, std::abs(at_origin) + glm::distance(normal, plane.normal) * away);
      lines_.push_back(line);
    }
    slack_ = std::llrint(std::ceil((error + kDoubleError) / unit_));
  }

  /// Answers for line `k`.
  [[nodiscard]] Answer test(std::size_t k, const SphereNode& node) const {
    const Lattice centre = nearest(node.centre, 1);
    const Line& line = lines_[k];
    std::int64_t sum = line.offset;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum += line.normal[axis] * centre[axis];
    }
    const std::int64_t distance = sum < 0 ? -sum : sum;
    const double radius = node.radius + glm::distance(node.centre, value_of(centre)) + kDoubleError;
    const std::int64_t up = std::llrint(std::ceil(radius / unit_)) + slack_;
    return {distance <= up << fraction_, distance <= std::llrint(node.radius / unit_) << fraction_};
  }

 private:
  using Lattice = std::array<std::int64_t, 3>;
  struct Line {
    Lattice normal;
    std::int64_t offset;
  };

  [[nodiscard]] glm::dvec3 value_of(const Lattice& v) const {
    return glm::dvec3(double(v[0]), double(v[1]), double(v[2])) * unit_;
  }

  [[nodiscard]] Lattice nearest(const glm::dvec3& v, double length) const {
    const auto units = [&](double x) { return std::llrint(x * length / unit_); };
    return {units(v.x), units(v.y), units(v.z)};
  }

  /// As docs/fixed_encoding.md has it: the nearest lattice vector, or that nearest to a vector shorter by a
  /// unit if the first one is longer than 1 or has a component of +1.
  [[nodiscard]] Lattice lattice_normal(const glm::dvec3& v) const {
    const std::int64_t one = std::int64_t{1} << fraction_;
    const Lattice normal = nearest(v, 1);
    const std::int64_t square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    const bool fits = square <= one * one && *std::max_element(normal.begin(), normal.end()) < one;
    return fits ? normal : nearest(v, 1 - unit_);
  }

  int fraction_;
  double unit_;
  std::vector<Line> lines_;
  std::int64_t slack_ = 0;
};

/// The planes of a pencil as profile paper has them: entity plane_sphere_tester.
template <typename F>
class FloatLines {
 public:
  FloatLines(std::span<const Plane> lines, double max_origin) : max_origin_(max_origin) {
    for (const Plane& plane : lines) {
      lines_.push_back(
          {encode<F>(plane.normal, "plane normal"), F::from_double(plane.offset, "plane offset")});
    }
  }

  [[nodiscard]] Answer test(std::size_t k, const SphereNode& node) const {
    const Vec3<F> centre = encode<F>(node.centre, "sphere centre");
    const double radius = conservative_radius(decode(centre), node.radius, max_origin_);
    return {plane_meets_sphere(lines_[k], centre, F::from_double_up(radius, "sphere radius")),
            plane_meets_sphere(lines_[k], centre, F::from_double(node.radius, "sphere radius"))};
  }

 private:
  std::vector<PlaneWord<F>> lines_;
  double max_origin_;
};

/// What a pencil's walk tests.
std::vector<const SphereNode*> walked(const DeviceScene& scene, const Pencil& pencil) {
  struct Range {
    std::uint32_t first;
    std::uint32_t count;
  };
  std::vector<const SphereNode*> tested;
  std::vector<Range> waiting{{scene.root_first, scene.root_count}};
  while (!waiting.empty()) {
    const Range range = waiting.back();
    waiting.pop_back();
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      const SphereNode& node = scene.nodes[k];
      const auto any = [&](const std::vector<Plane>& planes) {
        return std::any_of(planes.begin(), planes.end(), [&](const Plane& p) { return meets(p, node); });
      };
      tested.push_back(&node);
      if (!node.leaf && any(pencil.row_planes) && any(pencil.column_planes)) {
        waiting.push_back({node.first, node.count});
      }
    }
  }
  return tested;
}

void count(PlaneErrors& errors, bool expected, bool found) {
  errors.lost += expected && !found ? 1U : 0U;
  errors.false_meets += !expected && found ? 1U : 0U;
}

PlaneSweep sweep_pencil(const DeviceScene& scene, double reach, const Pencil& pencil) {
  const std::vector<Plane> lines = lines_of(pencil);
  const std::vector<const SphereNode*> spheres = walked(scene, pencil);
  PlaneSweep sweep;
  std::vector<bool> expected;
  for (const SphereNode* sphere : spheres) {
    for (const Plane& plane : lines) {
      expected.push_back(meets(plane, *sphere));
    }
  }
  sweep.tests = expected.size();
  sweep.meets = static_cast<std::uint64_t>(std::count(expected.begin(), expected.end(), true));
  const auto run = [&](std::string key, int dsp48, const auto& tester) {
    PlaneTester result{std::move(key), dsp48, {}, {}};
    std::size_t next = 0;
    for (const SphereNode* sphere : spheres) {
      for (std::size_t k = 0; k < lines.size(); ++k) {
        const Answer answer = tester.test(k, *sphere);
        count(result.conservative, expected[next], answer.conservative);
        count(result.bare, expected[next], answer.bare);
        ++next;
      }
    }
    sweep.testers.push_back(std::move(result));
  };
  constexpr int kFloatDsp48 = 12;
  run("fp24_paper", kFloatDsp48, FloatLines<Fp24Paper>(lines, scene.max_origin));
  run("fp24", kFloatDsp48, FloatLines<Fp24>(lines, scene.max_origin));
  for (int width = kLeastWidth; width <= kMostWidth; ++width) {
    run("w" + std::to_string(width), fixed_plane_dsp48(width),
        FixedLines(width, lines, pencil.origin, reach));
  }
  return sweep;
}

void add(PlaneErrors& sum, const PlaneErrors& errors) {
  sum.lost += errors.lost;
  sum.false_meets += errors.false_meets;
}

}  // namespace

int fixed_plane_dsp48(int width) {
  constexpr int kPart = 17;     // bits that a factor's lower parts have; the top part has a sign too
  constexpr int kSumBits = 48;  // of a DSP48's adder
  constexpr int kHeadroom = 6;  // sums need so many more bits than a product's fraction
  const int parts = (width - 1 + kPart - 1) / kPart;
  const int adders = 2 * (width - 1) + kHeadroom > kSumBits ? 2 : 1;
  return 3 * parts * parts + adders;
}

PlaneSweep sweep_planes(const DeviceScene& scene, std::span<const Pencil> pencils,
                        const ShowProgress& progress) {
  const double reach = reach_of(scene);
  std::vector<PlaneSweep> swept(pencils.size());
  for_each_parallel(
      pencils.size(), [&](std::size_t k) { swept[k] = sweep_pencil(scene, reach, pencils[k]); }, progress);
  PlaneSweep sum;
  for (const PlaneSweep& one : swept) {
    sum.tests += one.tests;
    sum.meets += one.meets;
    if (sum.testers.empty()) {
      sum.testers = one.testers;
      continue;
    }
    for (std::size_t k = 0; k < sum.testers.size(); ++k) {
      add(sum.testers[k].conservative, one.testers[k].conservative);
      add(sum.testers[k].bare, one.testers[k].bare);
    }
  }
  return sum;
}

}  // namespace raplas
