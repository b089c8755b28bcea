// The strict reader of JSON scene files.
#include "raplas/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "raplas/bezier.hpp"

namespace raplas {
namespace {

using Json = nlohmann::json;

/// An object of the file that knows its place in it, for messages.
class Section {
 public:
  Section(const std::filesystem::path& file, std::string path, const Json& json)
      : file_(file), path_(std::move(path)), json_(json) {
    if (!json.is_object()) {
      fail(path_, "must be an object");
    }
  }

  void allow_only(std::initializer_list<const char*> keys) const {
    for (const auto& [key, value] : json_.items()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        fail(key_path(key), "unknown key");
      }
    }
  }

  [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }

  [[nodiscard]] const Json& at(const char* key) const {
    if (!has(key)) {
      fail(key_path(key), "missing");
    }
    return json_.at(key);
  }

  [[nodiscard]] Section section(const char* key) const { return {file_, key_path(key), at(key)}; }

  [[nodiscard]] double number(const char* key, double low, double high) const {
    return checked(at(key), key_path(key), low, high);
  }

  [[nodiscard]] std::string text(const char* key) const {
    if (!at(key).is_string()) {
      fail(key_path(key), "must be a string");
    }
    return at(key).get<std::string>();
  }

  /// Three numbers in low .. high.
  [[nodiscard]] glm::dvec3 vector(const char* key, double low = -kHuge, double high = kHuge) const {
    const Json& value = at(key);
    if (!value.is_array() || value.size() != 3) {
      fail(key_path(key), "must be an array of 3 numbers");
    }
    glm::dvec3 v(0);
    for (std::size_t k = 0; k < 3; ++k) {
      v[static_cast<int>(k)] = checked(value[k], fmt::format("{}[{}]", key_path(key), k), low, high);
    }
    return v;
  }

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw std::runtime_error(fmt::format("{}: {}: {}", file_.string(), where, what));
  }

  [[nodiscard]] std::string key_path(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
  }

  static constexpr double kHuge = 1e30;

 private:
  [[nodiscard]] double checked(const Json& value, const std::string& where, double low, double high) const {
    if (!value.is_number()) {
      fail(where, "must be a number");
    }
    const auto x = value.get<double>();
    if (!(x >= low && x <= high)) {
      fail(where, fmt::format("{} is not in {} to {}", x, low, high));
    }
    return x;
  }

  const std::filesystem::path& file_;
  std::string path_;
  const Json& json_;
};

constexpr double kMaxRadiance = 1e6;

Camera read_camera(const Section& s) {
  s.allow_only({"eye", "look_at", "up", "fov_degrees"});
  const Camera camera{s.vector("eye"), s.vector("look_at"), s.vector("up"), s.number("fov_degrees", 1, 170)};
  const glm::dvec3 axis = camera.look_at - camera.eye;
  const double size = glm::length(axis) * glm::length(camera.up);
  if (!(glm::length(glm::cross(axis, camera.up)) > 1e-9 * size)) {
    s.fail(s.key_path("up"), "eye, look_at and up must not lie on one line");
  }
  return camera;
}

AreaLight read_light(const Section& s) {
  s.allow_only({"corner", "edge_u", "edge_v", "intensity"});
  const AreaLight light{s.vector("corner"), s.vector("edge_u"), s.vector("edge_v"),
                        s.vector("intensity", 0, kMaxRadiance)};
  const double size = glm::length(light.edge_u) * glm::length(light.edge_v);
  if (!(size > 0) || std::abs(glm::dot(light.edge_u, light.edge_v)) > 1e-6 * size) {
    s.fail(s.key_path("edge_v"), "must be at a right angle to edge_u, and neither may be zero");
  }
  return light;
}

MeshPlacement read_mesh(const Section& s, const std::filesystem::path& folder) {
  s.allow_only({"file", "scale", "rotate_x", "rotate_y", "rotate_z", "translate", "colour", "subdivisions"});
  MeshPlacement mesh;
  mesh.file = folder / s.text("file");
  if (s.has("scale")) {
    mesh.scale = s.number("scale", 1e-12, 1e12);
  }
  int axis = 0;
  for (const char* key : {"rotate_x", "rotate_y", "rotate_z"}) {
    mesh.rotate_degrees[axis++] = s.has(key) ? s.number(key, -360, 360) : 0.0;
  }
  if (s.has("translate")) {
    mesh.translate = s.vector("translate");
  }
  if (s.has("colour")) {
    mesh.colour = s.vector("colour", 0, 1);
  }
  if (s.has("subdivisions")) {
    if (!s.at("subdivisions").is_number_integer()) {
      s.fail(s.key_path("subdivisions"), "must be a whole number");
    }
    mesh.subdivisions = static_cast<int>(s.number("subdivisions", 1, 64));
  }
  return mesh;
}

/// The first line of the parser's message, without its prefix "[json.exception...] ".
std::string parse_cause(const Json::exception& error) {
  std::string text = error.what();
  const std::size_t prefix = text.find("] ");
  text = prefix == std::string::npos ? text : text.substr(prefix + 2);
  return text.substr(0, text.find('\n'));
}

}  // namespace

SceneDescription load_scene_file(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw std::runtime_error(fmt::format(
        "{}: {}", file.string(), std::filesystem::exists(file) ? "cannot be opened" : "no such file"));
  }
  Json json;
  try {
    json = Json::parse(in);
  } catch (const Json::exception& error) {
    throw std::runtime_error(fmt::format("{}: not a JSON file: {}", file.string(), parse_cause(error)));
  }
  if (!json.is_object()) {
    throw std::runtime_error(fmt::format("{}: must be a JSON object", file.string()));
  }
  const Section s(file, "", json);
  s.allow_only({"camera", "light", "background", "ambient", "meshes"});
  SceneDescription scene;
  scene.camera = read_camera(s.section("camera"));
  scene.light = read_light(s.section("light"));
  scene.background = s.vector("background", 0, kMaxRadiance);
  if (s.has("ambient")) {
    scene.ambient = s.vector("ambient", 0, kMaxRadiance);
  }
  const Json& meshes = s.at("meshes");
  if (!meshes.is_array() || meshes.empty()) {
    s.fail("meshes", "must be an array of at least one object");
  }
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    scene.meshes.push_back(
        read_mesh(Section(file, fmt::format("meshes[{}]", k), meshes[k]), file.parent_path()));
  }
  return scene;
}

Mesh load_any_mesh(const std::filesystem::path& file, int subdivisions) {
  return file.extension() == ".bpt" ? tessellate(load_patches(file), subdivisions) : load_mesh(file);
}

}  // namespace raplas
