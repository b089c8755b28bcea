// configurations: the same pictures by whole configurations, and what each gets wrong and takes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "configuration.hpp"
#include "heat_map.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "raplas/output_file.hpp"
#include "ray_errors.hpp"
#include "recorded.hpp"
#include "scene_names.hpp"
#include "skip_measure.hpp"

namespace raplas {
namespace {

/// Spheres that the clocked models test for a scene's clocks, about, and the most pencils.
constexpr std::uint64_t kClockedSpheres = 8'000'000;
constexpr std::size_t kClockedPencils = 1024;

/// Rays of a kind that software is timed with, about.
constexpr std::size_t kTimedRays = 50'000;

struct CommandLine {
  std::vector<std::string> scenes;
  std::vector<std::string> only;  ///< names of configurations; empty: all
  int width = 256;
  int height = 256;
  int shadow = 4;
  int repetitions = 7;   ///< of what is timed; 0: nothing is
  std::string pictures;  ///< folder; empty: none
  std::string json;      ///< empty: none
  bool quiet = false;
};

/// What a configuration gets wrong and takes, on a scene.
struct Measured {
  RayErrors camera;
  RayErrors shadow;
  PictureErrors picture;
  RayClocks camera_clocks;
  RayClocks shadow_clocks;
  std::optional<double> camera_seconds;  ///< a ray, of software
  std::optional<double> shadow_seconds;
  Image image = {};
};

/// A scene prepared for each structure, with its pencils for each size of camera pencils.
struct SceneRuns {
  std::string name;
  std::map<Structure, Prepared> prepared;
  std::map<int, Recorded> recorded;
  std::vector<Measured> measured;  ///< by configuration
};

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
Measured measure(const Configuration& configuration, const SceneRuns& scene, const CommandLine& line) {
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
  const RenderOptions options{line.width, line.height, configuration.pencil, line.shadow};
  m.image = render(prepared.scene, prepared.tree.source, *device, options, {}).image;
  m.picture = compare_pictures(to_8_bit(recorded.picture), to_8_bit(m.image));
  return m;
}

/// Software side by side: each repetition runs all of them, one after the other, on one thread.
void time_software(const std::vector<Configuration>& list, SceneRuns& scene, const CommandLine& line) {
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
  Progress progress(scene.name + ", time of software", line.quiet);
  for (int k = 0; k < line.repetitions; ++k) {
    for (Timed& timed : all) {
      timed.camera.push_back(seconds_a_ray(*timed.device, camera));
      timed.shadow.push_back(seconds_a_ray(*timed.device, shadow));
    }
    progress.show((k + 1.0) / line.repetitions);
  }
  for (Timed& timed : all) {
    if (const auto camera_times = quantiles(std::move(timed.camera))) {
      scene.measured[timed.configuration].camera_seconds = camera_times->median;
      scene.measured[timed.configuration].shadow_seconds = quantiles(std::move(timed.shadow))->median;
    }
  }
}

SceneRuns run_scene(const std::string& file, const std::vector<Configuration>& list,
                    const CommandLine& line) {
  SceneRuns scene;
  scene.name = std::filesystem::path(file).stem().string();
  scene.prepared.emplace(Structure::tree, prepare(file, Structure::tree));
  for (const Configuration& c : list) {
    if (!scene.prepared.contains(c.structure)) {
      scene.prepared.emplace(c.structure, prepare(file, c.structure));
    }
    if (!scene.recorded.contains(c.pencil)) {
      const RenderOptions options{line.width, line.height, c.pencil, line.shadow};
      scene.recorded.emplace(c.pencil, record(scene.prepared.at(Structure::tree), options));
    }
  }
  scene.measured.resize(list.size());
  {
    Progress progress(scene.name, line.quiet);
    const auto work = [&](std::size_t k) { scene.measured[k] = measure(list[k], scene, line); };
    for_each_parallel(list.size(), work, [&](double share) { progress.show(share); });
  }
  if (line.repetitions > 0) {
    time_software(list, scene, line);
  }
  return scene;
}

/// A measured number.
struct Value {
  const char* name;
  const char* unit;
  const char* heading;
  std::optional<double> number;  ///< nothing: there is none
};

double percent(std::uint64_t count, std::uint64_t of) {
  return of == 0 ? 0 : 100 * static_cast<double>(count) / static_cast<double>(of);
}

std::vector<Value> error_values(const Measured& m) {
  const RayErrors& c = m.camera;
  const RayErrors& s = m.shadow;
  const auto quantile = [](const std::optional<Quantiles>& q, double Quantiles::*which) {
    return q ? std::optional(*q.*which) : std::nullopt;
  };
  return {
      {"misclassified_percent", "% of rays", "wrong, %",
       percent(c.wrong() + s.wrong(), c.decided() + s.decided())},
      {"camera_missed_percent", "% of camera rays", "c: missed", percent(c.missed, c.decided())},
      {"camera_false_percent", "% of camera rays", "c: false", percent(c.false_hits, c.decided())},
      {"camera_other_percent", "% of camera rays", "c: other", percent(c.other, c.decided())},
      {"shadow_missed_percent", "% of shadow rays", "s: missed", percent(s.missed, s.decided())},
      {"shadow_false_percent", "% of shadow rays", "s: false", percent(s.false_hits, s.decided())},
      {"undecided", "rays", "undecided", static_cast<double>(c.undecided + s.undecided)},
      {"t_relative_median", "relative", "t: median", quantile(c.t_relative, &Quantiles::median)},
      {"t_relative_99", "relative", "99 %", quantile(c.t_relative, &Quantiles::percent_99)},
      {"t_relative_largest", "relative", "largest", quantile(c.t_relative, &Quantiles::largest)},
      {"t_ulp_median", "ulp of fp24", "ulp: med.", quantile(c.t_ulp, &Quantiles::median)},
      {"t_ulp_99", "ulp of fp24", "99 %", quantile(c.t_ulp, &Quantiles::percent_99)},
      {"t_ulp_largest", "ulp of fp24", "largest", quantile(c.t_ulp, &Quantiles::largest)},
      {"rmse", "8-bit levels", "rmse", m.picture.rmse},
      {"psnr", "dB", "psnr", m.picture.psnr},
      {"pixels_percent", "% of pixels", "pixels, %", m.picture.pixels_percent},
  };
}

/// Clocks a ray of the whole picture: sampled kinds count as often as they are in it.
double clocks_per_ray(const Measured& m) {
  const double camera = static_cast<double>(m.camera.rays);
  const double shadow = static_cast<double>(m.shadow.rays);
  return (camera * m.camera_clocks.per_ray() + shadow * m.shadow_clocks.per_ray()) / (camera + shadow);
}

/// Time a ray of the whole picture.
std::optional<double> seconds_per_ray(const Measured& m) {
  if (!m.camera_seconds || !m.shadow_seconds) {
    return std::nullopt;
  }
  const double camera = static_cast<double>(m.camera.rays);
  const double shadow = static_cast<double>(m.shadow.rays);
  return (camera * *m.camera_seconds + shadow * *m.shadow_seconds) / (camera + shadow);
}

/// Costs; `base`: of double precision.
std::vector<Value> cost_values(const Configuration& c, const Measured& m, const Measured& base) {
  constexpr double kNano = 1e9;
  const auto clocks = [&](double number) { return c.netlist.empty() ? std::nullopt : std::optional(number); };
  const auto ratio = [](const std::optional<double>& a, const std::optional<double>& b) {
    return a && b ? std::optional(*a / *b) : std::nullopt;
  };
  const auto nano = [](const std::optional<double>& a) { return a ? std::optional(*a * kNano) : a; };
  return {
      {"camera_clocks_per_ray", "clocks/ray", "c: clocks", clocks(m.camera_clocks.per_ray())},
      {"shadow_clocks_per_ray", "clocks/ray", "s: clocks", clocks(m.shadow_clocks.per_ray())},
      {"clocks_per_ray", "clocks/ray", "clocks", clocks(clocks_per_ray(m))},
      {"camera_time", "time of double", "c: time", ratio(m.camera_seconds, base.camera_seconds)},
      {"shadow_time", "time of double", "s: time", ratio(m.shadow_seconds, base.shadow_seconds)},
      {"time", "time of double", "time", ratio(seconds_per_ray(m), seconds_per_ray(base))},
      {"nanoseconds_per_ray", "ns/ray", "ns/ray", nano(seconds_per_ray(m))},
  };
}

void print_table(const std::vector<Configuration>& list, const SceneRuns& scene) {
  const auto rows = [&](const auto& values_of) {
    fmt::print("{:<16}", "");
    for (const Value& value : values_of(0)) {
      fmt::print("{:>11}", value.heading);
    }
    fmt::print("\n");
    for (std::size_t k = 0; k < list.size(); ++k) {
      fmt::print("{:<16}", list[k].name);
      for (const Value& value : values_of(k)) {
        fmt::print("{:>11}", value.number ? fmt::format("{:.3g}", *value.number) : "-");
      }
      fmt::print("\n");
    }
  };
  const Measured& base = scene.measured.front();
  fmt::print("{}: {} camera rays, {} shadow rays\n", scene.name, base.camera.rays, base.shadow.rays);
  rows([&](std::size_t k) { return error_values(scene.measured[k]); });
  rows([&](std::size_t k) { return cost_values(list[k], scene.measured[k], base); });
  fmt::print("\n");
  std::fflush(stdout);
}

/// Clocks of profile raplas for each camera pencil.
void write_heat_map(const SceneRuns& scene, const CommandLine& line) {
  const StreamRun run = run_stream(scene.prepared.at(Structure::tree).tree.scene,
                                   scene.recorded.at(kMaxRows).camera, [](double /*share*/) {});
  HeatMap map{(line.width + kMaxColumns - 1) / kMaxColumns, {}};
  for (const PencilCost& cost : run.costs) {
    map.values.push_back(cost.clocks);
  }
  OutputFile file(std::filesystem::path(line.pictures) / fmt::format("{}.clocks.png", scene.name));
  write_png(draw(map), file);
  file.commit();
}

void write_pictures(const std::vector<Configuration>& list, const SceneRuns& scene,
                    const std::string& folder) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    OutputFile file(std::filesystem::path(folder) / fmt::format("{}.{}.png", scene.name, list[k].name));
    write_png(scene.measured[k].image, file);
    file.commit();
  }
}

