#include "embree_device.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

namespace raplas {
namespace {

constexpr std::size_t kPacket = 16;

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// A packet's rays and which of them there are (-1).
struct alignas(64) Packet {
  std::array<int, kPacket> valid{};
  RTCRayHit16 rays{};
};

class EmbreeDevice final : public IntersectionDevice {
 public:
  explicit EmbreeDevice(bool robust) : device_(rtcNewDevice("threads=1")), robust_(robust) {
    if (!device_) {
      throw std::runtime_error(
          fmt::format("Embree does not start, error {}", static_cast<int>(rtcGetDeviceError(nullptr))));
    }
  }

  void load(const DeviceScene& scene) override {
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), robust_ ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    const Owned<RTCGeometry> mesh(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    const std::size_t triangles = scene.triangles.size();
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * triangles));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        mesh.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles));
    if (vertices == nullptr || indices == nullptr) {
      throw std::runtime_error("Embree has no memory for the scene");
    }
    for (const Triangle& t : scene.triangles) {
      for (const glm::dvec3& corner : {t.v0, t.v0 + t.e1, t.v0 + t.e2}) {
        for (int axis = 0; axis < 3; ++axis) {
          *vertices++ = static_cast<float>(corner[axis]);
        }
      }
    }
    for (unsigned k = 0; k < 3 * triangles; ++k) {
      indices[k] = k;
    }
    rtcCommitGeometry(mesh.get());
    rtcAttachGeometry(scene_.get(), mesh.get());
    rtcCommitScene(scene_.get());
    if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE) {
      throw std::runtime_error(
          fmt::format("Embree does not take the scene, error {}", static_cast<int>(error)));
    }
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> all;
    all.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      std::vector<Hit>& hits = all.emplace_back(pencil.directions.size());
      for (std::size_t first = 0; first < hits.size(); first += kPacket) {
        trace_packet(pencil, first, std::span(hits).subspan(first, std::min(kPacket, hits.size() - first)));
      }
    }
    return all;
  }

  [[nodiscard]] Counters counters() const override { return {}; }

 private:
  void trace_packet(const Pencil& pencil, std::size_t first, std::span<Hit> hits) {
    Packet packet;
    RTCRay16& ray = packet.rays.ray;
    for (std::size_t k = 0; k < hits.size(); ++k) {
      const glm::dvec3& direction = pencil.directions[first + k];
      packet.valid[k] = -1;
      ray.org_x[k] = static_cast<float>(pencil.origin.x);
      ray.org_y[k] = static_cast<float>(pencil.origin.y);
      ray.org_z[k] = static_cast<float>(pencil.origin.z);
      ray.dir_x[k] = static_cast<float>(direction.x);
      ray.dir_y[k] = static_cast<float>(direction.y);
      ray.dir_z[k] = static_cast<float>(direction.z);
      ray.tfar[k] = static_cast<float>(pencil.far / glm::dot(pencil.axis, direction));
      ray.mask[k] = ~0U;
      packet.rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    if (pencil.any_hit) {
      rtcOccluded16(packet.valid.data(), scene_.get(), &context, &ray);
      for (std::size_t k = 0; k < hits.size(); ++k) {
        if (ray.tfar[k] == -std::numeric_limits<float>::infinity()) {
          hits[k] = {true, 0, 0, 1, 0, 0};
        }
      }
      return;
    }
    rtcIntersect16(packet.valid.data(), scene_.get(), &context, &packet.rays);
    const RTCHit16& hit = packet.rays.hit;
    for (std::size_t k = 0; k < hits.size(); ++k) {
      if (hit.geomID[k] != RTC_INVALID_GEOMETRY_ID) {
        hits[k] = {true, hit.primID[k], ray.tfar[k], 1, hit.u[k], hit.v[k]};
      }
    }
  }

  Owned<RTCDevice> device_;
  Owned<RTCScene> scene_;
  bool robust_;
};

}  // namespace

std::unique_ptr<IntersectionDevice> make_embree_device(bool robust) {
  return std::make_unique<EmbreeDevice>(robust);
}

}  // namespace raplas
