// The subcommands of `raplas`.
#pragma once

#include <filesystem>
#include <string>

#include "session.hpp"

namespace raplas {

struct RenderCommand {
  Settings settings;
  std::string device;
  std::filesystem::path picture;
  std::filesystem::path hits;  ///< empty: none
};

/// Renders a scene into a PNG file. Returns the exit code.
int run(const RenderCommand& command);

struct CompareCommand {
  Settings settings;
  std::filesystem::path folder;
  std::string command_line;  ///< for the figures file
};

/// Renders with every device of this build and compares them. Returns 1 if model and rtl differ.
int run(const CompareCommand& command);

}  // namespace raplas
