// The words of the memories: fields as numbers, and packed as the RTL's ports take them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "raplas/constants.hpp"
#include "raplas/vector.hpp"

namespace raplas {

/// A packed word of kBits bits; bit 0 is bit 0 of element 0.
template <int kBits>
using PackedWord = std::array<std::uint32_t, static_cast<std::size_t>((kBits + 31) / 32)>;

/// The largest sphere, vertex or triangle ID.
inline constexpr std::uint32_t kLastId = (std::uint32_t{1} << kIdBits) - 1;

/// Rays of a pencil at most; ray (r, c) is number r * kMaxColumns + c.
inline constexpr std::size_t kMaxRays = std::size_t{kMaxRows} * kMaxColumns;

/// Event counters in the order of raplas::Counter; they wrap at 2^kCounterBits.
using EventCounters = std::array<std::uint32_t, kNumCounters>;

/// Puts the low bits of `value` into a field of a packed word.
template <std::size_t kWords>
constexpr void insert(std::array<std::uint32_t, kWords>& word, Field field, std::uint32_t value) noexcept {
  const auto index = static_cast<std::size_t>(field.lsb / 32);
  const int shift = field.lsb % 32;
  const std::uint64_t mask = ((std::uint64_t{1} << field.width) - 1) << shift;
  const std::uint64_t bits = (std::uint64_t{value} << shift) & mask;
  word[index] = (word[index] & ~static_cast<std::uint32_t>(mask)) | static_cast<std::uint32_t>(bits);
  if (shift + field.width > 32) {
    word[index + 1] =
        (word[index + 1] & ~static_cast<std::uint32_t>(mask >> 32)) | static_cast<std::uint32_t>(bits >> 32);
  }
}

/// A field of a packed word, at most 32 bits.
template <std::size_t kWords>
[[nodiscard]] constexpr std::uint32_t extract(const std::array<std::uint32_t, kWords>& word,
                                              Field field) noexcept {
  const auto index = static_cast<std::size_t>(field.lsb / 32);
  const int shift = field.lsb % 32;
  std::uint64_t bits = word[index];
  if (shift + field.width > 32) {
    bits |= std::uint64_t{word[index + 1]} << 32;
  }
  return static_cast<std::uint32_t>((bits >> shift) & ((std::uint64_t{1} << field.width) - 1));
}

/// Sphere Memory: a node of the tree.
template <typename F>
struct SphereWord {
  Vec3<F> centre;
  F radius;  ///< not negative
  bool leaf = false;
  std::uint32_t count = 0;
  std::uint32_t first = 0;

  [[nodiscard]] PackedWord<SphereLayout::kBits> pack() const noexcept {
    PackedWord<SphereLayout::kBits> word{};
    insert(word, SphereLayout::cx, centre.x.bits());
    insert(word, SphereLayout::cy, centre.y.bits());
    insert(word, SphereLayout::cz, centre.z.bits());
    insert(word, SphereLayout::r, radius.bits());
    insert(word, SphereLayout::leaf, leaf ? 1 : 0);
    insert(word, SphereLayout::count, count);
    insert(word, SphereLayout::first, first);
    return word;
  }
};

/// Triangle Memory.
template <typename F>
struct TriangleWord {
  Vec3<F> v0;
  Vec3<F> e1;
  Vec3<F> e2;
  Vec3<F> n;

  [[nodiscard]] PackedWord<TriangleLayout::kBits> pack() const noexcept {
    PackedWord<TriangleLayout::kBits> word{};
    insert(word, TriangleLayout::v0x, v0.x.bits());
    insert(word, TriangleLayout::v0y, v0.y.bits());
    insert(word, TriangleLayout::v0z, v0.z.bits());
    insert(word, TriangleLayout::e1x, e1.x.bits());
    insert(word, TriangleLayout::e1y, e1.y.bits());
    insert(word, TriangleLayout::e1z, e1.z.bits());
    insert(word, TriangleLayout::e2x, e2.x.bits());
    insert(word, TriangleLayout::e2y, e2.y.bits());
    insert(word, TriangleLayout::e2z, e2.z.bits());
    insert(word, TriangleLayout::nx, n.x.bits());
    insert(word, TriangleLayout::ny, n.y.bits());
    insert(word, TriangleLayout::nz, n.z.bits());
    return word;
  }
};

/// Plane Memory.
template <typename F>
struct PlaneWord {
  Vec3<F> normal;
  F offset;

  [[nodiscard]] PackedWord<PlaneLayout::kBits> pack() const noexcept {
    PackedWord<PlaneLayout::kBits> word{};
    insert(word, PlaneLayout::nx, normal.x.bits());
    insert(word, PlaneLayout::ny, normal.y.bits());
    insert(word, PlaneLayout::nz, normal.z.bits());
    insert(word, PlaneLayout::p, offset.bits());
    return word;
  }
};

/// Ray Memory: a unit direction.
template <typename F>
[[nodiscard]] PackedWord<RayLayout::kBits> pack_ray(const Vec3<F>& direction) noexcept {
  PackedWord<RayLayout::kBits> word{};
  insert(word, RayLayout::dx, direction.x.bits());
  insert(word, RayLayout::dy, direction.y.bits());
  insert(word, RayLayout::dz, direction.z.bits());
  return word;
}

/// Pencil register.
template <typename F>
struct PencilWord {
  std::uint32_t rows = 1;
  std::uint32_t columns = 1;
  Vec3<F> origin;

