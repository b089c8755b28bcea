#include "stress_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "exact_truth.hpp"
#include "raplas/sphere_tree.hpp"

namespace raplas {
namespace {

/// Hits less deep than this share of `far` must be found: the code of `far`, rounded down, is 2^-10 less at
/// most.
constexpr double kBeforeFar = 1 - 0x1p-9;
/// Hits of any-hit pencils lie before this many times `far`: device.hpp.
constexpr double kBehindFar = 1 + 0x1p-8;
/// What double precision adds to a band when t is compared with it.
constexpr double kDivision = 1e-12;
/// A closed mesh is thicker than this where rays that pass through it count as leaks.
constexpr double kThick = 0x1p-7;

/// A device's answer for a ray; `triangle` is an index of the case's list.
struct Answer {
  bool hit = false;
  std::uint32_t triangle = 0;
  std::uint32_t id = 0;  ///< of the triangle in the device
  Hit words;
};

using Answers = std::vector<std::vector<Answer>>;

/// One ray of a scene.
struct Ray {
  const Pencil& pencil;
  const glm::dvec3& direction;

  [[nodiscard]] double along() const { return glm::dot(pencil.axis, direction); }
};

/// The true hits of all rays of a scene.
std::vector<std::vector<TrueHits>> truth_of(const StressScene& scene) {
  const ExactTruth exact(scene.triangles);
  std::vector<std::vector<TrueHits>> truth;
  truth.reserve(scene.pencils.size());
  for (const Pencil& pencil : scene.pencils) {
    std::vector<TrueHits>& of_pencil = truth.emplace_back();
    of_pencil.reserve(pencil.directions.size());
    for (const glm::dvec3& direction : pencil.directions) {
      of_pencil.push_back(exact.hits(pencil.origin, direction));
    }
  }
  return truth;
}

/// A device with a scene in it.
class Loaded {
 public:
  Loaded(const StressDevice& device, const StressScene& scene)
      : device_(make_device(device.maker, device.options)) {
    tree_ = device.flat ? build_flat(scene.triangles, scene.tree) : build_tree(scene.triangles, scene.tree);
    check_tree(tree_.scene);
    for (const Pencil& pencil : scene.pencils) {
      tree_.scene.max_origin = std::max(tree_.scene.max_origin, glm::length(pencil.origin) * (1 + 0x1p-40));
    }
    device_->load(tree_.scene);
  }

  [[nodiscard]] Answers answers(std::span<const Pencil> pencils) {
    const auto hits = device_->trace(pencils);
    Answers all;
    all.reserve(hits.size());
    for (const std::vector<Hit>& of_pencil : hits) {
      std::vector<Answer>& answers = all.emplace_back();
      answers.reserve(of_pencil.size());
      for (const Hit& hit : of_pencil) {
        answers.push_back({hit.hit, hit.hit ? tree_.source[hit.triangle] : 0, hit.triangle, hit});
      }
    }
    return all;
  }

  [[nodiscard]] const DeviceScene& scene() const { return tree_.scene; }

 private:
  std::unique_ptr<IntersectionDevice> device_;
  SphereTree tree_;
};

/// The true answer as far as it matters: hits at `far` and beyond don't.
bool truly_hit(const Ray& ray, const TrueHits& truth) {
  return !truth.nearest.empty() && truth.t * ray.along() < ray.pencil.far;
}

bool is_true(const Ray& ray, const TrueHits& truth, const Answer& answer) {
  const bool hit = answer.hit && answer.words.t() * ray.along() < ray.pencil.far;
  if (hit != truly_hit(ray, truth) || !hit || ray.pencil.any_hit) {
    return hit == truly_hit(ray, truth);
  }
  return std::binary_search(truth.nearest.begin(), truth.nearest.end(), answer.triangle);
}

/// Whether roundings within a device's error bound may lead to an answer.
class Explanation {
 public:
  Explanation(const ErrorModel& model, const std::vector<Triangle>& triangles)
      : model_(model), triangles_(triangles) {}

