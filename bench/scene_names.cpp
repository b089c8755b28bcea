#include "scene_names.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <stdexcept>

namespace raplas {

void check_names(const std::vector<std::string>& scenes) {
  std::set<std::string> stems;
  for (const std::string& scene : scenes) {
    const std::string stem = std::filesystem::path(scene).stem().string();
    if (!stems.insert(stem).second) {
      throw std::runtime_error(fmt::format("{}: another scene is called {} too", scene, stem));
    }
  }
}

}  // namespace raplas
