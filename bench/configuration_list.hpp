// Whole ways to trace a picture, to be compared with each other.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raplas/device.hpp"
#include "unit_device.hpp"

namespace raplas {

/// What a configuration's scene is made of.
enum class Structure {
  flat,        ///< the paper's list of spheres, of whole triangles
  whole_tree,  ///< a tree of whole triangles
  tree         ///< a tree, large triangles in pieces
};

struct Configuration {
  std::string name;   ///< in the figures' names
  std::string title;  ///< for readers
  Structure structure = Structure::tree;
  int pencil = kMaxRows;  ///< rays in a row of a camera pencil
  std::function<std::unique_ptr<IntersectionDevice>()> make;
  /// Clocks of hardware; neither these nor the device's counter `cycles`: none, it is software.
  std::function<RayClocks(const DeviceScene&, std::span<const Pencil>)> clocks = {};
  std::string netlist = {};  ///< unit of scripts/netlist.py; empty: software
};

/// Was Embree found when this was built?
[[nodiscard]] bool with_embree();

/// All that are compared; the first is double precision.
[[nodiscard]] std::vector<Configuration> configurations();

}  // namespace raplas
