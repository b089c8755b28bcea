// decisions: single tests of rays against triangles and of spheres against rays and planes, very many of
// them, on random inputs at their edges. Exit code 1 if one is not what its error bound says.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "error_band.hpp"
#include "figure_file.hpp"
#include "parallel.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "raplas/encode.hpp"
#include "raplas/encode_fixed.hpp"
#include "raplas/pencil.hpp"
#include "raplas/plane_sphere.hpp"
#include "stress_meshes.hpp"

namespace raplas {
namespace {

constexpr double kUnit = 1.0 / (1 << kCoordinateFraction);

/// More than what double precision makes of a distance below 4.
constexpr double kDoubleError = 0x1p-46;

struct CommandLine {
  double count = 2e8;
  std::string json;  ///< empty: none
  bool quiet = false;
};

/// Tests of one kind.
struct Kind {
  std::uint64_t decided = 0;  ///< whose answer is certain
  std::uint64_t wrong = 0;
  std::uint64_t open = 0;  ///< within the error bound: either answer is right

  void add(const Kind& other) {
    decided += other.decided;
    wrong += other.wrong;
    open += other.open;
  }
  void judge(bool certain, bool right) {
    ++(certain ? decided : open);
    wrong += certain && !right ? 1U : 0U;
  }
};

struct Decisions {
  Kind triangles_paper;
  Kind triangles_raplas;
  Kind triangles_certified;  ///< a hit must be possible
  Kind spheres_paper;        ///< a plane that meets the sphere must be found to
  Kind spheres_raplas;       ///< a ray that meets the sphere must be found by its row and column

  void add(const Decisions& d) {
    triangles_paper.add(d.triangles_paper);
    triangles_raplas.add(d.triangles_raplas);
    triangles_certified.add(d.triangles_certified);
    spheres_paper.add(d.spheres_paper);
    spheres_raplas.add(d.spheres_raplas);
  }
};

/// Within the unit ball, edges of 2^-10 to 1, not too thin for a word's N.
Triangle some_triangle(Dice& dice) {
  for (;;) {
    const double size = std::exp2(dice.uniform(-10, 0));
    const Triangle t{dice.in_ball(0.95), size * dice.on_sphere(),
                     size * dice.uniform(0.05, 1) * dice.on_sphere()};
    if (std::max(glm::length(t.v0 + t.e1), glm::length(t.v0 + t.e2)) < 0.99 &&
        glm::length(glm::cross(t.e1, t.e2)) > 0.01 * size * size) {
      return t;
    }
  }
}

/// 16x16 rays that cover the triangle and its surroundings.
Pencil pencil_over(Dice& dice, const Triangle& t) {
  for (;;) {
    const glm::dvec3 middle = t.v0 + (t.e1 + t.e2) / 3.0;
    const glm::dvec3 origin = dice.in_ball(0.99);
    const double reach = std::max(glm::length(t.e1), glm::length(t.e2));
    if (glm::distance(origin, middle) < 0.3 * reach) {
      continue;
    }
    const glm::dvec3 axis = glm::normalize(middle - origin);
    const glm::dvec3 u = glm::normalize(glm::cross(axis, dice.on_sphere()));
    const glm::dvec3 v = glm::cross(axis, u);
    const double step = reach / dice.uniform(6, 14);
    return make_pencil(origin, {middle - 8.0 * step * (u + v), step * u, step * v, kMaxRows, kMaxColumns});
  }
}

/// A sphere that a random ray of the pencil touches, nearly or exactly; half of them across one of its
/// planes.
SphereNode some_sphere(Dice& dice, const Pencil& pencil) {
  for (;;) {
    const auto ray = static_cast<std::size_t>(dice.uniform(0, 256));
    const glm::dvec3& direction = pencil.directions[ray];
    const bool across = dice.uniform(0, 1) < 0.5;
    const auto& planes = dice.uniform(0, 1) < 0.5 ? pencil.row_planes : pencil.column_planes;
    const std::size_t line = &planes == &pencil.row_planes ? ray / kMaxColumns : ray % kMaxColumns;
    const double size = std::exp2(dice.uniform(-12, -1));
    const glm::dvec3 centre =
        across ? pencil.origin + dice.uniform(0, 2) * direction + size * planes[line].normal
               : dice.in_ball(0.95);
    const glm::dvec3 to = centre - pencil.origin;
    const double distance = glm::length(to - glm::dot(to, direction) * direction);
    const double radius = distance * (1 + dice.uniform(-1, 1) * std::exp2(dice.uniform(-40, 0)));
    if (radius > 1e-4 && glm::length(centre) + radius < 0.99) {
      return {centre, radius, true, 0, 1};
    }
  }
}

class Block {
 public:
  explicit Block(std::uint64_t seed)
      : dice_(seed), triangle_(some_triangle(dice_)), pencil_(pencil_over(dice_, triangle_)) {
    scene_.triangles.push_back(triangle_);
    scene_.nodes.push_back({glm::dvec3(0), 1, true, 0, 1});
    scene_.root_count = 1;
  }

