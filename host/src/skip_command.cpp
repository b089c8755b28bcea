// raplas skip: what each skip saves, for a scene's camera and shadow pencils.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "figure_file.hpp"
#include "heat_map.hpp"
#include "progress.hpp"
#include "raplas/output_file.hpp"
#include "scene_pencils.hpp"
#include "skip_measure.hpp"

namespace raplas {
namespace {

constexpr int kSide = kMaxRows;  // rays in a row of a pencil

/// So many spheres does the clocked model of profile paper test in some seconds.
constexpr std::uint64_t kPaperSpheres = 20'000'000;

/// A kind of pencils of the scene with all that was measured of it.
struct Measured {
  std::string kind;
  std::vector<Pencil> pencils;
  std::size_t in_row = 1;  ///< pencils in a row of the picture
  SkipCounts conventional;
  PaperRun paper;
  SkipSteps steps;
  StreamRun stream;
};

void measure(const Prepared& prepared, const SkipCommand& command, Measured& m) {
  const DeviceScene& scene = prepared.tree.scene;
  const bool quiet = command.settings.quiet;
  const auto show = [](Progress& progress) { return [&progress](double share) { progress.show(share); }; };
  {
    Progress progress(m.kind + ", clocked model", quiet);
    m.stream = run_stream(scene, m.pencils, show(progress));
  }
  const std::size_t wanted =
      command.sample == 0 ? m.pencils.size() : static_cast<std::size_t>(command.sample);
  const std::vector<std::size_t> sample = every_kth(m.pencils.size(), wanted, m.in_row);
  std::vector<Pencil> pencils;
  std::vector<std::vector<Hit>> hits;
  for (const std::size_t k : sample) {
    pencils.push_back(m.pencils[k]);
    hits.push_back(m.stream.hits[k]);
  }
  {
    Progress progress(m.kind + ", conventional", quiet);
    m.conventional = run_conventional(scene, pencils, show(progress));
  }
  {
    Progress progress(m.kind + ", walks", quiet);
    m.steps = run_steps(scene, pencils, hits, show(progress));
  }
  Progress progress(m.kind + ", paper", quiet);
  m.paper = run_paper(scene, m.pencils, m.in_row, kPaperSpheres, show(progress));
}

void print_line(const std::string& title, const SkipCounts& counts, const BusyClocks* busy) {
  fmt::print("{:<22}{:>10}{:>10}{:>12.3f}{:>12.3f}{:>14.3f}", title, counts.pencils, counts.rays,
             per(counts.spheres, counts.rays), per(counts.vertices, counts.rays),
             per(counts.pairs, counts.rays));
  if (busy != nullptr) {
    fmt::print("{:>12.3f}{:>12.4f}{:>8.1f}{:>9.1f}{:>7.1f}", per(busy->clocks, counts.rays),
               per(counts.rays, busy->clocks), 100 * per(busy->either, busy->clocks),
               100 * per(busy->objects, busy->clocks), 100 * per(busy->pairs, busy->clocks));
  }
  fmt::print("\n");
}

void print_table(const std::string& name, const Measured& m, std::size_t triangles) {
  fmt::print("{}, {}: {} pencils; tests and clocks for each ray; busy: % of clocks\n", name, m.kind,
             m.pencils.size());
  fmt::print("{:<22}{:>10}{:>10}{:>12}{:>12}{:>14}{:>12}{:>12}{:>8}{:>9}{:>7}\n", "", "pencils", "rays",
             "spheres", "vertices", "pairs", "clocks", "rays/clock", "busy", "testers", "pairs");
  const SkipCounts& all = m.stream.counts;
  print_line("brute force", {all.pencils, all.rays, 0, 0, all.rays * triangles}, nullptr);
  print_line("conventional", m.conventional, nullptr);
  print_line("paper, 4x4, clocked", m.paper.counts, &m.paper.busy);
  for (const SkipStep& step : m.steps.steps) {
    print_line(step.title, step.counts, nullptr);
  }
  print_line("clocked unit", all, &m.stream.busy);
  fmt::print(
      "results compared: {}, different: {}; clocks of the stream with the host's words: {}; pencils not "
      "sent: {}\n\n",
      m.steps.rays_compared, m.steps.rays_different, m.stream.stream_clocks, m.stream.not_sent);
  std::fflush(stdout);
}

void add_counts(FigureFile& figures, const std::string& name, const SkipCounts& counts) {
  figures.add(name + ".sphere_tests_per_ray", per(counts.spheres, counts.rays), "tests/ray");
  figures.add(name + ".vertex_tests_per_ray", per(counts.vertices, counts.rays), "tests/ray");
  figures.add(name + ".pairs_per_ray", per(counts.pairs, counts.rays), "pairs/ray");
}

void add_clocks(FigureFile& figures, const std::string& name, const SkipCounts& counts,
                const BusyClocks& busy) {
  figures.add(name + ".rays_per_clock", per(counts.rays, busy.clocks), "rays/clock");
  figures.add(name + ".busy_percent", 100 * per(busy.either, busy.clocks), "% of clocks");
  figures.add(name + ".testers_busy_percent", 100 * per(busy.objects, busy.clocks), "% of clocks");
  figures.add(name + ".pairs_busy_percent", 100 * per(busy.pairs, busy.clocks), "% of clocks");
}

void add_figures(FigureFile& figures, const std::string& scene, const Measured& m, std::size_t triangles) {
  const std::string tail = "." + scene + "." + m.kind;
  add_counts(figures, "skip" + tail, m.stream.counts);
  add_clocks(figures, "skip" + tail, m.stream.counts, m.stream.busy);
  add_counts(figures, "skip_paper" + tail, m.paper.counts);
  add_clocks(figures, "skip_paper" + tail, m.paper.counts, m.paper.busy);
  const std::string step = "skip_step" + tail;
  add_counts(figures, step + ".brute", {1, 1, 0, 0, triangles});
  add_counts(figures, step + ".conventional", m.conventional);
  add_counts(figures, step + ".paper", m.paper.counts);
  figures.add(step + ".paper.clocks_per_ray", per(m.paper.busy.clocks, m.paper.counts.rays), "clocks/ray");
  for (const SkipStep& s : m.steps.steps) {
    add_counts(figures, step + "." + s.key, s.counts);
  }
  add_counts(figures, step + ".clocked", m.stream.counts);
  figures.add(step + ".clocked.clocks_per_ray", per(m.stream.busy.clocks, m.stream.counts.rays),
              "clocks/ray");
  figures.add("skip" + tail + ".pencils", m.stream.counts.pencils, "pencils");
  figures.add("skip" + tail + ".walked", m.steps.steps.front().counts.pencils, "pencils");
  figures.add("skip" + tail + ".not_sent_percent", 100 * per(m.stream.not_sent, m.stream.counts.pencils),
              "% of pencils");
  figures.add("skip" + tail + ".compared", m.steps.rays_compared, "results");
  figures.add("skip" + tail + ".different", m.steps.rays_different, "results");
}

/// The files of the heat maps, opened before the work that fills them.
struct HeatMaps {
  OutputFile objects;
  OutputFile pairs;
  OutputFile cycles;