  /// `t`: what the device says it is; none is what any t may be.
  [[nodiscard]] bool explains(const Ray& ray, const TrueHits& truth, std::optional<std::uint32_t> triangle,
                              std::optional<double> t) const {
    const double along = ray.along();
    Band found;
    found.t_low = std::numeric_limits<double>::infinity();
    if (triangle) {
      found = band(ray, *triangle);
      const double low = found.t_low * (1 - kDivision);
      const double high = found.t_high * (1 + kDivision);
      if (found.verdict == Verdict::miss || (t && (*t < low || *t > high))) {
        return false;
      }
      if (ray.pencil.any_hit) {
        return !t || *t * along < ray.pencil.far * kBehindFar;
      }
    }
    return std::none_of(truth.candidates.begin(), truth.candidates.end(), [&](std::uint32_t other) {
      const Band b = band(ray, other);
      return b.verdict == Verdict::hit && b.deep_enough && b.t_high < found.t_low &&
             b.t_high * along < ray.pencil.far * kBeforeFar;
    });
  }

 private:
  [[nodiscard]] Band band(const Ray& ray, std::uint32_t triangle) const {
    return error_band(model_, triangles_[triangle], ray.pencil.origin, ray.direction);
  }

  ErrorModel model_;
  const std::vector<Triangle>& triangles_;
};

/// A case's input with what all devices are compared with.
class Judge {
 public:
  Judge(const StressCase& stress, const StressInput& input) : property_(stress.property), input_(input) {
    truth_ = truth_of(input.scene);
    if (property_ == Property::moved) {
      base_truth_ = truth_of(input.base);
      index_in_scene_.resize(input.base_of.size());
      for (std::uint32_t k = 0; k < input.base_of.size(); ++k) {
        index_in_scene_[input.base_of[k]] = k;
      }
    }
  }

  /// `base`: the device's answers of the input's base, for Property::same_hits.
  [[nodiscard]] StressCounts count(const StressDevice& device, const DeviceScene& loaded,
                                   const Answers& answers, const Answers& base) const {
    StressCounts counts;
    const Explanation explanation(device.errors, input_.scene.triangles);
    const auto lowest =
        property_ == Property::lower_id ? lowest_ids(loaded) : std::map<Words, std::uint32_t>{};
    for (std::size_t p = 0; p < answers.size(); ++p) {
      const std::size_t of_scene = p * device.share;
      const Pencil& pencil = input_.scene.pencils[of_scene];
      for (std::size_t k = 0; k < pencil.directions.size(); ++k) {
        const Ray ray{pencil, pencil.directions[k]};
        const Answer& answer = answers[p][k];
        const TrueHits& truth = truth_[of_scene][k];
        ++counts.rays;
        counts.hits += truly_hit(ray, truth) ? 1U : 0U;
        counts.unexplained += explains(explanation, ray, truth, answer) ? 0U : 1U;
        bool same = is_true(ray, truth, answer);
        if (same && answer.hit && !pencil.any_hit) {
          const double error = std::abs(answer.words.t() - truth.t) / truth.t;
          counts.t_error = std::max(counts.t_error, error);
        }
        if (property_ == Property::moved) {
          const TrueHits moved = in_scene(base_truth_[of_scene][k]);
          same = is_true(ray, moved, answer);
          counts.broken += is_explained_truth(explanation, ray, truth, moved) ? 0U : 1U;
        } else if (property_ == Property::same_hits) {
          counts.broken += agree(answer, base[p][k]) ? 0U : 1U;
        } else {
          counts.broken += is_broken(ray, truth, answer, loaded, lowest) ? 1U : 0U;
        }
        counts.differing += same ? 0U : 1U;
      }
    }
    return counts;
  }

 private:
  using Words = std::array<double, 9>;

  static Words words_of(const Triangle& t) {
    return {t.v0.x, t.v0.y, t.v0.z, t.e1.x, t.e1.y, t.e1.z, t.e2.x, t.e2.y, t.e2.z};
  }

  static std::map<Words, std::uint32_t> lowest_ids(const DeviceScene& scene) {
    std::map<Words, std::uint32_t> lowest;
    for (std::uint32_t id = 0; id < scene.triangles.size(); ++id) {
      lowest.try_emplace(words_of(scene.triangles[id]), id);
    }
    return lowest;
  }

