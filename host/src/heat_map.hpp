// Pictures of a number for each tile of another picture.
#pragma once

#include <cstdint>
#include <vector>

#include "raplas/image.hpp"

namespace raplas {

/// A number for each place, rows from the top; all rows equally long.
struct HeatMap {
  int columns = 0;
  std::vector<std::uint64_t> values;
};

/// Black, blue, red, yellow, white from 0 to a top that 1 in 200 numbers exceed (they are white, too); each
/// number 8x8 pixels, below them the ramp with its numbers.
[[nodiscard]] Image draw(const HeatMap& map);

}  // namespace raplas
