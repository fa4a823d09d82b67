// Two deformable bodies in contact against closed forms, and against one body on a rigid plane.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "mortar/bodies.hpp"
#include "scene/run/post_files.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace {

const std::string soft = "{matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}";

std::string block(const std::string& origin, const std::string& size, const std::string& divisions,
                  const std::string& material) {
  return "{mesh: {geometry: {block: {origin: " + origin + ", size: " + size +
         ", divisions: " + divisions + "}}}, material: " + material + "}";
}

std::vector<int> contact_nodes(const BodiesScene& scene, const std::string& a,
                               const std::string& b) {
  std::set<int> nodes(scene.mesh.node_sets.at(a).begin(), scene.mesh.node_sets.at(a).end());
  nodes.insert(scene.mesh.node_sets.at(b).begin(), scene.mesh.node_sets.at(b).end());
  return {nodes.begin(), nodes.end()};
}

// a body on another one, both free to widen
std::string patch(const std::string& pad_divisions, const std::string& on,
                  const std::string& against) {
  return "bodies:\n"
         "  skin: " +
         block("[0, 0, 0]", "[2, 1, 2]", "[4, 2, 3]", soft) + "\n" +
         "  pad: " + block("[0, 1, 0]", "[2, 1, 2]", pad_divisions, soft) + "\n" +
         "supports:\n"
         "  - {on: skin_bottom, hold: [y]}\n"
         "  - {on: skin_x_min, hold: [x]}\n"
         "  - {on: skin_z_min, hold: [z]}\n"
         "  - {on: pad_x_min, hold: [x]}\n"
         "  - {on: pad_z_min, hold: [z]}\n"
         "loads: [{on: pad_top, displacement: {y: -0.3}}]\n"
         "contacts: {pad: {on: " +
         on + ", against: " + against +
         "}}\n"
         "path: {first: 0.5, largest: 0.5}\n";
}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return (*high - *low) / std::abs(*high);
}

}  // namespace

TEST_CASE("two bodies whose meshes do not match transmit a uniform pressure") {
  for (const auto& [on, against] :
       {std::pair{"pad_bottom", "skin_top"}, std::pair{"skin_top", "pad_bottom"}}) {
    const auto shown = on;
    CAPTURE(shown);
    const BodiesScene scene = bodies_scene(patch("[3, 2, 5]", on, against));
    const BodiesSolution solution = solved(scene);
    CHECK(spread(solution.last().cell_fields.at("von_mises")) < 1e-10);
    CHECK(spread(solution.last().cell_fields.at("J")) < 1e-10);
  }
}

TEST_CASE("two equal bodies pressed together are one against a frictionless plane") {
  const auto scene_of = [](const std::string& pad, const std::string& moved,
                           const std::string& contact) {
    return "bodies:\n  skin: " + block("[0, 0, 0]", "[3, 1, 2]", "[5, 3, 4]", soft) + "\n" + pad +
           "supports:\n  - {on: skin_bottom, hold: [x, y, z]}\n" + moved + "contacts: {" + contact +
           "}\npath: {first: 0.25, largest: 0.25}\n";
  };
  const BodiesScene two =
      bodies_scene(scene_of("  pad: " + block("[0, 1, 0]", "[3, 1, 2]", "[5, 3, 4]", soft) + "\n",
                            "loads:\n  - {on: pad_top, displacement: {x: 0, y: -0.4, z: 0}}\n",
                            "pad: {on: pad_bottom, against: skin_top}"));
  const BodiesScene one = bodies_scene(scene_of(
      "", "",
      "plane: {on: skin_top, rigid: {plane: {point: [0, 1, 0], normal: [0, -1, 0]}}, motion: [{t: 1, to: "
      "[0, -0.2, 0]}]}"));
  const StepRecord of_two = solved(two).last();
  const StepRecord of_one = solved(one).last();
  const double force = of_two.scalars.at("force_pad");
  CHECK(force == near(of_one.force_ind.norm(), 1e-8));
  const int pad_first = two.mesh.node_sets.at("skin_bottom").front();
  for (int i = 0; i < one.mesh.n_nodes(); ++i) {
    const Vec3 u = of_two.u[static_cast<std::size_t>(pad_first + i)];
    CHECK((u - of_one.u[static_cast<std::size_t>(i)]).norm() < 1e-8);
  }
}

