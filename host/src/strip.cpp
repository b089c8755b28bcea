// Strips: the shortest path through a leaf's triangles.
#include "raplas/strip.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

namespace raplas {
namespace {

using Order = std::vector<std::size_t>;

/// Where the corners of `to` are in `slots`: by slot the corner that stays, 3 for a slot that is free.
std::array<std::size_t, 3> kept_corners(const std::array<FixedVec3, 3>& slots, const FixedTriangle& to) {
  std::array<std::size_t, 3> kept{3, 3, 3};
  std::array<bool, 3> placed{};
  for (std::size_t slot = 0; slot < 3; ++slot) {
    for (std::size_t corner = 0; corner < 3 && kept[slot] == 3; ++corner) {
      if (!placed[corner] && slots[slot] == to.corners[corner]) {
        kept[slot] = corner;
        placed[corner] = true;
      }
    }
  }
  return kept;
}

/// Words of triangle b behind triangle a, at [a * count + b].
std::vector<int> word_counts(std::span<const FixedTriangle> triangles) {
  std::vector<int> words;
  words.reserve(triangles.size() * triangles.size());
  for (const FixedTriangle& from : triangles) {
    for (const FixedTriangle& to : triangles) {
      const auto kept = kept_corners(from.corners, to);
      words.push_back(std::max(1, static_cast<int>(std::count(kept.begin(), kept.end(), std::size_t{3}))));
    }
  }
  return words;
}

/// The order of least words: dynamic programming over sets of triangles and the last one of each.
Order least_order(std::size_t count, const std::vector<int>& words) {
  struct State {
    int words = std::numeric_limits<int>::max() / 2;
    std::size_t before = 0;  ///< the triangle before the last one
  };
  const std::size_t sets = std::size_t{1} << count;
  std::vector<State> states(sets * count);
  for (std::size_t k = 0; k < count; ++k) {
    states[(std::size_t{1} << k) * count + k].words = 3;
  }
  for (std::size_t set = 1; set < sets; ++set) {
    for (std::size_t next = 0; next < count; ++next) {
      if ((set >> next & 1U) != 0) {
        continue;
      }
      State& state = states[(set | std::size_t{1} << next) * count + next];
      for (std::size_t last = 0; last < count; ++last) {
        const int total = states[set * count + last].words + words[last * count + next];
        if (total < state.words) {
          state = {total, last};
        }
      }
    }
  }
  std::size_t set = sets - 1;
  std::size_t last = 0;
  for (std::size_t k = 1; k < count; ++k) {
    last = states[set * count + k].words < states[set * count + last].words ? k : last;
  }
  Order order;
  while (set != 0) {
    order.push_back(last);
    const std::size_t before = states[set * count + last].before;
    set &= ~(std::size_t{1} << last);
    last = before;
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// From each triangle on the nearest one that is left; the best of these orders.
Order greedy_order(std::size_t count, const std::vector<int>& words) {
  Order best;
  int best_words = std::numeric_limits<int>::max();
  for (std::size_t first = 0; first < count; ++first) {
    Order order{first};
    std::vector<bool> used(count);
    used[first] = true;
    int total = 0;
    while (order.size() < count) {
      const std::size_t last = order.back();
      std::size_t next = count;
      for (std::size_t k = 0; k < count; ++k) {
        if (!used[k] && (next == count || words[last * count + k] < words[last * count + next])) {
          next = k;
        }
      }
      total += words[last * count + next];
      used[next] = true;
      order.push_back(next);
    }
    if (total < best_words) {
      best_words = total;
      best = std::move(order);
    }
  }
  return best;
}

}  // namespace

std::vector<VertexWord> make_strip(std::span<const FixedTriangle> triangles) {
  const std::size_t count = triangles.size();
  const std::vector<int> words = word_counts(triangles);
  const Order order = count <= kMaxExactStrip ? least_order(count, words) : greedy_order(count, words);
  std::vector<VertexWord> strip;
  std::array<FixedVec3, 3> slots{};
  for (const std::size_t k : order) {
    const FixedTriangle& triangle = triangles[k];
    auto kept = strip.empty() ? std::array<std::size_t, 3>{3, 3, 3} : kept_corners(slots, triangle);
    if (std::find(kept.begin(), kept.end(), std::size_t{3}) == kept.end()) {
      kept[2] = 3;  // nothing is new, but a word has to close the triangle
    }
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (std::find(kept.begin(), kept.end(), corner) != kept.end()) {
        continue;
      }
      const auto slot =
          static_cast<std::size_t>(std::find(kept.begin(), kept.end(), std::size_t{3}) - kept.begin());
      kept[slot] = corner;
      slots[slot] = triangle.corners[corner];
      strip.push_back({slots[slot], static_cast<std::uint32_t>(slot), false, triangle.id});
    }
    strip.back().emit = true;
  }
  return strip;
}

}  // namespace raplas
