// exact_hits: that the hits of an exact device are those of double precision, and what that costs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "figure_file.hpp"
#include "parallel.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "scene_options.hpp"
#include "scene_pencils.hpp"
#include "session.hpp"

namespace raplas {
namespace {

/// Pencils that a device gets together.
constexpr std::size_t kBatch = 512;

struct CommandLine : SceneOptions {
  int tile = 16;
  std::string device = "model";
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

/// Devices for as many threads as need them at a time.
class DevicePool {
 public:
  DevicePool(const DeviceScene& scene, std::string name) : scene_(scene), name_(std::move(name)) {}

  [[nodiscard]] std::unique_ptr<Devices> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        auto devices = std::move(free_.back());
        free_.pop_back();
        return devices;
      }
    }
    return std::make_unique<Devices>(scene_, name_);
  }
  void give_back(std::unique_ptr<Devices> devices) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(devices));
  }

 private:
  const DeviceScene& scene_;
  std::string name_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Devices>> free_;
};

std::uint64_t cycles(const IntersectionDevice& device) {
  return device.counters()[static_cast<std::size_t>(Counter::cycles)];
}

Retests since(const Retests& before, const Retests& now) {
  return {now.rays - before.rays, now.hits - before.hits, now.rivals - before.rivals,
          now.traced - before.traced, now.seconds - before.seconds};
}

/// Traces pencils by all three and compares.
Measured compare(Devices& devices, std::span<const Pencil> pencils, Hits& expected) {
  Measured m;
  const auto start = std::chrono::steady_clock::now();
  expected = devices.reference->trace(pencils);
  m.reference_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Retests retests_before = devices.exact->retests();
  const std::uint64_t exact_before = cycles(*devices.exact);
  const std::uint64_t plain_before = cycles(*devices.plain);
  const Hits exact = devices.exact->trace(pencils);
  const Hits plain = devices.plain->trace(pencils);
  m.retests = since(retests_before, devices.exact->retests());
  m.clocks = cycles(*devices.exact) - exact_before;
  m.plain_clocks = cycles(*devices.plain) - plain_before;
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

Measured measure(DevicePool& pool, std::span<const Pencil> pencils, bool quiet, const std::string& what,
                 Hits& expected) {
  expected.resize(pencils.size());
  const std::size_t batches = (pencils.size() + kBatch - 1) / kBatch;
  std::vector<Measured> measured(batches);
  Progress progress(what, quiet);
  for_each_parallel(
      batches,
      [&](std::size_t k) {
        std::unique_ptr<Devices> devices = pool.take();
        const auto batch = pencils.subspan(k * kBatch, std::min(kBatch, pencils.size() - k * kBatch));
        Hits hits;
        measured[k] = compare(*devices, batch, hits);
        std::move(hits.begin(), hits.end(), expected.begin() + static_cast<std::ptrdiff_t>(k * kBatch));
        pool.give_back(std::move(devices));
      },
      [&](double done) { progress.show(done); });
  Measured sum;
  for (const Measured& m : measured) {
    sum.add(m);
  }
  return sum;
}

/// Figures and a line of the table.
void report(const std::string& name, const Measured& m, FigureFile& figures) {
  const auto figure = [&](const char* key, const auto& value, const char* unit) {
    figures.add(name + "." + key, value, unit);
  };
  const double retested = percent(m.retests.traced, m.rays);
  const double rivals = percent(m.retests.rivals, m.rays);
  const double clocks = per(m.clocks, m.rays);
  const double plain_clocks = per(m.plain_clocks, m.rays);
  const double host = m.reference_seconds > 0 ? 100 * m.retests.seconds / m.reference_seconds : 0;
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
  check_names(line.scenes);
  FigureFile figures(line.json, command);
  fmt::print("{:<38}{:>12}{:>10}{:>10}{:>12}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "rays", "hit, %", "differ",
             "24 bit", "2 tests", "traced", "clocks", "exact", "host");
  fmt::print("{:<38}{:>12}{:>10}{:>10}{:>12}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "", "", "", "wrong, %",
             "%", "%", "a ray", "a ray", "% of dbl");
  Measured all;
  for (const std::string& scene_file : line.scenes) {
    Settings settings;
    settings.scene = scene_file;
    const Prepared prepared = prepare(settings);
    const std::string name = "exact." + scene_name(scene_file);
    DevicePool pool(prepared.tree.scene, line.device);
    const auto measure_kind = [&](const char* kind, std::span<const Pencil> pencils, Hits& hits) {
      const Measured m = measure(pool, pencils, line.quiet, name + "." + kind, hits);
      report(name + "." + kind, m, figures);
      all.add(m);
    };
    const std::vector<Pencil> camera = camera_pencils(prepared.scene.camera, line.width, line.height);
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
  report("exact", all, figures);
  figures.commit();
  return all.differing == 0 ? 0 : 1;
}

int parse_and_run(int argc, char** argv) {
  constexpr int kMaxSide = 16384;
  CLI::App app{"Compare the hits of an exact device with double precision", "exact_hits"};
  CommandLine line;
  line.width = 1024;
  line.height = 1024;
  add_options(app, line);
  app.add_option("--tile", line.tile,
                 "shadow and hemisphere pencils of one pixel in so many rows and columns")
      ->check(CLI::Range(1, kMaxSide))
      ->capture_default_str();
  app.add_option("--device", line.device, "what traces the rays")
      ->check(CLI::IsMember({"model", "rtl"}))
      ->capture_default_str();
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
