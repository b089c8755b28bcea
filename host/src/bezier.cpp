// Bicubic Bezier patches: the .bpt reader and the tessellation.
#include "raplas/bezier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

namespace raplas {
namespace {

/// Gives equal indices to points that fall into the same cell of a fine grid.
class VertexWelder {
 public:
  VertexWelder(double cell, std::vector<glm::dvec3>& vertices) : cell_(cell), vertices_(vertices) {}

  std::uint32_t index_of(const glm::dvec3& p) {
    const auto key =
        std::make_tuple(std::llround(p.x / cell_), std::llround(p.y / cell_), std::llround(p.z / cell_));
    const auto [entry, added] = index_.try_emplace(key, static_cast<std::uint32_t>(vertices_.size()));
    if (added) {
      vertices_.push_back(p);
    }
    return entry->second;
  }

 private:
  double cell_;
  std::vector<glm::dvec3>& vertices_;
  std::map<std::tuple<long long, long long, long long>, std::uint32_t> index_;
};

std::array<double, 4> bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

double size_of(const std::vector<BezierPatch>& patches) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-std::numeric_limits<double>::infinity());
  for (const BezierPatch& patch : patches) {
    for (const glm::dvec3& p : patch) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  return glm::distance(low, high);
}

}  // namespace

std::vector<BezierPatch> load_patches(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw std::runtime_error(fmt::format("{}: cannot be opened", file.string()));
  }
  long count = 0;
  if (!(in >> count) || count < 1 || count > 100000) {
    throw std::runtime_error(fmt::format("{}: does not begin with a number of patches", file.string()));
  }
  std::vector<BezierPatch> patches(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < patches.size(); ++k) {
    int rows = 0;
    int columns = 0;
    if (!(in >> rows >> columns) || rows != 3 || columns != 3) {
      throw std::runtime_error(
          fmt::format("{}: patch {} does not begin with the degrees 3 3", file.string(), k + 1));
    }
    for (glm::dvec3& p : patches[k]) {
      if (!(in >> p.x >> p.y >> p.z)) {
        throw std::runtime_error(
            fmt::format("{}: patch {} lacks 16 points of 3 numbers", file.string(), k + 1));
      }
    }
  }
  return patches;
}

glm::dvec3 evaluate(const BezierPatch& patch, double u, double v) {
  const std::array<double, 4> bu = bernstein(u);
  const std::array<double, 4> bv = bernstein(v);
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      sum += bu[i] * bv[j] * patch[4 * i + j];
    }
  }
  return sum;
}

Mesh tessellate(const std::vector<BezierPatch>& patches, int subdivisions) {
  if (subdivisions < 1 || subdivisions > 64) {
    throw std::runtime_error(fmt::format("{} subdivisions: must be 1 to 64", subdivisions));
  }
  Mesh mesh;
  mesh.colours.emplace_back(0.7);
  VertexWelder welder(1e-9 * size_of(patches), mesh.vertices);
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) {
      mesh.triangles.push_back({a, b, c});
      mesh.colour_of.push_back(0);
    }
  };
  const auto n = static_cast<std::size_t>(subdivisions);
  std::vector<std::uint32_t> grid((n + 1) * (n + 1));
  for (const BezierPatch& patch : patches) {
    for (std::size_t i = 0; i <= n; ++i) {
      for (std::size_t j = 0; j <= n; ++j) {
        const double u = static_cast<double>(i) / static_cast<double>(n);
        const double v = static_cast<double>(j) / static_cast<double>(n);
        grid[i * (n + 1) + j] = welder.index_of(evaluate(patch, u, v));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const std::size_t k = i * (n + 1) + j;
        add(grid[k], grid[k + 1], grid[k + n + 1]);
        add(grid[k + 1], grid[k + n + 2], grid[k + n + 1]);
      }
    }
  }
  return mesh;
}

}  // namespace raplas
