// What the devices of profile raplas share: the host's side of the write port, the start and the read port.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "raplas/encode_fixed.hpp"
#include "raplas/host_port.hpp"

namespace raplas {

/// What the unit would do with the pencil and a sphere of the root range: walk on, or drop the sphere.
[[nodiscard]] inline bool meets(const FixedPencilMemory<Fp24>& pencil, const NodeWord& node) {
  const FixedTest test = test_object(pencil.planes, node.centre, node.radius, pencil.limits.slack);
  return test.near && test.z < pencil.limits.far && (test.rows_meet & first_lines(pencil.pencil.rows)) != 0 &&
         (test.columns_meet & first_lines(pencil.pencil.columns)) != 0;
}

/// Streams pencils through a unit: in each clock a word may be written, a bank started and a result read, so
/// that pencils are loaded and read while others run. Unit is the clocked model or the RTL:
///   load(scene)                             resets, writes the memories
///   write_pencil_word(pencil, bank, k)      in the next clock()
///   ask(bank, ray)                          in the next clock(); result() after kMemoryStages of them
///   clock(start, bank), busy(), hit_rows(bank), result(), counters()
template <typename Unit>
class FixedDevice final : public IntersectionDevice {
 public:
  explicit FixedDevice(const DeviceOptions& options) : options_(options) {}

  void load(const DeviceScene& scene) override {
    FixedScene words = encode_fixed(scene, options_.exact);
    vertex_error_ = words.vertex_error;
    uncertain_ = std::move(words.uncertain);
    const FixedSceneMemory<Fp24>& memory = words.memory;
    check("spheres, the Sphere Memory holds", memory.nodes.size(), options_.sphere_depth);
    check("vertices, the Vertex Memory holds", memory.vertices.size(), 2 * options_.triangle_depth);
    check("triangles, the Triangle Memory holds", memory.triangles.size(), options_.triangle_depth);
    const auto root = memory.nodes.begin() + memory.scene.first;
    root_.assign(root, root + memory.scene.count);
    unit_.load(std::move(words.memory));
    counters_ = {};
    last_counters_ = {};
    clocks_ = 0;
    skipped_pencils_ = 0;
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> hits;
    hits.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      hits.emplace_back(pencil.directions.size());
    }
    trace(pencils, [&hits](const RayWord& found) {
      hits[found.pencil][found.ray] = decode_fixed(found.word.nearest, *found.words, found.place);
    });
    return hits;
  }

  /// What the unit says of a ray that may hit something.
  struct RayWord {
    std::size_t pencil;
    std::size_t ray;
    RayHits<Fp24> word;
    const FixedPencil* words;
    std::size_t place;  ///< of the ray in the bank
  };

  /// Traces and gives the words of rays in rows with a hit to `sink`; other rays hit nothing.
  void trace(std::span<const Pencil> pencils, const std::function<void(const RayWord&)>& sink) {
    Progress at;
    next_pencil(pencils, at);
    while (at.read < at.order.size()) {
      clock(pencils, sink, at);
    }
    sent_ = std::move(at.order);
    const EventCounters now = unit_.counters();
    for (std::size_t k = 0; k < now.size(); ++k) {  // they wrap at 2^32
      counters_[k] += static_cast<std::uint32_t>(now[k] - last_counters_[k]);
    }
    last_counters_ = now;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }
  [[nodiscard]] std::uint64_t simulated_clocks() const override { return clocks_; }
  [[nodiscard]] std::uint64_t skipped_pencils() const override { return skipped_pencils_; }
  [[nodiscard]] Unit& unit() noexcept { return unit_; }
  /// Triangles that the unit's certified hits don't hold for.
  [[nodiscard]] const std::vector<std::uint32_t>& uncertain() const noexcept { return uncertain_; }
  /// The pencils of the last trace() that were not skipped, by index.
  [[nodiscard]] const std::vector<std::size_t>& sent() const noexcept { return sent_; }

 private:
  static constexpr std::uint64_t kHangClocks = 100'000'000;

  /// A ray whose result was asked for.
  struct Asked {
    std::size_t pencil = 0;  ///< of `order`
    std::size_t ray = 0;
    std::size_t place = 0;  ///< in the bank
  };