/// Means over the scenes: arithmetic of errors, PSNR of the root mean square of the scenes' RMSE, geometric
/// of clocks and times.
class Means {
 public:
  void add(const Measured& m, const std::vector<Value>& costs) {
    ++scenes_;
    misclassified_ += error_values(m).front().number.value_or(0);
    rmse_ += m.picture.rmse;
    squares_ += m.picture.rmse * m.picture.rmse;
    pixels_ += m.picture.pixels_percent;
    for (const Value& cost : costs) {
      if (cost.number) {
        log_costs_[cost.name] += std::log(*cost.number);
        units_[cost.name] = cost.unit;
      }
    }
  }

  [[nodiscard]] std::vector<Value> errors() const {
    return {{"misclassified_percent", "% of rays", "", misclassified_ / scenes_},
            {"rmse", "8-bit levels", "", rmse_ / scenes_},
            {"psnr", "dB", "", psnr_of(std::sqrt(squares_ / scenes_))},
            {"pixels_percent", "% of pixels", "", pixels_ / scenes_}};
  }

  [[nodiscard]] std::vector<Value> costs() const {
    std::vector<Value> values;
    for (const auto& [name, sum] : log_costs_) {
      values.push_back({name.c_str(), units_.at(name), "", std::exp(sum / scenes_)});
    }
    return values;
  }

