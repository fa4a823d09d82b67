// The program langer-post on a small solution made in memory.
#include <doctest/doctest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/hdf5/h5.hpp"
#include "core/tensor/stress.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/solve_config.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/block.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace stage_tests {

namespace fs = std::filesystem;

namespace {

constexpr int n_steps = 4;

std::string text_of(const std::string& path) {
  std::ostringstream s;
  s << std::ifstream(path).rdbuf();
  return s.str();
}

// a bar stretched along x and pressed a little by a sphere; every number is a simple function of t
SolutionHeader header() {
  SolutionHeader h;
  h.mesh = test::block(test::even(0, 3, 3), test::even(0, 1, 1), test::even(0, 1, 1));
  h.mesh.node_sets["A"] = {static_cast<int>(h.mesh.X.size()) - 1};
  h.material = test::table1(0, 1e-2);
  h.formulation = "mean_dilatation";
  h.contact_nodes = {{"ball", {4, 5, 6}}};
  SolveConfig solve;
  solve.supports = {{"x_min", {Axis::x}}};
  solve.contacts["ball"] = {"y_max", Sphere{0.5, {1.5, 1.5, 0.5}}, 0, {{1, {0, -0.1, 0}}}};
  h.identity = {"solve", to_yaml(solve), fnv1a(to_yaml(solve)), {}, "langer-solve"};
  return h;
}

StepRecord step(const SolutionHeader& h, double t) {
  StepRecord r;
  r.t = t, r.increment = 0.25, r.iterations = 3, r.residual = 1e-10;
  for (const Vec3& X : h.mesh.X) {
    r.u.emplace_back(0.1 * t * X[0], -0.05 * t * X[1], -0.04 * t * X[2]);
    r.reaction.emplace_back(X[0] == 3 ? t : 0, 0, 0);
  }
  r.scalars = {{"penetration", 1e-12},      {"cone", 0},
               {"complementarity", 1e-11},  {"energy", t * t},
               {"negative_eigenvalues", 0}, {"shear_stiffness_min", 0.3 - 0.1 * t}};
  r.u_ind = Vec3(0, -0.1 * t, 0), r.force_ind = Vec3(0, 2 * t, 0);
  r.contacts["ball"] = {{{0, -t, 0}, {0, -t, 0}, {0, 0, 0}}, {1, 2, 0}, {0, 0, 0.1}};
  return r;
}

std::string folder(const std::string& name) {
  const fs::path path = fs::path(BINARY_DIR) / "test_files" / ("post_stage_" + name);
  fs::remove_all(path);
  fs::create_directories(path);
  SolutionWriter writer((path / "solution.h5").string(), header());
  for (int i = 1; i <= n_steps; ++i) writer.append(step(header(), double(i) / n_steps));
  writer.finish();
  return path.string();
}

struct Ended {
  int code;
  std::string said;
};
Ended post(const std::string& where, const std::string& config, const std::string& options = "") {
  std::ofstream(where + "/post.yaml") << config;
  const std::string command = "cd " + where + " && " + BIN_DIR +
                              "/langer-post post.yaml --solution solution.h5 -o out/curves.h5 " +
                              options + " > said 2>&1";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(where + "/said")};
}

const std::string columns = R"(columns:
- {quantity: u_ind}
- {quantity: force}
- {quantity: eps_xx, at: x_max}
- {quantity: u_y, at: A, name: u_y}
- {quantity: von_mises, at: A}
- {quantity: newton_iterations}
- {quantity: contact_nodes}
)";

}  // namespace