  /// How many pencils have got how far. Pencil k of `order` uses bank k modulo kPencilBanks: it is written
  /// while results of the pencil before it there are still being read, and started when all of them are asked
  /// for.
  struct Progress {
    std::size_t encoded = 0;         ///< of all pencils
    std::vector<std::size_t> order;  ///< those of them that may hit something
    std::deque<FixedPencil> banks;   ///< the last of `order`, from `read` on
    std::size_t written = 0;
    std::size_t word = 0;  ///< next one of pencil `written`
    std::size_t started = 0;
    std::size_t finished = 0;
    std::size_t asked = 0;                     ///< for all their results
    std::size_t ray = 0;                       ///< next one asked for of pencil `asked`
    std::deque<std::optional<Asked>> answers;  ///< that are on their way; one for each clock
    std::size_t read = 0;
    std::uint64_t idle = 0;  ///< clocks since a pencil finished
  };

  static void check(const char* what, std::size_t size, std::size_t depth) {
    if (size > depth) {
      throw std::runtime_error(std::to_string(size) + " " + what + " " + std::to_string(depth));
    }
  }

  void clock(std::span<const Pencil> pencils, const std::function<void(const RayWord&)>& sink, Progress& at) {
    const std::size_t startable = at.written;
    if (at.written < at.order.size() && at.written - at.finished < kPencilBanks) {
      write_word(pencils, at);
    }
    at.answers.push_back(ask(pencils, at));
    const bool start = at.started < startable && at.started - at.asked < kPencilBanks;
    unit_.clock(start, at.started % kPencilBanks);
    ++clocks_;
    at.started += start ? 1 : 0;
    ++at.idle;
    while (at.finished < at.started && (unit_.busy() >> (at.finished % kPencilBanks) & 1U) == 0) {
      ++at.finished;
      at.idle = 0;
    }
    if (at.idle == kHangClocks) {
      throw std::runtime_error("a pencil did not end within 100 million clocks");
    }
    if (at.answers.size() == kMemoryStages) {
      if (const auto& answer = at.answers.front()) {
        sink({at.order[answer->pencil], answer->ray, unit_.result(), &at.banks[answer->pencil - at.read],
              answer->place});
      }
      at.answers.pop_front();
    }
    const auto awaited = [&at](const std::optional<Asked>& a) { return a && a->pencil == at.read; };
    while (at.read < at.asked && std::none_of(at.answers.begin(), at.answers.end(), awaited)) {
      at.banks.pop_front();
      ++at.read;
    }
  }

  /// Asks for the result of the next ray of the finished pencils whose row has a hit.
  std::optional<Asked> ask(std::span<const Pencil> pencils, Progress& at) {
    while (at.asked < at.finished) {
      const Pencil& pencil = pencils[at.order[at.asked]];
      const std::size_t bank = at.asked % kPencilBanks;
      const auto columns = static_cast<std::size_t>(pencil.columns);
      const std::size_t row = at.ray / columns;
      if (at.ray == pencil.directions.size()) {
        ++at.asked;
        at.ray = 0;
      } else if ((unit_.hit_rows(bank) >> row & 1U) == 0) {
        at.ray += columns;
      } else {
        const Asked asked{at.asked, at.ray, row * kMaxColumns + at.ray % columns};
        unit_.ask(bank, asked.place);
        ++at.ray;
        return asked;
      }
    }
    return std::nullopt;
  }

  /// Encodes pencils up to the next one that meets a sphere of the root range; the others hit nothing.
  void next_pencil(std::span<const Pencil> pencils, Progress& at) {
    while (at.encoded < pencils.size()) {
      const std::size_t index = at.encoded++;
      const FixedPencil words = encode_fixed(pencils[index], vertex_error_, options_.exact);
      if (std::any_of(root_.begin(), root_.end(),
                      [&](const NodeWord& node) { return meets(words.memory, node); })) {
        at.order.push_back(index);
        at.banks.push_back(words);
        return;
      }
      ++skipped_pencils_;
    }
  }

  void write_word(std::span<const Pencil> pencils, Progress& at) {
    const FixedPencilMemory<Fp24>& memory = at.banks.back().memory;
    unit_.write_pencil_word(memory, at.written % kPencilBanks, at.word);
    ++at.word;
    if (at.word == pencil_words(memory)) {
      at.word = 0;
      ++at.written;
      next_pencil(pencils, at);
    }
  }

  DeviceOptions options_;
  Unit unit_;
  double vertex_error_ = 0;
  std::vector<std::uint32_t> uncertain_;
  std::vector<NodeWord> root_;  ///< nodes of the root range
  std::uint64_t skipped_pencils_ = 0;
  std::vector<std::size_t> sent_;
  Counters counters_{};
  EventCounters last_counters_{};
  std::uint64_t clocks_ = 0;
};

}  // namespace raplas
