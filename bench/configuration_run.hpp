// Runs of configurations on a scene: pictures, errors, clocks, times.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "configuration_list.hpp"
#include "ray_errors.hpp"
#include "recorded.hpp"
#include "session.hpp"

namespace raplas {

/// How the runs are made.
struct RunOptions {
  int width = 256;  ///< of the picture
  int height = 256;
  int shadow = 4;       ///< rays in a row of a shadow pencil
  int repetitions = 7;  ///< of what is timed; 0: nothing is
  bool quiet = false;
};

/// What a configuration gets wrong and takes, on a scene.
struct Measured {
  RayErrors camera;
  RayErrors shadow;
  PictureErrors picture;
  RayClocks camera_clocks;
  RayClocks shadow_clocks;
  std::optional<double> camera_seconds;  ///< a ray, of software
  std::optional<double> shadow_seconds;
  Image image = {};
};

/// A scene prepared for each structure, with its pencils for each size of camera pencils.
struct SceneRuns {
  std::string name;
  std::map<Structure, Prepared> prepared;
  std::map<int, Recorded> recorded;
  std::vector<Measured> measured;  ///< by configuration
};

/// Runs all configurations on the scene in `file`: pictures and errors several at a time, then the times of
/// software one by one.
[[nodiscard]] SceneRuns run_scene(const std::string& file, const std::vector<Configuration>& list,
                                  const RunOptions& options);

}  // namespace raplas
