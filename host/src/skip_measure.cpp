#include "skip_measure.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>

#include "model_unit.hpp"
#include "raplas/encode.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

constexpr int kPaperSide = 4;

/// Rays row .. row + 3, column .. column + 3 of a pencil, as far as it has them, as a pencil.
Pencil part_of(const Pencil& whole, int row, int column) {
  Pencil part = whole;
  part.rows = std::min(kPaperSide, whole.rows - row);
  part.columns = std::min(kPaperSide, whole.columns - column);
  part.row_planes.clear();
  part.column_planes.clear();
  part.directions.clear();
  for (int r = row; r < row + part.rows; ++r) {
    part.row_planes.push_back(whole.row_planes[static_cast<std::size_t>(r)]);
    for (int c = column; c < column + part.columns; ++c) {
      const int ray = r * whole.columns + c;
      part.directions.push_back(whole.directions[static_cast<std::size_t>(ray)]);
    }
  }
  for (int c = column; c < column + part.columns; ++c) {
    part.column_planes.push_back(whole.column_planes[static_cast<std::size_t>(c)]);
  }
  return part;
}

/// The leaves of a tree of whole triangles as a flat list.
DeviceScene flat_list(const DeviceScene& scene) {
  TreeOptions options;
  options.longest_edge = kWholeTriangles;
  DeviceScene tree = scene.pieces.empty() ? scene : build_tree(scene.triangles, options).scene;
  tree.max_origin = scene.max_origin;
  DeviceScene flat;
  flat.triangles = tree.triangles;
  flat.max_origin = tree.max_origin;
  for (const SphereNode& node : tree.nodes) {
    if (node.leaf) {
      flat.nodes.push_back(node);
    }
  }
  flat.root_count = static_cast<std::uint32_t>(flat.nodes.size());
  return flat;
}

/// Of each k-th pencil one part, which one depends on k only.
std::vector<Pencil> paper_pencils(std::span<const Pencil> pencils, std::size_t row, std::size_t wanted) {
  std::vector<Pencil> parts;
  for (const std::size_t k : every_kth(pencils.size(), wanted, row)) {
    const Pencil& whole = pencils[k];
    const int across = (whole.columns + kPaperSide - 1) / kPaperSide;
    const int down = (whole.rows + kPaperSide - 1) / kPaperSide;
    const int place = static_cast<int>((k * 7) % static_cast<std::size_t>(across * down));
    parts.push_back(part_of(whole, place / across * kPaperSide, place % across * kPaperSide));
  }
  return parts;
}

void add(BusyClocks& busy, bool object, bool pair) {
  ++busy.clocks;
  busy.objects += object ? 1 : 0;
  busy.pairs += pair ? 1 : 0;
  busy.either += object || pair ? 1 : 0;
}

/// The walks, each with one skip more than the one before.
struct Variant {
  const char* key;
  const char* title;
  Skips skips;
};

std::vector<Variant> variants(bool any_hit) {
  Skips skips{false, false, false, false, false, false, false, false};
  std::vector<Variant> list{{"flat", "16x16, flat list", skips}};
  const auto next = [&](const char* key, const char* title, bool Skips::*skip) {
    skips.*skip = true;
    list.push_back({key, title, skips});
  };
  next("tree", "+ tree", &Skips::tree);
  next("inherited", "+ inherited masks", &Skips::inherited);
  next("behind", "+ behind", &Skips::behind);
  next("nearest", "+ nearest first", &Skips::nearest_first);
  next("hidden", "+ hidden", &Skips::hidden);
  next("rectangles", "+ rectangles", &Skips::rectangles);
  next("scan_lines", "+ scan lines", &Skips::scan_lines);
  if (any_hit) {
    next("ended", "+ ended", &Skips::ended);
  }
  return list;
}

void add(SkipCounts& sum, const SkipCounts& counts) {
  sum.pencils += counts.pencils;
  sum.rays += counts.rays;
  sum.spheres += counts.spheres;
  sum.vertices += counts.vertices;
  sum.pairs += counts.pairs;
}

