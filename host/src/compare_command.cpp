// raplas compare: the same picture by every device of this build.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "figure_file.hpp"
#include "hit_records.hpp"
#include "raplas/output_file.hpp"

namespace raplas {
namespace {

#ifdef RAPLAS_WITH_RTL
constexpr bool kWithRtl = true;
#else
constexpr bool kWithRtl = false;
#endif

/// A run with its picture in 8 bits and its hits.
struct Entry {
  std::string name;
  DeviceRun run;
  std::vector<std::uint8_t> picture;
  std::vector<Hit> hits;
};

Entry trace(const CompareCommand& command, const Prepared& prepared, const std::string& name) {
  Entry entry;
  entry.name = name;
  entry.run = run_device(prepared, command.settings, name, [&entry](std::span<const Hit> hits) {
    entry.hits.insert(entry.hits.end(), hits.begin(), hits.end());
  });
  entry.picture = to_8_bit(entry.run.rendering.image);
  return entry;
}

/// Bits in which the hits differ; a ray that only one of them has counts with all its bits.
std::uint64_t differing_bits(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  const std::size_t common = std::min(a.size(), b.size());
  std::uint64_t bits = kHitBits * (std::max(a.size(), b.size()) - common);
  for (std::size_t k = 0; k < common; ++k) {
    bits += differing_bits(a[k], b[k]);
  }
  return bits;
}

/// The same rays hit something; which triangle, double precision says only of those that aren't any-hit.
bool same_rays_hit(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Hit& x, const Hit& y) { return x.hit == y.hit; });
}

std::uint64_t differing_counters(const Counters& a, const Counters& b) {
  std::uint64_t differing = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    differing += a[k] != b[k] ? 1U : 0U;
  }
  return differing;
}

double rate(std::uint64_t count, double seconds) {
  return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

/// Clocks a second of simulation: all that an RTL device simulates, or the cycles that a model counts.
double simulated_rate(const DeviceRun& run) {
  const std::uint64_t clocks = run.simulated_clocks != 0 ? run.simulated_clocks : run.cycles();
  return rate(clocks, run.rendering.stats.trace_seconds);
}

void print_table(const std::vector<Entry>& entries, const Entry& reference) {
  fmt::print("{:<12}{:>12}{:>14}{:>13}{:>14}{:>14}{:>14}\n", "device", "rays", "cycles", "rays/cycle",
             "cycles/s", "pixels off", "off > 2");
  for (const Entry& e : entries) {
    const double rays_per_cycle = rate(e.run.rays(), static_cast<double>(e.run.cycles()));
    fmt::print("{:<12}{:>12}{:>14}{:>13.4f}{:>14.0f}{:>14}{:>14}\n", e.name, e.run.rays(), e.run.cycles(),
               rays_per_cycle, simulated_rate(e.run), pixels_off(e.picture, reference.picture, 0),
               pixels_off(e.picture, reference.picture, 2));
  }
  fmt::print("\n{:<18}", "counter");
  for (const Entry& e : entries) {
    fmt::print("{:>16}", e.name);
  }
  fmt::print("\n");
  for (std::size_t k = 0; k < kCounterNames.size(); ++k) {
    fmt::print("{:<18}", kCounterNames[k]);
    for (const Entry& e : entries) {
      fmt::print("{:>16}", e.run.counters[k]);
    }
    fmt::print("\n");
  }
}

}  // namespace

int run(const CompareCommand& command) {
  const Settings& settings = command.settings;
  std::error_code error;
  std::filesystem::create_directories(command.folder, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: cannot be made a folder ({})", command.folder.string(), error.message()));
  }
  std::vector<std::string> names{"reference", "model"};
  if (kWithRtl) {
    names.emplace_back("rtl");
  }
  std::vector<std::unique_ptr<OutputFile>> pictures;
  pictures.reserve(names.size());
  for (const std::string& name : names) {
    pictures.push_back(std::make_unique<OutputFile>(command.folder / (name + ".png")));
  }
  FigureFile figures(settings.json, command.command_line);
  const Prepared prepared = prepare(settings);
  std::vector<Entry> entries;
  for (std::size_t k = 0; k < names.size(); ++k) {
    entries.push_back(trace(command, prepared, names[k]));
    write_png(entries[k].run.rendering.image, *pictures[k]);
  }
  for (const auto& picture : pictures) {
    picture->commit();
  }
  const Entry& reference = entries[0];
  const Entry& model = entries[1];
  const Entry& last = entries.back();
  print_table(entries, reference);

  bool equal = true;
  if (kWithRtl) {
    const std::uint64_t bits = differing_bits(model.hits, last.hits);
    const std::uint64_t counters = differing_counters(model.run.counters, last.run.counters);
    fmt::print("\nmodel against rtl: {} hits, {} differing bits, {} differing counters\n", last.hits.size(),
               bits, counters);
    figures.add("render.differing_bits", bits, "bits");
    figures.add("render.differing_counters", counters, "counters");
    equal = bits == 0 && counters == 0 && !last.hits.empty();
  } else {
    fmt::print("\nmodel against rtl: not compared, this build has no Verilator model\n");
  }
  if (settings.device.exact) {
    const bool exact =
        pixels_off(last.picture, reference.picture, 0) == 0 && same_rays_hit(last.hits, reference.hits);
    fmt::print("exact against double precision: {}\n", exact ? "the same picture" : "not the same picture");
    equal = equal && exact;
  }
  figures.add("render.hits_compared", kWithRtl ? last.hits.size() : 0, "hits");
  figures.add("render.pixels_off_reference", pixels_off(last.picture, reference.picture, 0), "pixels");
  figures.add("render.pixels_off_reference_over_2_levels", pixels_off(last.picture, reference.picture, 2),
              "pixels");
  figures.add("render.cycles", last.run.cycles(), "cycles");
  figures.add("render.rays", last.run.rays(), "rays");
  figures.add("render.rays_per_cycle", rate(last.run.rays(), static_cast<double>(last.run.cycles())),
              "rays/cycle");
  figures.add("render.pixels", last.picture.size() / 3, "pixels");
  figures.add(kWithRtl ? "sim.cycles_per_second" : "model.cycles_per_second", simulated_rate(last.run),
              "cycles/s");
  figures.commit();
  return equal ? 0 : 1;
}

}  // namespace raplas
