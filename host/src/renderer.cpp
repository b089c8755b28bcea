// The renderer: tiles of the image, one camera pencil each, many of them at a time.
#include "raplas/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <stdexcept>

#include "raplas/pencil.hpp"
#include "shading.hpp"
#include "shadow_pencil.hpp"

namespace raplas {
namespace {

/// Pencils that go to the device together.
constexpr std::size_t kBatch = 1024;

/// Samples of the light in a row and column where no shadow rays are traced.
constexpr int kUnshadowedSamples = 4;

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
    const int tiles = (image.width + size - 1) / size;
    const int rows = std::max(1, static_cast<int>(kBatch) / tiles) * size;  // of pixels
    for (int y = 0; y < image.height; y += rows) {
      render_rows(y, std::min(y + rows, image.height));
    }
    return std::move(result_);
  }

 private:
  /// A pixel that waits for its shadow rays.
  struct Lit {
    std::size_t pixel;
    glm::dvec3 colour;  ///< without the light
    SurfacePoint point;
    Grid light;
  };

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils, std::uint64_t& rays) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::vector<Hit>> hits = device_.trace(pencils);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    result_.stats.trace_seconds += seconds.count();
    result_.stats.pencils += pencils.size();
    for (std::size_t k = 0; k < pencils.size(); ++k) {
      if (hits.size() != pencils.size() || hits[k].size() != pencils[k].directions.size()) {
        throw std::runtime_error("the device gave a wrong number of hits");
      }
      rays += hits[k].size();
      if (hooks_.hits) {
        hooks_.hits(hits[k]);
      }
    }
    return hits;
  }

  /// Rows of tiles: their camera pencils, then their shadow pencils.
  void render_rows(int begin, int end) {
    struct Tile {
      int x;
      int y;
    };
    std::vector<Tile> tiles;
    std::vector<Pencil> pencils;
    for (int y = begin; y < end; y += options_.pencil) {
      for (int x = 0; x < options_.width; x += options_.pencil) {
        tiles.push_back({x, y});
        pencils.push_back(camera_.pencil(x, y, std::min(options_.pencil, options_.width - x),
                                         std::min(options_.pencil, end - y)));
      }
    }
    const auto hits = trace(pencils, result_.stats.camera_rays);
    for (std::size_t tile = 0; tile < pencils.size(); ++tile) {
      const Pencil& pencil = pencils[tile];
      for (std::size_t ray = 0; ray < pencil.directions.size(); ++ray) {
        shade(hits[tile][ray], pencil.directions[ray], tiles[tile].x + static_cast<int>(ray) % pencil.columns,
              tiles[tile].y + static_cast<int>(ray) / pencil.columns);
      }
      if (hooks_.progress) {
        const double share = static_cast<double>(tile + 1) / static_cast<double>(pencils.size());
        hooks_.progress((begin + share * (end - begin)) / options_.height);
      }
    }
    trace_shadows();
  }

  void shade(const Hit& hit, const glm::dvec3& direction, int x, int y) {
    const auto pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(x);
    auto& colour = result_.image.pixels[pixel];
    const double limit = hit.hit ? hit.t() : std::numeric_limits<double>::infinity();
    if (sees_light(scene_.light, scene_.camera.eye, direction, limit)) {
      colour = scene_.light.intensity;
      return;
    }
    if (!hit.hit) {
      colour = scene_.background;
      return;
    }
    const SurfacePoint point = seen_point(scene_, source_[hit.triangle], hit, direction);
    const glm::dvec3 unlit = point.colour * ambient(point);
    colour = unlit;
    if (!needs_shadow_rays(point, scene_.light)) {
      return;
    }
    const int size = options_.shadow > 0 ? options_.shadow : kUnshadowedSamples;
    const Grid light = shadow_grid(scene_.light, size, x, y);
    if (options_.shadow == 0) {
      colour = unlit + reflected(point, light, shadow_origin(point), {});
      return;
    }
    waiting_.push_back({pixel, unlit, point, light});
    if (waiting_.size() == kBatch) {
      trace_shadows();
    }
  }

  void trace_shadows() {
    std::vector<Pencil> pencils;
    pencils.reserve(waiting_.size());
    for (const Lit& lit : waiting_) {
      pencils.push_back(shadow_pencil(lit.point, lit.light));
    }
    const auto hits = trace(pencils, result_.stats.shadow_rays);
    for (std::size_t k = 0; k < waiting_.size(); ++k) {
      const Lit& lit = waiting_[k];
      result_.image.pixels[lit.pixel] =
          lit.colour + reflected(lit.point, lit.light, pencils[k].origin, hits[k]);
    }
    waiting_.clear();
  }

  /// Light from everywhere, of which surfaces that face up get twice as much as those that face down.
  [[nodiscard]] glm::dvec3 ambient(const SurfacePoint& point) const {
    return scene_.ambient * (0.75 + 0.25 * glm::dot(point.normal, up_));
  }

  /// What the point reflects of the light whose samples no hit hides (none of them if there are no hits).
  [[nodiscard]] glm::dvec3 reflected(const SurfacePoint& point, const Grid& light, const glm::dvec3& origin,
                                     std::span<const Hit> hidden) const {
    double irradiance = 0;  // at radiance 1
    for (int r = 0; r < light.rows; ++r) {
      for (int c = 0; c < light.columns; ++c) {
        const int ray = r * light.columns + c;
        if (hidden.empty() || !hidden[static_cast<std::size_t>(ray)].hit) {
          const glm::dvec3 to =
              light.first + double(r) * light.row_step + double(c) * light.column_step - origin;
          irradiance += form_factor(point, to, light_normal_, light_area_ / (light.rows * light.columns));
        }
      }
    }
    return point.colour * (scene_.light.intensity * (irradiance / glm::pi<double>()));
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
  std::vector<Lit> waiting_;
  Rendering result_;
};

}  // namespace

Rendering render(const Scene& scene, std::span<const std::uint32_t> source, IntersectionDevice& device,
                 const RenderOptions& options, const RenderHooks& hooks) {
  return Renderer(scene, source, device, options, hooks).run();
}

}  // namespace raplas