TEST_CASE("a block slides over a finer one with a force of friction times pressure") {
  const std::string stiff = "{matrix: {neo_hooke: {a1: 5}}, volume: {quadratic: {d: 0.01}}}";
  const BodiesScene scene = bodies_scene(
      "bodies:\n"
      "  skin: " +
      block("[0, 0, 0]", "[4, 0.5, 1]", "[12, 1, 3]", stiff) + "\n" +
      "  pad: " + block("[0.5, 0.5, 0.2]", "[1, 0.5, 0.6]", "[2, 1, 2]", stiff) + "\n" +
      "supports:\n"
      "  - {on: skin_bottom, hold: [x, y, z]}\n"
      "loads:\n"
      "  - {on: pad_top, displacement: {x: [{t: 0.1, to: 0}, {t: 1, to: 1.9}], y: [{t: 0.1, to: "
      "-1.0e-6}, {t: 1, to: -1.0e-6}], z: 0}}\n"
      "contacts: {pad: {on: pad_bottom, against: skin_top, friction: 0.3}}\n"
      "path: {first: 0.05, largest: 0.05}\n");
  const BodiesSolution solution = solved(scene);
  int sliding = 0;
  for (const StepRecord& step : solution.steps) {
    if (step.t < 0.3) continue;
    const double normal = std::abs(step.scalars.at("force_pad_y"));
    const double along = std::abs(step.scalars.at("force_pad_x"));
    CHECK(along == near(0.3 * normal, 1e-6));
    ++sliding;
    const auto [force, moment] =
        imbalance(scene, step, contact_nodes(scene, "pad_bottom", "skin_top"));
    CHECK(force < 1e-12);
    CHECK(moment < 1e-10);
  }
  CHECK(sliding > 10);
  CHECK(static_cast<double>(solution.cost.factorizations) <= 1.5 * solution.iterations);
}

