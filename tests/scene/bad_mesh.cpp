// A mesh file that no solid has is refused by langer-solve, by name and place.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "results/store/mesh_file.hpp"
#include "support/block.hpp"

using namespace langer;

namespace bad_mesh_tests {

namespace fs = std::filesystem;

namespace {

struct Ended {
  int code;
  std::string said;
};
Ended solve_on(const Mesh& mesh) {
  const fs::path folder = fs::path(BINARY_DIR) / "test_files" / "bad_mesh";
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_mesh((folder / "mesh.h5").string(), mesh, {"mesh", "", "0", {}, ""});
  std::ofstream(folder / "solve.yaml")
      << "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}}\n"
         "supports:\n- {on: y_min, hold: [x, y, z]}\n"
         "loads:\n- {on: y_max, displacement: {y: 0.01}}\n";
  const std::string command = "cd " + folder.string() + " && " + BIN_DIR +
                              "/langer-solve solve.yaml --mesh mesh.h5 -o solution.h5 > said 2>&1";
  const int status = std::system(command.c_str());
  std::ostringstream said;
  said << std::ifstream(folder / "said").rdbuf();
  CHECK(fs::exists(folder / "solution.h5") == (status == 0));
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, said.str()};
}

}  // namespace

TEST_CASE(
    "a mesh file with a folded, a flat or an inverted cell is refused with the file and the cell") {
  const Mesh good = test::cube(2);
  CHECK(solve_on(good).code == 0);
  Mesh folded = good;
  folded.X[folded.cell(5)[6]] = folded.X[folded.cell(5)[0]] -
                                Vec3(0.1, 0.1, 0.1);  // a corner pushed through the opposite one
  Mesh flat = test::cube(1);
  for (Vec3& X : flat.X) X[2] = 0;
  Mesh inverted = test::cube(1);
  for (Vec3& X : inverted.X) X[2] = -X[2];
  for (const auto& [mesh, cell] : {std::pair{folded, 5}, {flat, 0}, {inverted, 0}}) {
    const auto wrong = cell;
    CAPTURE(wrong);
    const Ended run = solve_on(mesh);
    INFO(run.said);
    CHECK(run.code == 3);
    CHECK(run.said.find("mesh.h5: cell " + std::to_string(cell) +
                        " is folded or flat: Jacobian ") != std::string::npos);
    CHECK(run.said.find("expected a positive Jacobian everywhere") != std::string::npos);
  }
}

}  // namespace bad_mesh_tests
