// Runs the built `raplas`: pictures, figures, and one line for everything that goes wrong.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "test_folder.hpp"

namespace raplas {
namespace {

const std::string kScene = RAPLAS_SCENES "/cornell_teapot.json";

class Cli : public ::testing::Test {
 protected:
  /// Runs in the test's folder; returns the exit code. Output goes to the files "stdout" and "stderr".
  int raplas(const std::string& arguments) {
    const std::string command = fmt::format("cd '{}' && '{}' {} > stdout 2> stderr", folder_.path().string(),
                                            RAPLAS_BINARY, arguments);
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// The command must fail with this exit code and one line that holds `part`, and leave no file behind.
  void expect_error(const std::string& arguments, int code, const std::string& part) {
    folder_.write("stdout", "");
    folder_.write("stderr", "");
    const auto files = folder_.size();
    EXPECT_EQ(raplas(arguments), code) << arguments;
    const std::string error = folder_.read("stderr");
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_EQ(error.find("raplas: "), 0U) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(folder_.size(), files) << arguments << " left a file";
    EXPECT_EQ(folder_.read("stdout"), "");
  }

  void expect_bad_mesh(const std::string& name, const std::string& text, const std::string& cause) {
    folder_.write(name, text);
    expect_error("render " + name + " --device reference -o x.png", 1, name + ": " + cause);
  }

  nlohmann::json json(const std::string& name) { return nlohmann::json::parse(folder_.read(name)); }

  TestFolder folder_;
};

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kSmall = " --device reference --width 40 --height 24 ";

TEST_F(Cli, RendersThePictureAndTheFigures) {
  ASSERT_EQ(raplas("render " + kScene + kSmall + "-o a.png --json a.json --hits a.hits"), 0)
      << folder_.read("stderr");
  EXPECT_EQ(folder_.read("a.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto figures = json("a.json");
  EXPECT_EQ(figures["width"], 40);
  EXPECT_EQ(figures["triangles"], 1008);
  EXPECT_EQ(figures["rays"]["camera"], 960);
  EXPECT_GT(figures["rays"]["shadow"], 960);
  EXPECT_GT(figures["counters"]["hits"], 0);
  EXPECT_EQ(figures["degenerate_dropped"], 0);
  const std::string hits = folder_.read("a.hits");
  const std::size_t rays =
      figures["rays"]["camera"].get<std::size_t>() + figures["rays"]["shadow"].get<std::size_t>();
  EXPECT_EQ(hits.size(), hits.find('\n') + 1 + 37 * rays);
  EXPECT_NE(folder_.read("stderr").find("100 %"), std::string::npos);
  EXPECT_EQ(folder_.size(), 5);
}

TEST_F(Cli, RepeatsItselfBitForBit) {
  ASSERT_EQ(raplas("render " + kScene + kSmall + "--quiet -o a.png --hits a.hits"), 0);
  EXPECT_EQ(folder_.read("stderr") + folder_.read("stdout"), "");
  ASSERT_EQ(raplas("render " + kScene + kSmall + "--quiet -o b.png --hits b.hits"), 0);
  EXPECT_EQ(folder_.read("a.png"), folder_.read("b.png"));
  EXPECT_EQ(folder_.read("a.hits"), folder_.read("b.hits"));
}

TEST_F(Cli, FlatListAndTreeShowTheSamePicture) {
  ASSERT_EQ(raplas("render " + kScene + kSmall + "--structure flat --pencil 4 -o a.png --json a.json"), 0);
  ASSERT_EQ(raplas("render " + kScene + kSmall + "--profile raplas --leaf 1 -o b.png"), 0);
  EXPECT_EQ(folder_.read("a.png"), folder_.read("b.png"));
}

TEST_F(Cli, ProfilesSetPencilsAndStructure) {
  ASSERT_EQ(raplas("render " + kScene +
                   " --device reference --width 16 --height 16 --shadow 0 --profile paper "
                   "--json a.json"),
            0);
  EXPECT_EQ(json("a.json")["pencils"], 16);
  ASSERT_EQ(
      raplas("render " + kScene + " --device reference --width 16 --height 16 --shadow 0 --json a.json"), 0);
  EXPECT_EQ(json("a.json")["pencils"], 1);
}

TEST_F(Cli, DropsAndCountsDegenerateTriangles) {
  folder_.write("d.obj", kTriangle + "f 1 2 3\nf 1 2 2\nf 3 3 3\n");
  ASSERT_EQ(raplas("render d.obj" + kSmall + "--quiet --json a.json"), 0);
  EXPECT_EQ(json("a.json")["degenerate_dropped"], 2);
  EXPECT_EQ(json("a.json")["triangles"], 3);  // with the floor's two
  EXPECT_NE(folder_.read("stderr").find("d.obj: 2 degenerate triangles dropped"), std::string::npos);
}

TEST_F(Cli, NamesBadMeshes) {
  expect_error("render gone.obj --device reference -o x.png", 1, "gone.obj: no such file");
  expect_error("render gone.json --device reference -o x.png", 1, "gone.json: no such file");
  expect_bad_mesh("text.ply", "not a mesh at all\n", "not a mesh");
  expect_bad_mesh("empty.obj", "", "not a mesh");
  expect_bad_mesh("bad.json", "{", "not a JSON file");
  expect_bad_mesh("bad.bpt", "1\n3 3\n0 0 0\n", "patch 1");
  expect_bad_mesh("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 2");
  expect_bad_mesh("inf.obj", "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n", "vertex 3");
  expect_bad_mesh("points.obj", kTriangle, "no triangles");
  expect_bad_mesh("range.obj", kTriangle + "f 1 2 9\n", "not a mesh (OBJ: vertex index out of range)");
  expect_bad_mesh("flat.obj", kTriangle + "f 1 2 2\n", "no triangles with an area");
}

TEST_F(Cli, RefusesScenesThatAreTooLargeForTheMemories) {
  std::string grid;
  for (int k = 0; k < 4100; ++k) {
    grid += fmt::format("v {0} 0 0\nv {0}.5 0 1\nv {0}.5 1 0\nf {1} {2} {3}\n", k, 3 * k + 1, 3 * k + 2,
                        3 * k + 3);
  }
  folder_.write("grid.obj", grid);
  expect_error("render grid.obj --device reference --memories chip", 1,
               "grid.obj: 4102 triangles, the Triangle Memory holds 4096");
  EXPECT_EQ(raplas("render grid.obj --shadow 0" + kSmall), 0);
  folder_.write("spheres.obj", grid.substr(0, grid.find("v 4000 ")));
  expect_error("render spheres.obj --device reference --memories chip --leaf 1", 1,
               "spheres, the Sphere Memory holds 4096");
}

TEST_F(Cli, FindsUnwritableOutputBeforeRendering) {
  expect_error("render gone.obj -o missing/x.png", 1, "missing/x.png: cannot be written");
  expect_error("render gone.obj --json missing/x.json", 1, "missing/x.json: cannot be written");
  expect_error("render gone.obj --hits missing/x.hits", 1, "missing/x.hits: cannot be written");
  expect_error("render gone.obj -o .", 1, "is not the name of a file");
}

TEST_F(Cli, FindsAFullDiskAndLeavesNothing) {
  const std::string run = "render " + kScene + kSmall + "--quiet ";
  expect_error(run + "-o /dev/full", 1, "/dev/full: writing failed");
  expect_error(run + "--json /dev/full", 1, "/dev/full: writing failed");
  expect_error(run + "--hits /dev/full", 1, "/dev/full: writing failed");
}

TEST_F(Cli, ExplainsWrongUsage) {
  expect_error("", 2, "subcommand");
  expect_error("paint", 2, "");
  expect_error("render", 2, "scene");
  expect_error("render a.obj --colour", 2, "--colour");
  expect_error("render a.obj --device abacus", 2, "abacus");
  expect_error("render a.obj --profile fast", 2, "fast");
  expect_error("render a.obj --width 0", 2, "--width");
  expect_error("render a.obj --width 16385", 2, "--width");
  expect_error("render a.obj --height x", 2, "--height");
  expect_error("render a.obj --pencil 17", 2, "--pencil");
  expect_error("render a.obj --shadow 17", 2, "--shadow");
  expect_error("render a.obj --leaf 128", 2, "--leaf");
  expect_error("render a.obj --memories huge", 2, "huge");
#ifndef RAPLAS_WITH_RTL
  expect_error("render " + kScene + " --quiet --device rtl", 1, "no Verilator model");
#endif
}

TEST_F(Cli, ComparesTheDevicesOfThisBuild) {
  ASSERT_EQ(raplas("compare " + kScene + " --quiet --width 16 --height 16 --shadow 2 -o out --json c.json"),
            0)
      << folder_.read("stdout") << folder_.read("stderr");
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out" / "model.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out" / "reference.png"));
  const auto figures = json("c.json");
  EXPECT_EQ(figures["render.pixels"]["value"], 256);
  EXPECT_TRUE(figures["render.pixels_off_reference"]["value"].is_number());
#ifdef RAPLAS_WITH_RTL
  EXPECT_EQ(figures["render.differing_bits"]["value"], 0);
  EXPECT_EQ(figures["render.differing_counters"]["value"], 0);
  EXPECT_GT(figures["render.hits_compared"]["value"], 256);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out" / "rtl.png"));
#endif
  expect_error("compare gone.obj -o stdout", 1, "stdout: cannot be made a folder");
}

TEST_F(Cli, ExactPicturesAreThoseOfDoublePrecision) {
  ASSERT_EQ(
      raplas("compare " + kScene + " --exact --quiet --width 40 --height 40 --shadow 2 -o out --json c.json"),
      0)
      << folder_.read("stdout") << folder_.read("stderr");
  EXPECT_EQ(json("c.json")["render.pixels_off_reference"]["value"], 0);
  ASSERT_EQ(raplas("render " + kScene +
                   " --exact --quiet --width 40 --height 40 --shadow 0 -o x.png --json r.json"),
            0);
  const auto retests = json("r.json")["retests"];
  EXPECT_EQ(retests["rays"], 1600);
  EXPECT_GT(retests["rivals"], 0);
  EXPECT_LT(retests["traced"], 160) << "nothing is left to the unit";
  expect_error("render " + kScene + " --exact --profile paper", 1, "profile paper has no certified hits");
}

TEST_F(Cli, MeasuresWhatIsSkipped) {
  ASSERT_EQ(raplas("skip " + kScene + " --quiet --width 40 --height 24 --name box -o maps --json s.json"), 0)
      << folder_.read("stdout") << folder_.read("stderr");
  for (const char* name : {"objects.png", "pairs.png", "cycles.png"}) {
    EXPECT_EQ(folder_.read(std::string("maps/") + name).substr(0, 8), "\x89PNG\r\n\x1a\n") << name;
  }
  const auto figures = json("s.json");
  const auto value = [&](const std::string& name) {
    EXPECT_TRUE(figures.contains(name)) << name;
    return figures.contains(name) ? figures[name]["value"].get<double>() : -1;
  };
  EXPECT_EQ(value("skip.box.triangles"), 1008);
  EXPECT_EQ(value("skip_step.box.camera.brute.pairs_per_ray"), 1008);
  // the whole picture: the clocked unit and all steps but the first, each with the first
  EXPECT_EQ(value("skip.box.camera.pencils"), 6);
  EXPECT_EQ(value("skip.box.camera.compared"), 8 * 40 * 24);
  for (const std::string kind : {"camera", "shadow"}) {
    const std::string clocked = "skip.box." + kind;
    EXPECT_GT(value(clocked + ".compared"), 0);
    EXPECT_EQ(value(clocked + ".walked"), value(clocked + ".pencils"));
    EXPECT_EQ(value(clocked + ".different"), 0);
    const double either = value(clocked + ".busy_percent");
    const double objects = value(clocked + ".testers_busy_percent");
    const double pairs = value(clocked + ".pairs_busy_percent");
    EXPECT_GE(either, std::max(objects, pairs));
    EXPECT_LE(either, std::min(objects + pairs, 100.0));
    // one object and one pair a clock: tests a ray and the percentages say the same
    const double clocks = 1 / value(clocked + ".rays_per_clock");
    EXPECT_NEAR(value(clocked + ".sphere_tests_per_ray") + value(clocked + ".vertex_tests_per_ray"),
                objects / 100 * clocks, 1e-9);
    EXPECT_NEAR(value(clocked + ".pairs_per_ray"), pairs / 100 * clocks, 1e-9);
    EXPECT_GT(value("skip_paper.box." + kind + ".rays_per_clock"), 0);
    // what is skipped is not tested
    const std::string step = "skip_step.box." + kind + ".";
    EXPECT_LT(value(step + "tree.sphere_tests_per_ray"), value(step + "flat.sphere_tests_per_ray"));
    EXPECT_LE(value(step + "tree.pairs_per_ray"), value(step + "flat.pairs_per_ray"));
    EXPECT_LE(value(step + "inherited.pairs_per_ray"), value(step + "tree.pairs_per_ray"));
    EXPECT_LE(value(step + "behind.pairs_per_ray"), value(step + "inherited.pairs_per_ray"));
    EXPECT_LT(value(step + "hidden.pairs_per_ray"), value(step + "nearest.pairs_per_ray"));
    EXPECT_LT(value(step + "rectangles.pairs_per_ray"), value(step + "hidden.pairs_per_ray"));
    EXPECT_LE(value(step + "scan_lines.pairs_per_ray"), value(step + "rectangles.pairs_per_ray"));
    EXPECT_EQ(value(step + "hidden.vertex_tests_per_ray"), 0);
  }
  EXPECT_LT(value("skip_step.box.camera.scan_lines.pairs_per_ray"),
            value("skip_step.box.camera.rectangles.pairs_per_ray"));
  EXPECT_LE(value("skip_step.box.shadow.ended.pairs_per_ray"),
            value("skip_step.box.shadow.scan_lines.pairs_per_ray"));
  EXPECT_FALSE(figures.contains("skip_step.box.camera.ended.pairs_per_ray"));
  EXPECT_NE(folder_.read("stdout").find("different: 0"), std::string::npos);
}

TEST_F(Cli, MeasuresTheSameTwice) {
  const std::string run = "skip " + kScene + " --quiet --width 20 --height 36 --sample 2 --tile 5 ";
  ASSERT_EQ(raplas(run + "-o a --json a.json"), 0) << folder_.read("stderr");
  ASSERT_EQ(raplas(run + "-o b --json b.json"), 0) << folder_.read("stderr");
  EXPECT_EQ(folder_.read("a/cycles.png"), folder_.read("b/cycles.png"));
  const auto a = json("a.json");
  const auto b = json("b.json");
  EXPECT_LT(a["skip.cornell_teapot.camera.walked"]["value"],
            a["skip.cornell_teapot.camera.pencils"]["value"]);
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, figure] : a.items()) {
    EXPECT_EQ(figure["value"], b[name]["value"]) << name;
  }
}

TEST_F(Cli, MeasuresTheModelAgainstTheRtl) {
#ifdef RAPLAS_WITH_RTL
  ASSERT_EQ(raplas("skip " + kScene + " --quiet --width 48 --height 32 --rtl 4 --json s.json"), 0)
      << folder_.read("stdout") << folder_.read("stderr");
  const auto figures = json("s.json");
  EXPECT_GE(figures["skip.rtl.pencils_checked"]["value"], 4);
  EXPECT_EQ(figures["skip.rtl.differences"]["value"], 0);
#else
  expect_error("skip " + kScene + " --quiet --rtl 4", 1, "no Verilator model");
#endif
}

TEST_F(Cli, ExplainsWhyItCannotMeasure) {
  expect_error("skip gone.obj -o stdout", 1, "stdout: cannot be made a folder");
  expect_error("skip gone.obj -o . --json missing/x.json", 1, "missing/x.json: cannot be written");
  expect_error("skip gone.obj -o .", 1, "gone.obj: no such file");
  expect_error("skip", 2, "scene");
  expect_error("skip a.obj --profile paper", 2, "--profile");
  expect_error("skip a.obj --sample 0", 2, "--sample");
  expect_error("skip a.obj --tile x", 2, "--tile");
  expect_error("skip a.obj --rtl -1", 2, "--rtl");
}

}  // namespace
}  // namespace raplas
