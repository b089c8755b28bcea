// The number behind count_checked(), for the bench's main.
#pragma once

#include <cstdint>

namespace raplas {

[[nodiscard]] std::uint64_t checked();

}  // namespace raplas
