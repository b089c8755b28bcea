// Tone mapping and PNG files.
#include "raplas/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace raplas {

std::vector<std::uint8_t> to_8_bit(const Image& image) {
  constexpr double kGamma = 2.2;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const glm::vec3& pixel : image.pixels) {
    for (int k = 0; k < 3; ++k) {
      const double level = std::pow(std::clamp(static_cast<double>(pixel[k]), 0.0, 1.0), 1 / kGamma);
      bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * level)));
    }
  }
  return bytes;
}

std::size_t pixels_off(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, int levels) {
  std::size_t off = 0;
  for (std::size_t k = 0; k + 2 < std::min(a.size(), b.size()); k += 3) {
    const bool differs = std::abs(a[k] - b[k]) > levels || std::abs(a[k + 1] - b[k + 1]) > levels ||
                         std::abs(a[k + 2] - b[k + 2]) > levels;
    off += differs ? 1U : 0U;
  }
  return off;
}

void write_png(const Image& image, OutputFile& file) {
  const std::vector<std::uint8_t> bytes = to_8_bit(image);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_stdio(&png, file.stream(), 0, bytes.data(), 0, nullptr) == 0) {
    throw std::runtime_error(fmt::format("{}: writing failed ({})", file.target().string(), png.message));
  }
}

}  // namespace raplas
