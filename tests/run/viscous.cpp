// Viscous bodies on their way through time, against what is known of them.
#include <doctest/doctest.h>

#include <complex>
#include <numbers>
#include <tuple>

#include "core/tensor/kinematics.hpp"
#include "mechanics/element/viscous_points.hpp"
#include "results/post/cycle.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace viscous_tests {

namespace {

const std::string branches =
    ", viscous: [{tau: 0.5, gamma: 0.4}, {tau: 20, gamma: 0.3, of: matrix}, {tau: 3, gamma: 0.2, of: fibres}]";
const std::string matrix =
    "matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-4}}";
const std::string fibres = ", fibres: [{hgo: {c1: 0.317, c2: 1.1}, alpha: 60}]";

std::string material(const std::string& more) {
  return "material: {" + matrix + fibres + more + "}\n";
}

std::string block(const std::string& cells, const std::string& divisions = "[6, 2, 6]") {
  return "mesh:\n  geometry: {block: {size: [12, 4, 12], divisions: " + divisions +
         "}}\n  cells: " + cells +
         "\n  sets: {contact: {of: top, within: {cylinder: {axis: y, through: [6, 0, 6], radius: 3.1}}}}\n"
         "supports: [{on: bottom, hold: [x, y, z]}]\n";
}
std::string ball(const std::string& motion) {
  return "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [6, 6.5, 6]}}, friction: 0.34, motion: " +
         motion + "}}\n";
}
const std::string hold = "[{t: 0.1, to: [0, -0.6, 0]}, {t: 1, to: [0, -0.6, 0]}]";

// pulled by 20 % in one direction, the others free to slide; tetrahedra are made in memory
std::string pull(const std::string& cells) {
  return (cells == "tet15"
              ? ""
              : "mesh: {geometry: {block: {size: [4, 2, 2], divisions: [3, 2, 2]}}, cells: " +
                    cells + "}\n") +
         std::string(
             "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n"
             "loads: [{on: x_max, displacement: {x: 0.8}}]\n");
}
Mesh mesh_of(const SolveConfig& config) {
  if (config.mesh) return test::mesh_in(config);
  return test::raised_block(
      test::block(test::even(0, 4, 3), test::even(0, 2, 2), test::even(0, 2, 2)), CellType::tet15);
}

struct Found {
  std::vector<StepRecord> steps;
  const StepRecord& last() const { return steps.back(); }
};

Found follow(const std::string& text, bool at_a_point = false) {
  CAPTURE(text);
  const SolveConfig config = test::config_of(text);
  Run run(mesh_of(config), config, config.material, test::nowhere, at_a_point);
  REQUIRE((run.reduction.kind() == Reduction::Kind::homogeneous) == at_a_point);
  Found found;
  RunListener each;
  each.of_whole = [&](const StepRecord& step, const SolveReport&) {
    found.steps.push_back(step);
  };
  const RunEnd end = run.follow(each);
  CAPTURE(end.path.why);
  REQUIRE(end.path.complete);
  return found;
}

double farthest(const StepRecord& a, const StepRecord& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.u.size(); ++i) most = std::max(most, (a.u[i] - b.u[i]).norm());
  return most;
}

double reaction(const StepRecord& step) {
  double sum = 0;
  for (const Vec3& r : step.reaction) sum += r.cwiseAbs().sum();
  return sum;
}

}  // namespace

TEST_CASE("viscous: seconds alone change no digit of an elastic scene") {
  const std::string scene = block("hex8") + material("") + ball("[{t: 1, to: [0, -0.6, 0]}]");
  const Found without = follow(scene), with = follow(scene + "path: {seconds: 100}\n");
  REQUIRE(without.steps.size() == with.steps.size());
  for (std::size_t i = 0; i < with.steps.size(); ++i) {
    CHECK(with.steps[i].u == without.steps[i].u);
    CHECK(with.steps[i].reaction == without.steps[i].reaction);
    CHECK(with.steps[i].scalars.at("time") == near(100 * with.steps[i].t, 1e-14));
    CHECK(!with.steps[i].scalars.count("viscous_work"));
    CHECK(!without.steps[i].scalars.count("time"));
  }
}