TEST_CASE("the table has one row per state, the unloaded one first, and columns named with units") {
  const std::string where = folder("table");
  const Ended run =
      post(where, columns + "further:\n- {history: energy}\n- {quantity: reaction_x, at: x_max}\n");
  INFO(run.said);
  REQUIRE(run.code == 0);
  std::istringstream csv(text_of(where + "/out/curves.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  REQUIRE(lines.size() == 1 + n_steps + 1);
  CHECK(lines[0] ==
        "u_ind_mm,force_N,eps_xx_x_max,u_y_mm,von_mises_A_MPa,newton_iterations,contact_nodes");
  CHECK(lines[1] == "0,0,0,0,0,0,0");
  const CurvesFile file = read_curves(where + "/out/curves.h5");
  REQUIRE(file.curves.columns.size() == 7);
  CHECK(file.curves.columns[1].values == std::vector<double>{0, 0.5, 1, 1.5, 2});
  CHECK(file.curves.columns[2].values.back() == near(0.1));
  CHECK(file.curves.columns[3].values.back() == near(-0.05));
  CHECK(file.curves.columns[5].values == std::vector<double>{0, 3, 3, 3, 3});
  CHECK(file.curves.columns[6].values == std::vector<double>{0, 2, 2, 2, 2});
}

TEST_CASE(
    "zero_at takes a column's value at a state from all of them, and wants a state at which the path stops") {
  const std::string where = folder("zero_at");
  REQUIRE(
      post(
          where,
          "columns:\n- {quantity: u_ind}\n- {quantity: force, zero_at: t=0.5}\n- {history: energy, zero_at: 1}\n")
          .code == 0);
  const CurvesFile file = read_curves(where + "/out/curves.h5");
  CHECK(file.curves.columns[1].values == std::vector<double>{-1, -0.5, 0, 0.5, 1});
  CHECK(file.curves.columns[2].values == std::vector<double>{-0.0625, 0, 0.1875, 0.5, 0.9375});
  const Ended between = post(where, "columns:\n- {quantity: u_ind, zero_at: t=0.4}\n");
  CHECK(between.code == 2);
  CHECK(between.said.find(
            "post.yaml:2:21: columns[0].zero_at: t=0.4; expected a state of the solution") !=
        std::string::npos);
}

TEST_CASE(
    "the summary is the last row with what stands beyond the table, every column is a curve over the first") {
  const std::string where = folder("summary");
  REQUIRE(
      post(where, columns + "further:\n- {history: energy}\n- {quantity: reaction_x, at: x_max}\n")
          .code == 0);
  const CurvesFile file = read_curves(where + "/out/curves.h5");
  std::map<std::string, Summary> summary;
  for (const Summary& s : read_summary(where + "/out/curves.h5")) summary[s.name] = s;
  CHECK(summary.size() == 9);
  CHECK(summary["u_y"].value == near(-0.05));
  CHECK(summary["u_y"].unit == "mm");
  CHECK(summary["energy"].value == 1);
  CHECK(summary["reaction_x_x_max"].value == near(4));
  REQUIRE(file.curves.curves.size() == 8);
  for (const auto& c : file.curves.curves) {
    CHECK(c.x_label == "u_ind");
    CHECK(c.x.size() == n_steps + 1);
  }
}

TEST_CASE(
    "snapshots are the states asked for, with fields at points and in cells that fit together") {
  const std::string where = folder("snapshots");
  const Ended run = post(where, columns + "snapshots: [last, 1, t=0.4]\n");
  INFO(run.said);
  REQUIRE(run.code == 0);
  for (const char* name : {"snapshot_0001.hdf", "snapshot_0002.hdf", "snapshot_0004.hdf"})
    CHECK(fs::exists(where + "/out/" + name));
  const h5::File file = h5::File::open(where + "/out/snapshot_0004.hdf");
  const h5::Group points = file.root().group("VTKHDF/PointData"),
                  cells = file.root().group("VTKHDF/CellData");
  const std::size_t n = header().mesh.X.size();
  const auto sigma = points.read<double>("sigma", {n, 6}).values;
  const auto cell_sigma = cells.read<double>("sigma", {3, 6}).values;
  CHECK(std::abs(sigma[0]) > 1e-3);
  for (int c = 0; c < 6; ++c)  // the deformation is homogeneous
    for (std::size_t i = 0; i < n; ++i) CHECK(sigma[6 * i + c] == near(cell_sigma[c], 1e-9));
  CHECK(points.unit("sigma") == "MPa");
  CHECK(points.read<double>("u", {n, 3}).values[3 * (n - 1)] == near(0.3));
  const auto status = points.read<double>("contact_status_ball", {n}).values;
  CHECK(std::vector<double>(status.begin() + 3, status.begin() + 8) ==
        std::vector<double>{-1, 1, 2, 0, -1});
  const auto after = cells.read<double>("fibre_1_deformed", {3, 3}).values;
  CHECK(after[0] == near(1.1));
  CHECK(cells.read<double>("fibre_1", {3, 3}).values[0] == 1);
  CHECK(cells.read<double>("J", {3}).values[2] == near(1.1 * 0.95 * 0.96));
}

TEST_CASE(
    "layers with laws and fibre angles of their own: each shows the stress of its law, and the stiffest point is in the stiff one") {
  const std::string where = folder("layers");
  SolutionHeader layered = header();
  layered.mesh.bodies = {"deep", "shallow"};
  layered.mesh.body = {0, 1, 1};  // cells along x
  layered.materials = {test::stable(20, 1e-2), test::stable(70, 1e-2)};
  std::get<Yeoh>(layered.materials[1].matrix[0]).a1 *= 3;
  layered.material = layered.materials[0];
  const auto corner = [&](double x) {
    for (int i = 0; i < layered.mesh.n_nodes(); ++i)
      if ((layered.mesh.X[static_cast<std::size_t>(i)] - Vec3(x, 1, 1)).norm() < 1e-9) return i;
    return -1;
  };
  layered.mesh.node_sets["P"] = {corner(0)};  // in the first body
  layered.mesh.node_sets["Q"] = {corner(2)};  // between two cells of the second
  {
    SolutionWriter writer(where + "/layers.h5", layered);
    for (int i = 1; i <= n_steps; ++i) writer.append(step(layered, double(i) / n_steps));
    writer.finish();
  }
  fs::rename(where + "/layers.h5", where + "/solution.h5");
  const Ended run = post(
      where,
      "columns:\n- {quantity: u_ind}\n- {quantity: von_mises, at: P}\n- {quantity: von_mises, at: Q}\n"
      "- {quantity: fibre_stretch, at: P}\n- {quantity: fibre_stretch, at: Q}\n- {quantity: von_mises_max}\n"
      "- {quantity: von_mises_max_x}\n");
  INFO(run.said);
  REQUIRE(run.code == 0);
  const std::vector<Column> columns = read_curves(where + "/out/curves.h5").curves.columns;
  REQUIRE(columns.size() == 7);
  for (int row = 1; row <= n_steps; ++row) {
    CAPTURE(row);
    const double s = double(row) / n_steps;
    const Mat3 F = Vec3(1 + 0.1 * s, 1 - 0.05 * s, 1 - 0.04 * s).asDiagonal();
    for (int body : {0, 1}) {
      const Material& m = layered.materials[static_cast<std::size_t>(body)];
      const std::vector<Vec3> a = fibre_directions(m);
      const double expected = von_mises(cauchy(F, response(m, F.transpose() * F, a).S));
      CHECK(columns[1 + body].values[row] == near(expected, 1e-10));
      CHECK(columns[3 + body].values[row] ==
            near((F * a[0]).norm() / std::cbrt(F(0, 0) * F(1, 1) * F(2, 2)), 1e-10));
    }
    CHECK(columns[2].values[row] > 1.1 * columns[1].values[row]);
    CHECK(columns[5].values[row] == near(columns[2].values[row], 1e-10));
    CHECK(columns[6].values[row] > 1);
  }
}

TEST_CASE(
    "figures and the picture stand beside the table, without gnuplot it says so once and goes on") {
  const std::string where = folder("figures");
  const std::string config =
      columns +
      "figures:\n  force: {x: u_ind, y: [force]}\nrender: {field: u_x, cuts: [{axis: z, at: 0.5}]}\n";
  fs::create_directories(where + "/nothing");
  const Ended run = post(where, config, "--set snapshots=[]");
  CHECK(run.code == 0);
  CHECK(fs::exists(where + "/out/force.gp"));
  CHECK(text_of(where + "/out/render.svg").find("displacement u<tspan") != std::string::npos);
  if (std::system("command -v gnuplot > /dev/null 2>&1") == 0)
    for (const char* name : {"force.svg", "force.png", "render.png"})
      CHECK(fs::exists(where + "/out/" + name));

  std::ofstream(where + "/post.yaml") << config;
  const std::string command =
      "cd " + where + " && PATH=nothing " + BIN_DIR +
      "/langer-post post.yaml --solution solution.h5 -o bare/curves.h5 > said 2>&1";
  CHECK(std::system(command.c_str()) == 0);
  const std::string said = text_of(where + "/said");
  CHECK(said.find("not drawn: force, render (there is no gnuplot on the PATH)") !=
        std::string::npos);
  CHECK(fs::exists(where + "/bare/curves.h5"));
  CHECK(fs::exists(where + "/bare/render.svg"));
}

TEST_CASE(
    "names that do not exist end with code 2 at their key, all together, and change nothing that was there") {
  const std::string where = folder("names");
  REQUIRE(post(where, columns).code == 0);
  const std::string before = text_of(where + "/out/curves.h5");
  const Ended run =
      post(where, "columns:\n- {quantity: u_y, at: Q}\n- {quantity: force}\n- {history: enrgy}\n");
  INFO(run.said);
  CHECK(run.code == 2);
  CHECK(run.said.find("post.yaml:2:19: columns[0].at: the mesh has no nodes called \"Q\"") !=
        std::string::npos);
  CHECK(run.said.find("post.yaml:4:4: columns[2].history: the solution has no history \"enrgy\"") !=
        std::string::npos);
  CHECK(run.said.find("did you mean \"energy\"?") != std::string::npos);
  CHECK(text_of(where + "/out/curves.h5") == before);
  CHECK(post(where, columns + "snapshots: [9]\n")
            .said.find("snapshots[0]: 9; expected a row from 0 to 4") != std::string::npos);
  CHECK(post(where, columns + "snapshots: [9]\n").code == 2);
  CHECK(text_of(where + "/out/curves.h5") == before);
}

TEST_CASE("a solution that is missing, cut short or of another kind ends with code 3") {
  const std::string where = folder("input");
  const std::string good = text_of(where + "/solution.h5");
  std::ofstream(where + "/solution.h5", std::ios::trunc) << good.substr(0, good.size() / 2);
  CHECK(post(where, columns).code == 3);
  fs::remove(where + "/solution.h5");
  CHECK(post(where, columns).code == 3);
  fs::create_directories(where + "/other");
  write_curves(where + "/solution.h5", {}, header().identity);
  const Ended run = post(where, columns);
  INFO(run.said);
  CHECK(run.code == 3);
  CHECK_FALSE(fs::exists(where + "/out/curves.h5"));
}

}  // namespace stage_tests
