// Device `model`: the clocked golden models.
#include "device_factories.hpp"
#include "exact_device.hpp"
#include "model_unit.hpp"
#include "raplas/encode.hpp"

namespace raplas {
namespace {

/// Profile paper: one pencil after the other.
class PaperModelDevice final : public IntersectionDevice {
 public:
  explicit PaperModelDevice(const DeviceOptions& options) : options_(options) {}

  void load(const DeviceScene& scene) override {
    scene_ = encode<Fp24Paper>(scene, options_);
    unit_.load(&scene_);
    counters_ = {};
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> hits;
    hits.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      hits.push_back(trace_one(pencil));
    }
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }

 private:
  std::vector<Hit> trace_one(const Pencil& pencil) {
    unit_.pencil(bank_) = encode<Fp24Paper>(pencil);
    unit_.clock(true, bank_);
    while (unit_.busy()) {
      unit_.clock(false, bank_);
    }
    std::vector<Hit> hits;
    hits.reserve(pencil.directions.size());
    for (std::size_t r = 0; r < static_cast<std::size_t>(pencil.rows); ++r) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(pencil.columns); ++c) {
        hits.push_back(decode(unit_.results(bank_)[r * kMaxColumns + c]));
      }
    }
    drop_far_hits(pencil, hits);
    for (std::size_t k = 0; k < counters_.size(); ++k) {
      counters_[k] += unit_.counters()[k];
    }
    bank_ ^= 1U;
    return hits;
  }

  DeviceOptions options_;
  SceneMemory<Fp24Paper> scene_;
  IntersectionUnit<Fp24Paper> unit_;
  Counters counters_{};
  std::size_t bank_ = 0;
};

}  // namespace

std::unique_ptr<IntersectionDevice> make_model_device(const DeviceOptions& options) {
  if (options.profile == Profile::paper) {
    return std::make_unique<PaperModelDevice>(options);
  }
  return make_fixed_device<ModelUnit>(options);
}

}  // namespace raplas
