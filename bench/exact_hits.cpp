// exact_hits: that the hits of an exact device are those of double precision, and what that costs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "parallel.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "raplas/output_file.hpp"
#include "scene_pencils.hpp"
#include "session.hpp"

namespace raplas {
namespace {

/// Pencils that a device gets together.
constexpr std::size_t kBatch = 512;

struct CommandLine {
  std::vector<std::string> scenes;
  int width = 1024;
  int height = 1024;
  int tile = 16;
  std::string device = "model";
  std::string json;  ///< empty: none
  bool quiet = false;
};

/// What was measured of pencils of one kind.
struct Measured {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;  ///< in double precision
  std::uint64_t differing =
      0;  ///< hits that are not those of double precision, bit by bit; of any-hit ones whether
  Retests retests;
  std::uint64_t clocks = 0;        ///< of the exact device
  std::uint64_t plain_clocks = 0;  ///< of the same device if it isn't exact
  std::uint64_t plain_wrong = 0;   ///< its rays with another triangle, or hit or missed wrongly
  double reference_seconds = 0;    ///< of one core, in double precision

  void add(const Measured& m) {
    rays += m.rays;
    hits += m.hits;
    differing += m.differing;
    retests.rays += m.retests.rays;
    retests.hits += m.retests.hits;
    retests.rivals += m.retests.rivals;
    retests.traced += m.retests.traced;
    retests.seconds += m.retests.seconds;
    clocks += m.clocks;
    plain_clocks += m.plain_clocks;
    plain_wrong += m.plain_wrong;
    reference_seconds += m.reference_seconds;
  }
};

double percent(std::uint64_t count, std::uint64_t of) {
  return of == 0 ? 0 : 100 * static_cast<double>(count) / static_cast<double>(of);
}

double per(double sum, std::uint64_t of) { return of == 0 ? 0 : sum / static_cast<double>(of); }

using Hits = std::vector<std::vector<Hit>>;

/// A device of each kind, with its scene.
struct Devices {
  Devices(const DeviceScene& scene, const std::string& name) {
    DeviceOptions options;
    plain = make_device(name, options);
    options.exact = true;
    exact = make_device(name, options);
    reference = make_device("reference", {});
    for (const auto& device : {plain.get(), exact.get(), reference.get()}) {
      device->load(scene);
    }
  }

