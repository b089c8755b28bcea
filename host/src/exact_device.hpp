// The hits of double precision from a unit that computes in 24 bits: docs/exact.md.
#pragma once

#include <chrono>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fixed_device.hpp"
#include "tree_tracer.hpp"

namespace raplas {

/// A FixedDevice with certified hits, of which the host decides the doubtful ones. Its hits are those of
/// device `reference`, bit by bit; of an any-hit pencil which triangle is hit may differ.
template <typename Unit>
class ExactDevice final : public IntersectionDevice {
 public:
  explicit ExactDevice(const DeviceOptions& options) : device_(options) {}

  void load(const DeviceScene& scene) override {
    device_.load(scene);
    tracer_.load(scene);
    retests_ = {};
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<RayHits<Fp24>>> words;
    words.reserve(pencils.size());
    std::vector<Pencil> sent;
    std::vector<std::size_t> sent_from;
    for (std::size_t k = 0; k < pencils.size(); ++k) {
      words.emplace_back(pencils[k].directions.size());
      if (can_certify(pencils[k])) {
        sent.push_back(pencils[k]);
        sent_from.push_back(k);
      } else {
        check_directions(pencils[k]);
        words.back().assign(pencils[k].directions.size(), kUnknown);
      }
    }
    device_.trace(sent, [&](const auto& found) { words[sent_from[found.pencil]][found.ray] = found.word; });
    const auto begun = std::chrono::steady_clock::now();
    std::vector<std::vector<Hit>> hits;
    hits.reserve(pencils.size());
    for (std::size_t k = 0; k < pencils.size(); ++k) {
      std::vector<Hit>& of_pencil = hits.emplace_back();
      of_pencil.reserve(words[k].size());
      const Start start(pencils[k]);
      for (std::size_t ray = 0; ray < words[k].size(); ++ray) {
        of_pencil.push_back(Tracer::hit_of(decide(start, pencils[k].directions[ray], words[k][ray])));
      }
    }
    retests_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return device_.counters(); }
  [[nodiscard]] std::uint64_t simulated_clocks() const override { return device_.simulated_clocks(); }
  [[nodiscard]] std::uint64_t skipped_pencils() const override { return device_.skipped_pencils(); }
  [[nodiscard]] Retests retests() const override { return retests_; }

 private:
  using Tracer = TreeTracer<double>;
  using Start = Tracer::Start;
  using Found = Tracer::Found;

  /// Of a ray that the unit didn't trace.
  static constexpr RayHits<Fp24> kUnknown{{true, 0, {}, {}, {}, {}}, true};

  /// No triangle that the unit left out is less deep than its nearest hit with a known depth times this.
  static constexpr double kLeftOut = 1 + 0x1p-9;

  static void check_directions(const Pencil& pencil) {
    for (const glm::dvec3& direction : pencil.directions) {
      if (!(glm::dot(pencil.axis, direction) > 0)) {
        throw std::invalid_argument("a ray doesn't go along its pencil's axis");
      }
    }
  }

  Found decide(const Start& start, const glm::dvec3& direction, const RayHits<Fp24>& word) {
    ++retests_.rays;
    Found best = word.nearest.hit ? decide_hit(start, direction, word) : Found{};
    for (const std::uint32_t triangle : device_.uncertain()) {
      take_nearer(best, tracer_.test(triangle, start, direction));
    }
    return best;
  }

  Found decide_hit(const Start& start, const glm::dvec3& direction, const RayHits<Fp24>& word) {
    ++retests_.hits;
    const Found nearest = tracer_.test(word.nearest.triangle, start, direction);
    Found best = nearest;
    if (word.rival) {
      ++retests_.rivals;
      take_nearer(best, tracer_.test(word.rival_triangle, start, direction));
    }
    // an any-hit ray ends with its rival, others at a nearest hit with a known depth
    const bool decided = start.any_hit ? best.hit || !(word.rival || word.crowd)
                                       : !word.crowd && (word.unsure || nearest.hit ||
                                                         before_left_out(start, direction, word, best));
    if (decided) {
      return best;
    }
    ++retests_.traced;
    return tracer_.trace(start, direction);
  }

  /// A hit before all that the unit left out of the ray because it is deeper than its nearest one.
  static bool before_left_out(const Start& start, const glm::dvec3& direction, const RayHits<Fp24>& word,
                              const Found& hit) {
    const double depth = word.nearest.t.to_double() / word.nearest.d.to_double();
    return hit.hit && hit.t / hit.d * glm::dot(start.axis, direction) < depth * kLeftOut;
  }

  static void take_nearer(Found& best, const Found& hit) {
    if (hit.hit && Tracer::nearer(hit, best)) {
      best = hit;
    }
  }

  FixedDevice<Unit> device_;
  Tracer tracer_;
  Retests retests_;
};

/// The device of a unit that options ask for.
template <typename Unit>
[[nodiscard]] std::unique_ptr<IntersectionDevice> make_fixed_device(const DeviceOptions& options) {
  if (options.exact) {
    return std::make_unique<ExactDevice<Unit>>(options);
  }
  return std::make_unique<FixedDevice<Unit>>(options);
}

}  // namespace raplas
