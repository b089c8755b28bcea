// plane_error: what plane tests of several widths lose and find too much, for the camera pencils of scenes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "figure_file.hpp"
#include "plane_sweep.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "scene_options.hpp"
#include "scene_pencils.hpp"
#include "session.hpp"

namespace raplas {
namespace {

struct Value {
  const char* name;
  double number;
};

/// All in % of the meets that there are.
std::vector<Value> values(const PlaneSweep& sweep, const PlaneTester& tester) {
  return {{"lost_percent", percent(tester.conservative.lost, sweep.meets)},
          {"false_percent", percent(tester.conservative.false_meets, sweep.meets)},
          {"bare_lost_percent", percent(tester.bare.lost, sweep.meets)},
          {"bare_false_percent", percent(tester.bare.false_meets, sweep.meets)}};
}

PlaneSweep sweep_scene(const std::string& file, const SceneOptions& line) {
  Settings settings;
  settings.scene = file;
  const Prepared prepared = prepare(settings);
  const std::vector<Pencil> pencils = camera_pencils(prepared.scene.camera, line.width, line.height);
  Progress progress(scene_name(file), line.quiet);
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

void run(const SceneOptions& line, const std::string& command) {
  check_names(line.scenes);
  FigureFile figures(line.json, command);
  std::map<std::string, double> means;
  for (const std::string& path : line.scenes) {
    const std::string scene = scene_name(path);
    const PlaneSweep sweep = sweep_scene(path, line);
    print_table(scene, sweep);
    figures.add("planes." + scene + ".tests", sweep.tests, "tests");
    figures.add("planes." + scene + ".meets", sweep.meets, "tests");
    for (const PlaneTester& tester : sweep.testers) {
      for (const auto& [name, number] : values(sweep, tester)) {
        figures.add("planes." + scene + "." + tester.key + "." + name, number, "% of meets");
        means["planes." + tester.key + "." + name] += number / static_cast<double>(line.scenes.size());
      }
      figures.add("planes." + tester.key + ".dsp48", tester.dsp48, "DSP48");
    }
  }
  for (const auto& [name, mean] : means) {
    figures.add(name, mean, "% of meets");
  }
  figures.commit();
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Measure what plane tests of several widths lose and find too much", "plane_error"};
  SceneOptions line;
  add_options(app, line);
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
