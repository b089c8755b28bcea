// The renderer: tiles of the image, one camera pencil each.
#include "raplas/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <stdexcept>

#include "raplas/pencil.hpp"
#include "shading.hpp"

namespace raplas {
namespace {

/// An occluder counts when it is nearer than this share of the way to the light.
constexpr double kBeforeLight = 1 - 1e-3;

/// Samples of the light in a row and column where no shadow rays are traced.
constexpr int kUnshadowedSamples = 4;

/// A number in -0.5 .. 0.5 for each pixel and `salt`, always the same (integer mixing after SplitMix64).
double pixel_noise(int x, int y, std::uint64_t salt) {
  std::uint64_t z =
      (static_cast<std::uint64_t>(y) << 32) + static_cast<std::uint64_t>(x) + salt * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-53 - 0.5;
}

class Renderer {
 public:
  Renderer(const Scene& scene, std::span<const std::uint32_t> source, IntersectionDevice& device,
           const RenderOptions& options, const RenderHooks& hooks)
      : scene_(scene),
        source_(source),
        device_(device),
        options_(options),
        hooks_(hooks),
        camera_(scene.camera, options.width, options.height),
        up_(glm::normalize(scene.camera.up)),
        light_normal_(light_normal(scene.light)),
        light_area_(glm::length(glm::cross(scene.light.edge_u, scene.light.edge_v))) {}

  Rendering run() {
    const int size = options_.pencil;
    Image& image = result_.image;
    image.width = options_.width;
    image.height = options_.height;
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; y += size) {
      for (int x = 0; x < image.width; x += size) {
        render_tile(x, y, std::min(size, image.width - x), std::min(size, image.height - y));
        if (hooks_.progress) {
          const double rows = y + double(size) * std::min(x + size, image.width) / image.width;
          hooks_.progress(std::min(1.0, rows / image.height));
        }
      }
    }
    return std::move(result_);
  }

 private:
  std::vector<Hit> trace(const Pencil& pencil, std::uint64_t& rays) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Hit> hits = device_.trace(pencil);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (hits.size() != pencil.directions.size()) {
      throw std::runtime_error("the device gave a wrong number of hits");
    }
    result_.stats.trace_seconds += seconds.count();
    result_.stats.pencils += 1;
    rays += hits.size();
    if (hooks_.hits) {
      hooks_.hits(hits);
    }
    return hits;
  }

  void render_tile(int x0, int y0, int columns, int rows) {
    const Pencil pencil = camera_.pencil(x0, y0, columns, rows);
    const std::vector<Hit> hits = trace(pencil, result_.stats.camera_rays);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        const auto ray =
            static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
        const auto pixel = static_cast<std::size_t>(y0 + r) * static_cast<std::size_t>(options_.width) +
                           static_cast<std::size_t>(x0 + c);
        result_.image.pixels[pixel] = shade(hits[ray], pencil.directions[ray], x0 + c, y0 + r);
      }
    }
  }

  glm::dvec3 shade(const Hit& hit, const glm::dvec3& direction, int x, int y) {
    const double limit = hit.hit ? hit.t() : std::numeric_limits<double>::infinity();
    if (sees_light(scene_.light, scene_.camera.eye, direction, limit)) {
      return scene_.light.intensity;
    }
    if (!hit.hit) {
      return scene_.background;
    }
    const std::uint32_t triangle = source_[hit.triangle];
    const SurfacePoint point =
        surface_point(scene_.triangles[triangle], scene_.surfaces[triangle], hit, direction);
    return point.colour *
           (ambient(point) + scene_.light.intensity * (irradiance(point, x, y) / glm::pi<double>()));
  }

  /// Light from everywhere, of which surfaces that face up get twice as much as those that face down.
  [[nodiscard]] glm::dvec3 ambient(const SurfacePoint& point) const {
    return scene_.ambient * (0.75 + 0.25 * glm::dot(point.normal, up_));
  }

  /// Irradiance from the light at radiance 1. Its samples are shifted within their cells, differently in each
  /// pixel.
  double irradiance(const SurfacePoint& point, int x, int y) {
    if (!may_be_lit(point, scene_.light)) {
      return 0;
    }
    const int size = options_.shadow > 0 ? options_.shadow : kUnshadowedSamples;
    const Grid grid = light_grid(scene_.light, size, pixel_noise(x, y, 1), pixel_noise(x, y, 2));
    const glm::dvec3 origin = shadow_origin(point);
    std::vector<Hit> hits;
    if (options_.shadow > 0) {
      hits = trace(make_pencil(origin, grid), result_.stats.shadow_rays);
    }
    double sum = 0;
    for (int r = 0; r < size; ++r) {
      for (int c = 0; c < size; ++c) {
        const glm::dvec3 to = grid.first + double(r) * grid.row_step + double(c) * grid.column_step - origin;
        const auto ray =
            static_cast<std::size_t>(r) * static_cast<std::size_t>(size) + static_cast<std::size_t>(c);
        const bool occluded =
            !hits.empty() && hits[ray].hit && hits[ray].t() < glm::length(to) * kBeforeLight;
        sum += occluded ? 0 : form_factor(point, to, light_normal_, light_area_ / (size * size));
      }
    }
    return sum;
  }

  const Scene& scene_;
  std::span<const std::uint32_t> source_;
  IntersectionDevice& device_;
  RenderOptions options_;
  const RenderHooks& hooks_;
  CameraFrame camera_;
  glm::dvec3 up_;
  glm::dvec3 light_normal_;
  double light_area_;
  Rendering result_;
};

}  // namespace

Rendering render(const Scene& scene, std::span<const std::uint32_t> source, IntersectionDevice& device,
                 const RenderOptions& options, const RenderHooks& hooks) {
  return Renderer(scene, source, device, options, hooks).run();
}

}  // namespace raplas
