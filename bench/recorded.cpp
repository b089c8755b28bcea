#include "recorded.hpp"

#include <utility>

namespace raplas {
namespace {

/// Device `reference`, which keeps what it is asked and what it answers.
class Recorder final : public IntersectionDevice {
 public:
  void load(const DeviceScene& scene) override { device_->load(scene); }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> hits = device_->trace(pencils);
    for (std::size_t k = 0; k < pencils.size(); ++k) {
      const bool shadow = pencils[k].any_hit;
      (shadow ? recorded_.shadow : recorded_.camera).push_back(pencils[k]);
      (shadow ? recorded_.shadow_hits : recorded_.camera_hits).push_back(hits[k]);
    }
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return device_->counters(); }
  [[nodiscard]] Recorded take() && { return std::move(recorded_); }

 private:
  std::unique_ptr<IntersectionDevice> device_ = make_device("reference", {});
  Recorded recorded_;
};

}  // namespace

Recorded record(const Prepared& prepared, const RenderOptions& options) {
  Recorder recorder;
  recorder.load(prepared.tree.scene);
  Rendering rendering = render(prepared.scene, prepared.tree.source, recorder, options, {});
  Recorded recorded = std::move(recorder).take();
  recorded.picture = std::move(rendering.image);
  to_scene_triangles(prepared.tree.source, recorded.camera_hits);
  to_scene_triangles(prepared.tree.source, recorded.shadow_hits);
  return recorded;
}

void to_scene_triangles(std::span<const std::uint32_t> source, std::vector<std::vector<Hit>>& hits) {
  for (std::vector<Hit>& of_pencil : hits) {
    for (Hit& hit : of_pencil) {
      hit.triangle = hit.hit ? source[hit.triangle] : 0;
    }
  }
}

}  // namespace raplas
