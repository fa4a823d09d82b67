#include "pipeline/plan/plan.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/error.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, const std::string& text) {
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::map<std::string, fs::file_time_type> times(const fs::path& folder) {
  std::map<std::string, fs::file_time_type> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) found[entry.path().string()] = entry.last_write_time();
  return found;
}

// a folder of its own as working directory, left and removed at the end
struct Project {
  fs::path before = fs::current_path(),
           root = fs::temp_directory_path() / ("langer_plan_" + std::to_string(getpid()));
  Project() {
    fs::remove_all(root);
    fs::create_directories(root);
    fs::current_path(root);
    write("law.yaml", "matrix: {yeoh: {a1: 0.2}}\nvolume: {quadratic: {d: 1.0e-3}}   # MPa\n");
    write("curve.csv", "strain,stress_MPa\n0,0\n");
    write(
        "configs/fit.yaml",
        "data: [{file: ../curve.csv}]\nlaw: {include: ../law.yaml}\nparameters: [{key: matrix.yeoh.a1, lower: 0, upper: 1}]\n");
    write("configs/mesh.yaml", "geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}\n");
    write(
        "configs/solve.yaml",
        "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, displacement: {x: 0.1}}]\nthreads: 1\n");
    write(
        "p.yaml",
        "pipeline: p\nnodes:\n  fit: {stage: fit, config: configs/fit.yaml}\n  mesh: {stage: mesh, config: configs/mesh.yaml}\n"
        "  solve: {stage: solve, config: configs/solve.yaml, mesh: mesh, material: law.yaml,\n"
        "          sweep: {x: {key: \"loads[0].displacement.x\", values: [0.1, 0.2]}}}\n");
  }
  ~Project() {
    fs::current_path(before);
    fs::remove_all(root);
  }
};

