// Reading meshes by assimp, with the checks that assimp leaves out.
#include "raplas/mesh.hpp"

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "obj_check.hpp"

namespace raplas {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& cause) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), cause));
}

/// assimp's message as part of one line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) {
    text.pop_back();
  }
  return text;
}

/// Checks what assimp's importers don't: indices in range, finite coordinates.
void check(const std::filesystem::path& file, const aiMesh& part) {
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= part.mNumVertices) {
        fail(file, fmt::format("face {} has the vertex index {}, out of range 0 to {}", f,
                               static_cast<int>(face.mIndices[k]), static_cast<long>(part.mNumVertices) - 1));
      }
    }
  }
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      fail(file, fmt::format("vertex {} is ({}, {}, {}), not finite", i, p.x, p.y, p.z));
    }
  }
}

glm::dvec3 colour_of(const aiMaterial& material) {
  aiColor4D colour(0.7F, 0.7F, 0.7F, 1.0F);
  if (material.Get(AI_MATKEY_BASE_COLOR, colour) != aiReturn_SUCCESS) {
    material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  }
  return glm::clamp(glm::dvec3(colour.r, colour.g, colour.b), 0.0, 1.0);
}

/// Appends one part of the scene, placed by `matrix`.
void append(const std::filesystem::path& file, const aiMesh& part, const aiMatrix4x4t<double>& matrix,
            Mesh& mesh) {
  const std::size_t base = mesh.vertices.size();
  if (base + part.mNumVertices > std::numeric_limits<std::uint32_t>::max()) {
    fail(file, "more than 2^32 vertices");
  }
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    const aiVector3t<double> q = matrix * aiVector3t<double>(p.x, p.y, p.z);
    mesh.vertices.emplace_back(q.x, q.y, q.z);
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices == 3) {
      const auto index = [&](unsigned k) { return static_cast<std::uint32_t>(base + face.mIndices[k]); };
      mesh.triangles.push_back({index(0), index(1), index(2)});
      mesh.colour_of.push_back(part.mMaterialIndex);
    }
  }
}

void append_node(const std::filesystem::path& file, const aiScene& scene, const aiNode& node,
                 const aiMatrix4x4t<double>& parent, Mesh& mesh) {
  const aiMatrix4x4& m = node.mTransformation;
  const aiMatrix4x4t<double> matrix =
      parent * aiMatrix4x4t<double>(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
                                    m.d1, m.d2, m.d3, m.d4);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    append(file, *scene.mMeshes[node.mMeshes[i]], matrix, mesh);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    append_node(file, scene, *node.mChildren[i], matrix, mesh);
  }
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& file) {
  if (!std::ifstream(file)) {
    fail(file, std::filesystem::exists(file) ? "cannot be opened" : "no such file");
  }
  if (std::filesystem::is_directory(file)) {
    fail(file, "is a folder, not a mesh");
  }
  if (file.extension() == ".obj") {
    check_obj_vertices(file);
  }
  Assimp::Importer importer;
  // Nothing is post-processed before the indices are checked: assimp's steps take them as given.
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (scene == nullptr) {
    fail(file, fmt::format("not a mesh ({})", one_line(importer.GetErrorString())));
  }
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    check(file, *scene->mMeshes[i]);
  }
  Mesh mesh;
  if (scene->mNumMeshes > 0) {
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (scene == nullptr) {
      fail(file, fmt::format("cannot be made into triangles ({})", one_line(importer.GetErrorString())));
    }
    append_node(file, *scene, *scene->mRootNode, aiMatrix4x4t<double>(), mesh);
    for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
      mesh.colours.push_back(colour_of(*scene->mMaterials[i]));
    }
  }
  if (mesh.triangles.empty()) {
    fail(file, "no triangles");
  }
  return mesh;
}

}  // namespace raplas
