// What tracing a pencil costs, and how much of it each skip saves: docs/skipping.md has the definitions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "parallel.hpp"
#include "raplas/device.hpp"

namespace raplas {

/// Tests, and what they served.
struct SkipCounts {
  std::uint64_t pencils = 0;
  std::uint64_t rays = 0;
  std::uint64_t spheres = 0;   ///< tests of a sphere: by a ray (conventional), or by a pencil
  std::uint64_t vertices = 0;  ///< tests of a vertex by a pencil
  std::uint64_t pairs = 0;     ///< tests of a ray against a triangle
};

/// Clocks of a unit in which a pencil was under way.
struct BusyClocks {
  std::uint64_t clocks = 0;
  std::uint64_t objects = 0;  ///< ... and the plane testers took a sphere or a vertex
  std::uint64_t pairs = 0;    ///< ... and the ray-triangle unit took a pair
  std::uint64_t either = 0;   ///< ... and one of the two did
};

/// Every k-th of `count` things, about `wanted` of them; k has no factor in common with `row`, so that of a
/// picture with so many things in a row not only some columns are taken. All, if `wanted` is not less.
[[nodiscard]] std::vector<std::size_t> every_kth(std::size_t count, std::size_t wanted, std::size_t row);

/// Each ray by itself through the spheres, with all that one ray can skip: the tests of device `reference`.
[[nodiscard]] SkipCounts run_conventional(const DeviceScene& scene, std::span<const Pencil> pencils,
                                          const ShowProgress& progress);

/// What the paper's unit does with pencils of 4x4.
struct PaperRun {
  SkipCounts counts;
  BusyClocks busy;
};

/// The clocked model of profile paper with a flat list of the tree's leaves. Of each of some pencils (all, or
/// every_kth() of them so that about `max_spheres` spheres are tested; `row` of them are in a row of the
/// picture) one pencil of 4x4 of its rays is traced.
[[nodiscard]] PaperRun run_paper(const DeviceScene& scene, std::span<const Pencil> pencils, std::size_t row,
                                 std::uint64_t max_spheres, const ShowProgress& progress);

/// A walk with some skips switched on.
struct SkipStep {
  std::string key;    ///< of its figures
  std::string title;  ///< of its line in the table
  SkipCounts counts;
};

struct SkipSteps {
  std::vector<SkipStep> steps;
  std::uint64_t rays_compared = 0;   ///< of a step, or of `expected`, with the first step
  std::uint64_t rays_different = 0;  ///< in a bit of the result word; of any-hit pencils in the hit bit
};

/// Walks each pencil with one skip more each time, on all of the machine's threads, and compares the results
/// of each walk, and `expected`, with those of the first walk, which skips nothing.
[[nodiscard]] SkipSteps run_steps(const DeviceScene& scene, std::span<const Pencil> pencils,
                                  std::span<const std::vector<Hit>> expected, const ShowProgress& progress);

/// What one pencil took in a stream: nothing if it wasn't sent.
struct PencilCost {
  std::uint64_t spheres = 0;
  std::uint64_t vertices = 0;
  std::uint64_t pairs = 0;
  std::uint64_t clocks = 0;  ///< from the end of the pencil before to its own end
};

struct StreamRun {
  SkipCounts counts;
  BusyClocks busy;
  std::uint64_t stream_clocks = 0;  ///< with those of the host's writing and reading
  std::uint64_t not_sent = 0;       ///< pencils that the host found to miss all spheres of the root range
  std::vector<PencilCost> costs;    ///< by pencil
  std::vector<std::vector<Hit>> hits;
};

/// All pencils as one stream through the clocked model of profile raplas.
[[nodiscard]] StreamRun run_stream(const DeviceScene& scene, std::span<const Pencil> pencils,
                                   const ShowProgress& progress);

}  // namespace raplas