  explicit HeatMaps(const std::filesystem::path& folder)
      : objects(folder / "objects.png"), pairs(folder / "pairs.png"), cycles(folder / "cycles.png") {}

  void write(const Measured& camera) {
    const auto one = [&](OutputFile& file, auto number) {
      HeatMap map;
      map.columns = static_cast<int>(camera.in_row);
      for (const PencilCost& cost : camera.stream.costs) {
        map.values.push_back(number(cost));
      }
      write_png(draw(map), file);
    };
    one(objects, [](const PencilCost& c) { return c.spheres + c.vertices; });
    one(pairs, [](const PencilCost& c) { return c.pairs; });
    one(cycles, [](const PencilCost& c) { return c.clocks; });
  }
  void commit() {
    objects.commit();
    pairs.commit();
    cycles.commit();
  }
};

/// Camera and shadow pencils in turn, half of them each, spread over the picture.
std::vector<Pencil> mixed_pencils(const Measured& camera, const Measured& shadow, std::size_t count) {
  const auto a = every_kth(camera.pencils.size(), (count + 1) / 2, camera.in_row);
  const auto b = every_kth(shadow.pencils.size(), (count + 1) / 2, shadow.in_row);
  std::vector<Pencil> mixed;
  for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
    if (k < a.size()) {
      mixed.push_back(camera.pencils[a[k]]);
    }
    if (k < b.size()) {
      mixed.push_back(shadow.pencils[b[k]]);
    }
  }
  return mixed;
}

/// The same stream on model and RTL. Returns the number of differences: rays and counters, cycles among them.
std::uint64_t compare_rtl(const Prepared& prepared, const SkipCommand& command,
                          const std::vector<Pencil>& pencils, FigureFile& figures) {
  struct Run {
    std::vector<std::vector<Hit>> hits;
    Counters counters;
    std::uint64_t clocks;
  };
  const auto run = [&](const char* name) {
    const auto device = make_device(name, command.settings.device);
    device->load(prepared.tree.scene);
    Run result{device->trace(pencils), {}, 0};
    result.counters = device->counters();
    result.clocks = device->simulated_clocks();
    return result;
  };
  const Run model = run("model");
  const Run rtl = run("rtl");
  std::uint64_t differences = model.clocks == rtl.clocks ? 0U : 1U;
  std::uint64_t rays = 0;
  for (std::size_t k = 0; k < pencils.size(); ++k) {
    for (std::size_t ray = 0; ray < pencils[k].directions.size(); ++ray) {
      ++rays;
      differences += model.hits[k][ray] == rtl.hits[k][ray] ? 0U : 1U;
    }
  }
  for (std::size_t k = 0; k < model.counters.size(); ++k) {
    differences += model.counters[k] == rtl.counters[k] ? 0U : 1U;
  }
  fmt::print("model against rtl: {} pencils, {} rays, {} clocks, {} differences\n", pencils.size(), rays,
             rtl.clocks, differences);
  figures.add("skip.rtl.pencils_checked", pencils.size(), "pencils");
  figures.add("skip.rtl.rays_checked", rays, "rays");
  figures.add("skip.rtl.clocks_checked", rtl.clocks, "clocks");
  figures.add("skip.rtl.differences", differences, "rays, counters and clocks");
  return differences;
}

}  // namespace

