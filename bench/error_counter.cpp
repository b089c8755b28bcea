#include "error_counter.hpp"

#include <algorithm>

namespace raplas {

std::optional<Quantiles> quantiles(std::vector<double> values) {
  if (values.empty()) {
    return std::nullopt;
  }
  const auto at = [&](std::size_t percent) {
    const std::size_t rank = (values.size() * percent + 99) / 100;  // 1 .. size
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  return Quantiles{at(50), at(99), at(100)};
}

RayVerdict compare_nearest(const ReferencePair* nearest, const ReferencePair* found) {
  if (nearest == nullptr || found == nullptr) {
    return nearest == found ? RayVerdict::right
                            : (found == nullptr ? RayVerdict::missed : RayVerdict::false_hit);
  }
  const bool as_near =
      found->verdict == Verdict::hit && found->t - found->t_error <= nearest->t + nearest->t_error;
  return as_near ? RayVerdict::right : RayVerdict::other;
}

}  // namespace raplas
