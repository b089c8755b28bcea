// stress: a catalogue of numerical traps, each with the property that must hold, on every device.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "figure_file.hpp"
#include "parallel.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "raplas/output_file.hpp"
#include "stress_run.hpp"

namespace raplas {
namespace {

struct CommandLine {
  std::vector<std::string> devices;  ///< empty: all but the RTL
  std::string cases;                 ///< part of a case's name
  std::size_t rays = 16384;
  std::string csv;   ///< empty: none
  std::string json;  ///< empty: none
  bool list = false;
  bool quiet = false;
};

/// Cases that count for holes take this many times the rays of others: a million at the default.
constexpr std::size_t kAlignedShare = 7;

/// A case and what each device made of it.
struct Row {
  StressCase stress;
  std::vector<StressCounts> devices;
};

/// Of which devices a case's property is claimed.
std::string promise_of(const StressCase& stress, const std::vector<StressDevice>& devices) {
  if (stress.control) {
    return "must fail";
  }
  std::string promised;
  std::size_t count = 0;
  for (const StressDevice& device : devices) {
    if (is_promised(stress, device)) {
      promised += (count == 0 ? "" : " ") + std::string(device.name);
      ++count;
    }
  }
  return count == 0 ? "known not to" : count == devices.size() ? "promised" : promised;
}

std::vector<StressDevice> chosen_devices(const std::vector<std::string>& names) {
  std::vector<StressDevice> chosen;
  std::string known;
  for (const StressDevice& device : stress_devices()) {
    const bool named = std::find(names.begin(), names.end(), device.name) != names.end();
    if (named || (names.empty() && device.maker != std::string("rtl"))) {
      chosen.push_back(device);
    }
    known += (known.empty() ? "" : ", ") + std::string(device.name);
  }
  if (chosen.size() < names.size()) {
    throw std::runtime_error(fmt::format("--devices: the devices of this build are {}", known));
  }
  return chosen;
}

std::vector<Row> chosen_cases(const std::string& part) {
  std::vector<Row> rows;
  for (StressCase& stress : stress_cases()) {
    if (stress.name.find(part) != std::string::npos) {
      rows.push_back({std::move(stress), {}});
    }
  }
  if (rows.empty()) {
    throw std::runtime_error(fmt::format("--cases: no case has {} in its name; --list shows them", part));
  }
  return rows;
}

void measure(std::vector<Row>& rows, const std::vector<StressDevice>& devices, const CommandLine& line) {
  Progress progress("stress", line.quiet);
  for_each_parallel(
      rows.size(),
      [&](std::size_t k) {
        Row& row = rows[k];
        row.devices = run_case(row.stress, line.rays * (row.stress.aligned ? kAlignedShare : 1), devices);
      },
      [&](double share) { progress.show(share); });
}

/// The control of a property: its failures were looked for and not found on any device.
bool unnoticed(const Row& row) {
  return row.stress.control && std::none_of(row.devices.begin(), row.devices.end(),
                                            [](const StressCounts& counts) { return counts.broken > 0; });
}

int failed_properties(const Row& row, const std::vector<StressDevice>& devices) {
  int failed = unnoticed(row) ? 1 : 0;
  for (std::size_t k = 0; k < devices.size(); ++k) {
    failed += row.devices[k].failures(is_promised(row.stress, devices[k]));
  }
  return failed;
}

std::string cell(const StressCounts& counts) {
  if (!counts.refusal.empty()) {
    return "refused";
  }
  if (counts.rays == 0) {
    return "-";
  }
  return fmt::format("{:.3g} {} {}", percent(counts.differing, counts.rays), counts.unexplained,
                     counts.broken);
}

void print_row(const Row& row, const std::vector<StressDevice>& devices, std::size_t name_width) {
  const auto [rays, hits] = [&] {
    for (const StressCounts& counts : row.devices) {
      if (counts.rays > 0) {
        return std::pair(counts.rays, counts.hits);
      }
    }
    return std::pair(std::uint64_t{0}, std::uint64_t{0});
  }();
  fmt::print("{:<{}}  {:<9}  {:<24}{:>8}{:>8}", row.stress.name, name_width, name_of(row.stress.property),
             promise_of(row.stress, devices), rays, hits);
  for (const StressCounts& counts : row.devices) {
    fmt::print("{:>18}", cell(counts));
  }
  fmt::print("{}\n", failed_properties(row, devices) > 0 ? "  FAILED" : "");
}

void print_table(const std::vector<Row>& rows, const std::vector<StressDevice>& devices) {
  std::size_t width = 0;
  for (const Row& row : rows) {
    width = std::max(width, row.stress.name.size());
  }
  fmt::print(
      "of each device: rays not as in exact arithmetic, %; rays that its error bound doesn't explain; rays "
      "that "
      "break the property\n{:<{}}  {:<9}  {:<24}{:>8}{:>8}",
      "case", width, "property", "it is", "rays", "hits");
  for (const StressDevice& device : devices) {
    fmt::print("{:>18}", device.name);
  }
  fmt::print("\n");
  for (const Row& row : rows) {
    print_row(row, devices, width);
    for (std::size_t k = 0; k < devices.size(); ++k) {
      const StressCounts& counts = row.devices[k];
      if (!counts.refusal.empty() && counts.broken > 0) {
        fmt::print("  {}: {}\n", devices[k].name, counts.refusal);
      }
    }
  }
}

/// Rays through edges and vertices of closed meshes, and how many of them escape, by device that takes them
/// all.
struct Holes {
  std::uint64_t rays = 0;
  std::map<std::string, std::uint64_t> escaped;
};

Holes holes_of(const std::vector<Row>& rows, const std::vector<StressDevice>& devices) {
  Holes holes;
  for (const Row& row : rows) {
    std::uint64_t rays = 0;
    for (std::size_t k = 0; row.stress.aligned && k < devices.size(); ++k) {
      if (devices[k].share == 1) {
        rays = row.devices[k].rays;
        holes.escaped[devices[k].name] += row.devices[k].broken;
      }
    }
    holes.rays += rays;
  }
  return holes;
}

std::string csv_of(const std::vector<Row>& rows, const std::vector<StressDevice>& devices) {
  std::string text =
      "case,trap,property,it_is,device,rays,hits,differing,differing_percent,unexplained,broken,t_error,"
      "refusal\n";
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < devices.size(); ++k) {
      const StressCounts& c = row.devices[k];
      text += fmt::format("{},\"{}\",{},{},{},{},{},{},{},{},{},{},\"{}\"\n", row.stress.name,
                          row.stress.trap, name_of(row.stress.property), promise_of(row.stress, devices),
                          devices[k].name, c.rays, c.hits, c.differing, percent(c.differing, c.rays),
                          c.unexplained, c.broken, c.t_error, c.refusal);
    }
  }
  return text;
}