/// Walks one pencil with one skip more each time and compares; `expected`: of the clocked unit.
SkipSteps walk_steps(const FixedScene& scene, const Pencil& pencil, std::span<const Hit> expected,
                     const std::vector<Variant>& list) {
  const FixedPencil words = encode_fixed(pencil, scene.vertex_error);
  const std::size_t rays = pencil.directions.size();
  const auto columns = static_cast<std::size_t>(pencil.columns);
  const auto ray_id = [&](std::size_t ray) { return ray / columns * kMaxColumns + ray % columns; };
  SkipSteps result;
  const auto compare = [&](const auto& mine, const auto& theirs) {
    ++result.rays_compared;
    result.rays_different += (pencil.any_hit ? mine.hit == theirs.hit : mine == theirs) ? 0U : 1U;
  };
  FixedTrace<Fp24>::Results first{};
  for (const Variant& v : list) {
    const FixedTrace<Fp24> trace(scene.memory, words.memory, v.skips);
    const FixedCounts& counts = trace.counts();
    result.steps.push_back({v.key, v.title, {1, rays, counts.spheres, counts.vertices, counts.pairs}});
    if (result.steps.size() == 1) {
      first = trace.results();
      continue;
    }
    for (std::size_t ray = 0; ray < rays; ++ray) {
      compare(trace.results()[ray_id(ray)].nearest, first[ray_id(ray)].nearest);
    }
  }
  for (std::size_t ray = 0; ray < rays; ++ray) {
    compare(decode_fixed(first[ray_id(ray)].nearest, words, ray_id(ray)), expected[ray]);
  }
  return result;
}

/// ModelUnit with an eye on what its parts take in each clock.
class ObservedUnit {
 public:
  void load(FixedSceneMemory<Fp24> scene) { unit_.load(std::move(scene)); }
  void write_pencil_word(const FixedPencilMemory<Fp24>& pencil, std::size_t bank, std::size_t word) {
    unit_.write_pencil_word(pencil, bank, word);
  }
  void ask(std::size_t bank, std::size_t ray) { unit_.ask(bank, ray); }
  [[nodiscard]] std::uint32_t busy() const { return unit_.busy(); }
  [[nodiscard]] LineMask hit_rows(std::size_t bank) const { return unit_.hit_rows(bank); }
  [[nodiscard]] RayHits<Fp24> result() const { return unit_.result(); }
  [[nodiscard]] EventCounters counters() const { return unit_.counters(); }

  void clock(bool start, std::size_t bank) {
    const EventCounters before = unit_.counters();
    const std::uint32_t busy_before = unit_.busy();
    PencilCost& walked = banks_[unit_.model().walk_bank()];
    PencilCost& paired = banks_[unit_.model().pair_bank()];
    unit_.clock(start, bank);
    const EventCounters& now = unit_.model().counters();
    const auto counted = [&](Counter c) {
      return now[static_cast<std::size_t>(c)] != before[static_cast<std::size_t>(c)];
    };
    const bool sphere = counted(Counter::spheres_tested);
    const bool vertex = counted(Counter::vertices_tested);
    const bool pair = counted(Counter::pairs_tested);
    walked.spheres += sphere ? 1 : 0;
    walked.vertices += vertex ? 1 : 0;
    paired.pairs += pair ? 1 : 0;
    if (busy_before != 0) {
      add(busy_, sphere || vertex, pair);
      ++since_end_;
    }
    const std::uint32_t ended = busy_before & ~unit_.busy();
    for (std::size_t k = 0; k < banks_.size(); ++k) {
      if ((ended >> k & 1U) != 0) {
        banks_[k].clocks = since_end_;
        costs_.push_back(banks_[k]);
        banks_[k] = {};
        since_end_ = 0;
        if (on_end_) {
          on_end_(costs_.size());
        }
      }
    }
  }

  void on_end(std::function<void(std::size_t)> call) { on_end_ = std::move(call); }
  [[nodiscard]] const BusyClocks& busy_clocks() const { return busy_; }
  [[nodiscard]] const std::vector<PencilCost>& costs() const { return costs_; }

 private:
  ModelUnit unit_;
  std::array<PencilCost, kPencilBanks> banks_{};
  std::uint64_t since_end_ = 0;
  BusyClocks busy_;
  std::vector<PencilCost> costs_;
  std::function<void(std::size_t)> on_end_;
};

}  // namespace

