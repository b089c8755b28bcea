#include "raplas/mesh.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "test_folder.hpp"

namespace raplas {
namespace {

class MeshFiles : public ::testing::Test {
 protected:
  /// Writes a file and returns the error of loading it, "" if there is none.
  std::string error_of(const std::string& name, const std::string& text) {
    try {
      mesh_ = load_mesh(folder_.write(name, text));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  void expect_error(const std::string& name, const std::string& text, const std::string& part) {
    const std::string error = error_of(name, text);
    EXPECT_NE(error.find(name), std::string::npos) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }

  TestFolder folder_;
  Mesh mesh_;
};

std::string ply(const std::string& x, const std::string& face) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n{} 0 0\n0 1 0\n{}\n",
      x, face);
}

std::string stl(const std::string& x) {
  return fmt::format(
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {} 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n"
      "endsolid a\n",
      x);
}

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(MeshFiles, ReadsObjPolygonsAsTrianglesWithTheirColours) {
  folder_.write("m.mtl", "newmtl red\nKd 0.8 0.1 0.2\n");
  ASSERT_EQ(error_of("m.obj", "mtllib m.mtl\n" + kCorners + "usemtl red\nf 1 2 3 4\n"), "");
  ASSERT_EQ(mesh_.triangles.size(), 2U);
  EXPECT_NEAR(mesh_.colours.at(mesh_.colour_of[1]).r, 0.8, 1e-6);
  EXPECT_NEAR(mesh_.colours.at(mesh_.colour_of[1]).b, 0.2, 1e-6);
}

TEST_F(MeshFiles, ReadsPlyAndStl) {
  EXPECT_EQ(error_of("a.ply", ply("1", "3 0 1 2")), "");
  EXPECT_EQ(mesh_.triangles.size(), 1U);
  EXPECT_EQ(error_of("a.stl", stl("1")), "");
  EXPECT_EQ(mesh_.triangles.size(), 1U);
}

TEST_F(MeshFiles, ReadsGltfWithItsNodesTransforms) {
  // One triangle (0,0,0) (1,0,0) (0,1,0), its node moved by (5, 0, 0).
  ASSERT_EQ(error_of("a.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"translation":[5,0,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"),
            "");
  ASSERT_EQ(mesh_.triangles.size(), 1U);
  EXPECT_EQ(mesh_.vertices[mesh_.triangles[0][1]], glm::dvec3(6, 0, 0));
}

TEST_F(MeshFiles, NamesAMissingFile) {
  EXPECT_THROW((void)load_mesh(folder_.path() / "nothing.obj"), std::runtime_error);
}

TEST_F(MeshFiles, RefusesWhatIsNoMesh) {
  expect_error("empty.obj", "", "not a mesh");
  expect_error("text.ply", "these are words\n", "not a mesh");
  expect_error("text.glb", "these are words, and more of them, not a mesh\n", "not a mesh");
  expect_error("text.xyz", "these are words\n", "not a mesh");
  expect_error("text.obj", "these are words\nand more of them\n", "no triangles");
}

TEST_F(MeshFiles, RefusesMeshesWithoutTriangles) {
  expect_error("points.obj", kCorners, "no triangles");
  expect_error("line.obj", kCorners + "l 1 2\n", "no triangles");
}

TEST_F(MeshFiles, NamesAVertexThatIsNotFinite) {
  expect_error("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 2 (line 2)");
  expect_error("inf.obj", "v 0 0 0\nv 1 0 0\n\nv 0 -inf 0\nf 1 2 3\n", "vertex 3 (line 4)");
  expect_error("big.obj", "v 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 2");
  expect_error("nan.ply", ply("nan", "3 0 1 2"), "vertex 1");
  expect_error("inf.ply", ply("inf", "3 0 1 2"), "vertex 1");
  expect_error("nan.stl", stl("nan"), "vertex 1");
}

TEST_F(MeshFiles, RefusesIndicesOutOfRange) {
  expect_error("high.obj", kCorners + "f 1 2 9\n", "out of range");
  expect_error("zero.obj", kCorners + "f 1 2 0\n", "");
  expect_error("low.obj", kCorners + "f -1 -2 -7\n", "");
  expect_error("high.ply", ply("1", "3 0 1 3"), "out of range");
  expect_error("huge.ply", ply("1", "3 0 1 1000000000"), "out of range");
  expect_error("low.ply", ply("1", "3 0 1 -1"), "out of range");
}

TEST(SmoothNormals, FollowACurveButStopAtACrease) {
  Mesh mesh;
  // Two faces that meet along the edge 0-1 at an angle, then at a right angle.
  for (const double angle : {0.3, M_PI / 2}) {
    mesh.vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-std::cos(angle), 0, std::sin(angle)}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
    const auto normals = smooth_normals(mesh, 45);
    const double turned = std::acos(glm::dot(normals[0][0], normals[0][1 + 0]));
    EXPECT_NEAR(std::acos(std::min(1.0, glm::dot(normals[0][0], glm::dvec3(0, 0, 1)))),
                angle < 1 ? angle / 2 : 0, 1e-6);
    EXPECT_NEAR(turned, angle < 1 ? angle / 2 : 0, 1e-6);
  }
}

}  // namespace
}  // namespace raplas