void add_figures(FigureFile& figures, const std::vector<Row>& rows, const std::vector<StressDevice>& devices,
                 int failed) {
  figures.add("stress.cases", rows.size(), "cases");
  figures.add("stress.failed_properties", failed, "properties");
  const Holes holes = holes_of(rows, devices);
  figures.add("holes.rays", holes.rays, "rays");
  for (const auto& [device, escaped] : holes.escaped) {
    figures.add("holes." + device, escaped, "rays");
  }
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < devices.size(); ++k) {
      const StressCounts& c = row.devices[k];
      if (c.rays > 0) {
        const std::string name = fmt::format("stress.{}.{}.", row.stress.name, devices[k].name);
        figures.add(name + "differing_percent", percent(c.differing, c.rays), "% of rays");
        figures.add(name + "broken", c.broken, "rays");
      }
    }
  }
}

int run(const CommandLine& line, const std::string& command) {
  std::vector<Row> rows = chosen_cases(line.cases);
  if (line.list) {
    for (const Row& row : rows) {
      fmt::print("{:<32} {:<10} {}\n", row.stress.name, name_of(row.stress.property), row.stress.trap);
    }
    return 0;
  }
  const std::vector<StressDevice> devices = chosen_devices(line.devices);
  std::optional<OutputFile> csv;
  if (!line.csv.empty()) {
    csv.emplace(line.csv);
  }
  FigureFile figures(line.json, command);
  measure(rows, devices, line);
  print_table(rows, devices);
  int failed = 0;
  for (const Row& row : rows) {
    failed += failed_properties(row, devices);
  }
  const Holes holes = holes_of(rows, devices);
  fmt::print("{} rays through edges and vertices of closed meshes; escaped:", holes.rays);
  for (const auto& [device, escaped] : holes.escaped) {
    fmt::print(" {} {}", device, escaped);
  }
  fmt::print("\n{} cases, {} promised properties failed\n", rows.size(), failed);
  if (csv) {
    csv->write(csv_of(rows, devices));
    csv->commit();
  }
  add_figures(figures, rows, devices, failed);
  figures.commit();
  return failed == 0 ? 0 : 1;
}

int parse_and_run(int argc, char** argv) {
  constexpr std::size_t kMostRays = 100'000'000;
  CLI::App app{"Run the catalogue of numerical traps", "stress"};
  CommandLine line;
  app.add_option("--devices", line.devices, "which devices, separated by commas; default: all but rtl")
      ->delimiter(',');
  app.add_option("--cases", line.cases, "only cases with this in their names");
  app.add_option("--rays", line.rays, "rays of a case")
      ->check(CLI::Range(std::size_t{1}, kMostRays))
      ->capture_default_str();
  app.add_option("--csv", line.csv, "file for all numbers, one line a case and device");
  app.add_option("--json", line.json, "file for figures");
  app.add_flag("--list", line.list, "print the cases and end");
  app.add_flag("--quiet", line.quiet, "no progress");
  if (const auto exit_code = parse(app, argc, argv)) {
    return *exit_code;
  }
  return run(line, command_line(app, argc, argv));
}

}  // namespace
}  // namespace raplas

int main(int argc, char** argv) { return raplas::run_program("stress", argc, argv, raplas::parse_and_run); }
