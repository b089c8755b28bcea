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

struct SkipCommand {
  Settings settings;
  std::filesystem::path folder;  ///< of the heat maps
  std::string name;              ///< of the scene in the figures; empty: the file's stem
  int sample = 0;                ///< pencils of a kind that are walked with each skip, about; 0: all
  int tile = 0;                  ///< one shadow pencil in so many rows and columns of pixels
  int rtl = 0;                   ///< pencils for model against RTL
  std::string command_line;      ///< for the figures file
};

/// Measures what each skip saves. Returns 1 if any of them changes a hit, or if model and RTL differ.
int run(const SkipCommand& command);

}  // namespace raplas
