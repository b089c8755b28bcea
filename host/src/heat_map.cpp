#include "heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <string>
#include <string_view>

namespace raplas {
namespace {

constexpr int kScale = 8;       // pixels of a number
constexpr int kStrip = 8;       // pixels of the ramp's height
constexpr int kLegend = 24;     // with its numbers
constexpr int kGlyphWidth = 6;  // with the gap
constexpr int kGlyphHeight = 7;
constexpr int kLeastWidth = 160;  // room for the legend

/// Rows of the digits from the top, 5 bits each, the left one highest.
constexpr std::array<std::array<std::uint8_t, kGlyphHeight>, 10> kDigits{{
    {0b01110, 0b10001, 0b10011, 0b10101, 0b11001, 0b10001, 0b01110},
    {0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110},
    {0b01110, 0b10001, 0b00001, 0b00010, 0b00100, 0b01000, 0b11111},
    {0b11111, 0b00010, 0b00100, 0b00010, 0b00001, 0b10001, 0b01110},
    {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010},
    {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110},
    {0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110},
    {0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000},
    {0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110},
    {0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100},
}};

/// As write_png() must get it: linear.
glm::vec3 linear(const glm::dvec3& colour) { return glm::vec3(glm::pow(colour, glm::dvec3(2.2))); }

/// The colour of a share 0 .. 1 of the top.
glm::vec3 ramp(double share) {
  constexpr int kLast = 4;
  static const std::array<glm::dvec3, kLast + 1> kColours{glm::dvec3(0), glm::dvec3(0.15, 0.2, 0.65),
                                                          glm::dvec3(0.85, 0.2, 0.25),
                                                          glm::dvec3(1, 0.85, 0.2), glm::dvec3(1)};
  const double place = std::clamp(share, 0.0, 1.0) * kLast;
  const int below = std::min(static_cast<int>(place), kLast - 1);
  const auto k = static_cast<std::size_t>(below);
  return linear(glm::mix(kColours[k], kColours[k + 1], place - below));
}

std::uint64_t top_of(std::vector<std::uint64_t> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 199 / 200);
  std::nth_element(values.begin(), place, values.end());
  return std::max<std::uint64_t>(*place, 1);
}

class Canvas {
 public:
  Canvas(int width, int height) {
    image_.width = width;
    image_.height = height;
    image_.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  void set(int x, int y, const glm::vec3& colour) {
    image_.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                  static_cast<std::size_t>(x)] = colour;
  }
  void fill(int x0, int y0, int width, int height, const glm::vec3& colour) {
    for (int y = y0; y < y0 + height; ++y) {
      for (int x = x0; x < x0 + width; ++x) {
        set(x, y, colour);
      }
    }
  }
  void write(int x0, int y0, std::string_view digits) {
    for (const char digit : digits) {
      const auto& rows = kDigits[static_cast<std::size_t>(digit - '0')];
      for (int y = 0; y < kGlyphHeight; ++y) {
        for (int x = 0; x < kGlyphWidth - 1; ++x) {
          if ((rows[static_cast<std::size_t>(y)] >> (kGlyphWidth - 2 - x) & 1) != 0) {
            set(x0 + x, y0 + y, glm::vec3(1));
          }
        }
      }
      x0 += kGlyphWidth;
    }
  }
  Image take() { return std::move(image_); }

 private:
  Image image_;
};

}  // namespace

Image draw(const HeatMap& map) {
  const int rows = static_cast<int>(map.values.size()) / map.columns;
  const int width = std::max(map.columns * kScale, kLeastWidth);
  const int height = rows * kScale;
  const std::uint64_t top = top_of(map.values);
  Canvas canvas(width, height + kLegend);
  for (int k = 0; k < rows * map.columns; ++k) {
    const double share =
        static_cast<double>(map.values[static_cast<std::size_t>(k)]) / static_cast<double>(top);
    canvas.fill(k % map.columns * kScale, k / map.columns * kScale, kScale, kScale, ramp(share));
  }
  const int strip = height + 4;
  for (int x = 0; x < width; ++x) {
    canvas.fill(x, strip, 1, kStrip, ramp(double(x) / (width - 1)));
  }
  constexpr int kMarks = 2;
  for (int mark = 0; mark <= kMarks; ++mark) {
    const std::string number = fmt::format("{}", top * static_cast<std::uint64_t>(mark) / kMarks);
    const int length = static_cast<int>(number.size()) * kGlyphWidth;
    canvas.write((width - length) * mark / kMarks, strip + kStrip + 3, number);
  }
  return canvas.take();
}

}  // namespace raplas