  static bool explains(const Explanation& explanation, const Ray& ray, const TrueHits& truth,
                       const Answer& answer) {
    return answer.hit ? explanation.explains(ray, truth, answer.triangle, answer.words.t())
                      : explanation.explains(ray, truth, std::nullopt, std::nullopt);
  }

  /// Could the device have given the true answer of the scene before it was moved?
  static bool is_explained_truth(const Explanation& explanation, const Ray& ray, const TrueHits& truth,
                                 const TrueHits& moved) {
    if (moved.nearest.empty()) {
      return explanation.explains(ray, truth, std::nullopt, std::nullopt);
    }
    return std::any_of(moved.nearest.begin(), moved.nearest.end(), [&](std::uint32_t triangle) {
      return explanation.explains(ray, truth, triangle, std::nullopt);
    });
  }

  [[nodiscard]] TrueHits in_scene(TrueHits truth) const {
    for (std::uint32_t& triangle : truth.nearest) {
      triangle = index_in_scene_[triangle];
    }
    std::sort(truth.nearest.begin(), truth.nearest.end());
    return truth;
  }

  [[nodiscard]] bool agree(const Answer& answer, const Answer& base) const {
    if (!answer.hit || !base.hit) {
      return answer.hit == base.hit;
    }
    const Hit& a = answer.words;
    const Hit& b = base.words;
    if (input_.base_of[answer.triangle] != base.triangle) {
      return a.t_scaled * b.d == b.t_scaled * a.d;  // exact for words of 24 bits
    }
    return a.t_scaled == b.t_scaled && a.d == b.d && a.u_scaled == b.u_scaled && a.v_scaled == b.v_scaled;
  }

  [[nodiscard]] bool is_broken(const Ray& ray, const TrueHits& truth, const Answer& answer,
                               const DeviceScene& loaded,
                               const std::map<Words, std::uint32_t>& lowest) const {
    switch (property_) {
      case Property::lower_id:
        return answer.hit && answer.id != lowest.at(words_of(loaded.triangles[answer.id]));
      case Property::inside:
        return !answer.hit;
      case Property::outside:
        return passes_within(ray, truth) &&
               (!answer.hit || (shows_back(answer.triangle, ray.direction) &&
                                (comes_out(ray, truth) || answer.words.t() - truth.t > kThick)));
      case Property::leaves:
      case Property::grazes:
        return answer.hit;
      default:
        return false;
    }
  }

  /// Does the ray pass the mesh not just at its outline, or come out of it without having gone in?
  [[nodiscard]] bool passes_within(const Ray& ray, const TrueHits& truth) const {
    return !truth.nearest.empty() && (truth.t_last - truth.t > kThick || comes_out(ray, truth));
  }

  /// Is the back of a triangle the first that it truly meets?
  [[nodiscard]] bool comes_out(const Ray& ray, const TrueHits& truth) const {
    return std::all_of(truth.nearest.begin(), truth.nearest.end(),
                       [&](std::uint32_t triangle) { return shows_back(triangle, ray.direction); });
  }

  [[nodiscard]] bool shows_back(std::uint32_t triangle, const glm::dvec3& direction) const {
    const Triangle& t = input_.scene.triangles[triangle];
    return glm::dot(glm::cross(t.e1, t.e2), direction) > 0;
  }

