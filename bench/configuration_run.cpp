#include "configuration_run.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "parallel.hpp"
#include "progress.hpp"
#include "scene_options.hpp"
#include "skip_measure.hpp"

namespace raplas {
namespace {

/// Spheres that the clocked models test for a scene's clocks, about, and the most pencils.
constexpr std::uint64_t kClockedSpheres = 8'000'000;
constexpr std::size_t kClockedPencils = 1024;

/// Rays of a kind that software is timed with, about.
constexpr std::size_t kTimedRays = 50'000;

Prepared prepare(const std::string& file, Structure structure) {
  Settings settings;
  settings.scene = file;
  settings.flat = structure == Structure::flat;
  if (structure != Structure::tree) {
    settings.tree.longest_edge = kWholeTriangles;
  }
  return raplas::prepare(settings);
}

std::size_t rays_of(std::span<const Pencil> pencils) {
  std::size_t rays = 0;
  for (const Pencil& pencil : pencils) {
    rays += pencil.directions.size();
  }
  return rays;
}

/// About `wanted` of the pencils, spread over all.
std::vector<Pencil> sampled(std::span<const Pencil> pencils, std::size_t wanted) {
  constexpr std::size_t kRow = 30030;  // so that no step has a factor of up to 13 in common with a row
  std::vector<Pencil> sample;
  for (const std::size_t k : every_kth(pencils.size(), wanted, kRow)) {
    sample.push_back(pencils[k]);
  }
  return sample;
}

std::uint64_t cycles(const IntersectionDevice& device) {
  return device.counters()[static_cast<std::size_t>(Counter::cycles)];
}

/// Errors, clocks and the picture of one configuration.
Measured measure(const Configuration& configuration, const SceneRuns& scene, const RunOptions& options) {
  const Prepared& prepared = scene.prepared.at(configuration.structure);
  const Prepared& reference = scene.prepared.at(Structure::tree);
  const Recorded& recorded = scene.recorded.at(configuration.pencil);
  const auto device = configuration.make();
  device->load(prepared.tree.scene);
  Measured m;
  const auto trace = [&](const std::vector<Pencil>& pencils, const std::vector<std::vector<Hit>>& expected,
                         RayErrors& errors, RayClocks& clocks) {
    const std::uint64_t before = cycles(*device);
    auto hits = device->trace(pencils);
    clocks = {rays_of(pencils), cycles(*device) - before};
    to_scene_triangles(prepared.tree.source, hits);
    errors = compare_rays(reference, pencils, expected, hits);
    if (configuration.clocks) {
      const std::size_t spheres = prepared.tree.scene.root_count;
      clocks = configuration.clocks(
          prepared.tree.scene,
          sampled(pencils, std::clamp<std::size_t>(kClockedSpheres / spheres, 1, kClockedPencils)));
    }
  };
  trace(recorded.camera, recorded.camera_hits, m.camera, m.camera_clocks);
  trace(recorded.shadow, recorded.shadow_hits, m.shadow, m.shadow_clocks);
  const RenderOptions render_options{options.width, options.height, configuration.pencil, options.shadow};
  m.image = render(prepared.scene, prepared.tree.source, *device, render_options, {}).image;
  m.picture = compare_pictures(to_8_bit(recorded.picture), to_8_bit(m.image));
  return m;
}

/// Software side by side: each repetition runs all of them, one after the other, on one thread.
void time_software(const std::vector<Configuration>& list, SceneRuns& scene, const RunOptions& options) {
  struct Timed {
    std::size_t configuration;
    std::unique_ptr<IntersectionDevice> device;
    std::vector<double> camera;
    std::vector<double> shadow;
  };
  std::vector<Timed> all;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (list[k].netlist.empty()) {
      all.push_back({k, list[k].make(), {}, {}});
      all.back().device->load(scene.prepared.at(list[k].structure).tree.scene);
    }
  }
  const Recorded& recorded = scene.recorded.at(kMaxRows);
  const auto part = [](const std::vector<Pencil>& pencils) {
    const std::size_t rays = std::max<std::size_t>(1, rays_of(pencils));
    return sampled(pencils, std::max<std::size_t>(1, kTimedRays * pencils.size() / rays));
  };
  const std::vector<Pencil> camera = part(recorded.camera);
  const std::vector<Pencil> shadow = part(recorded.shadow);
  const auto seconds_a_ray = [](IntersectionDevice& device, const std::vector<Pencil>& pencils) {
    const auto start = std::chrono::steady_clock::now();
    const auto hits = device.trace(pencils);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return seconds.count() / static_cast<double>(std::max<std::size_t>(1, rays_of(pencils)));
  };
  Progress progress(scene.name + ", time of software", options.quiet);
  for (int k = 0; k < options.repetitions; ++k) {
    for (Timed& timed : all) {
      timed.camera.push_back(seconds_a_ray(*timed.device, camera));
      timed.shadow.push_back(seconds_a_ray(*timed.device, shadow));
    }
    progress.show((k + 1.0) / options.repetitions);
  }
  for (Timed& timed : all) {
    if (const auto camera_times = quantiles(std::move(timed.camera))) {
      scene.measured[timed.configuration].camera_seconds = camera_times->median;
      scene.measured[timed.configuration].shadow_seconds = quantiles(std::move(timed.shadow))->median;
    }
  }
}

}  // namespace

SceneRuns run_scene(const std::string& file, const std::vector<Configuration>& list,
                    const RunOptions& options) {
  SceneRuns scene;
  scene.name = scene_name(file);
  scene.prepared.emplace(Structure::tree, prepare(file, Structure::tree));
  for (const Configuration& c : list) {
    if (!scene.prepared.contains(c.structure)) {
      scene.prepared.emplace(c.structure, prepare(file, c.structure));
    }
    if (!scene.recorded.contains(c.pencil)) {
      const RenderOptions render_options{options.width, options.height, c.pencil, options.shadow};
      scene.recorded.emplace(c.pencil, record(scene.prepared.at(Structure::tree), render_options));
    }
  }
  scene.measured.resize(list.size());
  {
    Progress progress(scene.name, options.quiet);
    const auto work = [&](std::size_t k) { scene.measured[k] = measure(list[k], scene, options); };
    for_each_parallel(list.size(), work, [&](double share) { progress.show(share); });
  }
  if (options.repetitions > 0) {
    time_software(list, scene, options);
  }
  return scene;
}

}  // namespace raplas
