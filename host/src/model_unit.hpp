// The clocked model of entity raplas_unit behind the ports that the host drives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "fixed_device.hpp"
#include "raplas/raplas_unit.hpp"

namespace raplas {

/// The clocked model as FixedDevice drives it.
class ModelUnit {
 public:
  void load(FixedSceneMemory<Fp24> scene) {
    scene_ = std::move(scene);
    unit_ = std::make_unique<RaplasUnit<Fp24>>();
    unit_->load(&scene_);
  }
  void write_pencil_word(const FixedPencilMemory<Fp24>& pencil, std::size_t bank, std::size_t word) {
    if (word + 1 == pencil_words(pencil)) {  // nothing looks at it before
      unit_->pencil(bank) = pencil;
    }
  }
  void ask(std::size_t bank, std::size_t ray) { asked_ = unit_->results(bank)[ray]; }
  void clock(bool start, std::size_t bank) {
    results_.clock(asked_);
    unit_->clock(start, bank);
  }
  [[nodiscard]] std::uint32_t busy() const { return unit_->busy(); }
  [[nodiscard]] LineMask hit_rows(std::size_t bank) const { return unit_->hit_rows(bank); }
  [[nodiscard]] RayHits<Fp24> result() const { return results_.out(); }
  [[nodiscard]] EventCounters counters() const { return unit_->counters(); }
  [[nodiscard]] const RaplasUnit<Fp24>& model() const { return *unit_; }

 private:
  FixedSceneMemory<Fp24> scene_;
  std::unique_ptr<RaplasUnit<Fp24>> unit_;
  RayHits<Fp24> asked_;
  Delay<RayHits<Fp24>, kMemoryStages> results_;
};

}  // namespace raplas