 private:
  double scenes_ = 0;
  double misclassified_ = 0;
  double rmse_ = 0;
  double squares_ = 0;
  double pixels_ = 0;
  std::map<std::string, double> log_costs_;
  std::map<std::string, const char*> units_;
};

nlohmann::ordered_json figures(const std::vector<Configuration>& list, const std::vector<SceneRuns>& scenes,
                               const std::string& command) {
  nlohmann::ordered_json json;
  const auto add = [&](const std::string& name, const auto& value, const char* unit) {
    json[name] = {{"value", value}, {"unit", unit}, {"command", command}};
  };
  const auto add_all = [&](const std::string& prefix, const std::vector<Value>& values) {
    for (const Value& value : values) {
      if (value.number) {
        add(prefix + "." + value.name, *value.number, value.unit);
      }
    }
  };
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Configuration& c = list[k];
    add("configuration." + c.name + ".title", c.title, "");
    add("configuration." + c.name + ".netlist", c.netlist, "");
    Means means;
    for (const SceneRuns& scene : scenes) {
      const auto costs = cost_values(c, scene.measured[k], scene.measured.front());
      means.add(scene.measured[k], costs);
      add_all("error." + scene.name + "." + c.name, error_values(scene.measured[k]));
      add_all("cost." + scene.name + "." + c.name, costs);
    }
    add_all("error." + c.name, means.errors());
    add_all("cost." + c.name, means.costs());
  }
  return json;
}

