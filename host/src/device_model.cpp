// Device `model`: the clocked golden model.
#include "device_factories.hpp"
#include "raplas/encode.hpp"

namespace raplas {
namespace {

template <typename F>
class ModelDevice final : public IntersectionDevice {
 public:
  explicit ModelDevice(const DeviceOptions& options) : options_(options) {}

  void load(const DeviceScene& scene) override {
    scene_ = encode<F>(scene, options_);
    unit_.load(&scene_);
    counters_ = {};
  }

  std::vector<Hit> trace(const Pencil& pencil) override {
    unit_.pencil(bank_) = encode<F>(pencil);
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
    for (std::size_t k = 0; k < counters_.size(); ++k) {
      counters_[k] += unit_.counters()[k];
    }
    bank_ ^= 1U;
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return counters_; }

 private:
  DeviceOptions options_;
  SceneMemory<F> scene_;
  IntersectionUnit<F> unit_;
  Counters counters_{};
  std::size_t bank_ = 0;
};

}  // namespace

std::unique_ptr<IntersectionDevice> make_model_device(const DeviceOptions& options) {
  if (options.guard_bits) {
    return std::make_unique<ModelDevice<Fp24>>(options);
  }
  return std::make_unique<ModelDevice<Fp24Paper>>(options);
}

}  // namespace raplas