namespace {

const std::string stiff_pad =
    "{matrix: {neo_hooke: {a1: 500}}, volume: {quadratic: {d: 1.0e-4}}}";  // 1e4 times `soft`

std::string pressed_and_drawn(const std::string& pad, const std::string& rest,
                              const std::string& increment) {
  return "bodies:\n  skin: " + block("[0, 0, 0]", "[3, 1, 2]", "[5, 3, 4]", soft) + "\n" + pad +
         "supports:\n  - {on: skin_bottom, hold: [x, y, z]}\n" + rest +
         "path: {first: " + increment + ", largest: " + increment + "}\n";
}

const std::string pad_over_skin =
    "  pad: " + block("[-0.5, 1, -0.5]", "[4, 0.5, 3]", "[4, 1, 3]", stiff_pad) + "\n";
const std::string pad_pressed_and_drawn =
    "loads:\n  - {on: pad_top, displacement: {x: [{t: 0.5, to: 0}, {t: 1, to: 0.2}], "
    "y: [{t: 0.5, to: -0.2}, {t: 1, to: -0.2}], z: 0}}\n"
    "contacts: {pad: {on: skin_top, against: pad_bottom, friction: 0.3}}\n";

VecX flat(const std::vector<Vec3>& u) {
  VecX out(3 * static_cast<Eigen::Index>(u.size()));
  for (std::size_t i = 0; i < u.size(); ++i)
    out.segment<3>(3 * static_cast<Eigen::Index>(i)) = u[i];
  return out;
}

std::string refusal(const std::string& text) {
  const BodiesScene scene = bodies_scene(text);
  try {
    Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::config);
    return failure.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a stiff pad with friction is a rigid plane, and its work is stored or dissipated") {
  const BodiesScene pad =
      bodies_scene(pressed_and_drawn(pad_over_skin, pad_pressed_and_drawn, "0.025"));
  double work = 0;
  double dissipated = 0;
  VecX u = VecX::Zero(3 * pad.mesh.n_nodes());
  VecX reaction = u;
  std::vector<Vec3> r(pad.mesh.node_sets.at("skin_top").size(), Vec3::Zero());
  std::optional<EnergyPath> path;
  const auto each = [&](const Run& run, const StepRecord& step) {
    const std::vector<SurfaceContact>& surfaces = run.increment.surfaces();
    if (!path) {
      path.emplace(pad.mesh, std::vector<RigidContact>{}, std::vector<double>{0.5},
                   std::vector<TurnedSet>{}, surfaces);
      StepRecord rest;
      rest.u.assign(pad.mesh.X.size(), Vec3::Zero());
      rest.reaction = rest.u;
      path->add(energy_state(rest, {}, {}, surfaces));
    }
    path->add(energy_state(step, {}, {}, surfaces));
    const VecX u_next = flat(step.u);
    const VecX reaction_next = flat(step.reaction);
    for (int node : pad.mesh.node_sets.at("pad_top"))
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof)
        work += 0.5 * (reaction[dof] + reaction_next[dof]) * (u_next[dof] - u[dof]);
    const std::vector<Vec3>& r_next = step.contacts.at("pad").r;
    for (const MortarNode& node : run.increment.surface_averages()[0]) {
      const auto i = static_cast<std::size_t>(node.candidate);
      const Vec3 v = node.average(u_next - u);
      const Vec3 slip = v - node.normal * node.normal.dot(v);
      dissipated -= 0.5 * (r[i] + r_next[i]).dot(slip);
    }
    u = u_next;
    reaction = reaction_next;
    r = r_next;
  };
  const BodiesSolution solution = solved(pad, each);
  const StepRecord of_pad = solution.last();
  const StepRecord of_plane =
      solved(
          bodies_scene(pressed_and_drawn(
              "",
              "contacts: {plane: {on: skin_top, friction: 0.3, rigid: {plane: {point: [0, 1, 0], normal: "
              "[0, -1, 0]}}, motion: [{t: 0.5, to: [0, -0.2, 0]}, {t: 1, to: [0.2, -0.2, 0]}]}}\n",
              "0.025")))
          .last();
  CHECK(std::abs(of_pad.scalars.at("force_pad_y")) == near(std::abs(of_plane.force_ind[1]), 1e-3));
  CHECK(std::abs(of_pad.scalars.at("force_pad_x")) == near(std::abs(of_plane.force_ind[0]), 1e-3));
  CHECK(dissipated > 0.01 * work);
  CHECK(work == near(of_pad.scalars.at("energy") + dissipated, 1e-3));
  // the columns of langer-post; they integrate by parabolas
  const PathSums sums = path->sums().back();
  CHECK(sums.work == near(work, 1e-3));
  CHECK(sums.dissipated == near(dissipated, 1e-3));
  CHECK(std::abs(sums.balance) < 1e-3);
  const std::vector<double>& slip = path->slip(0);
  CHECK(*std::ranges::max_element(slip) > 0.05);
  CHECK(*std::ranges::max_element(slip) < 0.25);
}

