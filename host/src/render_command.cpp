// raplas render: one device, one picture.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "hit_records.hpp"
#include "raplas/output_file.hpp"

namespace raplas {
namespace {

nlohmann::ordered_json figures(const RenderCommand& command, const Prepared& prepared, const DeviceRun& run) {
  const RenderStats& stats = run.rendering.stats;
  nlohmann::ordered_json counters;
  for (std::size_t k = 0; k < run.counters.size(); ++k) {
    counters[std::string(kCounterNames[k])] = run.counters[k];
  }
  nlohmann::ordered_json json;
  json["device"] = command.device;
  json["profile"] = command.settings.profile;
  json["scene"] = command.settings.scene.string();
  json["width"] = command.settings.render.width;
  json["height"] = command.settings.render.height;
  json["triangles"] = prepared.tree.scene.triangles.size();
  json["spheres"] = prepared.tree.scene.nodes.size();
  json["degenerate_dropped"] = prepared.scene.degenerate_dropped;
  json["rays"] = {{"camera", stats.camera_rays}, {"shadow", stats.shadow_rays}};
  json["pencils"] = stats.pencils;
  json["counters"] = counters;
  if (run.cycles() > 0) {
    json["rays_per_cycle"] = static_cast<double>(run.rays()) / static_cast<double>(run.cycles());
  } else {
    json["rays_per_cycle"] = nullptr;
  }
  if (command.settings.device.exact) {
    const Retests& retests = run.retests;
    json["retests"] = {{"rays", retests.rays},
                       {"hits", retests.hits},
                       {"rivals", retests.rivals},
                       {"traced", retests.traced},
                       {"seconds", retests.seconds}};
  }
  json["trace_seconds"] = stats.trace_seconds;
  json["seconds"] = run.seconds;
  return json;
}

/// Opens a file unless its name is empty.
void open(std::optional<OutputFile>& file, const std::filesystem::path& name) {
  if (!name.empty()) {
    file.emplace(name);
  }
}

}  // namespace

int run(const RenderCommand& command) {
  const Settings& settings = command.settings;
  // Unwritable outputs are found before anything is rendered.
  OutputFile picture(command.picture);
  std::optional<OutputFile> json;
  std::optional<OutputFile> hits;
  open(json, settings.json);
  open(hits, command.hits);
  std::function<void(std::span<const Hit>)> hit_sink;
  if (hits) {
    hits->write(kHitFileHeader);
    hit_sink = [&hits](std::span<const Hit> records) { hits->write(dump(records)); };
  }
  const Prepared prepared = prepare(settings);
  const DeviceRun result = run_device(prepared, settings, command.device, hit_sink);
  write_png(result.rendering.image, picture);
  if (json) {
    json->write(figures(command, prepared, result).dump(2) + "\n");
    json->commit();
  }
  if (hits) {
    hits->commit();
  }
  picture.commit();
  if (!settings.quiet) {
    fmt::print("{}: {} triangles, {} spheres, {} rays in {} pencils, {:.2f} s\n", command.picture.string(),
               prepared.tree.scene.triangles.size(), prepared.tree.scene.nodes.size(), result.rays(),
               result.rendering.stats.pencils, result.seconds);
  }
  return 0;
}

}  // namespace raplas
