// plane_error: what plane tests of several widths lose and find too much, for the camera pencils of scenes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plane_sweep.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "raplas/output_file.hpp"
#include "raplas/pencil.hpp"
#include "scene_names.hpp"
#include "session.hpp"

namespace raplas {
namespace {

struct CommandLine {
  std::vector<std::string> scenes;
  int width = 256;
  int height = 256;
  std::string json;  ///< empty: none
  bool quiet = false;
};

struct Value {
  const char* name;
  double number;
};

/// All in % of the meets that there are.
std::vector<Value> values(const PlaneSweep& sweep, const PlaneTester& tester) {
  const auto percent = [&](std::uint64_t count) {
    return sweep.meets == 0 ? 0 : 100 * static_cast<double>(count) / static_cast<double>(sweep.meets);
  };
  return {{"lost_percent", percent(tester.conservative.lost)},
          {"false_percent", percent(tester.conservative.false_meets)},
          {"bare_lost_percent", percent(tester.bare.lost)},
          {"bare_false_percent", percent(tester.bare.false_meets)}};
}

PlaneSweep sweep_scene(const std::string& file, const CommandLine& line) {
  Settings settings;
  settings.scene = file;
  const Prepared prepared = prepare(settings);
  const CameraFrame camera(prepared.scene.camera, line.width, line.height);
  std::vector<Pencil> pencils;
  for (int y = 0; y < line.height; y += kMaxRows) {
    for (int x = 0; x < line.width; x += kMaxColumns) {
      pencils.push_back(
          camera.pencil(x, y, std::min(kMaxColumns, line.width - x), std::min(kMaxRows, line.height - y)));
    }
  }
  Progress progress(settings.scene.stem().string(), line.quiet);
  return sweep_planes(prepared.tree.scene, pencils, [&](double share) { progress.show(share); });
}

void print_table(const std::string& scene, const PlaneSweep& sweep) {
  fmt::print("{}: {} tests, {} of them meet; % of these\n{:<12}{:>7}{:>12}{:>12}{:>14}{:>14}\n", scene,
             sweep.tests, sweep.meets, "", "DSP48", "lost", "false", "bare: lost", "bare: false");
  for (const PlaneTester& tester : sweep.testers) {
    const auto v = values(sweep, tester);
    fmt::print("{:<12}{:>7}{:>12.4g}{:>12.4g}{:>14.4g}{:>14.4g}\n", tester.key, tester.dsp48, v[0].number,
               v[1].number, v[2].number, v[3].number);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void run(const CommandLine& line, const std::string& command) {
  check_names(line.scenes);
  std::optional<OutputFile> file;
  if (!line.json.empty()) {
    file.emplace(line.json);
  }
  nlohmann::ordered_json json;
  const auto add = [&](const std::string& name, const auto& value, const char* unit) {
    json[name] = {{"value", value}, {"unit", unit}, {"command", command}};
  };
  std::map<std::string, double> means;
  for (const std::string& path : line.scenes) {
    const std::string scene = std::filesystem::path(path).stem().string();
    const PlaneSweep sweep = sweep_scene(path, line);
    print_table(scene, sweep);
    add("planes." + scene + ".tests", sweep.tests, "tests");
    add("planes." + scene + ".meets", sweep.meets, "tests");
    for (const PlaneTester& tester : sweep.testers) {
      for (const auto& [name, number] : values(sweep, tester)) {
        add("planes." + scene + "." + tester.key + "." + name, number, "% of meets");
        means["planes." + tester.key + "." + name] += number / static_cast<double>(line.scenes.size());
      }
      json["planes." + tester.key + ".dsp48"] = {
          {"value", tester.dsp48}, {"unit", "DSP48"}, {"command", command}};
    }
  }
  for (const auto& [name, mean] : means) {
    add(name, mean, "% of meets");
  }
  if (file) {
    file->write(json.dump(2) + "\n");
    file->commit();
  }
}

int parse_and_run(int argc, char** argv) {
  constexpr int kMaxSide = 16384;
  CLI::App app{"Measure what plane tests of several widths lose and find too much", "plane_error"};
  CommandLine line;
  app.add_option("scenes", line.scenes, "scenes (.json) or meshes (.obj .ply .stl .gltf .glb .bpt)")
      ->required();
  app.add_option("--width", line.width, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--height", line.height, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
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
  return raplas::run_program("plane_error", argc, argv, raplas::parse_and_run);
}