TEST_CASE("a quarter of two bodies with friction is a quarter of the whole") {
  const auto scene_of = [](const std::string& origin, const std::string& n, const std::string& w,
                           const std::string& supports) {
    return "bodies:\n  skin: " +
           block("[" + origin + ", 0, " + origin + "]", "[" + w + ", 1, " + w + "]",
                 "[" + n + ", 2, " + n + "]", soft) +
           "\n  pad: " +
           block("[" + std::to_string(0.625 * std::stod(origin)) + ", 1, " +
                     std::to_string(0.625 * std::stod(origin)) + "]",
                 "[" + std::to_string(0.625 * std::stod(w)) + ", 1, " +
                     std::to_string(0.625 * std::stod(w)) + "]",
                 "[" + n + ", 2, " + n + "]", soft) +
           "\nsupports:\n  - {on: skin_bottom, hold: [x, y, z]}\n" + supports +
           "loads: [{on: pad_top, displacement: {x: 0, y: -0.3, z: 0}}]\n"
           "contacts: {pad: {on: pad_bottom, against: skin_top, friction: 0.2}}\n"
           "path: {first: 0.5, largest: 0.5}\n";
  };
  const BodiesScene quarter =
      bodies_scene(scene_of("0", "4", "2",
                            "  - {on: skin_x_min, hold: [x]}\n  - {on: skin_z_min, hold: [z]}\n"
                            "  - {on: pad_x_min, hold: [x]}\n  - {on: pad_z_min, hold: [z]}\n"));
  const BodiesScene whole = bodies_scene(scene_of("-2", "8", "4", ""));
  const StepRecord of_quarter = solved(quarter).last();
  const StepRecord of_whole = solved(whole).last();
  int found = 0;
  for (int i = 0; i < quarter.mesh.n_nodes(); ++i)
    for (int j = 0; j < whole.mesh.n_nodes(); ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      if ((quarter.mesh.X[a] - whole.mesh.X[b]).norm() > 1e-9) continue;
      // nodes of the two bodies may be at one place; those of the skin come first
      if ((2 * i < quarter.mesh.n_nodes()) != (2 * j < whole.mesh.n_nodes())) continue;
      ++found;
      CHECK((of_quarter.u[a] - of_whole.u[b]).norm() < 1e-6);  // by the tolerance of the law
    }
  CHECK(found == quarter.mesh.n_nodes());
}

TEST_CASE("a run of two bodies that was killed goes on with the same digits") {
  const BodiesScene scene =
      bodies_scene(pressed_and_drawn(pad_over_skin, pad_pressed_and_drawn, "0.1"));
  const BodiesSolution whole = solved(scene);
  const std::size_t at = whole.steps.size() - 6;
  const BodiesSolution rest = solved(scene, {}, &whole.steps[at], &whole.steps[at - 1]);
  REQUIRE(rest.steps.size() == 5);
  CHECK((flat(rest.last().u) - flat(whole.last().u)).isZero(0));
  CHECK(rest.last().scalars.at("force_pad") == whole.last().scalars.at("force_pad"));
}

TEST_CASE("the force on an indenter does not include what bodies below it exchange") {
  const StepRecord last =
      solved(bodies_scene(
                 "bodies:\n  skin: " + block("[-2, 0, -2]", "[4, 1, 4]", "[4, 2, 4]", soft) +
                 "\n  pad: " + block("[-1, 1, -1]", "[2, 1, 2]", "[4, 2, 4]", soft) +
                 "\n"
                 "supports:\n  - {on: skin_bottom, hold: [x, y, z]}\n"
                 "  - {on: pad_x_min, hold: [x]}\n  - {on: pad_z_min, hold: [z]}\n"
                 "contacts:\n  pad: {on: pad_bottom, against: skin_top}\n"
                 "  ball: {on: pad_top, rigid: {sphere: {radius: 3, centre: [0, 5, 0]}}, motion: "
                 "[{t: 1, to: [0, -0.3, 0]}]}\n"
                 "path: {first: 0.5, largest: 0.5}\n"))
          .last();
  const double on_ball = last.scalars.at("force_ball_y");
  CHECK(on_ball > 0.01);
  CHECK(last.force_ind[1] == near(on_ball, 1e-12));
  CHECK(std::abs(last.scalars.at("force_pad_y")) == near(on_ball, 1e-6));
}

TEST_CASE("a body that only friction holds is found between two others") {
  const std::string between =
      "bodies:\n"
      "  skin: " +
      block("[-2, 0, -2]", "[4, 1, 4]", "[4, 2, 4]", soft) + "\n" +
      "  pad: " + block("[-1, 1, -1]", "[2, 1, 2]", "[3, 2, 3]", soft) + "\n" +
      "  plate: " + block("[-2, 2, -2]", "[4, 1, 4]", "[5, 2, 5]", soft) + "\n" +
      "supports: [{on: skin_bottom, hold: [x, y, z]}]\n"
      "loads: [{on: plate_top, displacement: {x: 0.1, y: -0.3, z: 0}}]\n"
      "contacts:\n"
      "  below: {on: pad_bottom, against: skin_top, friction: FRICTION}\n"
      "  above: {on: pad_top, against: plate_bottom, friction: FRICTION}\n"
      "path: {first: 0.25, largest: 0.25}\n";
  const auto with = [&](const std::string& friction) {
    std::string text = between;
    for (auto at = text.find("FRICTION"); at != text.npos; at = text.find("FRICTION"))
      text.replace(at, 8, friction);
    return text;
  };
  const BodiesScene scene = bodies_scene(with("0.4"));
  const StepRecord last = solved(scene).last();
  for (const char* axis : {"x", "y"}) {
    const double below = last.scalars.at(std::string("force_below_") + axis);
    const double above = last.scalars.at(std::string("force_above_") + axis);
    CHECK(below == near(-above, 1e-7));
  }
  const std::string loose = refusal(with("0"));
  CHECK(loose.find(
            "scene.yaml:8:3: contacts.below: holds the body \"pad\" alone, without friction") !=
        loose.npos);
}