/// Those that were asked for; double precision always.
std::vector<Configuration> chosen(const std::vector<std::string>& only) {
  std::vector<Configuration> list = configurations();
  for (const std::string& name : only) {
    if (std::none_of(list.begin(), list.end(), [&](const auto& c) { return c.name == name; })) {
      throw std::runtime_error(fmt::format("no configuration {} in this build", name));
    }
  }
  if (!only.empty()) {
    std::erase_if(list, [&](const Configuration& c) {
      return c.name != "double" && std::find(only.begin(), only.end(), c.name) == only.end();
    });
  }
  return list;
}

void run(const CommandLine& line, const std::string& command) {
  check_names(line.scenes);
  const std::vector<Configuration> list = chosen(line.only);
  if (line.only.empty() && !with_embree()) {
    fmt::print(
        stderr,
        "configurations: note: without Embree, which this build did not find (Debian: libembree-dev)\n");
  }
  if (!line.pictures.empty()) {
    std::filesystem::create_directories(line.pictures);
  }
  std::optional<OutputFile> json;
  if (!line.json.empty()) {
    json.emplace(line.json);
  }
  std::vector<SceneRuns> scenes;
  for (const std::string& file : line.scenes) {
    SceneRuns scene = run_scene(file, list, line);
    print_table(list, scene);
    if (!line.pictures.empty()) {
      write_pictures(list, scene, line.pictures);
      write_heat_map(scene, line);
    }
    scene.prepared.clear();
    scene.recorded.clear();
    scenes.push_back(std::move(scene));
  }
  if (json) {
    json->write(figures(list, scenes, command).dump(2) + "\n");
    json->commit();
  }
}

int parse_and_run(int argc, char** argv) {
  constexpr int kMaxSide = 16384;
  constexpr int kMaxRepetitions = 1000;
  CLI::App app{"Trace the same pictures by whole configurations, and measure errors and costs",
               "configurations"};
  CommandLine line;
  app.add_option("scenes", line.scenes, "scenes (.json) or meshes (.obj .ply .stl .gltf .glb .bpt)")
      ->required();
  app.add_option("--only", line.only, "configurations, besides double (default: all)");
  app.add_option("--width", line.width, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--height", line.height, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--shadow", line.shadow, "rays in a row of a shadow pencil")
      ->check(CLI::Range(1, kMaxRows))
      ->capture_default_str();
  app.add_option("--repetitions", line.repetitions, "of software that is timed; 0: none is")
      ->check(CLI::Range(0, kMaxRepetitions))
      ->capture_default_str();
  app.add_option("--pictures", line.pictures, "folder for the pictures, SCENE.CONFIGURATION.png");
  app.add_option("--json", line.json, "file for figures");
  app.add_flag("--quiet", line.quiet, "no progress");
  if (const auto exit_code = parse(app, argc, argv)) {
    return *exit_code;
  }
  run(line, command_line(app, argc, argv));
  return 0;
}

}  // namespace
}  // namespace raplas

int main(int argc, char** argv) {
  return raplas::run_program("configurations", argc, argv, raplas::parse_and_run);
}
