// A check of OBJ files that assimp's reader cannot make: it renumbers vertices and drops unused ones.
#pragma once

#include <filesystem>

namespace raplas {

/// Throws std::runtime_error naming the file, vertex (counted from 1) and line if a "v" line holds a number
/// that isn't finite as a float.
void check_obj_vertices(const std::filesystem::path& file);

}  // namespace raplas
