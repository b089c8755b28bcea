#include "stress_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "raplas/pencil.hpp"

namespace raplas {
namespace {

constexpr double kLattice = 0x1p-20;

glm::dvec3 on_lattice(const glm::dvec3& p) { return glm::round(p / kLattice) * kLattice; }

/// Faces of a grid of rows x columns quadrilaterals; vertex(row, column) is the index of their corner, seen
/// with rows going to the right and columns up.
template <typename Vertex>
void add_grid(ClosedMesh& mesh, int rows, int columns, const Vertex& vertex) {
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      mesh.faces.push_back({vertex(r, c), vertex(r + 1, c), vertex(r + 1, c + 1)});
      mesh.faces.push_back({vertex(r, c), vertex(r + 1, c + 1), vertex(r, c + 1)});
    }
  }
}

double turn(int part, int of) { return 2 * glm::pi<double>() * part / of; }

}  // namespace

glm::dvec3 Dice::in_cube() {
  const double x = uniform(-1, 1);
  const double y = uniform(-1, 1);
  return {x, y, uniform(-1, 1)};
}

glm::dvec3 Dice::on_sphere() {
  for (;;) {
    const glm::dvec3 v = in_cube();
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1) {
      return v / length;
    }
  }
}

glm::dvec3 Dice::in_ball(double radius) {
  const glm::dvec3 direction = on_sphere();
  return direction * (radius * std::cbrt(uniform(0, 1)));
}

bool is_closed(const ClosedMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& face : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{face[k], face[(k + 1) % 3]}];
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto back = edges.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != edges.end() && back->second == 1;
  });
}

double volume_6(const ClosedMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    sum += glm::dot(mesh.vertices[a], glm::cross(mesh.vertices[b], mesh.vertices[c]));
  }
  return sum;
}

std::vector<Triangle> triangles_of(const ClosedMesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    const glm::dvec3 v0 = on_lattice(mesh.vertices[a]);
    triangles.push_back({v0, on_lattice(mesh.vertices[b]) - v0, on_lattice(mesh.vertices[c]) - v0});
  }
  return triangles;
}

ClosedMesh tetrahedron(double radius) {
  const double s = radius / std::sqrt(3.0);
  return {{{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

ClosedMesh cube(double radius) {
  const double s = radius / std::sqrt(3.0);
  ClosedMesh mesh;
  for (unsigned k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back((k & 1U) != 0 ? s : -s, (k & 2U) != 0 ? s : -s, (k & 4U) != 0 ? s : -s);
  }
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

ClosedMesh icosphere(double radius, int subdivisions) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  ClosedMesh mesh{{{-1, g, 0},
                   {1, g, 0},
                   {-1, -g, 0},
                   {1, -g, 0},
                   {0, -1, g},
                   {0, 1, g},
                   {0, -1, -g},
                   {0, 1, -g},
                   {g, 0, -1},
                   {g, 0, 1},
                   {-g, 0, -1},
                   {-g, 0, 1}},
                  {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int k = 0; k < subdivisions; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) {
        mesh.vertices.push_back(glm::normalize(mesh.vertices[a]) + glm::normalize(mesh.vertices[b]));
      }
      return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.faces) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.faces = std::move(finer);
  }
  for (glm::dvec3& v : mesh.vertices) {
    v = glm::normalize(v) * radius;
  }
  return mesh;
}

ClosedMesh uv_sphere(double radius, int rings, int sectors) {
  ClosedMesh mesh;
  for (int r = 1; r < rings; ++r) {
    const double polar = turn(r, 2 * rings);
    for (int s = 0; s < sectors; ++s) {
      mesh.vertices.emplace_back(radius * std::sin(polar) * std::cos(turn(s, sectors)),
                                 radius * std::sin(polar) * std::sin(turn(s, sectors)),
                                 radius * std::cos(polar));
    }
  }
  const auto vertex = [sectors](int ring, int sector) {
    return static_cast<std::uint32_t>(ring * sectors + sector % sectors);
  };
  add_grid(mesh, rings - 2, sectors, vertex);
  const auto north = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, radius);
  mesh.vertices.emplace_back(0, 0, -radius);
  for (int s = 0; s < sectors; ++s) {
    mesh.faces.push_back({north, vertex(0, s), vertex(0, s + 1)});
    mesh.faces.push_back({north + 1, vertex(rings - 2, s + 1), vertex(rings - 2, s)});
  }
  return mesh;
}

ClosedMesh torus(double radius, int rings, int sectors) {
  const double ring = radius / 1.5;
  const double tube = ring / 2;
  ClosedMesh mesh;
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const double out = ring + tube * std::cos(turn(s, sectors));
      mesh.vertices.emplace_back(out * std::cos(turn(r, rings)), out * std::sin(turn(r, rings)),
                                 tube * std::sin(turn(s, sectors)));
    }
  }
  add_grid(mesh, rings, sectors,
           [=](int r, int s) { return static_cast<std::uint32_t>((r % rings) * sectors + s % sectors); });
  return mesh;
}

std::array<glm::dvec3, 2> any_across(const glm::dvec3& v, Dice& dice) {
  const glm::dvec3 other = std::abs(v.x) < 0.5 * glm::length(v) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(v, other));
  const glm::dvec3 b = glm::normalize(glm::cross(v, a));
  const double angle = dice.uniform(0, 2 * glm::pi<double>());
  return {std::cos(angle) * a + std::sin(angle) * b, std::cos(angle) * b - std::sin(angle) * a};
}

glm::dvec3 point_in(const Triangle& triangle, Dice& dice) {
  double u = dice.uniform(0, 1);
  double v = dice.uniform(0, 1);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return triangle.v0 + u * triangle.e1 + v * triangle.e2;
}

std::vector<Triangle> random_triangles(std::size_t count, double size, Dice& dice) {
  std::vector<Triangle> triangles;
  triangles.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const glm::dvec3 middle = dice.in_ball(1 - size - 1.0 / 64);
    const glm::dvec3 v0 = middle + dice.in_ball(size);
    const glm::dvec3 v1 = middle + dice.in_ball(size);
    triangles.push_back({v0, v1 - v0, middle + dice.in_ball(size) - v0});
  }
  return triangles;
}

Pencil pencil_towards(const glm::dvec3& origin, const glm::dvec3& target, double angle, int rows, int columns,
                      Dice& dice) {
  const glm::dvec3 forward = target - origin;
  const double step = 2 * std::tan(angle / 2) * glm::length(forward) / (kMaxRows - 1);
  const auto [down, right] = any_across(forward, dice);
  const glm::dvec3 first = target - ((rows - 1) / 2.0 * step) * down - ((columns - 1) / 2.0 * step) * right;
  return make_pencil(origin, {first, down * step, right * step, rows, columns});
}

Pencil aligned_pencil(const glm::dvec3& origin, const Triangle& triangle) {
  return make_pencil(origin, {triangle.v0, triangle.e2 / 8.0, triangle.e1 / 8.0, kMaxRows, kMaxColumns});
}

}  // namespace raplas
