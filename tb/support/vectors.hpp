// Recorded vectors: tb/vectors/<unit>.txt, a line of hexadecimal words each, # starts a comment.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace raplas {

/// The lines of a unit's file; stops the program if it is missing or empty.
inline std::vector<std::vector<std::uint32_t>> read_vectors(const std::string& unit) {
  const std::string path = std::string(RAPLAS_VECTORS) + "/" + unit + ".txt";
  std::ifstream file(path);
  std::vector<std::vector<std::uint32_t>> lines;
  for (std::string text; std::getline(file, text);) {
    std::istringstream words(text.substr(0, text.find('#')));
    std::vector<std::uint32_t> line;
    for (std::uint32_t word = 0; words >> std::hex >> word;) {
      line.push_back(word);
    }
    if (!line.empty()) {
      lines.push_back(line);
    }
  }
  if (lines.empty()) {
    std::cerr << path << ": no vectors\n";
    std::exit(1);
  }
  return lines;
}

}  // namespace raplas
