// The catalogue of numerical traps: docs/stress.md.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "raplas/device.hpp"
#include "raplas/sphere_tree.hpp"
#include "stress_meshes.hpp"

namespace raplas {

/// What must be true of each answer, beside that it is right but for what the error bound explains.
enum class Property : std::uint8_t {
  explained,  ///< nothing else
  moved,      ///< so is, for the scene as given, the true answer of the scene before it was moved
  same_hits,  ///< the same words as with the other order or tree, but for which triangle of a tie
  lower_id,   ///< of triangles with the same words it is the one with the lowest ID
  inside,     ///< from inside a closed mesh every ray hits
  outside,    ///< from outside no ray passes through a closed mesh
  leaves,     ///< rays that leave the surface of a convex mesh, and say so, hit nothing
  grazes,     ///< rays that leave it, or go along it, hit nothing
  refused     ///< or it is refused with one line
};

/// Triangles, what a tree is made of them, and pencils: all in the coordinates of the devices.
struct StressScene {
  std::vector<Triangle> triangles;
  std::vector<Pencil> pencils;
  TreeOptions tree{};
};

/// A scene, and for Property::moved and same_hits another one with the same rays.
struct StressInput {
  StressScene scene;
  StressScene base{};
  std::vector<std::uint32_t> base_of{};  ///< by triangle of `scene`: its index in `base`
};

struct StressCase {
  std::string name;  ///< group.trap
  std::string trap;  ///< what is difficult about it, a few words
  Property property = Property::explained;
  bool control = false;  ///< the property is broken on purpose: what breaks it must be noticed
  bool aligned = false;  ///< rays go through the edges and vertices of a closed mesh: counts for holes
  std::function<StressInput(std::size_t rays, Dice& dice)>
      make;  ///< about so many rays; may throw if refused
};

/// All cases; each name occurs once.
[[nodiscard]] std::vector<StressCase> stress_cases();

/// The groups of the catalogue.
[[nodiscard]] std::vector<StressCase> moved_cases();
[[nodiscard]] std::vector<StressCase> shape_cases();
[[nodiscard]] std::vector<StressCase> ray_cases();
[[nodiscard]] std::vector<StressCase> sphere_cases();
[[nodiscard]] std::vector<StressCase> exponent_cases();
[[nodiscard]] std::vector<StressCase> closed_cases();
[[nodiscard]] std::vector<StressCase> refused_cases();

/// The number of pencils of rows x columns rays that have about so many rays, at least 1.
[[nodiscard]] std::size_t pencils_of(std::size_t rays, int rows = kMaxRows, int columns = kMaxColumns);

[[nodiscard]] double longest_edge_of(const Triangle& triangle);

/// Pencils of 16x16 rays from random points of the ball to points of random triangles; the grid is about
/// `width` times as wide as the triangle is long, or, of every other pencil, as it is high.
[[nodiscard]] std::vector<Pencil> pencils_at(const std::vector<Triangle>& triangles, std::size_t rays,
                                             double width, Dice& dice);

/// An input without a base.
[[nodiscard]] StressInput input_of(std::vector<Triangle> triangles, std::vector<Pencil> pencils,
                                   const TreeOptions& tree = {});

}  // namespace raplas
