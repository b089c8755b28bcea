#include "raplas/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "test_folder.hpp"

namespace raplas {
namespace {

using Json = nlohmann::json;

/// A valid scene around the mesh m.obj.
Json description() {
  return Json::parse(R"({
    "camera": {"eye": [0, 0, -50], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 40},
    "light": {"corner": [-1, 5, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "intensity": [5, 5, 5]},
    "background": [0, 0, 0],
    "meshes": [{"file": "m.obj"}]})");
}

class SceneFiles : public ::testing::Test {
 protected:
  SceneFiles() { folder_.write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\nf 1 3 4\n"); }

  std::string error_of(const std::string& text) {
    try {
      (void)load_scene(folder_.write("scene.json", text));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  /// The scene with the value at `pointer` replaced must be refused with a line that names the file and
  /// `key`.
  void expect_refused(const std::string& pointer, const Json& value, const std::string& key) {
    Json scene = description();
    scene[Json::json_pointer(pointer)] = value;
    const std::string error = error_of(scene.dump());
    EXPECT_NE(error.find("scene.json: " + key), std::string::npos) << pointer << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }

  TestFolder folder_;
};

TEST_F(SceneFiles, NormalisesEverythingIntoTheUnitBall) {
  ASSERT_EQ(error_of(description().dump()), "");
  const Scene scene = load_scene(folder_.path() / "scene.json");
  ASSERT_EQ(scene.triangles.size(), 2U);
  EXPECT_EQ(scene.degenerate_dropped, 1U);
  double farthest = glm::length(scene.camera.eye);
  for (const Triangle& t : scene.triangles) {
    for (const glm::dvec3& p : {t.v0, t.v0 + t.e1, t.v0 + t.e2}) {
      farthest = std::max(farthest, glm::length(p));
      EXPECT_LE(glm::length(p) + surface_offset(glm::length(p), scene.longest_edge), scene.max_origin);
    }
  }
  for (const double u : {0.0, 1.0}) {
    for (const double v : {0.0, 1.0}) {
      farthest = std::max(farthest,
                          glm::length(scene.light.corner + u * scene.light.edge_u + v * scene.light.edge_v));
    }
  }
  EXPECT_LE(farthest, 1 - 1.0 / 64 + 1e-12);
  EXPECT_GT(farthest, 0.9);
  EXPECT_LE(glm::length(scene.camera.eye), scene.max_origin);
  EXPECT_LE(scene.max_origin, 1);
  EXPECT_NEAR(scene.longest_edge, std::sqrt(2.0) / 2 * glm::length(scene.light.edge_u), 1e-12);
  // One scale for all: the square's side and the light's edge keep their ratio of 1 to 2.
  EXPECT_NEAR(glm::length(scene.triangles[0].e1) * 2, glm::length(scene.light.edge_u), 1e-12);
}

TEST_F(SceneFiles, PlacesMeshesByScaleThenTurnsThenTranslation) {
  Json scene = description();
  scene["meshes"][0] = {
      {"file", "m.obj"}, {"scale", 2}, {"rotate_z", 90}, {"translate", {0, 0, 3}}, {"colour", {1, 0, 0}}};
  ASSERT_EQ(error_of(scene.dump()), "");
  const Scene placed = load_scene(folder_.path() / "scene.json");
  const double unit = glm::length(placed.light.edge_u) / 2;
  // Edge (1, 0, 0) becomes (0, 2, 0).
  EXPECT_LT(glm::distance(placed.triangles[0].e1, glm::dvec3(0, 2 * unit, 0)), 1e-12);
  EXPECT_NEAR(placed.triangles[0].v0.z - placed.camera.eye.z, 53 * unit, 1e-12);
  EXPECT_EQ(placed.surfaces[0].colour, glm::dvec3(1, 0, 0));
}

TEST_F(SceneFiles, RefusesUnknownMissingAndWrongKeys) {
  expect_refused("/camara", 1, "camara");
  expect_refused("/camera/zoom", 1, "camera.zoom");
  expect_refused("/camera", 1, "camera");
  expect_refused("/camera/eye", {1, 2}, "camera.eye");
  expect_refused("/camera/eye", {1, 2, "3"}, "camera.eye[2]");
  expect_refused("/camera/eye", {1, nullptr, 3}, "camera.eye[1]");
  expect_refused("/camera/eye", {1e300, 0, 0}, "camera.eye[0]");
  expect_refused("/camera/up", {0, 0, 1}, "camera.up");
  expect_refused("/camera/fov_degrees", 0, "camera.fov_degrees");
  expect_refused("/light/edge_v", {0, 0, 0}, "light.edge_v");
  expect_refused("/light/edge_v", {1, 0, 1}, "light.edge_v");
  expect_refused("/light/intensity", {1, 1, -1}, "light.intensity[2]");
  expect_refused("/meshes", Json::array(), "meshes");
  expect_refused("/meshes/0/file", 7, "meshes[0].file");
  expect_refused("/meshes/0/scale", 0, "meshes[0].scale");
  expect_refused("/meshes/0/subdivisions", 2.5, "meshes[0].subdivisions");
  expect_refused("/meshes/0/subdivisions", 65, "meshes[0].subdivisions");
  for (const char* key : {"camera", "light", "background", "meshes"}) {
    Json scene = description();
    scene.erase(key);
    EXPECT_NE(error_of(scene.dump()).find(std::string(key) + ": missing"), std::string::npos);
  }
  EXPECT_NE(error_of("{\"camera\": ").find("not a JSON file"), std::string::npos);
  EXPECT_NE(error_of("{\"camera\": 1e999}").find("not a JSON file"), std::string::npos);
  EXPECT_NE(error_of("[]").find("must be a JSON object"), std::string::npos);
}

TEST_F(SceneFiles, NamesTheMeshFileThatIsMissing) {
  Json scene = description();
  scene["meshes"][0]["file"] = "gone.obj";
  EXPECT_NE(error_of(scene.dump()).find("gone.obj: no such file"), std::string::npos);
}

TEST_F(SceneFiles, RefusesASceneOfDegenerateTrianglesOnly) {
  folder_.write("m.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_NE(error_of(description().dump()).find("no triangles with an area"), std::string::npos);
}

TEST_F(SceneFiles, BareMeshGetsAFloorBelowAndALightThatSeesIt) {
  const Scene scene =
      load_scene(folder_.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 2 3 4\n"));
  ASSERT_EQ(scene.triangles.size(), 5U);
  const glm::dvec3 shines = glm::cross(scene.light.edge_u, scene.light.edge_v);
  for (const Triangle& t : scene.triangles) {
    EXPECT_GT(glm::dot(shines, t.v0 - scene.light.corner), 0);
  }
  EXPECT_NEAR(glm::normalize(glm::cross(scene.triangles[4].e1, scene.triangles[4].e2)).y, 1, 1e-9);
}

TEST(BundledScene, HasTheBoxAndTheTeapotOnItsFloor) {
  const Scene scene = load_scene(RAPLAS_SCENES "/cornell_teapot.json");
  EXPECT_GE(scene.triangles.size(), 1000U);
  EXPECT_LE(scene.triangles.size(), 1300U);
  EXPECT_EQ(scene.degenerate_dropped, 0U);
  // 16 triangles of the box come first, its floor's first; the teapot's lowest point is on it.
  const double floor = scene.triangles[0].v0.y;
  double lowest = 1;
  for (std::size_t k = 16; k < scene.triangles.size(); ++k) {
    const Triangle& t = scene.triangles[k];
    lowest = std::min({lowest, t.v0.y, t.v0.y + t.e1.y, t.v0.y + t.e2.y});
  }
  EXPECT_NEAR(lowest, floor, 1e-3);
}

}  // namespace
}  // namespace raplas
