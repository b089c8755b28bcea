// Pictures: linear float RGB, and 8 bits for files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "raplas/output_file.hpp"

namespace raplas {

/// Linear RGB, rows from the top, pixel (x, y) at y * width + x.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> pixels;
};

/// 3 bytes a pixel: each channel cut to 0 .. 1, raised to 1 / 2.2, times 255, to nearest.
[[nodiscard]] std::vector<std::uint8_t> to_8_bit(const Image& image);

/// Number of pixels of which a channel differs by more than `levels`; both pictures of 3 bytes a pixel and
/// one size.
[[nodiscard]] std::size_t pixels_off(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                                     int levels);

/// Writes the 8-bit picture as PNG. Throws std::runtime_error naming the file when writing fails.
void write_png(const Image& image, OutputFile& file);

}  // namespace raplas