TEST_CASE(
    "viscous: endless increments are those of the law, sudden ones of 1 + sum gamma times the law") {
  for (const char* cells : {"hex8", "hex27", "tet15"}) {
    const std::string scene = pull(cells) + "solver: {newton: {relative: 1e-12}}\n";
    const Found law = follow(scene + material("") + "path: {steps: 2}\n");
    const Found slow = follow(scene + material(branches) + "path: {steps: 2, seconds: 1e14}\n");
    CHECK(farthest(law.last(), slow.last()) <= 1e-10);
    CHECK(reaction(slow.last()) == near(reaction(law.last()), 1e-10));
    const std::string at_once =
        "material: {matrix: {yeoh: {a1: 0.4573, a2: 0.6392, a3: 0.7055}}, volume: {quadratic: {d: 1.0e-4}}, "
        "fibres: [{hgo: {c1: 0.5072, c2: 1.1}, alpha: 60}]}\n";  // 1.7 and 1.6 times
    const Found stiff = follow(scene + at_once + "path: {steps: 2}\n");
    const Found sudden = follow(scene + material(branches) + "path: {steps: 2, seconds: 1e-12}\n");
    CHECK(farthest(stiff.last(), sudden.last()) <= 1e-10);
    CHECK(reaction(sudden.last()) == near(reaction(stiff.last()), 1e-10));
  }
}

TEST_CASE(
    "viscous: a body that deforms alike everywhere has the stress of a point, in all cells, whole or at one hexahedron") {
  for (const char* cells : {"hex8", "hex27", "tet15"}) {
    const std::string path = "path: {steps: 6, seconds: 3}\nsolver: {newton: {relative: 1e-12}}\n";
    const Found whole = follow(pull(cells) + material(branches) + path),
                point = follow(pull(cells) + material(branches) + path, true);
    REQUIRE(whole.steps.size() == 6);
    REQUIRE(point.steps.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(farthest(whole.steps[i], point.steps[i]) <= 1e-9);
      for (const char* field : {"von_mises", "pressure", "J"}) {
        const auto& values = whole.steps[i].cell_fields.at(field);
        for (double v : values) {
          CHECK(v == near(values[0], 1e-8));
          CHECK(v == near(point.steps[i].cell_fields.at(field)[0], 1e-8));
        }
      }
      CHECK(whole.steps[i].scalars.at("viscous_work") ==
            near(point.steps[i].scalars.at("viscous_work"), 1e-8));
    }
  }
}

TEST_CASE("viscous: equal increments have an error of second order") {
  const std::string scene = pull("hex8") + material(branches) +
                            "solver: {newton: {relative: 1e-12}}\npath: {seconds: 3, steps: ";
  const auto force = [&](int n) {
    return reaction(follow(scene + std::to_string(n) + "}\n", true).last());
  };
  const double exact = force(640), coarse = force(10) - exact, fine = force(20) - exact;
  CHECK(std::log2(coarse / fine) == near(2, 0.05));
}

TEST_CASE("viscous: increments follow their error, from milliseconds to an hour in one path") {
  // pulled in 10 ms, held for an hour
  const auto scene = [](const std::string& error) {
    return "mesh: {geometry: {block: {size: [4, 2, 2], divisions: [2, 2, 2]}}}\nsupports: [{on: x_min, hold: [x, y, z]}]\n"
           "contacts: {plate: {rigid: {plane: {point: [0, 2, 0], normal: [0, -1, 0]}}, motion: [{t: 2.7777778e-6, to: [0, -0.1, 0]}, "
           "{t: 1, to: [0, -0.1, 0]}]}}\nmaterial: {" +
           matrix +
           ", viscous: [{tau: 0.002, gamma: 0.4}, {tau: 0.5, gamma: 0.3}, {tau: 300, gamma: 0.5}]}\npath: {seconds: 3600" +
           error + "}\n";
  };
  const Found found = follow(scene(""));
  const double first = found.steps.front().scalars.at("time"),
               last = found.steps.back().increment * 3600;
  CHECK(first < 0.01);
  CHECK(last > 100);
  CHECK(found.steps.size() < 100);
  // each decade of the hold is seen
  for (double t = 0.01; t < 1000; t *= 10)
    CHECK(std::any_of(found.steps.begin(), found.steps.end(), [&](const StepRecord& s) {
      const double now = s.scalars.at("time");
      return now > t && now < 10 * t;
    }));
  const Found finer = follow(scene(", time_error: 1e-5, largest: 0.02, first: 0.01"));
  CHECK(finer.steps.size() > found.steps.size());
  const auto peak = [](const Found& f) {
    double most = 0;
    for (const StepRecord& s : f.steps) most = std::max(most, s.force_ind.norm());
    return most;
  };
  CHECK(peak(found) == near(peak(finer), 2e-3));
  CHECK(found.last().force_ind.norm() == near(finer.last().force_ind.norm(), 1e-4));
}