  Decisions run() {
    Decisions d;
    test_triangle(d);
    for (int k = 0; k < kSpheres; ++k) {
      test_sphere(some_sphere(dice_, pencil_), d);
    }
    return d;
  }

  static constexpr int kSpheres = 3;

 private:
  void test_triangle(Decisions& d) const {
    const TriangleWord<Fp24Paper> paper = encode<Fp24Paper>(triangle_);
    const TriangleWord<Fp24> raplas = encode<Fp24>(triangle_);
    const FixedScene certified = encode_fixed(scene_, true);
    const FixedPencil words = encode_fixed(pencil_, certified.vertex_error, true);
    const FixedPencilMemory<Fp24>& memory = words.memory;
    const auto origin = encode<Fp24Paper>(pencil_.origin, "origin");
    for (std::size_t ray = 0; ray < pencil_.directions.size(); ++ray) {
      const glm::dvec3& direction = pencil_.directions[ray];
      const auto judge = [&](Kind& kind, const ErrorModel& errors, bool hit) {
        const Verdict verdict = error_band(errors, triangle_, pencil_.origin, direction).verdict;
        kind.judge(verdict != Verdict::undecided, hit == (verdict == Verdict::hit));
      };
      judge(d.triangles_paper, kPaperErrors,
            solve(paper, origin, encode<Fp24Paper>(direction, "direction")).hit);
      judge(d.triangles_raplas, kRaplasErrors, solve(raplas, memory.pencil.origin, memory.rays[ray]).hit);
      const bool possible = solve(certified.memory.triangles[0], memory.pencil.origin, memory.rays[ray],
                                  Fp24::from_bits(memory.limits.band))
                                .hit;
      const Verdict truth = error_band(kDoubleErrors, triangle_, pencil_.origin, direction).verdict;
      d.triangles_certified.judge(truth != Verdict::undecided, truth == Verdict::miss || possible);
    }
  }

