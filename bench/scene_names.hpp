// Scenes are called as their files' stems.
#pragma once

#include <string>
#include <vector>

namespace raplas {

/// Throws std::runtime_error if two scenes would have figures of the same name.
void check_names(const std::vector<std::string>& scenes);

}  // namespace raplas