  Property property_;
  const StressInput& input_;
  std::vector<std::vector<TrueHits>> truth_;
  std::vector<std::vector<TrueHits>> base_truth_;  ///< Property::moved
  std::vector<std::uint32_t> index_in_scene_;      ///< Property::moved: by triangle of the base
};

std::vector<Pencil> every(std::span<const Pencil> pencils, std::size_t step) {
  std::vector<Pencil> some;
  for (std::size_t k = 0; k < pencils.size(); k += step) {
    some.push_back(pencils[k]);
  }
  return some;
}

/// One line, with something in it?
bool is_one_line(const std::string& text) { return !text.empty() && text.find('\n') == std::string::npos; }

StressCounts refused(const StressCase& stress, const std::string& text) {
  StressCounts counts;
  counts.refusal = text;
  counts.broken = stress.property == Property::refused && is_one_line(text) ? 0 : 1;
  return counts;
}

/// Answers that are not those of the reference device, bit by bit; of any-hit pencils whether there is a hit.
std::uint64_t inexact(const StressDevice& device, const Answers& answers, const StressScene& scene) {
  Loaded reference({"reference", "reference", {}, kDoubleErrors}, scene);
  const std::vector<Pencil> pencils = every(scene.pencils, device.share);
  const Answers right = reference.answers(pencils);
  std::uint64_t count = 0;
  for (std::size_t p = 0; p < pencils.size(); ++p) {
    for (std::size_t k = 0; k < right[p].size(); ++k) {
      const Hit& a = answers[p][k].words;
      const Hit& b = right[p][k].words;
      count += (pencils[p].any_hit ? a.hit == b.hit : a == b) ? 0U : 1U;
    }
  }
  return count;
}

/// The input of a case on one device; `judge` is made when the first device has answered.
StressCounts run_device(const StressCase& stress, const StressInput& input, const StressDevice& device,
                        std::optional<Judge>& judge) {
  Answers answers;
  Answers base;
  std::optional<Loaded> loaded;
  try {
    loaded.emplace(device, input.scene);
    answers = loaded->answers(every(input.scene.pencils, device.share));
    if (stress.property == Property::same_hits) {
      base = Loaded(device, input.base).answers(every(input.base.pencils, device.share));
    }
  } catch (const std::exception& error) {
    return refused(stress, error.what());
  }
  if (!judge) {
    judge.emplace(stress, input);
  }
  StressCounts counts = judge->count(device, loaded->scene(), answers, base);
  if (device.options.exact) {
    counts.inexact = inexact(device, answers, input.scene);
  }
  return counts;
}

/// The seed of a case: its name's.
std::uint64_t seed_of(const std::string& name) {
  std::uint64_t seed = 0xcbf29ce484222325U;  // FNV-1a
  for (const char c : name) {
    seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  return seed;
}

}  // namespace

std::span<const StressDevice> stress_devices() {
  static const std::vector<StressDevice> kDevices{
      {"reference", "reference", {}, kDoubleErrors, false, false, true, 1, true},
      {"paper", "model", {.profile = Profile::paper}, kPaperErrors, true, true, false},
      {"raplas", "model", {}, kRaplasErrors},
      {"exact", "model", {.exact = true}, kDoubleErrors, false, true, true, 1, true},
#ifdef RAPLAS_WITH_RTL
      {"rtl", "rtl", {}, kRaplasErrors, false, true, true, 16},
      {"exact_rtl", "rtl", {.exact = true}, kDoubleErrors, false, true, true, 16, true},
#endif
  };
  return kDevices;
}

bool is_promised(const StressCase& stress, const StressDevice& device) {
  switch (stress.property) {
    case Property::inside:
    case Property::outside:
      return device.closed && !stress.control;
    case Property::grazes:
      return false;
    case Property::leaves:
      return !stress.control && device.near_plane;
    default:
      return true;
  }
}

const char* name_of(Property property) {
  constexpr std::array<const char*, 9> kNames{"explained", "moved",  "same_hits", "lower_id", "inside",
                                              "outside",   "leaves", "grazes",    "refused"};
  return kNames.at(static_cast<std::size_t>(property));
}

std::vector<StressCounts> run_case(const StressCase& stress, std::size_t rays,
                                   std::span<const StressDevice> devices) {
  Dice dice(seed_of(stress.name));
  StressInput input;
  try {
    input = stress.make(rays, dice);
  } catch (const std::exception& error) {
    if (stress.property != Property::refused) {
      throw;
    }
    return std::vector<StressCounts>(devices.size(), refused(stress, error.what()));
  }
  std::vector<StressCounts> results;
  std::optional<Judge> judge;
  for (const StressDevice& device : devices) {
    const bool skipped = stress.property == Property::refused && !device.refuses;
    results.push_back(skipped ? StressCounts{} : run_device(stress, input, device, judge));
  }
  return results;
}

}  // namespace raplas
