// configurations: the same pictures by whole configurations, and what each gets wrong and takes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "configuration_run.hpp"
#include "figure_file.hpp"
#include "heat_map.hpp"
#include "program.hpp"
#include "raplas/output_file.hpp"
#include "scene_options.hpp"
#include "skip_measure.hpp"

namespace raplas {
namespace {

struct CommandLine : SceneOptions {
  std::vector<std::string> only;  ///< names of configurations; empty: all
  RunOptions run;
  std::string pictures;  ///< folder; empty: none
};

/// A measured number.
struct Value {
  const char* name;
  const char* unit;
  const char* heading;
  std::optional<double> number;  ///< nothing: there is none
};

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

void add_figures(FigureFile& figures, const std::vector<Configuration>& list,
                 const std::vector<SceneRuns>& scenes) {
  const auto add_all = [&](const std::string& prefix, const std::vector<Value>& values) {
    for (const Value& value : values) {
      if (value.number) {
        figures.add(prefix + "." + value.name, *value.number, value.unit);
      }
    }
  };
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Configuration& c = list[k];
    figures.add("configuration." + c.name + ".title", c.title, "");
    figures.add("configuration." + c.name + ".netlist", c.netlist, "");
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
  FigureFile figures(line.json, command);
  std::vector<SceneRuns> scenes;
  RunOptions options = line.run;
  options.width = line.width;
  options.height = line.height;
  options.quiet = line.quiet;
  for (const std::string& file : line.scenes) {
    SceneRuns scene = run_scene(file, list, options);
    print_table(list, scene);
    if (!line.pictures.empty()) {
      write_pictures(list, scene, line.pictures);
      write_heat_map(scene, line);
    }
    scene.prepared.clear();
    scene.recorded.clear();
    scenes.push_back(std::move(scene));
  }
  add_figures(figures, list, scenes);
  figures.commit();
}

int parse_and_run(int argc, char** argv) {
  constexpr int kMaxRepetitions = 1000;
  CLI::App app{"Trace the same pictures by whole configurations, and measure errors and costs",
               "configurations"};
  CommandLine line;
  add_options(app, line);
  app.add_option("--only", line.only, "configurations, besides double (default: all)");
  app.add_option("--shadow", line.run.shadow, "rays in a row of a shadow pencil")
      ->check(CLI::Range(1, kMaxRows))
      ->capture_default_str();
  app.add_option("--repetitions", line.run.repetitions, "of software that is timed; 0: none is")
      ->check(CLI::Range(0, kMaxRepetitions))
      ->capture_default_str();
  app.add_option("--pictures", line.pictures, "folder for the pictures, SCENE.CONFIGURATION.png");
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
