// What the enlarged radius costs in real scenes, and whether their words lie within the ranges of the
// theorems of formal/bounds. RAPLAS_CASES, if it is set, asks for larger pictures and the bunny.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "exact_distance.hpp"
#include "figures.hpp"
#include "normalised.hpp"
#include "raplas/encode.hpp"
#include "raplas/pencil.hpp"
#include "raplas/renderer.hpp"
#include "raplas/scene.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

/// Of the spheres that pencils meet on their way through a tree.
struct Price {
  std::uint64_t planes = 0;        ///< pairs of sphere and plane that meet, in double precision
  std::uint64_t extra_planes = 0;  ///< that meet for the device only
  std::uint64_t spheres = 0;       ///< spheres that meet a row and a column of a pencil
  std::uint64_t extra_spheres = 0;
  std::uint64_t lost = 0;     ///< planes that meet, but not for the device
  std::uint64_t too_far = 0;  ///< extra planes beyond what the enlargement and an error as large explain
  std::uint64_t outside = 0;  ///< words of scene and pencils that are not in the ranges of formal/bounds
  double percent_planes() const {
    return 100.0 * static_cast<double>(extra_planes) / static_cast<double>(planes);
  }
  double percent_spheres() const {
    return 100.0 * static_cast<double>(extra_spheres) / static_cast<double>(spheres);
  }
};

/// The model's value-exact walk, with an account of its plane tests.
template <typename F>
class Accountant final : public IntersectionDevice {
 public:
  void load(const DeviceScene& scene) override {
    scene_ = scene;
    memory_ = encode<F>(scene, {});
    for (const SphereWord<F>& sphere : memory_.spheres) {
      check(sphere.centre, kMaxCentre);
    }
    for (const TriangleWord<F>& t : memory_.triangles) {
      check(t.v0, kMaxVertex);
      check(t.e1, kMaxEdge);
      check(t.e2, kMaxEdge);
      check(t.n, kMaxNormal);
      price_.outside += glm::length(decode(t.e1) - decode(t.e2)) <= kMaxEdge ? 0U : 1U;
    }
  }

  std::vector<std::vector<Hit>> trace(std::span<const Pencil> pencils) override {
    std::vector<std::vector<Hit>> hits;
    hits.reserve(pencils.size());
    for (const Pencil& pencil : pencils) {
      hits.push_back(trace_one(pencil));
    }
    return hits;
  }

  [[nodiscard]] Counters counters() const override { return {}; }
  [[nodiscard]] const Price& price() const { return price_; }

