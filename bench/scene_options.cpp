#include "scene_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <set>
#include <stdexcept>

namespace raplas {

void add_options(CLI::App& app, SceneOptions& options) {
  constexpr int kMaxSide = 16384;
  app.add_option("scenes", options.scenes, "scenes (.json) or meshes (.obj .ply .stl .gltf .glb .bpt)")
      ->required();
  app.add_option("--width", options.width, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--height", options.height, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--json", options.json, "file for figures");
  app.add_flag("--quiet", options.quiet, "no progress");
}

std::string scene_name(const std::string& file) { return std::filesystem::path(file).stem().string(); }

void check_names(const std::vector<std::string>& scenes) {
  std::set<std::string> names;
  for (const std::string& scene : scenes) {
    const std::string name = scene_name(scene);
    if (!names.insert(name).second) {
      throw std::runtime_error(fmt::format("{}: another scene is called {} too", scene, name));
    }
  }
}

}  // namespace raplas
