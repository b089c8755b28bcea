#include "reference_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "scene_pencils.hpp"

namespace raplas {
namespace {

/// Spheres are taken this much larger, so that rounding in meets() loses none.
constexpr double kSlack = 1e-9;

/// Error of a triple product a.(b x c) in double, as a share of |a| |b| |c|: 7 roundings of 2^-53 at most, of
/// terms whose magnitudes sum up to at most sqrt(3) |a| |b| |c|, are below 13 * 2^-53.
constexpr double kTripleError = 0x1p-48;

/// A computed number and how far it may be off.
struct Bounded {
  double value;
  double error;

  [[nodiscard]] bool surely_positive() const { return value > error; }
  [[nodiscard]] bool surely_negative() const { return value < -error; }
};

bool meets(const SphereNode& node, const glm::dvec3& origin, const glm::dvec3& direction) {
  const glm::dvec3 to_centre = node.centre - origin;
  const double middle = glm::dot(to_centre, direction);
  const glm::dvec3 across = to_centre - middle * direction;
  const double radius = node.radius * (1 + kSlack) + kSlack;
  const double half2 = radius * radius - glm::dot(across, across);
  return half2 >= 0 && middle + std::sqrt(half2) >= 0;
}

}  // namespace

ReferencePair reference_pair(const Triangle& triangle, std::uint32_t id, const glm::dvec3& origin,
                             const glm::dvec3& direction) {
  const glm::dvec3 normal = glm::cross(triangle.e1, triangle.e2);
  const glm::dvec3 to_v0 = triangle.v0 - origin;
  const glm::dvec3 d_cross_t = glm::cross(direction, to_v0);
  const double n_dot_d = glm::dot(normal, direction);
  const double sign = n_dot_d < 0 ? -1 : 1;
  const double e1 = glm::length(triangle.e1);
  const double e2 = glm::length(triangle.e2);
  const double ray = glm::length(direction);
  const double away = glm::length(to_v0);

  const Bounded t{sign * glm::dot(normal, to_v0), kTripleError * e1 * e2 * away};
  const Bounded d{sign * n_dot_d, kTripleError * e1 * e2 * ray};
  const Bounded u{-sign * glm::dot(d_cross_t, triangle.e2), kTripleError * ray * away * e2};
  const Bounded v{sign * glm::dot(d_cross_t, triangle.e1), kTripleError * ray * away * e1};
  const Bounded w{d.value - u.value - v.value, d.error + u.error + v.error};
  const std::array<Bounded, 4> conditions{t, u, v, w};

  ReferencePair pair{id};
  if (!d.surely_positive()) {
    return pair;
  }
  if (std::any_of(conditions.begin(), conditions.end(),
                  [](const Bounded& x) { return x.surely_negative(); })) {
    pair.verdict = Verdict::miss;
  } else if (std::all_of(conditions.begin(), conditions.end(),
                         [](const Bounded& x) { return x.surely_positive(); })) {
    pair.verdict = Verdict::hit;
    pair.t = t.value / d.value;
    pair.t_error = (t.error + pair.t * d.error) / (d.value - d.error) + 0x1p-52 * pair.t;
  }
  return pair;
}

std::vector<std::uint32_t> candidates(const DeviceScene& scene, const glm::dvec3& origin,
                                      const glm::dvec3& direction) {
  struct Range {
    std::uint32_t first;
    std::uint32_t count;
  };
  std::vector<std::uint32_t> found;
  std::vector<Range> waiting{{scene.root_first, scene.root_count}};
  while (!waiting.empty()) {
    const Range range = waiting.back();
    waiting.pop_back();
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      const SphereNode& node = scene.nodes[k];
      if (!meets(node, origin, direction)) {
        continue;
      }
      if (!node.leaf) {
        waiting.push_back({node.first, node.count});
        continue;
      }
      for (std::uint32_t piece = node.first; piece < node.first + node.count; ++piece) {
        found.push_back(scene.piece(piece).triangle);
      }
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

SampledRay sampled_ray(const DeviceScene& scene, const glm::dvec3& origin, const glm::dvec3& direction) {
  SampledRay ray{direction, {}, 0};
  for (const std::uint32_t id : candidates(scene, origin, direction)) {
    const ReferencePair pair = reference_pair(scene.triangles[id], id, origin, direction);
    if (pair.verdict == Verdict::undecided) {
      ++ray.undecided;
    } else {
      ray.pairs.push_back(pair);
    }
  }
  return ray;
}

Sample make_sample(const DeviceScene& scene, const Camera& camera, int width, int height,
                   const ShowProgress& progress) {
  const std::vector<Pencil> pencils = camera_pencils(camera, width, height);
  Sample sample{scene.triangles, {}};
  sample.pencils.resize(pencils.size());
  const auto work = [&](std::size_t k) {
    const Pencil& pencil = pencils[k];
    SampledPencil& sampled = sample.pencils[k];
    sampled.origin = pencil.origin;
    sampled.rays.reserve(pencil.directions.size());
    for (const glm::dvec3& direction : pencil.directions) {
      sampled.rays.push_back(sampled_ray(scene, pencil.origin, direction));
    }
  };
  for_each_parallel(sample.pencils.size(), work, progress);
  return sample;
}

SampleCounts count(const Sample& sample) {
  SampleCounts counts;
  for (const SampledPencil& pencil : sample.pencils) {
    for (const SampledRay& ray : pencil.rays) {
      const auto hits = std::count_if(ray.pairs.begin(), ray.pairs.end(),
                                      [](const ReferencePair& p) { return p.verdict == Verdict::hit; });
      ++counts.rays;
      counts.rays_hit += hits > 0 ? 1U : 0U;
      counts.pairs += ray.pairs.size();
      counts.hits += static_cast<std::uint64_t>(hits);
      counts.undecided += ray.undecided;
    }
  }
  return counts;
}

const ReferencePair* nearest_hit(std::span<const ReferencePair> pairs) {
  const ReferencePair* best = nullptr;
  for (const ReferencePair& pair : pairs) {
    const bool nearer =
        best == nullptr || pair.t < best->t || (pair.t == best->t && pair.triangle < best->triangle);
    if (pair.verdict == Verdict::hit && nearer) {
      best = &pair;
    }
  }
  return best;
}

}  // namespace raplas
