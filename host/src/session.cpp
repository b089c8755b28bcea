#include "session.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "progress.hpp"

namespace raplas {
namespace {

void check_capacity(const Settings& settings, std::size_t count, const char* what, const char* memory,
                    std::size_t depth) {
  if (count > depth) {
    throw std::runtime_error(fmt::format("{}: {} {}, the {} Memory holds {}", settings.scene.string(), count,
                                         what, memory, depth));
  }
}

}  // namespace

Prepared prepare(const Settings& settings) {
  Prepared prepared{load_scene(settings.scene), {}};
  const Scene& scene = prepared.scene;
  if (scene.degenerate_dropped > 0) {
    fmt::print(stderr, "raplas: note: {}: {} degenerate triangles dropped\n", settings.scene.string(),
               scene.degenerate_dropped);
  }
  check_capacity(settings, scene.triangles.size(), "triangles", "Triangle", settings.device.triangle_depth);
  try {
    prepared.tree = settings.flat ? build_flat(scene.triangles, settings.tree)
                                  : build_tree(scene.triangles, settings.tree);
    check_tree(prepared.tree.scene);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", settings.scene.string(), error.what()));
  }
  prepared.tree.scene.max_origin = scene.max_origin;
  check_capacity(settings, prepared.tree.scene.nodes.size(), "spheres", "Sphere",
                 settings.device.sphere_depth);
  return prepared;
}

DeviceRun run_device(const Prepared& prepared, const Settings& settings, const std::string& name,
                     const std::function<void(std::span<const Hit>)>& hits) {
  const auto start = std::chrono::steady_clock::now();
  const auto device = make_device(name, settings.device);
  device->load(prepared.tree.scene);
  Progress progress(name, settings.quiet);
  RenderHooks hooks;
  hooks.hits = hits;
  hooks.progress = [&progress](double share) { progress.show(share); };
  DeviceRun run;
  run.rendering = render(prepared.scene, prepared.tree.source, *device, settings.render, hooks);
  run.counters = device->counters();
  run.retests = device->retests();
  run.simulated_clocks = device->simulated_clocks();
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace raplas