 private:
  std::vector<Hit> trace_one(const Pencil& pencil) {
    const PencilMemory<F> words = encode<F>(pencil);
    check(words.pencil.origin, kMaxOrigin);
    for (const auto& planes : {words.rows, words.columns}) {
      for (const PlaneWord<F>& plane : planes) {
        check(plane.normal, kMaxUnit);
        check({plane.offset, {}, {}}, kMaxOffset);
      }
    }
    for (const Vec3<F>& direction : words.rays) {
      check(direction, kMaxUnit);
    }
    std::vector<SphereRange> ranges{{scene_.root_first, scene_.root_count}};
    while (!ranges.empty()) {
      const SphereRange range = ranges.back();
      ranges.pop_back();
      for (std::uint32_t id = range.first; id < range.first + range.count; ++id) {
        const auto rows = account(id, pencil.row_planes, words.rows);
        const auto columns = account(id, pencil.column_planes, words.columns);
        const bool truly = rows.truly && columns.truly;
        const bool here = rows.here && columns.here;
        price_.spheres += truly ? 1U : 0U;
        price_.extra_spheres += here && !truly ? 1U : 0U;
        if (here && !scene_.nodes[id].leaf) {
          ranges.push_back({scene_.nodes[id].first, scene_.nodes[id].count});
        }
      }
    }
    ResultMemory<F> results;
    EventCounters counters;
    trace_pencil(memory_, words, results, counters);
    std::vector<Hit> hits;
    for (std::size_t r = 0; r < static_cast<std::size_t>(pencil.rows); ++r) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(pencil.columns); ++c) {
        hits.push_back(decode(results[r * kMaxColumns + c]));
      }
    }
    return hits;
  }

  struct Meets {
    bool truly = false;
    bool here = false;
  };

  /// Is the vector one of those that the theorems of formal/bounds are about?
  void check(const Vec3<F>& v, double limit) { price_.outside += glm::length(decode(v)) <= limit ? 0U : 1U; }

  template <typename Words>
  Meets account(std::uint32_t id, const std::vector<Plane>& planes, const Words& words) {
    const SphereNode& node = scene_.nodes[id];
    const SphereWord<F>& sphere = memory_.spheres[id];
    Meets any;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const long double distance = exact_distance(planes[k], node.centre).first;
      const bool truly = distance <= node.radius;
      const bool here = plane_meets_sphere(words[k], sphere.centre, sphere.radius);
      price_.planes += truly ? 1U : 0U;
      price_.extra_planes += here && !truly ? 1U : 0U;
      price_.lost += truly && !here ? 1U : 0U;
      price_.too_far += here && distance > 2 * sphere.radius.to_double() - node.radius ? 1U : 0U;
      any.truly |= truly;
      any.here |= here;
    }
    return any;
  }

  DeviceScene scene_;
  SceneMemory<F> memory_;
  Price price_;
};

template <typename F>
Price price_of(const std::filesystem::path& file, int size) {
  const Scene scene = load_scene(file);
  TreeOptions options;
  options.longest_edge = kWholeTriangles;
  SphereTree tree = build_tree(scene.triangles, options);
  tree.scene.max_origin = scene.max_origin;
  Accountant<F> device;
  device.load(tree.scene);
  RenderOptions picture;
  picture.width = size;
  picture.height = size;
  (void)render(scene, tree.source, device, picture);
  return device.price();
}

TEST(ConservativeRadius, CostsFewFalseHitsInRealScenes) {
  const bool is_long = std::getenv("RAPLAS_CASES") != nullptr;
  std::vector<std::filesystem::path> files{std::filesystem::path(RAPLAS_SCENES) / "cornell_teapot.json"};
  const std::filesystem::path bunny = std::filesystem::path(RAPLAS_MESHES) / "bunny_69k.obj";
  if (is_long && std::filesystem::exists(bunny)) {  // `make scenes` fetches it
    files.push_back(bunny);
  }
  Figures figures;
  for (const auto& file : files) {
    const std::string suffix = file == files.front() ? "" : "." + file.stem().string();
    for (const auto& [adder, price] : {std::pair{"", price_of<Fp24>(file, is_long ? 128 : 32)},
                                       std::pair{"_paper", price_of<Fp24Paper>(file, is_long ? 128 : 32)}}) {
      fmt::print("{}{}: {} true plane hits, {} extra ({:.3f} %); {} true sphere hits, {} extra ({:.3f} %)\n",
                 file.stem().string(), adder, price.planes, price.extra_planes, price.percent_planes(),
                 price.spheres, price.extra_spheres, price.percent_spheres());
      EXPECT_EQ(price.lost, 0U);
      EXPECT_EQ(price.outside, 0U);
      EXPECT_EQ(price.too_far, 0U);
      EXPECT_GT(price.spheres, 5'000U);
      // a tenth of this is usual: more, and radii are enlarged by something of another size
      EXPECT_LT(price.percent_planes(), 5);
      EXPECT_LT(price.percent_spheres(), 5);
      figures.add("radius.extra_false_hits_percent" + suffix + adder, price.percent_planes(),
                  "% of plane hits of spheres");
      figures.add("radius.extra_false_spheres_percent" + suffix + adder, price.percent_spheres(),
                  "% of spheres that meet a row and a column");
    }
  }
  figures.write("_scenes");
}

}  // namespace
}  // namespace raplas