  std::unique_ptr<IntersectionDevice> plain;
  std::unique_ptr<IntersectionDevice> exact;
  std::unique_ptr<IntersectionDevice> reference;
};

/// Traces pencils by all three and compares.
Measured compare(Devices& devices, std::span<const Pencil> pencils, Hits& expected) {
  Measured m;
  const auto start = std::chrono::steady_clock::now();
  expected = devices.reference->trace(pencils);
  m.reference_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Hits exact = devices.exact->trace(pencils);
  const Hits plain = devices.plain->trace(pencils);
  for (std::size_t k = 0; k < pencils.size(); ++k) {
    for (std::size_t ray = 0; ray < expected[k].size(); ++ray) {
      const Hit& right = expected[k][ray];
      ++m.rays;
      m.hits += right.hit ? 1U : 0U;
      const auto same = [&](const Hit& hit) {
        return hit.hit == right.hit && (pencils[k].any_hit || !hit.hit || hit.triangle == right.triangle);
      };
      const bool equal = pencils[k].any_hit ? same(exact[k][ray]) : exact[k][ray] == right;
      m.differing += equal ? 0U : 1U;
      m.plain_wrong += same(plain[k][ray]) ? 0U : 1U;
    }
  }
  return m;
}

/// Devices keep counts since their scene was loaded; one set of them works for one share of the pencils.
Measured measure(const DeviceScene& scene, std::span<const Pencil> pencils, const CommandLine& line,
                 const std::string& what, Hits& expected) {
  expected.resize(pencils.size());
  constexpr std::size_t kShares = 16;
  const std::size_t share = (pencils.size() + kShares - 1) / kShares;
  std::vector<Measured> measured(kShares);
  Progress progress(what, line.quiet);
  for_each_parallel(
      kShares,
      [&](std::size_t k) {
        Devices devices(scene, line.device);
        const std::size_t begin = std::min(k * share, pencils.size());
        const std::size_t end = std::min(begin + share, pencils.size());
        for (std::size_t first = begin; first < end; first += kBatch) {
          const auto batch = pencils.subspan(first, std::min(kBatch, end - first));
          Hits hits;
          measured[k].add(compare(devices, batch, hits));
          std::move(hits.begin(), hits.end(), expected.begin() + static_cast<std::ptrdiff_t>(first));
        }
        const auto cycles = [](const IntersectionDevice& device) {
          return device.counters()[static_cast<std::size_t>(Counter::cycles)];
        };
        measured[k].retests = devices.exact->retests();
        measured[k].clocks = cycles(*devices.exact);
        measured[k].plain_clocks = cycles(*devices.plain);
      },
      [&](double done) { progress.show(done); });
  Measured sum;
  for (const Measured& m : measured) {
    sum.add(m);
  }
  return sum;
}

/// Figures and a line of the table.
void report(const std::string& name, const Measured& m, nlohmann::ordered_json& json,
            const std::string& command) {
  const auto figure = [&](const char* key, const auto& value, const char* unit) {
    json[name + "." + key] = {{"value", value}, {"unit", unit}, {"command", command}};
  };
  const double retested = percent(m.retests.traced, m.rays);
  const double rivals = percent(m.retests.rivals, m.rays);
  const double clocks = per(static_cast<double>(m.clocks), m.rays);
  const double plain_clocks = per(static_cast<double>(m.plain_clocks), m.rays);
  const double host = 100 * per(m.retests.seconds, 1) / std::max(m.reference_seconds, 1e-9);
  fmt::print("{:<38}{:>12}{:>10.2f}{:>10}{:>12.4f}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.1f}\n", name,
             m.rays, percent(m.hits, m.rays), m.differing, percent(m.plain_wrong, m.rays), rivals, retested,
             plain_clocks, clocks, host);
  figure("rays", m.rays, "rays");
  figure("hits_percent", percent(m.hits, m.rays), "% of rays");
  figure("differing_hits", m.differing, "rays");
  figure("plain_wrong_percent", percent(m.plain_wrong, m.rays), "% of rays");
  figure("rivals_percent", rivals, "% of rays");
  figure("retested_percent", retested, "% of rays");
  figure("plain_clocks", plain_clocks, "clocks/ray");
  figure("clocks", clocks, "clocks/ray");
  figure("host_time_percent", host, "% of the time in double precision");
  std::fflush(stdout);
}

int run(const CommandLine& line, const std::string& command) {
  std::optional<OutputFile> file;
  if (!line.json.empty()) {
    file.emplace(line.json);
  }
  nlohmann::ordered_json json;
  fmt::print("{:<38}{:>12}{:>10}{:>10}{:>12}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "rays", "hit, %", "differ",
             "24 bit", "2 tests", "traced", "clocks", "exact", "host");
  fmt::print("{:<38}{:>12}{:>10}{:>10}{:>12}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "", "", "", "wrong, %",
             "%", "%", "a ray", "a ray", "% of dbl");
  Measured all;
  for (const std::string& scene_file : line.scenes) {
    Settings settings;
    settings.scene = scene_file;
    const Prepared prepared = prepare(settings);
    const DeviceScene& scene = prepared.tree.scene;
    const std::string name = "exact." + settings.scene.stem().string();
    const auto measure_kind = [&](const char* kind, std::span<const Pencil> pencils, Hits& hits) {
      const Measured m = measure(scene, pencils, line, name + "." + kind, hits);
      report(name + "." + kind, m, json, command);
      all.add(m);
    };
    const std::vector<Pencil> camera = camera_pencils(prepared.scene, line.width, line.height);
    Hits hits;
    measure_kind("camera", camera, hits);
    const std::vector<SeenPixel> pixels =
        seen_pixels(prepared.scene, prepared.tree.source, line.width, line.height, line.tile, camera, hits);
    measure_kind("shadow", shadow_pencils(prepared.scene, pixels), hits);
    std::vector<Pencil> hemispheres;
    for (const SeenPixel& pixel : pixels) {
      for (Pencil& pencil : hemisphere_pencils(pixel.point)) {
        hemispheres.push_back(std::move(pencil));
      }
    }
    measure_kind("hemisphere", hemispheres, hits);
  }
  report("exact", all, json, command);
  if (file) {
    file->write(json.dump(2) + "\n");
    file->commit();
  }
  return all.differing == 0 ? 0 : 1;
}

int parse_and_run(int argc, char** argv) {
  constexpr int kMaxSide = 16384;
  CLI::App app{"Compare the hits of an exact device with double precision", "exact_hits"};
  CommandLine line;
  app.add_option("scenes", line.scenes, "scenes (.json) or meshes (.obj .ply .stl .gltf .glb .bpt)")
      ->required();
  app.add_option("--width", line.width, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--height", line.height, "pixels")->check(CLI::Range(1, kMaxSide))->capture_default_str();
  app.add_option("--tile", line.tile,
                 "shadow and hemisphere pencils of one pixel in so many rows and columns")
      ->check(CLI::Range(1, kMaxSide))
      ->capture_default_str();
  app.add_option("--device", line.device, "what traces the rays")
      ->check(CLI::IsMember({"model", "rtl"}))
      ->capture_default_str();
  app.add_option("--json", line.json, "file for figures");
  app.add_flag("--quiet", line.quiet, "no progress");
  if (const auto exit_code = parse(app, argc, argv)) {
    return *exit_code;
  }
  return run(line, command_line(app, argc, argv));
}

}  // namespace
}  // namespace raplas

int main(int argc, char** argv) {
  return raplas::run_program("exact_hits", argc, argv, raplas::parse_and_run);
}
