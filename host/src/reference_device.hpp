// A device that traces rays one by one in the scalar's precision.
#pragma once

#include <span>
#include <vector>

#include "tree_tracer.hpp"

namespace raplas {

template <typename Scalar>
class ReferenceDevice final : public IntersectionDevice {
 public:
  void load(const DeviceScene& scene) override {
    tracer_.load(scene);
    hits_ = 0;
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    using Tracer = TreeTracer<Scalar>;
    std::vector<std::vector<Hit>> all;
    all.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      std::vector<Hit>& hits = all.emplace_back();
      hits.reserve(pencil.directions.size());
      const typename Tracer::Start start(pencil);
      for (const glm::dvec3& direction : pencil.directions) {
        hits.push_back(Tracer::hit_of(tracer_.trace(start, typename Tracer::Vector(direction))));
        hits_ += hits.back().hit ? 1U : 0U;
      }
    }
    return all;
  }

  [[nodiscard]] Counters counters() const override {
    Counters counters{};
    const auto count = [&counters](Counter counter) -> std::uint64_t& {
      return counters[static_cast<std::size_t>(counter)];
    };
    count(Counter::spheres_tested) = tracer_.spheres_tested();
    count(Counter::pairs_tested) = tracer_.pairs_tested();
    count(Counter::hits) = hits_;
    return counters;
  }

 private:
  TreeTracer<Scalar> tracer_;
  std::uint64_t hits_ = 0;
};

}  // namespace raplas