TEST_CASE("nodes with nothing opposite have a gap of the reach of the search") {
  const BodiesScene scene =
      bodies_scene("bodies:\n  skin: " + block("[0, 0, 0]", "[2, 1, 2]", "[2, 1, 2]", soft) +
                   "\n  pad: " + block("[5, 1, 0]", "[2, 1, 2]", "[3, 1, 3]", soft) +
                   "\nsupports: [{on: skin_bottom, hold: [x, y, z]}]\n"
                   "loads: [{on: pad_top, displacement: {x: 0, y: -0.1, z: 0}}]\n"
                   "contacts:\n  pad: {on: pad_bottom, against: skin_top}\n");
  double reach = 0;
  const BodiesSolution found = solved(
      scene, [&](const Run& run, const StepRecord&) { reach = run.increment.surfaces()[0].reach; });
  const std::vector<double>& gaps = found.last().contacts.at("pad").gap;
  CHECK(gaps == std::vector<double>(16, reach));
  CHECK(found.last().scalars.at("force_pad") == 0);
}

TEST_CASE("bodies that overlap at the start, and sets that cover no facet, are refused") {
  const auto scene = [](const std::string& origin, const std::string& on) {
    return "bodies:\n"
           "  skin: " +
           block("[0, 0, 0]", "[2, 1, 2]", "[2, 1, 2]", soft) + "\n" +
           "  pad: " + block(origin, "[2, 1, 2]", "[3, 1, 3]", soft) + "\n" +
           "supports: [{on: skin_bottom, hold: [x, y, z]}]\n"
           "loads: [{on: pad_top, displacement: {x: 0, y: -0.1, z: 0}}]\n"
           "contacts:\n"
           "  pad: {on: " +
           on + ", against: skin_top}\n";
  };
  const std::string inside = refusal(scene("[0, 0.9, 0]", "pad_bottom"));
  CHECK(inside.find("scene.yaml:7:3: contacts.pad: the surfaces overlap at the start by 0.1 mm") !=
        inside.npos);
  const std::string unknown = refusal(scene("[0, 1, 0]", "pad_botom"));
  CHECK(unknown.find("scene.yaml:7:9: contacts.pad.on: found \"pad_botom\"") != unknown.npos);
  CHECK(refusal(scene("[0, 1, 0]", "pad_bottom")) == "accepted");
}

TEST_CASE("blocks whose edges lie on each other are pressed and drawn in a few iterations") {
  const BodiesScene scene =
      bodies_scene("bodies:\n  low: " + block("[-1, 0, -1]", "[2, 1, 2]", "[7, 2, 7]", soft) +
                   "\n  up: " + block("[-1, 1, -1]", "[2, 1, 2]", "[7, 2, 7]", soft) +
                   "\nsupports: [{on: low_bottom, hold: [x, y, z]}]\n"
                   "loads: [{on: up_top, displacement: {x: 0.1, y: -0.2, z: 0}}]\n"
                   "contacts: {pad: {on: up_bottom, against: low_top, friction: 0.2}}\n"
                   "path: {first: 0.25, largest: 0.25}\n");
  const BodiesSolution solution = solved(scene);
  CHECK(solution.steps.size() == 4);
  CHECK(solution.iterations < 12);
}