  [[nodiscard]] PackedWord<PencilLayout::kBits> pack() const noexcept {
    PackedWord<PencilLayout::kBits> word{};
    insert(word, PencilLayout::rows, rows);
    insert(word, PencilLayout::columns, columns);
    insert(word, PencilLayout::ox, origin.x.bits());
    insert(word, PencilLayout::oy, origin.y.bits());
    insert(word, PencilLayout::oz, origin.z.bits());
    return word;
  }
};

/// Scene register.
struct SceneWord {
  std::uint32_t spheres = 0;  ///< in the memory
  std::uint32_t count = 0;    ///< of the root range
  std::uint32_t first = 0;    ///< of the root range

  [[nodiscard]] PackedWord<SceneLayout::kBits> pack() const noexcept {
    PackedWord<SceneLayout::kBits> word{};
    insert(word, SceneLayout::spheres, spheres);
    insert(word, SceneLayout::count, count);
    insert(word, SceneLayout::first, first);
    return word;
  }
};

/// Result Memory: the nearest hit of a ray, in the division-free form.
template <typename F>
struct ResultWord {
  bool hit = false;
  std::uint32_t triangle = 0;
  F t;
  F d;
  F u;
  F v;

  friend constexpr bool operator==(const ResultWord&, const ResultWord&) noexcept = default;

  [[nodiscard]] PackedWord<ResultLayout::kBits> pack() const noexcept {
    PackedWord<ResultLayout::kBits> word{};
    insert(word, ResultLayout::hit, hit ? 1 : 0);
    insert(word, ResultLayout::triangle, triangle);
    insert(word, ResultLayout::t, t.bits());
    insert(word, ResultLayout::d, d.bits());
    insert(word, ResultLayout::u, u.bits());
    insert(word, ResultLayout::v, v.bits());
    return word;
  }

  [[nodiscard]] static ResultWord unpack(const PackedWord<ResultLayout::kBits>& word) noexcept {
    return {extract(word, ResultLayout::hit) != 0,        extract(word, ResultLayout::triangle),
            F::from_bits(extract(word, ResultLayout::t)), F::from_bits(extract(word, ResultLayout::d)),
            F::from_bits(extract(word, ResultLayout::u)), F::from_bits(extract(word, ResultLayout::v))};
  }
};

/// Result Memory of profile raplas. Of certified hits a triangle is *possible* if the ray may hit it in exact
/// arithmetic. All flags are false unless hits are certified: docs/exact.md.
template <typename F>
struct RayHits {
  ResultWord<F> nearest;             ///< the nearest possible hit as computed
  bool crowd = false;                ///< more triangles are possible than the word holds
  bool unsure = false;               ///< the depth isn't known, of none of the possible triangles
  bool rough = false;                ///< nearest's depth is known roughly
  bool rival = false;                ///< another triangle is possible, and may be nearer
  bool rival_rough = false;          ///< the rival's depth is known roughly or not at all
  std::uint32_t rival_triangle = 0;  ///< of a rival

  friend constexpr bool operator==(const RayHits&, const RayHits&) noexcept = default;

  [[nodiscard]] PackedWord<RayHitsLayout::kBits> pack() const noexcept {
    PackedWord<RayHitsLayout::kBits> word{};
    insert(word, RayHitsLayout::hit, nearest.hit ? 1 : 0);
    insert(word, RayHitsLayout::crowd, crowd ? 1 : 0);
    insert(word, RayHitsLayout::unsure, unsure ? 1 : 0);
    insert(word, RayHitsLayout::rough, rough ? 1 : 0);
    insert(word, RayHitsLayout::rival, rival ? 1 : 0);
    insert(word, RayHitsLayout::rival_rough, rival_rough ? 1 : 0);
    insert(word, RayHitsLayout::rival_triangle, rival_triangle);
    insert(word, RayHitsLayout::triangle, nearest.triangle);
    insert(word, RayHitsLayout::t, nearest.t.bits());
    insert(word, RayHitsLayout::d, nearest.d.bits());
    insert(word, RayHitsLayout::u, nearest.u.bits());
    insert(word, RayHitsLayout::v, nearest.v.bits());
    return word;
  }

  [[nodiscard]] static RayHits unpack(const PackedWord<RayHitsLayout::kBits>& word) noexcept {
    const auto flag = [&word](Field field) { return extract(word, field) != 0; };
    const auto number = [&word](Field field) { return F::from_bits(extract(word, field)); };
    return {{flag(RayHitsLayout::hit), extract(word, RayHitsLayout::triangle), number(RayHitsLayout::t),
             number(RayHitsLayout::d), number(RayHitsLayout::u), number(RayHitsLayout::v)},
            flag(RayHitsLayout::crowd),
            flag(RayHitsLayout::unsure),
            flag(RayHitsLayout::rough),
            flag(RayHitsLayout::rival),
            flag(RayHitsLayout::rival_rough),
            extract(word, RayHitsLayout::rival_triangle)};
  }
};

}  // namespace raplas