std::vector<std::size_t> every_kth(std::size_t count, std::size_t wanted, std::size_t row) {
  std::size_t k = wanted == 0 ? count : std::max<std::size_t>(1, count / wanted);
  while (k > 1 && std::gcd(k, row) != 1) {
    --k;
  }
  std::vector<std::size_t> taken;
  for (std::size_t i = k / 2; i < count; i += std::max<std::size_t>(k, 1)) {
    taken.push_back(i);
  }
  return taken;
}

SkipCounts run_conventional(const DeviceScene& scene, std::span<const Pencil> pencils,
                            const ShowProgress& progress) {
  const auto device = make_device("reference", {});
  device->load(scene);
  SkipCounts counts;
  for (const Pencil& pencil : pencils) {
    counts.rays += device->trace(pencil).size();
    ++counts.pencils;
    progress(static_cast<double>(counts.pencils) / static_cast<double>(pencils.size()));
  }
  counts.spheres = device->counters()[static_cast<std::size_t>(Counter::spheres_tested)];
  counts.pairs = device->counters()[static_cast<std::size_t>(Counter::pairs_tested)];
  return counts;
}

PaperRun run_paper(const DeviceScene& scene, std::span<const Pencil> pencils, std::size_t row,
                   std::uint64_t max_spheres, const ShowProgress& progress) {
  using F = Fp24Paper;
  const DeviceScene flat = flat_list(scene);
  const SceneMemory<F> memory = encode<F>(flat, {});
  const auto unit = std::make_unique<IntersectionUnit<F>>();
  unit->load(&memory);
  PaperRun run;
  const auto parts = paper_pencils(pencils, row, std::max<std::size_t>(1, max_spheres / flat.nodes.size()));
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::size_t bank = k % 2;
    unit->pencil(bank) = encode<F>(parts[k]);
    unit->clock(true, bank);
    while (unit->busy()) {
      const UnitEdges<F> edges = unit->edges();
      add(run.busy, edges.request.valid, edges.issue);
      unit->clock(false, bank);
    }
    const auto count = [&](Counter c) { return unit->counters()[static_cast<std::size_t>(c)]; };
    ++run.counts.pencils;
    run.counts.rays += parts[k].directions.size();
    run.counts.spheres += count(Counter::spheres_tested);
    run.counts.pairs += count(Counter::pairs_tested);
    progress(static_cast<double>(k + 1) / static_cast<double>(parts.size()));
  }
  return run;
}

SkipSteps run_steps(const DeviceScene& scene, std::span<const Pencil> pencils,
                    std::span<const std::vector<Hit>> expected, const ShowProgress& progress) {
  const FixedScene words = encode_fixed(scene);
  const std::vector<Variant> list = variants(!pencils.empty() && pencils.front().any_hit);
  std::vector<SkipSteps> walked(pencils.size());
  for_each_parallel(
      pencils.size(), [&](std::size_t k) { walked[k] = walk_steps(words, pencils[k], expected[k], list); },
      progress);
  SkipSteps result;
  for (const Variant& v : list) {
    result.steps.push_back({v.key, v.title, {}});
  }
  for (const SkipSteps& one : walked) {
    for (std::size_t v = 0; v < list.size(); ++v) {
      add(result.steps[v].counts, one.steps[v].counts);
    }
    result.rays_compared += one.rays_compared;
    result.rays_different += one.rays_different;
  }
  return result;
}

StreamRun run_stream(const DeviceScene& scene, std::span<const Pencil> pencils,
                     const ShowProgress& progress) {
  FixedDevice<ObservedUnit> device({});
  device.load(scene);
  device.unit().on_end(
      [&](std::size_t done) { progress(static_cast<double>(done) / static_cast<double>(pencils.size())); });
  StreamRun run;
  run.hits = device.trace(pencils);
  run.stream_clocks = device.simulated_clocks();
  run.busy = device.unit().busy_clocks();
  run.not_sent = device.skipped_pencils();
  run.costs.resize(pencils.size());
  for (std::size_t k = 0; k < device.sent().size(); ++k) {
    run.costs[device.sent()[k]] = device.unit().costs()[k];
  }
  run.counts.pencils = pencils.size();
  for (std::size_t k = 0; k < pencils.size(); ++k) {
    run.counts.rays += run.hits[k].size();
    run.counts.spheres += run.costs[k].spheres;
    run.counts.vertices += run.costs[k].vertices;
    run.counts.pairs += run.costs[k].pairs;
  }
  return run;
}

}  // namespace raplas
