#include "obj_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

namespace raplas {

void check_obj_vertices(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::size_t vertex = 0;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (line.size() < 2 || line[0] != 'v' || (line[1] != ' ' && line[1] != '\t')) {
      continue;
    }
    ++vertex;
    const char* at = line.c_str() + 1;
    for (int k = 0; k < 3; ++k) {
      char* end = nullptr;
      const float value = std::strtof(at, &end);
      if (end != at && !std::isfinite(value)) {
        throw std::runtime_error(fmt::format("{}: vertex {} (line {}) has the coordinate {}, not finite",
                                             file.string(), vertex, number, value));
      }
      at = end;
    }
  }
}

}  // namespace raplas
