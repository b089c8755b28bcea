// The one interface behind which every tracer stands: double precision, golden model, RTL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raplas/constants.hpp"

namespace raplas {

/// A triangle: vertex and the two edges that start there. Its ID is its index.
struct Triangle {
  glm::dvec3 v0;
  glm::dvec3 e1;
  glm::dvec3 e2;
};

/// Barycentric coordinates of pieces are multiples of 1 / kPieceUnit.
inline constexpr std::uint16_t kPieceUnit = 1U << 15;

/// A part of a triangle, with corners V0 + (a E1 + b E2) / kPieceUnit. Tests see its corners for the
/// triangle's; rays hit the triangle.
struct Piece {
  struct Corner {
    std::uint16_t a;
    std::uint16_t b;
    friend bool operator==(const Corner&, const Corner&) = default;
  };
  std::uint32_t triangle;
  std::array<Corner, 3> corners{{{0, 0}, {kPieceUnit, 0}, {0, kPieceUnit}}};  ///< all of it
};

/// A node of the sphere tree. Its children are the contiguous range first .. first + count - 1:
/// pieces of triangles in a leaf, otherwise nodes.
struct SphereNode {
  glm::dvec3 centre;
  double radius;  ///< encloses every piece below, measured around `centre`; the devices enlarge it
  bool leaf;
  std::uint32_t first;
  std::uint32_t count;  ///< 1 .. 127
};

/// What a device keeps in its Sphere and Triangle memories.
struct DeviceScene {
  std::vector<Triangle> triangles;
  std::vector<SphereNode> nodes;
  std::uint32_t root_first = 0;  ///< root range: a flat list is all nodes
  std::uint32_t root_count = 0;
  double max_origin = 0;           ///< no pencil starts farther from the coordinates' zero than this
  std::vector<Piece> pieces = {};  ///< what leaves are ranges of; none: whole triangles, by their IDs

  /// Number of things that leaves are ranges of.
  [[nodiscard]] std::size_t piece_count() const { return pieces.empty() ? triangles.size() : pieces.size(); }
  [[nodiscard]] Piece piece(std::uint32_t k) const { return pieces.empty() ? Piece{k} : pieces[k]; }
};

/// n.x + offset = 0, n of unit length.
struct Plane {
  glm::dvec3 normal;
  double offset;
};

/// Rays from one origin through a grid of rows x columns points (each 1 .. 16).
struct Pencil {
  glm::dvec3 origin{0};
  int rows = 0;
  int columns = 0;
  std::vector<Plane> row_planes;       ///< plane r holds the rays of row r
  std::vector<Plane> column_planes;    ///< plane c holds the rays of column c
  std::vector<glm::dvec3> directions;  ///< unit length, ray (r, c) at r * columns + c
  glm::dvec3 axis{0};                  ///< unit normal of the grid's plane, towards the grid
  glm::dvec3 front{0};                 ///< unit normal of the surface that the rays leave, if any
  double far = std::numeric_limits<double>::infinity();  ///< hits deeper along the axis need not be found
  bool any_hit = false;                                  ///< a hit is enough, it need not be the nearest
};

/// The nearest hit of a ray in the division-free form: t = t_scale * t_scaled / d, u = u_scaled / d,
/// v = v_scaled / d.
/// Values of the 24-bit devices are exact here, so that two devices agree bit by bit if these are equal.
struct Hit {
  bool hit = false;
  std::uint32_t triangle = 0;
  double t_scaled = 0;
  double d = 0;  ///< |N.D| > 0 for a hit
  double u_scaled = 0;
  double v_scaled = 0;
  double t_scale = 1;  ///< length of the direction that the device used

  [[nodiscard]] double t() const noexcept { return t_scale * t_scaled / d; }
  friend bool operator==(const Hit&, const Hit&) = default;
};

/// Event counts since the scene was loaded, in the order of raplas::Counter.
using Counters = std::array<std::uint64_t, kNumCounters>;

/// Rays of an exact device by what the host did for them in double precision.
struct Retests {
  std::uint64_t rays = 0;    ///< all
  std::uint64_t hits = 0;    ///< it tested the triangle that the unit found: t, u and v are the host's
  std::uint64_t rivals = 0;  ///< and another one that the unit couldn't tell from it
  std::uint64_t traced = 0;  ///< all triangles, through the sphere tree
  double seconds = 0;        ///< of all that
};

/// An accelerator that holds one scene and traces pencils through it.
class IntersectionDevice {
 public:
  virtual ~IntersectionDevice() = default;

  /// Loads the scene's memories. Throws std::runtime_error with a one-line reason if it doesn't fit or holds
  /// a number outside the device's format.
  virtual void load(const DeviceScene& scene) = 0;

  /// Traces pencils; they may overlap in the device. For each pencil one hit for each ray, in the order of
  /// Pencil::directions. Hits at a depth along the axis of more than Pencil::far may be among them, except
  /// that of a pencil with any_hit every hit lies before far (1 + 2^-8).
  [[nodiscard]] virtual std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) = 0;
  [[nodiscard]] std::vector<Hit> trace(const Pencil& pencil) { return trace(std::span(&pencil, 1)).front(); }

  /// Counts since load().
  [[nodiscard]] virtual Counters counters() const = 0;

  /// Clocks simulated by trace(), pencils written and results read included; 0 if nothing is simulated.
  [[nodiscard]] virtual std::uint64_t simulated_clocks() const { return 0; }

  /// Of an exact device, since load(): what the host had to test itself.
  [[nodiscard]] virtual Retests retests() const { return {}; }

  /// Pencils since load() that were not given to the unit, as they miss the spheres of the root range.
  [[nodiscard]] virtual std::uint64_t skipped_pencils() const { return 0; }
};

/// What a device is an instance of: the paper's unit, or all that has been learnt since.
enum class Profile { paper, raplas };

/// How a device is built.
struct DeviceOptions {
  Profile profile = Profile::raplas;
  std::size_t sphere_depth = 1U << 20;  ///< words of the Sphere Memory; XC4VSX35: 4096
  std::size_t triangle_depth = 1U << 20;
  bool exact = false;  ///< the hits of double precision, whatever the unit computes in (profile raplas)
};

/// Makes the device called `name` (reference, model, rtl); throws std::runtime_error for an unknown name,
/// listing the known ones.
[[nodiscard]] std::unique_ptr<IntersectionDevice> make_device(const std::string& name,
                                                              const DeviceOptions& options);

}  // namespace raplas