  void test_sphere(const SphereNode& sphere, Decisions& d) const {
    const auto centre = encode<Fp24Paper>(sphere.centre, "centre");
    const double apart = glm::distance(decode(centre), sphere.centre);
    const Fp24Paper radius =
        Fp24Paper::from_double_up(conservative_radius(decode(centre), sphere.radius + apart, 1), "radius");
    for (const std::vector<Plane>* planes : {&pencil_.row_planes, &pencil_.column_planes}) {
      for (const Plane& plane : *planes) {
        const PlaneWord<Fp24Paper> word{encode<Fp24Paper>(plane.normal, "normal"),
                                        Fp24Paper::from_double(plane.offset, "offset")};
        const double distance = std::abs(glm::dot(plane.normal, sphere.centre) + plane.offset);
        const bool meets = distance < sphere.radius;
        d.spheres_paper.judge(std::abs(distance - sphere.radius) > kDoubleError,
                              !meets || plane_meets_sphere(word, centre, radius));
      }
    }
    const FixedPencilMemory<Fp24> memory = encode_fixed(pencil_).memory;
    FixedVec3 word{};
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      word[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(std::lrint(sphere.centre[k] / kUnit));
      square += std::pow(sphere.centre[k] - word[static_cast<std::size_t>(k)] * kUnit, 2);
    }
    const double held = (sphere.radius + std::sqrt(square)) * (1 + 0x1p-40) / kUnit;
    const FixedTest test =
        test_object(memory.planes, word, static_cast<std::uint32_t>(std::ceil(held)), memory.limits.slack);
    for (std::size_t ray = 0; ray < pencil_.directions.size(); ++ray) {
      const glm::dvec3 to = sphere.centre - pencil_.origin;
      const double along = glm::dot(to, pencil_.directions[ray]);
      const double distance = along > 0 ? glm::length(to - along * pencil_.directions[ray]) : glm::length(to);
      const bool meets = distance < sphere.radius;
      const bool found =
          (test.rows_meet >> (ray / kMaxColumns) & test.columns_meet >> (ray % kMaxColumns) & 1U) != 0;
      d.spheres_raplas.judge(std::abs(distance - sphere.radius) > kDoubleError,
                             !meets || (found && test.near));
    }
  }

  Dice dice_;
  Triangle triangle_;
  Pencil pencil_;
  DeviceScene scene_;
};

int run(const CommandLine& line, const std::string& command) {
  FigureFile figures(line.json, command);
  // of a block there are 3 x 256 ray-triangle decisions and more of spheres
  constexpr double kOfBlock = 3.0 * kMaxRays;
  constexpr std::size_t kShares = 200;
  const auto blocks = static_cast<std::size_t>(std::ceil(line.count / kOfBlock / kShares));
  std::vector<Decisions> shares(kShares);
  {
    Progress progress("decisions", line.quiet);
    for_each_parallel(
        kShares,
        [&](std::size_t share) {
          for (std::size_t k = 0; k < blocks; ++k) {
            shares[share].add(Block(share * blocks + k).run());
          }
        },
        [&](double done) { progress.show(done); });
  }
  Decisions all;
  for (const Decisions& share : shares) {
    all.add(share);
  }
  std::uint64_t decided = 0;
  std::uint64_t wrong = 0;
  fmt::print("{:<44}{:>14}{:>14}{:>8}\n", "", "decided", "either way", "wrong");
  const auto report = [&](const char* name, const char* title, const Kind& kind) {
    fmt::print("{:<44}{:>14}{:>14}{:>8}\n", title, kind.decided, kind.open, kind.wrong);
    figures.add(std::string("soak.") + name, kind.decided, "decisions");
    decided += kind.decided;
    wrong += kind.wrong;
  };
  report("triangles_paper", "ray and triangle, profile paper", all.triangles_paper);
  report("triangles_raplas", "ray and triangle, profile raplas", all.triangles_raplas);
  report("triangles_certified", "ray and triangle, certified", all.triangles_certified);
  report("spheres_paper", "plane and sphere, profile paper", all.spheres_paper);
  report("spheres_raplas", "ray and sphere by its planes, profile raplas", all.spheres_raplas);
  figures.add("soak.decisions", decided, "decisions");
  figures.add("soak.wrong", wrong, "decisions");
  figures.commit();
  return wrong == 0 ? 0 : 1;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Check single tests of triangles and spheres against their error bounds", "decisions"};
  CommandLine line;
  app.add_option("--count", line.count, "decisions of rays against triangles, about; more of spheres")
      ->check(CLI::Range(1.0, 1e12))
      ->capture_default_str();
  app.add_option("--json", line.json, "file for figures");
  app.add_flag("--quiet", line.quiet, "no progress");
  if (const auto exit_code = parse(app, argc, argv)) {
    return *exit_code;
  }
  return run(line, command_line(app, argc, argv));
}

}  // namespace
}  // namespace raplas

int main(int argc, char** argv) {
  return raplas::run_program("decisions", argc, argv, raplas::parse_and_run);
}