TEST_CASE("viscous: symmetry and one thread or two solve the same body") {
  const std::string scene = block("hex8", "[8, 2, 8]") + material(branches) + ball(hold) +
                            "path: {seconds: 10, steps: 4}\nsolver: {newton: {relative: 1e-10}}\n";
  const Found whole = follow(scene), half = follow(scene + "symmetry: auto\n"),
              threads = follow(scene + "threads: 2\n");
  REQUIRE(whole.steps.size() == half.steps.size());
  for (std::size_t i = 0; i < whole.steps.size(); ++i) {
    CHECK(farthest(whole.steps[i], half.steps[i]) <= 1e-8);
    CHECK(half.steps[i].force_ind.norm() == near(whole.steps[i].force_ind.norm(), 1e-7));
    CHECK(half.steps[i].scalars.at("viscous_work") ==
          near(whole.steps[i].scalars.at("viscous_work"), 1e-7));
    CHECK(threads.steps[i].u == whole.steps[i].u);
  }
}

TEST_CASE("viscous: of a body of two materials only the viscous one relaxes") {
  const std::string layers =
      "mesh:\n  geometry: {block: {size: [6, 4, 6], divisions: [3, 4, 3]}}\n  bodies: [{name: fat, thickness: 2}, {name: skin, thickness: 2}]\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "contacts: {plate: {rigid: {plane: {point: [0, 4, 0], normal: [0, -1, 0]}}, motion: [{t: 0.01, to: [0, -0.3, 0]}, {t: 1, to: [0, -0.3, 0]}]}}\n"
      "path: {seconds: 1000, steps: 6}\n";
  const std::string soft = "{matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}";
  const auto force = [&](const std::string& skin, const std::string& fat) {
    return follow(layers + "materials: {skin: {material: " + soft + skin +
                  "}}, fat: {material: " + soft + fat + "}}}\n")
        .last()
        .force_ind.norm();
  };
  const std::string viscous = ", viscous: [{tau: 1, gamma: 1}]";
  const double elastic = force("", ""), one = force(viscous, ""), other = force("", viscous),
               both = force(viscous, viscous);
  for (double relaxed : {one, other, both}) CHECK(relaxed == near(elastic, 1e-5));
  const std::string slow = ", viscous: [{tau: 1e9, gamma: 1}]";
  const double skin = force(slow, ""), fat = force("", slow), all = force(slow, slow);
  CHECK(elastic < 0.9 * std::min(skin, fat));
  CHECK(std::max(skin, fat) < 0.9 * all);
}

TEST_CASE("viscous: a continued run is the run, to the last digit") {
  for (const std::string& scene :
       {block("hex8") + material(branches) + ball(hold) + "path: {seconds: 10}\n",
        block("hex8") + material(branches) + ball(hold) + "path: {seconds: 10}\nsymmetry: auto\n",
        block("hex27", "[3, 1, 3]") + material(branches) + ball(hold) + "path: {seconds: 10}\n",
        pull("tet15") + material(branches) + "path: {seconds: 10, largest: 0.3, first: 0.3}\n"}) {
    CAPTURE(scene);
    const SolveConfig config = test::config_of(scene);
    const Found whole = follow(scene);
    REQUIRE(whole.steps.size() >= 3);
    for (std::size_t at = 0; at + 1 < whole.steps.size();
         at += std::max<std::size_t>(2, whole.steps.size() / 2)) {
      Run run(mesh_of(config), config, config.material, test::nowhere);
      for (std::size_t k = 0; k <= at; ++k) run.replay(whole.steps[k]);
      run.resume(whole.steps[at], at > 0 ? std::optional(whole.steps[at - 1]) : std::nullopt);
      std::size_t k = at;
      RunListener each;
      each.of_whole = [&](const StepRecord& step, const SolveReport&) {
        ++k;
        CAPTURE(k);
        REQUIRE(k < whole.steps.size());
        REQUIRE(step.u == whole.steps[k].u);
        REQUIRE(step.reaction == whole.steps[k].reaction);
        REQUIRE(step.scalars == whole.steps[k].scalars);
        REQUIRE(step.cell_fields == whole.steps[k].cell_fields);
      };
      CHECK(run.follow(each).path.complete);
      CHECK(k + 1 == whole.steps.size());
    }
  }
}

