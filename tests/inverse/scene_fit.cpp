// Parameters from scenes: what is read of a path, what a file may say, fits of data that were made
// up, what is refused.
#include "identification/inverse/inverse_fit.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "core/base/random.hpp"
#include "identification/inverse/scene_data.hpp"
#include "identification/setup/fit_config_io.hpp"
#include "identification/setup/priors.hpp"
#include "mechanics/mesh/select.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/body_mesh.hpp"
#include "support/near.hpp"

using namespace langer;

namespace scene_fit_tests {

namespace fs = std::filesystem;

namespace {

// of this process: ctest runs the cases side by side
struct Folder {
  ~Folder() { fs::remove_all(path); }
  const std::string path =
      (fs::temp_directory_path() / ("langer_inverse_" + std::to_string(getpid()))).string();
} const own;
const std::string& folder = own.path;

void write(const std::string& name, const std::string& text) {
  fs::create_directories(folder);
  std::ofstream(folder + "/" + name) << text;
}

// a coarse section under a sphere, forty cells
constexpr const char* solve_yaml =
    "mesh: {geometry: {section: {of: axisymmetric, size: [6, 3], divisions: [10, 4], centre: {edge: 0.3, within: 1.5}}}, points: {beside: [3, 3, 0]}}\n"
    "supports: [{on: bottom, hold: [x, y]}]\n"
    "contacts:\n  sphere:\n    on: top\n    rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}}\n    motion: [{t: 1, to: [0, -1, 0]}]\n"
    "material: {matrix: {yeoh: {a1: 0.012, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\n"
    "stability: off\npath: {steps: 5}\n";

constexpr const char* law =
    "law: {matrix: {yeoh: {a1: 0.02, a2: 0.02, a3: 0.02}}, volume: {quadratic: {d: 1.0e-2}}}\nbounds: admissible\n";
constexpr const char* three =
    "parameters: [{key: matrix.yeoh.a1}, {key: matrix.yeoh.a2}, {key: matrix.yeoh.a3}]\n";

Loaded<FitConfig> read(const std::string& yaml) {
  write("solve.yaml", solve_yaml);
  return read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", folder));
}

// the force over travel, and the displacement beside, of the scene with its own material
ForwardPath truth(double a1 = 0.012) {
  write("solve.yaml", solve_yaml);
  auto loaded = read_config<SolveConfig>(load_yaml(folder + "/solve.yaml"));
  ForwardInput input{*loaded.config.material};
  std::get<Yeoh>(input.law.matrix[0]).a1 = a1;
  ForwardRun run(loaded.config, loaded.where, 0);
  Observation beside{Observation::Of::displacement, 1};
  beside.nodes = run.mesh().node_sets.at("beside"), beside.weights = {1};
  run.observe({Observation{}, beside}, {});
  return run.solve(input);
}

// the force over the path of a scene with its own material
ForwardPath solved_scene(const std::string& name, const std::string& yaml) {
  write(name, yaml);
  auto loaded = read_config<SolveConfig>(load_yaml(folder + "/" + name));
  ForwardRun run(loaded.config, loaded.where, 0);
  run.observe({Observation{}}, {});
  return run.solve({*loaded.config.material});
}

void write_force(const std::string& name, const ForwardPath& path, double touch = 0,
                 double offset = 0, double compliance = 0) {
  std::string text = fmt::format("travel_mm,force_mN,beside_um\n{},{},0\n",
                                 touch + compliance * offset, 1e3 * offset);
  for (std::size_t i = 0; i < path.t.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double force = path.values(k, 0);
    text += fmt::format("{},{},{}\n", path.t[i] + touch + compliance * force,
                        1e3 * (force + offset), 1e3 * path.values(k, 1));
  }
  write(name, text);
}

struct Found {
  FitResult fit;
  FitRecord record;
  int runs = 0;
};
Found fitted(const std::string& yaml, const std::string& journal = "",
             std::vector<std::string>* said = nullptr) {
  const auto loaded = read(yaml);
  FitProblem problem = fit_problem(loaded.config);
  InverseFit inverse({"fit", true, false}, loaded.config, loaded.where, problem, {},
                     journal.empty() ? "" : folder + "/" + journal);
  Found found{inverse.search()};
  found.record = FitRecord{};
  for (std::size_t i = 0; i < problem.free.size(); ++i)
    found.record.parameters.push_back({problem.free[i].key, "-"});
  const auto lines = inverse.add_curves(found.fit, found.record);
  if (said) *said = lines;
  found.runs = inverse.runs();
  return found;
}

std::string refusal(const std::string& yaml) {
  try {
    fitted(yaml);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "accepted";
}

void holds(const std::string& said, const std::string& part) {
  CAPTURE(said);
  CHECK(said.find(part) != std::string::npos);
}

constexpr const char* force =
    "data: [{kind: scene, solve: solve.yaml, file: force.csv, columns: {u_ind: travel_mm, force: force_mN}";

}  // namespace

TEST_CASE(
    "A cubic along a path is read exactly, with its rate, from either side of a kink, and rest is zero") {
  const std::vector<double> t{0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9, 1};
  const auto cubic = [](double x) {
    return x * (1 + x * (2 - 3 * x));
  };
  const auto of = [&](const std::vector<std::pair<Eigen::Index, double>>& weights, bool kinked) {
    double sum = 0;
    for (const auto& [i, w] : weights) {
      const double x = t[static_cast<std::size_t>(i)];
      sum += w * (kinked && x > 0.5 ? cubic(0.5) - 7 * (x - 0.5) : cubic(x));
    }
    return sum;
  };
  for (double x : {0.03, 0.1, 0.3, 0.45, 0.62, 0.97, 1.0}) {
    CAPTURE(x);
    const PathPlace smooth = place_on(t, {0, 1}, x);
    CHECK(of(smooth.value, false) == near(cubic(x), 1e-12));
    CHECK(of(smooth.rate, false) == near(1 + 4 * x - 9 * x * x, 1e-11));
    const PathPlace kink = place_on(t, {0, 0.5, 1}, x);
    CHECK(of(kink.value, true) == near(x > 0.5 ? cubic(0.5) - 7 * (x - 0.5) : cubic(x), 1e-12));
  }
  CHECK(place_on(t, {0, 1}, -0.1).value.empty());
  CHECK(place_on(t, {0, 1}, 1.04).exists);
  CHECK(place_on(t, {0, 1}, 1.14).exists);
  CHECK_FALSE(place_on(t, {0, 1}, 1.16).exists);
  CHECK_FALSE(place_on({0.1, 0.2}, {0, 1}, 0.5).exists);
}

TEST_CASE("What is read of a path has no jump in its rate where a state is") {
  const std::vector<double> t{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
  const auto rate_at = [&](double x) {
    double sum = 0;
    for (const auto& [i, w] : place_on(t, {0, 1}, x).rate)
      sum += w * std::pow(t[static_cast<std::size_t>(i)], 1.5);
    return sum;
  };
  for (double x : {0.1, 0.2, 0.4, 0.6, 0.9}) {
    CAPTURE(x);
    CHECK(rate_at(x - 1e-7) == near(rate_at(x + 1e-7), 1e-5));
    CHECK(rate_at(x) == near(1.5 * std::sqrt(x), 0.05));
  }
  // nor at the end of the path, behind which its last piece continues
  CHECK(rate_at(1.02) > rate_at(0.98));
  CHECK(rate_at(1 + 1e-7) == near(rate_at(1 - 1e-7), 1e-5));
}

TEST_CASE("A history that comes back is followed in its order") {
  Abscissa over;
  over.t = {0, 0.5, 1}, over.s = {0, 2, 0};
  std::size_t piece = 0;
  CHECK(*over.find(1, piece, 0) == near(0.25));
  CHECK(*over.find(2, piece, 0) == near(0.5));
  piece = 1;
  CHECK(*over.find(1, piece, 0) == near(0.75));
  CHECK(over.rate(1) == near(-0.25));
  CHECK_FALSE(over.find(2.1, piece, 0.01));
}

TEST_CASE(
    "The stretch of a path that a value lies on is told by the order of the values, through noise of what they are read by") {
  Abscissa over;
  over.t = {0, 0.5, 1}, over.s = {0, 2, 0};
  using Stretches = std::vector<std::size_t>;
  CHECK(over.stretches({0.5, 1, 1.5, 2, 1.5, 1, 0.5}, 0) == Stretches{0, 0, 0, 0, 1, 1, 1});
  CHECK(over.stretches({0.5, 1, 0.99, 1.5, 1.9, 1.7, 1.71, 0.2}, 0) ==
        Stretches{0, 0, 0, 0, 0, 1, 1, 1});  // the turn was not read
  CHECK(over.stretches({2, 1.5, 0.5}, 0)[1] == 1);
  CHECK(over.stretches({0.5, 1, 0.995}, 0) == Stretches{0, 0, 0});  // it does not turn by itself
  over.t = {0, 0.25, 0.5, 0.75, 1}, over.s = {0, 2, 0.5, 2, 0};
  CHECK(over.stretches({1, 2, 1, 0.6, 1, 1.9, 1, 0.2}, 0) == Stretches{0, 0, 1, 1, 2, 2, 3, 3});
  CHECK(over.stretches({1, 2.1, 1}, 0.01)[1] == 4);
}

TEST_CASE(
    "A law is found from loading and unloading with friction, whose forces differ at the same travel") {
  write("solve.yaml", solve_yaml);
  std::string scene = solve_yaml;
  scene.replace(scene.find("motion: [{t: 1, to: [0, -1, 0]}]"), 32,
                "friction: 0.4\n    motion: [{t: 0.5, to: [0, -0.8, 0]}, {t: 1, to: [0, 0, 0]}]");
  scene.replace(scene.find("steps: 5"), 8, "first: 0.05, largest: 0.05");
  write("there_and_back.yaml", scene);
  auto loaded = read_config<SolveConfig>(load_yaml(folder + "/there_and_back.yaml"));
  ForwardRun run(loaded.config, loaded.where, 0);
  run.observe({Observation{}}, {});
  const ForwardPath path = run.solve({*loaded.config.material});
  std::string text = "travel_mm,force_N\n";
  for (std::size_t i = 0; i < path.t.size(); ++i)
    text += fmt::format("{},{}\n", path.t[i] < 0.5 ? 1.6 * path.t[i] : 1.6 * (1 - path.t[i]),
                        path.values(static_cast<Eigen::Index>(i), 0));
  write("cycle.csv", text);
  const Found found = fitted(
      "data: [{kind: scene, solve: there_and_back.yaml, file: cycle.csv, columns: {u_ind: travel_mm, force: force_N}}]\n" +
      std::string(law) +
      "parameters: [{key: matrix.yeoh.a1}, {key: matrix.yeoh.a2}, {key: matrix.yeoh.a3}]\ndraft: false\n");
  CHECK(found.fit.best.p[0] == near(0.012, 1e-4));
  CHECK(found.fit.best.p[1] == near(0.03, 1e-4));
}

TEST_CASE("A law is found from the travel of an indenter that is pushed, measured over its force") {
  const ForwardPath path =
      truth();  // of one that is moved: without friction the states are the same
  std::string text = "travel_mm,force_N\n";
  for (std::size_t i = 0; i < path.t.size(); ++i)
    text += fmt::format("{},{}\n", path.t[i], path.values(static_cast<Eigen::Index>(i), 0));
  write("pushed.csv", text);
  std::string scene = solve_yaml;
  scene.replace(scene.find("motion: [{t: 1, to: [0, -1, 0]}]"), 32,
                fmt::format("control: {{force: {}}}",
                            path.values(static_cast<Eigen::Index>(path.t.size()) - 1, 0)));
  scene.replace(scene.find("steps: 5"), 8, "first: 0.1, largest: 0.1");
  write("pushed.yaml", scene);
  const std::string data =
      "data: [{kind: scene, solve: pushed.yaml, file: pushed.csv, columns: {u_ind: travel_mm, force: force_N}, standard_deviation: 0.01";
  const Found found = fitted(data + "}]\n" + law + three + "draft: false\n");
  REQUIRE(found.fit.best.converged);
  REQUIRE(found.record.curves.size() == 1);
  CHECK(found.record.curves[0].quantity == "u_ind");
  CHECK(found.record.curves[0].x_name == "force");
  CHECK(found.fit.best.p[0] == near(0.012, 1e-4));
  CHECK(found.fit.best.p[1] == near(0.03, 1e-4));
  CHECK(found.fit.best.p[2] == near(0.01, 1e-3));
  holds(refusal(data + ", touch_offset: 0.1}]\n" + law + three), "data[0].touch_offset");
}

TEST_CASE("The force on one of two indenters is over its own travel and against its own way") {
  const std::string scene =
      "mesh: {geometry: {block: {origin: [-5, 0, -2], size: [10, 2, 4], divisions: [20, 3, 8]}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "contacts:\n"
      "  a: {on: top, rigid: {sphere: {radius: 1.5, centre: [-2.5, 3.5, 0]}}, motion: [{t: 1, to: [0, -0.2, 0]}]}\n"
      "  b: {on: top, rigid: {sphere: {radius: 1.5, centre: [2.5, 3.5, 0]}}, motion: [{t: 1, to: [0.3, -0.4, 0]}]}\n"
      "material: {matrix: {yeoh: {a1: 0.012, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\nstability: off\npath: {steps: 4}\n";
  write("two.yaml", scene);
  auto loaded = read_config<SolveConfig>(load_yaml(folder + "/two.yaml"));
  Run run(body_mesh(loaded.config, "", loaded.where), loaded.config, loaded.config.material,
          loaded.where);
  std::string text = "travel_mm,force_N\n";
  RunListener each;
  each.of_whole = [&](StepRecord& whole, const SolveReport&) {
    const Vec3 force(whole.scalars.at("force_b_x"), whole.scalars.at("force_b_y"),
                     whole.scalars.at("force_b_z"));
    text += fmt::format("{},{}\n", 0.5 * whole.t, -force.dot(Vec3(0.6, -0.8, 0)));
  };
  REQUIRE(run.follow(each).path.complete);
  write("two.csv", text);
  const Found found = fitted(
      "data: [{kind: scene, solve: two.yaml, file: two.csv, columns: {u_ind: travel_mm, force: force_N}, on: b}]\n" +
      std::string(
          "law: {matrix: {yeoh: {a1: 0.02, a2: 0.02, a3: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\nbounds: admissible\n") +
      "parameters: [{key: matrix.yeoh.a1}, {key: matrix.yeoh.a2}]\ndraft: false\n");
  REQUIRE(found.fit.best.converged);
  CHECK(found.fit.best.p[0] == near(0.012, 1e-5));
  CHECK(found.fit.best.p[1] == near(0.03, 1e-5));
}

TEST_CASE(
    "A place on the surface is found where its shape functions put it, on a block and on a section") {
  for (const char* yaml :
       {"geometry: {block: {size: [6, 2, 4], divisions: [5, 2, 3]}}\n",
        "geometry: {block: {size: [6, 2, 4], divisions: [3, 1, 2]}}\ncells: hex27\n",
        "geometry: {section: {of: axisymmetric, size: [6, 2], divisions: [5, 2]}}\n"}) {
    CAPTURE(yaml);
    SolveConfig config;
    config.mesh = read_config<MeshConfig>(parse_yaml(yaml, "mesh.yaml")).config;
    const Mesh mesh = body_mesh(config, "", [](const std::string&) { return Place{}; });
    const double z = mesh.section ? 0 : 1.37;
    for (double x : {0.4, 2.5, 5.9})
      for (double y : {std::nan(""), 2.0}) {
        Observation at{Observation::Of::displacement, 0};
        REQUIRE(find_place(mesh, {x, y, z}, at));
        Vec3 found = Vec3::Zero();
        for (std::size_t k = 0; k < at.nodes.size(); ++k)
          found += at.weights[k] * mesh.X[static_cast<std::size_t>(at.nodes[k])];
        CHECK((found - Vec3(x, 2, z)).norm() < 1e-9);
      }
    Observation none;
    CHECK_FALSE(find_place(mesh, {7, std::nan(""), z}, none));
  }
}

TEST_CASE(
    "Three numbers of Yeoh's law are found again from the force on a sphere, from starts on either side") {
  write_force("force.csv", truth());
  for (const char* start :
       {"{a1: 0.05, a2: 0.01, a3: 0.05}", "{a1: 0.004, a2: 0.004, a3: 0.001}"}) {
    CAPTURE(start);
    const std::string from = std::string("law: {matrix: {yeoh: ") + start +
                             "}, volume: {quadratic: {d: 1.0e-2}}}\nbounds: admissible\n";
    const Found found = fitted(std::string(force) + "}]\n" + from + three + "jobs: 2\n");
    REQUIRE(found.fit.best.converged);
    CHECK(found.fit.best.p[0] == near(0.012, 1e-6));
    CHECK(found.fit.best.p[1] == near(0.03, 1e-6));
    CHECK(found.fit.best.p[2] == near(0.01, 1e-6));
    REQUIRE(found.record.curves.size() == 1);
    CHECK(found.record.curves[0].unit == "N");
    CHECK(found.record.curves[0].max_error_percent < 1e-5);
    CHECK(found.record.curves[0].discretisation_percent > 0.1);  // ten cells
  }
}

TEST_CASE(
    "The results do not depend on the number of scenes side by side, and a fit goes on with the runs that it has kept") {
  write_force("force.csv", truth());
  const std::string yaml = std::string(force) + "}]\n" + law + three + "draft: false\n";
  fs::remove(folder + "/kept.runs");
  const Found one = fitted(yaml), two = fitted(yaml + "jobs: 3\n", "kept.runs");
  CHECK(one.fit.best.p == two.fit.best.p);
  CHECK(one.runs == two.runs);
  const Found again = fitted(yaml, "kept.runs");
  CHECK(again.fit.best.p == one.fit.best.p);
  CHECK(again.runs == 0);
}

TEST_CASE("Touch offset, force offset and compliance of the machine are found beside the law") {
  // increments of 0.05 mm: readings between states are interpolated
  std::string scene = solve_yaml;
  scene.replace(scene.find("steps: 5"), 8, "steps: 20");
  ForwardPath path = solved_scene("fine.yaml", scene);
  path.values.conservativeResize(Eigen::NoChange, 2);
  path.values.col(1).setZero();
  std::string measured = force;
  measured.replace(measured.find("solve.yaml"), 10, "fine.yaml");
  const std::string true_rest =
      "law: {matrix: {yeoh: {a1: 0.02, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\nbounds: admissible\n";
  struct Machine {
    const char* key;
    double touch, offset, compliance, value;
  };
  for (const Machine& machine :
       {Machine{"touch_offset", 0.02, 0, 0, 0.02}, Machine{"force_offset", 0, 0.003, 0, 0.003},
        Machine{"compliance", 0, 0, 0.05, 0.05}}) {
    CAPTURE(machine.value);
    write_force("force.csv", path, machine.touch, machine.offset, machine.compliance);
    const Found found = fitted(measured + "}]\n" + true_rest +
                               "parameters: [{key: matrix.yeoh.a1}, {key: \"data[0]." +
                               machine.key + "\"}]\ndraft: false\n");
    REQUIRE(found.fit.best.converged);
    // The interpolation between states leaves 3e-4 of a1 and 2e-3 of the touch offset.
    CHECK(found.fit.best.p[0] == near(0.012, 5e-4));
    CHECK(found.fit.best.p[1] == near(machine.value, 4e-3));
  }
}

TEST_CASE("An offset of touch of either sign is found where all readings fall on increments") {
  std::string scene = solve_yaml;
  scene.replace(scene.find("steps: 5"), 8, "first: 0.05, largest: 0.05");
  const ForwardPath exact = solved_scene("fine.yaml", scene);
  const double largest = exact.values(exact.values.rows() - 1, 0);
  for (double touch : {-0.05, 0.05})
    for (std::uint64_t seed : {1, 2}) {
      CAPTURE(touch);
      CAPTURE(seed);
      Random random(12, seed);
      std::string text = "travel_mm,force_N\n";
      for (std::size_t i = 1; i < exact.t.size(); ++i)
        text += fmt::format(
            "{},{}\n", exact.t[i] + touch,
            exact.values(static_cast<Eigen::Index>(i), 0) + 0.005 * largest * random.normal());
      write("touched.csv", text);
      const Found found = fitted(fmt::format(
          "data: [{{kind: scene, solve: fine.yaml, file: touched.csv, columns: {{u_ind: travel_mm, force: force_N}}, "
          "standard_deviation: {}}}]\n"
          "law: {{matrix: {{yeoh: {{a1: 0.03, a2: 0.01, a3: 0.01}}}}, volume: {{quadratic: {{d: 1.0e-2}}}}}}\n"
          "parameters: [{{key: matrix.yeoh.a1, lower: 0.0001, upper: 1}}, {{key: matrix.yeoh.a2, lower: 0, upper: 1}}, "
          "{{key: \"data[0].touch_offset\", lower: -0.2, upper: 0.2}}]\ndraft: false\n",
          0.005 * largest));
      CHECK(found.fit.best.converged);
      for (Eigen::Index i = 0; i < 3; ++i) {
        const double expected = std::array{0.012, 0.03, touch}[static_cast<std::size_t>(i)];
        const double error = std::sqrt(found.fit.covariance(i, i));
        CHECK(std::abs(found.fit.best.p[i] - expected) < 3.5 * error);
      }
    }
}

TEST_CASE("The derivative by what the machine adds is that of the model") {
  write_force("force.csv", truth());
  const auto loaded = read(
      std::string(force) + ", compliance: 0.3, touch_offset: 0.013}]\n" + law +
      "parameters: [{key: matrix.yeoh.a1}, {key: \"data[0].touch_offset\"}, {key: \"data[0].force_offset\"}, {key: \"data[0].compliance\"}]\n");
  const FitProblem problem = fit_problem(loaded.config);
  SceneTests scenes(loaded.config, loaded.where, problem, {}, std::make_shared<RunCache>(),
                    {1, true});
  VecX p(4);
  p << 0.015, 0.013, 0.002, 0.3;
  MatX J;
  REQUIRE(scenes.slope(p, J));
  for (Eigen::Index i = 0; i < 4; ++i) {
    VecX above, below, moved = p;
    const double h = i == 0 ? 1e-3 * p[i] : 1e-5;
    moved[i] = p[i] + h;
    REQUIRE(scenes.model(moved, above));
    moved[i] = p[i] - h;
    REQUIRE(scenes.model(moved, below));
    const VecX quotient = (above - below) / (2 * h);
    CAPTURE(i);
    CHECK((quotient - J.col(i)).norm() < 1e-3 * quotient.norm());
  }
}

TEST_CASE("The derivatives of the runs are those of differences between runs") {
  write_force("force.csv", truth());
  const auto loaded = read(std::string(force) + "}]\n" + law + three);
  const FitProblem problem = fit_problem(loaded.config);
  const auto cache = std::make_shared<RunCache>();
  SceneTests exact(loaded.config, loaded.where, problem, {}, cache, {1, false}),
      quotients(loaded.config, loaded.where, problem, {}, cache, {1, true});
  VecX p(3);
  p << 0.015, 0.02, 0.012;
  MatX J, Q;
  REQUIRE(exact.slope(p, J));
  REQUIRE(quotients.slope(p, Q));
  for (Eigen::Index i = 0; i < 3; ++i)
    CHECK((J.col(i) - Q.col(i)).norm() < 1e-3 * J.col(i).norm());  // one-sided differences
  CHECK(exact.runs() == 1);
  CHECK(quotients.runs() == 4);
}

TEST_CASE("A viscous scene is differentiated by its run, one that adheres by differences of runs") {
  write_force("force.csv", truth());
  const auto loaded = read(std::string(force) +
                           "}]\nlaw: {matrix: {yeoh: {a1: 0.02, a2: 0.02, a3: 0.02}}, volume: "
                           "{quadratic: {d: 1.0e-2}}, viscous: [{tau: 0.5, gamma: 0.6}]}\n"
                           "parameters: [{key: matrix.yeoh.a1, start: 0.02, lower: 0.005, upper: "
                           "0.1}, {key: \"viscous[0].gamma\", start: 0.6, lower: 0, upper: 2}]\n");
  const FitProblem problem = fit_problem(loaded.config);
  VecX p(2);
  p << 0.015, 0.5;
  const auto slope = [&](bool by_quotients, int& runs) {
    SceneTests scenes(loaded.config, loaded.where, problem, {}, std::make_shared<RunCache>(),
                      {1, by_quotients});
    MatX J;
    REQUIRE(scenes.slope(p, J));
    runs = scenes.runs();
    return J;
  };
  std::string timed = solve_yaml;
  timed.replace(timed.find("steps: 5"), 8, "steps: 5, seconds: 2");
  write("solve.yaml", timed);
  int runs = 0;
  const MatX direct = slope(false, runs);
  CHECK(runs == 1);
  const MatX quotients = slope(true, runs);
  CHECK(runs == 3);
  for (Eigen::Index i = 0; i < 2; ++i)
    CHECK((direct - quotients).col(i).norm() < 1e-3 * direct.col(i).norm());
  std::string sticky = timed;
  sticky.replace(sticky.find("    motion:"), 11,
                 "    adhesion: {work: 1.0e-3, stiffness: 0.1}\n    motion:");
  write("solve.yaml", sticky);
  slope(false, runs);
  CHECK(runs == 3);
}

TEST_CASE("What a scene does not have, and files that do not fit it, are named where they stand") {
  write_force("force.csv", truth());
  const auto with = [](const std::string& data, const std::string& parameters = three) {
    return "data: [" + data + "]\n" + law + parameters;
  };
  const std::string scene = "{kind: scene, solve: solve.yaml, file: force.csv, ";
  holds(refusal(with(scene + "columns: {u_ind: travel_mm, force: forze_mN}}")),
        "no column \"forze_mN\"");
  holds(refusal(with(scene + "columns: {u_ind: force_mN, force: force_mN}}")),
        "the unit mN of the column \"force_mN\"");
  holds(refusal(with(scene + "columns: {u_ind: travel_mm, u_y: beside_um}, on: nowhere}")),
        "the scene has no set \"nowhere\"");
  holds(refusal(with(scene + "columns: {displacement: travel_mm, force: force_mN}, moved: top}")),
        "no imposed displacement on \"top\"");
  holds(refusal(with(scene + "columns: {time: travel_mm, force: force_mN}}")),
        "the unit mm of the column");
  holds(refusal(with(scene + "columns: {u_ind: travel_mm, force: force_mN}}",
                     "parameters: [{key: contacts.cone.friction}]\n")),
        "no scene has a contact \"cone\"");
  holds(refusal(with(scene + "columns: {u_ind: travel_mm, force: force_mN}}",
                     "parameters: [{key: matrix.gent.mu}]\n")),
        "the material has no number");
  write("force.csv", "travel_mm,force_mN\n0.5,10\n1.2,40\n");
  const std::string longer = refusal(with(scene + "columns: {u_ind: travel_mm, force: force_mN}}"));
  holds(longer, "force.csv:3:1");
  holds(longer, "0 to 1 mm");
  write("force.csv", "travel_mm,force_mN\n0.5,10\n0.7,nan\n");
  holds(refusal(with(scene + "columns: {u_ind: travel_mm, force: force_mN}}")), "force.csv:3:5");
}

namespace {

// The force on the sphere where a number of the scene is another one.
ForwardPath truth_with(const std::string& key, double value) {
  write("solve.yaml", solve_yaml);
  auto loaded = read_config<SolveConfig>(load_yaml(folder + "/solve.yaml"));
  ForwardRun run(loaded.config, loaded.where, 0);
  Observation beside{Observation::Of::displacement, 1};
  beside.nodes = run.mesh().node_sets.at("beside"), beside.weights = {1};
  run.observe({Observation{}, beside}, {});
  ForwardInput input{*loaded.config.material};
  input.numbers[key] = value;
  return run.solve(input);
}

// one number of the law and one of the scene, by the force and the displacement beside
std::string with_number(const std::string& number) {
  return "data:\n"
         "  - {kind: scene, solve: solve.yaml, file: force.csv, columns: {u_ind: travel_mm, force: force_mN}}\n"
         "  - {kind: scene, solve: solve.yaml, file: force.csv, columns: {u_ind: travel_mm, u_y: beside_um}, on: beside}\n" +
         std::string(law) + "parameters: [{key: matrix.yeoh.a1}, " + number + "]\ndraft: false\n";
}

}  // namespace

TEST_CASE(
    "A thickness and a radius of a scene are found again, and start where the scene has them") {
  for (const auto& [key, value, name] :
       {std::tuple("mesh.geometry.section.size[1]", 3.4, "thickness"),
        std::tuple("contacts.sphere.rigid.sphere.radius", 2.1, "sphere_radius")}) {
    const auto shown = key;
    CAPTURE(shown);
    write_force("force.csv", truth_with(key, value));
    const std::string yaml = with_number("{key: \"" + std::string(key) + "\"}");
    std::string other = yaml;
    other.replace(other.find("{a1: 0.02, a2: 0.02, a3: 0.02}"), 30,
                  "{a1: 0.02, a2: 0.03, a3: 0.01}");
    const Found found = fitted(other);
    REQUIRE(found.fit.best.converged);
    CHECK(found.fit.best.p[0] == near(0.012, 1e-5));
    CHECK(found.fit.best.p[1] == near(value, 1e-5));
    const auto loaded = read(other);
    FitProblem problem = fit_problem(loaded.config);
    CHECK(std::isnan(problem.free[1].start));
    complete_scene_numbers(loaded.config, loaded.where, problem);
    CHECK(problem.free[1].start == near(name == std::string("thickness") ? 3 : 2.5));
    CHECK(problem.free[1].name == name);
  }
}

TEST_CASE("Slopes of a scene by any of its numbers are those of differences of its runs") {
  write_force("force.csv", truth());
  for (const char* number :
       {"{key: \"mesh.geometry.section.size[1]\", start: 3.2}",
        "{key: contacts.sphere.rigid.sphere.radius, start: 2.3}",
        "{key: \"contacts.sphere.rigid.sphere.centre[1]\", start: 5.6, lower: 5.51, upper: 6}"}) {
    CAPTURE(number);
    const auto loaded = read(with_number(number));
    FitProblem problem = fit_problem(loaded.config);
    complete_scene_numbers(loaded.config, loaded.where, problem);
    const auto slopes = [&](bool quotients) {
      SceneTests scenes(loaded.config, loaded.where, problem, {}, std::make_shared<RunCache>(),
                        {1, quotients});
      MatX J;
      VecX p(2);
      p << 0.015, problem.free[1].start;
      REQUIRE(scenes.slope(p, J));
      return J;
    };
    const MatX direct = slopes(false);
    const MatX quotients = slopes(true);
    CHECK((direct - quotients).col(1).norm() <= 2e-3 * quotients.col(1).norm());
  }
}

TEST_CASE("Numbers that a scene cannot have otherwise are refused by name") {
  write_force("force.csv", truth());
  holds(refusal(with_number("{key: \"mesh.bodies[0].thickness\"}")), "mesh.bodies[0].thickness");
  holds(refusal(with_number("{key: contacts.sphere.rigid.sphere.diameter}")), "no such number");
  holds(refusal(with_number("{key: \"contacts.sphere.motion[0].to[1]\"}")), "touch_offset");
  holds(refusal(with_number("{key: contacts.sphere.rigid.sphere.radius, lower: 3}")), "starts at");
}

TEST_CASE("A prior of the thickness widens what the force alone says, and what is held is named") {
  write_force("force.csv", truth());
  const std::string data = std::string(force) + ", standard_deviation: 0.002}]\n";
  const std::string law_at =
      "law: {matrix: {yeoh: {a1: 0.012, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\nbounds: admissible\ndraft: false\n";
  const std::string two = "parameters: [{key: matrix.yeoh.a1}, {key: matrix.yeoh.a2}";
  const auto errors = [&](const std::string& more, std::vector<InverseFit::Widening>* held) {
    const auto loaded = read(data + law_at + two + more + "]\n");
    FitProblem problem = fit_problem(loaded.config);
    InverseFit inverse({"fit", true, false}, loaded.config, loaded.where, problem, {}, "");
    inverse.set_priors(priors_of(loaded.config, problem, loaded.where));
    const FitResult found = inverse.search();
    if (held) *held = inverse.widenings(found);
    return VecX(found.covariance.diagonal().cwiseSqrt());
  };
  std::vector<InverseFit::Widening> held;
  const VecX fixed = errors("", &held);
  const std::string thickness = ", {key: \"mesh.geometry.section.size[1]\"";
  const VecX known = errors(thickness + ", prior: {normal: [3, 0.3]}}", nullptr);
  const VecX unknown = errors(thickness + "}", nullptr);
  CHECK(known[2] < 0.3001);
  CHECK(known[1] > fixed[1]);
  CHECK(unknown[1] > known[1]);
  // what freeing the thickness does is what was foretold
  const auto one = std::ranges::find_if(held, [](const InverseFit::Widening& w) {
    return w.held.name == "mesh.geometry.section.size[1]";
  });
  REQUIRE(one != held.end());
  const double widest = std::max(unknown[0] / fixed[0], unknown[1] / fixed[1]);
  CHECK(one->factor == near(widest, 0.02));
  holds(in_words(*one), "is fixed at 3 mm; freeing it widens");
}

TEST_CASE("the posterior of a scene by some runs is that of its density, run at each step") {
  write_force("force.csv", truth());
  const auto loaded = read(std::string(force) + ", standard_deviation: 0.003}]\n" + law +
                           "parameters: [{key: matrix.yeoh.a1}, {key: matrix.yeoh.a2}]\n");
  FitProblem problem = fit_problem(loaded.config);
  InverseFit inverse({"fit", true, false}, loaded.config, loaded.where, problem, {}, "");
  const FitResult found = inverse.search();
  PosteriorConfig config;
  config.samples = 4000;
  const int before = inverse.runs();
  const CostlyPosterior fast = costly_posterior(inverse.costly(), found, config, 1);
  CHECK(fast.reached);
  CHECK(inverse.runs() - before <= fast.runs);
  CHECK(fast.runs <= 100);
  // the sampler with the scenes themselves
  config.samples = 160;
  config.warmup = 50;
  config.chains = 2;
  const Posterior exact = posterior(problem, found, config, 1);
  for (Eigen::Index j = 0; j < 2; ++j) {
    CAPTURE(j);
    const VecX values = exact.samples.col(j);
    const double mean = values.mean();
    const double deviation =
        std::sqrt((values.array() - mean).square().sum() / static_cast<double>(values.size() - 1));
    const double effective = exact.effective[static_cast<std::size_t>(j)];
    const VecX of_fast = fast.posterior.samples.col(j);
    CHECK(of_fast.mean() == near(mean, 0, 4 * deviation / std::sqrt(effective)));
    const double spread = std::sqrt((of_fast.array() - of_fast.mean()).square().sum() /
                                    static_cast<double>(of_fast.size() - 1));
    CHECK(spread == near(deviation, 0, 4 * deviation / std::sqrt(2 * effective)));
  }
}

}  // namespace scene_fit_tests
