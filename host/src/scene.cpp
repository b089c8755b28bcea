// Assembles a scene from its meshes and normalises it.
#include "raplas/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <stdexcept>

#include "raplas/normalise.hpp"

namespace raplas {
namespace {

constexpr double kCreaseDegrees = 60;

glm::dmat4 matrix_of(const MeshPlacement& place) {
  glm::dmat4 m = glm::translate(glm::dmat4(1), place.translate);
  m = glm::rotate(m, glm::radians(place.rotate_degrees.z), glm::dvec3(0, 0, 1));
  m = glm::rotate(m, glm::radians(place.rotate_degrees.y), glm::dvec3(0, 1, 0));
  m = glm::rotate(m, glm::radians(place.rotate_degrees.x), glm::dvec3(1, 0, 0));
  return glm::scale(m, glm::dvec3(place.scale));
}

void transform(Mesh& mesh, const MeshPlacement& place) {
  const glm::dmat4 m = matrix_of(place);
  for (glm::dvec3& vertex : mesh.vertices) {
    vertex = glm::dvec3(m * glm::dvec4(vertex, 1));
  }
  if (place.colour) {
    std::fill(mesh.colours.begin(), mesh.colours.end(), *place.colour);
  }
}

/// Appends a mesh; throws if it is nothing but triangles without area.
void append(Scene& scene, const Mesh& mesh, const std::filesystem::path& file) {
  const std::size_t first = scene.triangles.size();
  const auto normals = smooth_normals(mesh, kCreaseDegrees);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& [a, b, c] = mesh.triangles[k];
    const glm::dvec3& v0 = mesh.vertices[a];
    scene.triangles.push_back({v0, mesh.vertices[b] - v0, mesh.vertices[c] - v0});
    scene.surfaces.push_back({normals[k], mesh.colours.at(mesh.colour_of[k])});
  }
  const auto added = scene.triangles.begin() + static_cast<std::ptrdiff_t>(first);
  if (std::all_of(added, scene.triangles.end(), has_no_area)) {
    throw std::runtime_error(fmt::format("{}: no triangles with an area", file.string()));
  }
}

void apply(Scene& scene, const Camera& camera, const AreaLight& light, const glm::dvec3& background) {
  scene.camera = camera;
  scene.light = light;
  scene.background = background;
}

Scene from_description(const SceneDescription& description) {
  Scene scene;
  apply(scene, description.camera, description.light, description.background);
  scene.ambient = description.ambient;
  for (const MeshPlacement& place : description.meshes) {
    Mesh mesh = load_any_mesh(place.file, place.subdivisions);
    transform(mesh, place);
    append(scene, mesh, place.file);
  }
  return scene;
}

Scene from_bare_mesh(const std::filesystem::path& file) {
  MeshPlacement place;
  place.file = file;
  if (file.extension() == ".bpt") {
    place.rotate_degrees.x = -90;  // these files have z up
  }
  Mesh mesh = load_any_mesh(file, place.subdivisions);
  transform(mesh, place);
  const AutoScene frame = frame_mesh(mesh);
  Scene scene;
  apply(scene, frame.camera, frame.light, frame.background);
  scene.ambient = glm::dvec3(0.12);
  append(scene, mesh, file);
  append(scene, frame.floor, file);
  return scene;
}

/// Maps everything to the unit ball.
void normalise(Scene& scene) {
  const Camera& camera = scene.camera;
  const AreaLight& light = scene.light;
  std::vector<glm::dvec3> points{camera.eye, light.corner, light.corner + light.edge_u,
                                 light.corner + light.edge_v, light.corner + light.edge_u + light.edge_v};
  for (const Triangle& t : scene.triangles) {
    points.insert(points.end(), {t.v0, t.v0 + t.e1, t.v0 + t.e2});
  }
  const Placement place = place_in_ball(points);
  scene.camera.eye = place.point(scene.camera.eye);
  scene.camera.look_at = place.point(scene.camera.look_at);
  scene.light.corner = place.point(scene.light.corner);
  scene.light.edge_u *= place.scale;
  scene.light.edge_v *= place.scale;
  for (Triangle& t : scene.triangles) {
    t = place.triangle(t);
  }
}

void drop_degenerate(Scene& scene) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < scene.triangles.size(); ++k) {
    if (!is_degenerate(scene.triangles[k])) {
      scene.triangles[kept] = scene.triangles[k];
      scene.surfaces[kept] = scene.surfaces[k];
      ++kept;
    }
  }
  scene.degenerate_dropped = scene.triangles.size() - kept;
  scene.triangles.resize(kept);
  scene.surfaces.resize(kept);
}

/// The eye, and points of triangles moved by the offset. A device's u' and v' carry rounding errors of some
/// 2^-16, which may put a point outside its triangle: 2^-8 of an edge (at most 2 long) is ample.
double origin_bound(const Scene& scene) {
  double bound = 0;
  for (const Triangle& t : scene.triangles) {
    for (const glm::dvec3& p : {t.v0, t.v0 + t.e1, t.v0 + t.e2}) {
      bound = std::max(bound, glm::length(p));
    }
  }
  bound += 2.0 / 256;
  return std::max(glm::length(scene.camera.eye), bound + surface_offset(bound, scene.longest_edge));
}

double longest_edge(const std::vector<Triangle>& triangles) {
  double longest = 0;
  for (const Triangle& t : triangles) {
    longest = std::max({longest, glm::length(t.e1), glm::length(t.e2), glm::distance(t.e1, t.e2)});
  }
  return longest;
}

}  // namespace

double surface_offset(double origin_length, double longest_edge) {
  return 0x1p-16 * std::max(2.5 + origin_length / 2, 3 * origin_length + 9 * longest_edge);
}

Scene load_scene(const std::filesystem::path& file) {
  const bool described = file.extension() == ".json";
  Scene scene = described ? from_description(load_scene_file(file)) : from_bare_mesh(file);
  try {
    normalise(scene);
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
  }
  drop_degenerate(scene);
  if (scene.triangles.empty()) {
    throw std::runtime_error(fmt::format("{}: no triangles with an area", file.string()));
  }
  scene.longest_edge = longest_edge(scene.triangles);
  scene.max_origin = origin_bound(scene);
  return scene;
}

}  // namespace raplas