TEST_CASE(
    "viscous: storage and loss of small cycles are those of the branches, in a pulled and in a sheared block, and at a point") {
  const double size = 1e-4, period = 1;
  std::string triangle;
  for (int i = 0; i < 8; ++i)
    triangle +=
        "{s: " + std::to_string(0.25 + 0.5 * i) + ", to: " + (i % 2 ? "-" : "") + "1.0e-4}, ";
  const std::string
      law = "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-6}}",
      newton = "solver: {newton: {relative: 1e-12}}\n";
  const std::string sheared =
      "mesh: {geometry: {block: {size: [4, 2, 2], divisions: [3, 2, 2]}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}, {on: top, hold: [y, z]}]\nloads: [{on: top, displacement: {x: ";
  const std::string pulled =
      "mesh: {geometry: {block: {size: [4, 2, 2], divisions: [3, 2, 2]}}}\n"
      "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\nloads: [{on: x_max, displacement: {x: ";
  for (const auto& one :
       {std::tuple(sheared, "top", false), {pulled, "x_max", false}, {pulled, "x_max", true}}) {
    const std::string& scene = std::get<0>(one);
    const char* face = std::get<1>(one);
    const bool point = std::get<2>(one);
    CAPTURE(face);
    const auto found = [&](const std::string& text) {
      const Mesh mesh = test::mesh_in(test::config_of(text));
      std::array<std::vector<double>, 3> curve{{{0}, {0}, {0}}};  // s, mm, N
      for (const StepRecord& step : follow(text, point).steps) {
        double force = 0;
        for (int n : mesh.node_sets.at(face))
          force += step.reaction[static_cast<std::size_t>(n)][0];
        curve[0].push_back(step.scalars.count("time") ? step.scalars.at("time") : step.t);
        curve[1].push_back(step.u[static_cast<std::size_t>(mesh.node_sets.at(face)[0])][0]),
            curve[2].push_back(force);
      }
      return curve;
    };
    const auto elastic = found(scene + "1.0e-4}}]\n" + law + "}\npath: {steps: 1}\n" + newton);
    const double stiffness = elastic[2].back() / size;
    const auto cycles = found(
        scene + "[" + triangle + "{s: 4.25, to: 1.0e-4}]}}]\n" + law +
        ", viscous: [{tau: 0.05, gamma: 0.5}, {tau: 0.3, gamma: 0.4}]}\npath: {seconds: 4.25, steps: 40}\n" +
        newton);
    std::complex<double> exact = 1;
    for (const auto& [tau, gamma] : {std::pair{0.05, 0.5}, {0.3, 0.4}}) {
      const std::complex<double> x(0, 2 * std::numbers::pi / period * tau);
      exact += gamma * x / (1. + x);
    }
    const Cycle cycle = last_cycle(cycles[0], cycles[1], cycles[2], period);
    CHECK(cycle.storage == near(stiffness * exact.real(), 1e-3));
    CHECK(cycle.loss == near(stiffness * exact.imag(), 1e-3));
    CHECK(cycle.tan_delta() == near(exact.imag() / exact.real(), 1e-3));
    CHECK(cycle.change < 1e-3);
  }
}

TEST_CASE(
    "viscous: what the branches remember is told before the run: 6 numbers for each, and 13 beside them, at each Gauss point") {
  const auto bytes = [](const std::string& more) {
    const SolveConfig config = test::config_of(block("hex8") + material(more) + ball(hold) +
                                               "path: {seconds: 10}\nsymmetry: none\n");
    Run run(mesh_of(config), config, config.material, test::nowhere, false);
    return run.body.viscous() ? run.body.viscous_points()->bytes() : 0;
  };
  CHECK(bytes("") == 0);
  const double points = 6 * 2 * 6 * 8;
  CHECK(bytes(", viscous: [{tau: 1, gamma: 0.5}]") == 8 * points * (2 * 6 + 6 + 1));
  CHECK(bytes(", viscous: [{tau: 1, gamma: 0.5}, {tau: 2, gamma: 0.5}, {tau: 3, gamma: 0.5}]") ==
        8 * points * (2 * 6 + 3 * 6 + 1));
}

TEST_CASE("viscous: a viscous material wants the duration of the path") {
  const SolveConfig config = test::config_of(pull("hex8") + material(branches));
  CHECK(test::said_of_scene(pull("hex8") + material(branches), test::mesh_in(config))
            .find("path.seconds") != std::string::npos);
}

}  // namespace viscous_tests
