// format_error: how often each number format of the ray-triangle test is wrong, for the camera rays of
// scenes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "figure_file.hpp"
#include "format_sweep.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "raplas/output_file.hpp"
#include "scene_options.hpp"
#include "session.hpp"

namespace raplas {
namespace {

struct CommandLine : SceneOptions {
  std::string csv;  ///< empty: none
};

/// A scene with the errors of each format of kSweep.
struct Measured {
  std::string scene;  ///< the file's stem
  SampleCounts counts;
  std::vector<FormatErrors> errors;
};

/// A measured number of a format on a scene.
struct Value {
  const char* name;
  const char* unit;
  const char* heading;
  std::optional<double> number;  ///< nothing: no pair hits in both
};

std::vector<Value> values(const SampleCounts& counts, const FormatErrors& e) {
  const auto of_pairs = [&](std::uint64_t count) { return percent(count, counts.pairs); };
  const auto of_rays = [&](std::uint64_t count) { return percent(count, counts.rays); };
  const auto quantile = [](const std::optional<Quantiles>& q, double Quantiles::*which) {
    return q ? std::optional(*q.*which) : std::nullopt;
  };
  return {
      {"misclassified_percent", "% of pairs", "pairs wrong", of_pairs(e.misclassified())},
      {"false_hits_percent", "% of pairs", "false", of_pairs(e.false_hits)},
      {"missed_hits_percent", "% of pairs", "missed", of_pairs(e.missed_hits)},
      {"rays_wrong_percent", "% of rays", "rays wrong", of_rays(e.rays_wrong())},
      {"rays_false_percent", "% of rays", "false", of_rays(e.rays_false)},
      {"rays_missed_percent", "% of rays", "missed", of_rays(e.rays_missed)},
      {"rays_other_percent", "% of rays", "other", of_rays(e.rays_other)},
      {"t_relative_median", "relative", "t: median", quantile(e.t_relative, &Quantiles::median)},
      {"t_relative_99", "relative", "99 %", quantile(e.t_relative, &Quantiles::percent_99)},
      {"t_relative_largest", "relative", "largest", quantile(e.t_relative, &Quantiles::largest)},
      {"t_ulp_median", "ulp", "ulp: median", quantile(e.t_ulp, &Quantiles::median)},
      {"t_ulp_99", "ulp", "99 %", quantile(e.t_ulp, &Quantiles::percent_99)},
      {"t_ulp_largest", "ulp", "largest", quantile(e.t_ulp, &Quantiles::largest)},
  };
}

Measured measure_scene(const std::string& file, const CommandLine& line) {
  Settings settings;
  settings.scene = file;
  const Prepared prepared = prepare(settings);
  Measured m;
  m.scene = scene_name(file);
  Sample sample;
  {
    Progress progress(m.scene + ", double precision", line.quiet);
    sample = make_sample(prepared.tree.scene, prepared.scene.camera, line.width, line.height,
                         [&](double share) { progress.show(share); });
  }
  m.counts = count(sample);
  m.errors.resize(kSweep.size());
  Progress progress(m.scene + ", formats", line.quiet);
  for_each_parallel(
      kSweep.size(), [&](std::size_t k) { m.errors[k] = measure_swept(k, sample); },
      [&](double share) { progress.show(share); });
  return m;
}

void print_table(const Measured& m, const CommandLine& line) {
  const SampleCounts& c = m.counts;
  fmt::print(
      "{}: {}x{} pixels; {} rays, {} of them hit; {} pairs decided, {} of them hits; {} pairs undecided\n"
      "% of pairs, % of rays, relative error of t, the same in ulp of the format\n",
      m.scene, line.width, line.height, c.rays, c.rays_hit, c.pairs, c.hits, c.undecided);
  fmt::print("{:<26}", "");
  for (const Value& value : values(c, {})) {
    fmt::print("{:>12}", value.heading);
  }
  fmt::print("\n");
  for (std::size_t k = 0; k < kSweep.size(); ++k) {
    fmt::print("{:<26}", name_of(kSweep[k]));
    for (const Value& value : values(c, m.errors[k])) {
      fmt::print("{:>12}", value.number ? fmt::format("{:.3g}", *value.number) : "-");
    }
    fmt::print("\n");
  }
  fmt::print("\n");
  std::fflush(stdout);
}

std::string csv_head() {
  std::string text = "scene,format,exponent_bits,fraction_bits,guard,rounding,rays,pairs,undecided";
  for (const Value& value : values({}, {})) {
    text += fmt::format(",{}", value.name);
  }
  return text + "\n";
}

std::string csv_lines(const Measured& m) {
  std::string text;
  for (std::size_t k = 0; k < kSweep.size(); ++k) {
    const Format& format = kSweep[k];
    text += fmt::format("{},{},{},{},{},{},{},{},{}", m.scene, name_of(format), format.exponent_bits,
                        format.fraction_bits, name_of(format.guard), name_of(format.rounding), m.counts.rays,
                        m.counts.pairs, m.counts.undecided);
    for (const Value& value : values(m.counts, m.errors[k])) {
      text += value.number ? fmt::format(",{}", *value.number) : ",";
    }
    text += "\n";
  }
  return text;
}

/// Adds the figures error.<scene>.* and error.<scene>.<format>.*; numbers that are not there are left out.
void add_figures(FigureFile& figures, const Measured& m) {
  const std::string scene = "error." + m.scene + ".";
  const auto add = [&](const std::string& name, const auto& value, const char* unit) {
    figures.add(scene + name, value, unit);
  };
  add("rays", m.counts.rays, "rays");
  add("rays_hit", m.counts.rays_hit, "rays");
  add("pairs", m.counts.pairs, "pairs");
  add("hits", m.counts.hits, "pairs");
  add("undecided", m.counts.undecided, "pairs");
  for (std::size_t k = 0; k < kSweep.size(); ++k) {
    for (const Value& value : values(m.counts, m.errors[k])) {
      if (value.number) {
        add(name_of(kSweep[k]) + "." + value.name, *value.number, value.unit);
      }
    }
  }
}

void run(const CommandLine& line, const std::string& command) {
  check_names(line.scenes);
  std::optional<OutputFile> csv;
  if (!line.csv.empty()) {
    csv.emplace(line.csv);
    csv->write(csv_head());
  }
  FigureFile figures(line.json, command);
  for (const std::string& scene : line.scenes) {
    const Measured m = measure_scene(scene, line);
    print_table(m, line);
    if (csv) {
      csv->write(csv_lines(m));
    }
    add_figures(figures, m);
  }
  if (csv) {
    csv->commit();
  }
  figures.commit();
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Measure the errors of number formats of the ray-triangle test", "format_error"};
  CommandLine line;
  add_options(app, line);
  app.add_option("--csv", line.csv, "file for all numbers, one line a scene and format");
  if (const auto exit_code = parse(app, argc, argv)) {
    return *exit_code;
  }
  run(line, command_line(app, argc, argv));
  return 0;
}

}  // namespace
}  // namespace raplas

int main(int argc, char** argv) {
  return raplas::run_program("format_error", argc, argv, raplas::parse_and_run);
}