std::string failure(Exit& code) {
  try {
    plan("p.yaml", "", "bin");
  } catch (const Failure& f) {
    code = f.code();
    return f.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a plan is effective configs and a Makefile, planning again touches nothing") {
  Project project;
  const PlanReport first = plan("p.yaml", "", "bin");
  CHECK(first.folder == "runs/p");
  CHECK(first.steps == 4);
  CHECK(first.changed == 6);  // four configs, and the material beside each solve
  CHECK(fs::exists("runs/p/Makefile"));
  CHECK(read("runs/p/x_000.2/solve/solve.yaml").find("x: 0.2") != std::string::npos);
  CHECK(read("runs/p/x_000.2/solve/material.yaml").find("a2: 0\n") != std::string::npos);
  const auto before = times("runs");
  CHECK(plan("p.yaml", "", "bin").changed == 0);
  CHECK(times("runs") == before);
}

TEST_CASE(
    "a key and a word by their former names are told once, at their line, and the configs of the run have the new ones") {
  Project project;
  std::ofstream("configs/fit.yaml", std::ios::app) << "check: nlopt\n";
  std::ofstream("configs/solve.yaml", std::ios::app)
      << "mesh: {geometry: {block: {size: [1, 1, 1], divisions: [4, 4, 4]}}}\nestimate: second_rung\n";
  write(
      "p.yaml",
      "pipeline: p\nnodes:\n  fit: {stage: fit, config: configs/fit.yaml}\n  solve: {stage: solve, config: configs/solve.yaml, "
      "material: law.yaml, sweep: {x: {key: \"loads[0].displacement.x\", values: [0.1, 0.2]}}}\n");
  const std::vector<std::string> said = plan("p.yaml", "", "bin").doubts;
  REQUIRE(said.size() == 2);  // though the sweep reads solve.yaml twice
  CHECK(said[0].find("configs/fit.yaml:4:1: check is now called cross_check") != std::string::npos);
  CHECK(said[1].find("configs/solve.yaml:5:1: estimate: second_rung is now called refinement") !=
        std::string::npos);
  CHECK(read("runs/p/fit/fit.yaml").find("cross_check: nlopt") != std::string::npos);
  CHECK(read("runs/p/x_000.2/solve/solve.yaml").find("estimate: refinement") != std::string::npos);
}

TEST_CASE(
    "a changed value rewrites the configs that it is part of, a comment or the order of keys none") {
  Project project;
  plan("p.yaml", "", "bin");
  write("law.yaml",
        "# another comment\nvolume: {quadratic: {d: 0.001}}\nmatrix: {yeoh: {a1: 0.20}}\n");
  CHECK(plan("p.yaml", "", "bin").changed == 0);
  write(
      "configs/solve.yaml",
      "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, displacement: {x: 0.1}}]\nthreads: 2\n");
  CHECK(plan("p.yaml", "", "bin").changed == 2);
  write("law.yaml", "matrix: {yeoh: {a1: 0.3}}\nvolume: {quadratic: {d: 1.0e-3}}\n");
  CHECK(plan("p.yaml", "", "bin").changed == 3);  // the fit's start value and two materials
}

TEST_CASE("a node that comes in changes nothing of the others") {
  Project project;
  plan("p.yaml", "", "bin");
  std::ofstream("p.yaml", std::ios::app) << "  more: {stage: mesh, config: configs/mesh.yaml}\n";
  CHECK(plan("p.yaml", "", "bin").changed == 1);
}

TEST_CASE("another file at a port is a changed config, even where the file is old") {
  Project project;
  plan("p.yaml", "", "bin");
  std::string text = read("p.yaml");
  text += "  mesh2: {stage: mesh, config: configs/mesh.yaml}\n";
  text.replace(text.find("mesh: mesh, material"), 10, "mesh: mesh2");
  write("p.yaml", text);
  CHECK(plan("p.yaml", "", "bin").changed == 3);  // the new mesh and two solves
}

TEST_CASE("a data file is a prerequisite, and effective configs hold no absolute path") {
  Project project;
  plan("p.yaml", "", "bin");
  const std::string makefile = read("runs/p/Makefile");
  CHECK(makefile.find("fit/material.h5: fit/fit.yaml ../../curve.csv ") != std::string::npos);
  CHECK(read("runs/p/fit/fit.yaml").find("file: ../../../curve.csv\n") != std::string::npos);
  for (const auto& [path, time] : times("runs")) {
    const auto which = path;
    CAPTURE(which);
    CHECK(read(path).find(project.root.string()) == std::string::npos);
  }
}

TEST_CASE("everything is checked before anything is written") {
  Project project;
  write(
      "configs/solve.yaml",
      "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, displacement: {x: 0.1}}]\nthreds: 1\n");
  write("configs/mesh.yaml", "geometry: {block: {size: [1, 1, 1], divisions: [1, 1]}}\n");
  Exit code = Exit::ok;
  const std::string said = failure(code);
  CHECK(code == Exit::config);
  CHECK(said.find("configs/solve.yaml:3:1: unknown key \"threds\"") != std::string::npos);
  CHECK(said.find("configs/mesh.yaml:1:37: geometry.block.divisions: found 2 items") !=
        std::string::npos);
  CHECK(said.find("threds") == said.rfind("threds\""));  // once, although two members share it
  CHECK_FALSE(fs::exists("runs"));
}

TEST_CASE("an error in a value of the pipeline is reported at its line of the pipeline") {
  Project project;
  std::string text = read("p.yaml");
  text.replace(text.find("0.2]"), 4, "wide]");
  write("p.yaml", text);
  Exit code = Exit::ok;
  CHECK(failure(code).find(
            "p.yaml:6:69: loads[0].displacement.x: found wide; expected a number in mm") !=
        std::string::npos);
}

TEST_CASE("a material given twice or not at all is found by plan") {
  Project project;
  const std::string text = read("p.yaml"), given = ", material: law.yaml";
  std::string without = text;
  without.erase(without.find(given), given.size());
  write("p.yaml", without);
  Exit code = Exit::ok;
  CHECK(
      failure(code).find(
          "configs/solve.yaml:1:1: material: missing; expected the key material, or a file (--material)") !=
      std::string::npos);
  CHECK(code == Exit::config);
  std::ofstream("configs/solve.yaml", std::ios::app) << "material: {include: ../law.yaml}\n";
  CHECK(failure(code).empty());
  write("p.yaml", text);
  CHECK(
      failure(code).find(
          "configs/solve.yaml:4:1: material: given here and as a file; expected one of the two") !=
      std::string::npos);
}

TEST_CASE("a missing data file is found by plan, with the code of an input file") {
  Project project;
  fs::remove("curve.csv");
  Exit code = Exit::ok;
  const std::string said = failure(code);
  CHECK(said.find("configs/fit.yaml:1:9: data[0].file: curve.csv: there is no such file") !=
        std::string::npos);
  CHECK(code == Exit::input);
  CHECK_FALSE(fs::exists("runs"));
}

TEST_CASE("the run's folder may be anywhere, also behind a symbolic link") {
  Project project;
  fs::create_directories("far/away/scratch");
  fs::create_directory_symlink(fs::absolute("far/away/scratch"), "runs");
  plan("p.yaml", "", "bin");
  CHECK(read("far/away/scratch/p/Makefile").find(" ../../../../curve.csv ") != std::string::npos);
  CHECK(fs::exists("far/away/scratch/p/../../../../curve.csv"));
}