int run(const SkipCommand& command) {
#ifndef RAPLAS_WITH_RTL
  if (command.rtl > 0) {
    throw std::runtime_error("--rtl: this build has no Verilator model");
  }
#endif
  const Settings& settings = command.settings;
  std::error_code error;
  std::filesystem::create_directories(command.folder, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: cannot be made a folder ({})", command.folder.string(), error.message()));
  }
  HeatMaps maps(command.folder);
  FigureFile figures(settings.json, command.command_line);
  const Prepared prepared = prepare(settings);
  const std::size_t triangles = prepared.tree.scene.triangles.size();
  const std::string name = command.name.empty() ? settings.scene.stem().string() : command.name;
  fmt::print("{}: {} triangles, {} spheres, {}x{} pixels\n\n", name, triangles,
             prepared.tree.scene.nodes.size(), settings.render.width, settings.render.height);

  Measured camera;
  camera.kind = "camera";
  camera.pencils = camera_pencils(prepared.scene.camera, settings.render.width, settings.render.height);
  camera.in_row = static_cast<std::size_t>((settings.render.width + kSide - 1) / kSide);
  measure(prepared, command, camera);
  print_table(name, camera, triangles);
  Measured shadow;
  shadow.kind = "shadow";
  shadow.pencils = shadow_pencils(
      prepared.scene, seen_pixels(prepared.scene, prepared.tree.source, settings.render.width,
                                  settings.render.height, command.tile, camera.pencils, camera.stream.hits));
  shadow.in_row = static_cast<std::size_t>((settings.render.width + command.tile - 1) / command.tile);
  if (!shadow.pencils.empty()) {
    measure(prepared, command, shadow);
    print_table(name, shadow, triangles);
  }

  figures.add("skip." + name + ".triangles", triangles, "triangles");
  std::uint64_t different = 0;
  for (const Measured* m : {&camera, &shadow}) {
    if (!m->pencils.empty()) {
      add_figures(figures, name, *m, triangles);
      different += m->steps.rays_different;
    }
  }
  if (command.rtl > 0) {
    different += compare_rtl(prepared, command,
                             mixed_pencils(camera, shadow, static_cast<std::size_t>(command.rtl)), figures);
  }
  maps.write(camera);
  maps.commit();
  figures.commit();
  return different == 0 ? 0 : 1;
}

}  // namespace raplas
