// The figures that a program measures, in the form that scripts/figures.py collects.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "raplas/output_file.hpp"

namespace raplas {

class FigureFile {
 public:
  /// Opens `file`, so that an unwritable one is found before the work; an empty name: figures go nowhere.
  /// `command` is the command line that measures them.
  FigureFile(const std::filesystem::path& file, std::string command);

  /// A number or a text; one of the same name is replaced.
  template <typename Value>
  void add(const std::string& name, const Value& value, const char* unit) {
    figures_[name] = {{"value", value}, {"unit", unit}, {"command", command_}};
  }

  /// Writes the file; at most once.
  void commit();

 private:
  std::optional<OutputFile> file_;
  std::string command_;
  nlohmann::ordered_json figures_;
};

/// count / of; 0 of nothing.
[[nodiscard]] double per(std::uint64_t count, std::uint64_t of);
[[nodiscard]] double percent(std::uint64_t count, std::uint64_t of);

}  // namespace raplas
