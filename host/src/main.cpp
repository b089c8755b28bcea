// The `raplas` command: reads the command line and runs a subcommand.
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "commands.hpp"
#include "program.hpp"

namespace raplas {
namespace {

constexpr int kMaxSample = 1 << 20;

/// Options of the subcommands as given; what is absent comes from the profile.
struct CommandLine {
  std::string scene;
  std::string profile = "raplas";
  int width = 512;
  int height = 512;
  std::optional<int> pencil;
  int shadow = 4;
  std::optional<std::string> structure;
  int leaf = 4;
  std::string memories = "simulation";
  std::string json;
  bool exact = false;
  bool quiet = false;
};

/// What every subcommand has.
void add_common_options(CLI::App& app, CommandLine& line) {
  constexpr int kMaxSide = 16384;
  app.add_option("scene", line.scene, "scene (.json) or mesh (.obj .ply .stl .gltf .glb .bpt)")->required();
  app.add_option("--width", line.width, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--height", line.height, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--leaf", line.leaf, "most triangles of a sphere without children")
      ->check(CLI::Range(1, (1 << kCountBits) - 1))
      ->capture_default_str();
  app.add_option("--json", line.json, "file for figures");
  app.add_flag("--quiet", line.quiet, "no progress, no summary");
}

void add_options(CLI::App& app, CommandLine& line) {
  add_common_options(app, line);
  app.add_option("--profile", line.profile,
                 "paper: 4x4 pencils, no guard bits, flat list; raplas: 16x16, guarded, tree")
      ->check(CLI::IsMember({"paper", "raplas"}))
      ->capture_default_str();
  app.add_option("--pencil", line.pencil, "rays in a row of a camera pencil")->check(CLI::Range(1, kMaxRows));
  app.add_option("--shadow", line.shadow, "rays in a row of a shadow pencil, 0: no shadows")
      ->check(CLI::Range(0, kMaxRows))
      ->capture_default_str();
  app.add_option("--structure", line.structure, "of the bounding spheres")
      ->check(CLI::IsMember({"flat", "tree"}));
  app.add_flag(
      "--exact", line.exact,
      "the hits of double precision: what the device cannot decide in 24 bits is tested on the host");
  app.add_option("--memories", line.memories, "chip: 4096 triangles and 4096 spheres; simulation: 2^20 each")
      ->check(CLI::IsMember({"chip", "simulation"}))
      ->capture_default_str();
}

Settings resolve(const CommandLine& line) {
  constexpr std::size_t kChipDepth = 4096;
  constexpr int kPaperPencil = 4;
  const bool paper = line.profile == "paper";
  Settings settings;
  settings.scene = line.scene;
  settings.profile = line.profile;
  settings.render = {line.width, line.height, line.pencil.value_or(paper ? kPaperPencil : kMaxRows),
                     line.shadow};
  settings.flat = line.structure.value_or(paper ? "flat" : "tree") == "flat";
  settings.tree.leaf_size = line.leaf;
  if (paper) {
    settings.tree.longest_edge = kWholeTriangles;
  }
  settings.device.profile = paper ? Profile::paper : Profile::raplas;
  settings.device.exact = line.exact;
  if (line.memories == "chip") {
    settings.device.sphere_depth = kChipDepth;
    settings.device.triangle_depth = kChipDepth;
  }
  settings.json = line.json;
  settings.quiet = line.quiet;
  return settings;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Ray tracing with the RAPLAS accelerator", "raplas"};
  app.require_subcommand(1);
  CommandLine line;

  CLI::App* render = app.add_subcommand("render", "Render a scene into a PNG file");
  add_options(*render, line);
  std::string device = "model";
  std::string picture = "out.png";
  std::string hits;
  render->add_option("--device", device, "what traces the rays")
      ->check(CLI::IsMember({"reference", "model", "rtl"}))
      ->capture_default_str();
  render->add_option("-o,--output", picture, "PNG file")->capture_default_str();
  render->add_option("--hits", hits, "file for the raw hits of all rays");

  CLI::App* compare =
      app.add_subcommand("compare", "Render with every device and compare pictures, hits and counts");
  add_options(*compare, line);
  std::string folder = "compare";
  compare->add_option("-o,--output", folder, "folder for the pictures")->capture_default_str();

  CLI::App* skip =
      app.add_subcommand("skip", "Measure what profile raplas skips, and that no skip changes a hit");
  CommandLine skip_line;
  skip_line.width = 1024;
  skip_line.height = 1024;
  add_common_options(*skip, skip_line);
  SkipCommand skipping;
  std::string maps = "skip";
  skipping.tile = kMaxRows;
  skip->add_option("-o,--output", maps, "folder for the heat maps")->capture_default_str();
  skip->add_option("--name", skipping.name, "of the scene in the figures (default: the file's)");
  skip->add_option("--sample", skipping.sample,
                   "pencils of a kind that are walked with each skip, about (default: all)")
      ->check(CLI::Range(1, kMaxSample));
  skip->add_option("--tile", skipping.tile, "one shadow pencil in so many rows and columns of pixels")
      ->check(CLI::Range(1, kMaxSample))
      ->capture_default_str();
  skip->add_option("--rtl", skipping.rtl, "pencils that the RTL traces too, as the model, about")
      ->check(CLI::Range(0, kMaxSample))
      ->capture_default_str();

  if (const auto exit_code = parse(app, argc, argv)) {
    return *exit_code;
  }
  if (render->parsed()) {
    return run(RenderCommand{resolve(line), device, picture, hits});
  }
  if (skip->parsed()) {
    skipping.settings = resolve(skip_line);
    skipping.folder = maps;
    skipping.command_line = command_line(app, argc, argv);
    return run(skipping);
  }
  return run(CompareCommand{resolve(line), folder, command_line(app, argc, argv)});
}

}  // namespace
}  // namespace raplas

int main(int argc, char** argv) { return raplas::run_program("raplas", argc, argv, raplas::parse_and_run); }
