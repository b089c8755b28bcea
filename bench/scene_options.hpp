// What the command lines of programs have that measure scenes.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace raplas {

struct SceneOptions {
  std::vector<std::string> scenes;  ///< files
  int width = 256;                  ///< of the camera's picture
  int height = 256;
  std::string json;  ///< empty: none
  bool quiet = false;
};

/// Adds them to a command line; what they are set to is the default.
void add_options(CLI::App& app, SceneOptions& options);

/// What a scene is called in figures: its file's stem.
[[nodiscard]] std::string scene_name(const std::string& file);

/// Throws std::runtime_error if two scenes have the same name.
void check_names(const std::vector<std::string>& scenes);

}  // namespace raplas
