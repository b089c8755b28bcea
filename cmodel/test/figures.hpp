// Figures of a test, for scripts/figures.py.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace raplas {

/// RAPLAS_CASES, the number of cases of a long run; `standard` if it isn't set.
[[nodiscard]] inline std::uint64_t number_of_cases(std::uint64_t standard) {
  const char* text = std::getenv("RAPLAS_CASES");
  return text == nullptr ? standard : std::stoull(text);
}

/// Collects figures; write() puts them into the file that RAPLAS_FIGURES names, if it is set. `suffix` comes
/// before its extension: tests of one program that run at the same time need files of their own.
class Figures {
 public:
  explicit Figures(std::string command = "make prove") : command_(std::move(command)) {}

  template <typename Value>
  void add(const std::string& name, Value value, const char* unit) {
    figures_[name] = {{"value", value}, {"unit", unit}, {"command", command_}};
  }

  void write(const char* suffix = "") const {
    const char* name = std::getenv("RAPLAS_FIGURES");
    if (name == nullptr) {
      return;
    }
    std::filesystem::path path = name;
    path.replace_filename(path.stem().string() + suffix + path.extension().string());
    std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path);
    file << figures_.dump(2) << "\n";
    EXPECT_TRUE(file.good()) << path;
  }

 private:
  std::string command_;
  nlohmann::ordered_json figures_;
};

}  // namespace raplas
