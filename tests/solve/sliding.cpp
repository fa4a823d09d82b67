// An indenter drawn along the surface: the ratio of its forces follows from mu, and its work goes
// nowhere else.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "results/post/energy_columns.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// keeps the energy path of a scene
struct EnergyOf {
  std::unique_ptr<EnergyPath> path;
  explicit EnergyOf(test::Indentation& scene) {
    scene.after = [this](const Increment& increment, const Assembler& body) {
      const BodyState& state = increment.accepted();
      const VecX reactions = increment.reactions();
      std::vector<Vec3> u, f;
      for (Eigen::Index i = 0; i < state.u.size(); i += 3)
        u.push_back(state.u.segment<3>(i)), f.push_back(reactions.segment<3>(i));
      if (!path) {
        path = std::make_unique<EnergyPath>(body.mesh(), increment.contacts());
        const std::vector<Vec3> rest(body.mesh().n_nodes(), Vec3::Zero());
        path->add({0,
                   rest,
                   rest,
                   {std::vector<Vec3>(increment.contacts()[0].nodes.size(), Vec3::Zero())},
                   0});
      }
      path->add({state.t, u, f, state.r, body.W()});
    };
  }
};

struct Slide {
  std::vector<double> ratio;  // friction force over normal force, step by step
  PathSums energy;
};

// pressed 0.3 mm, drawn 1.5 mm along -x, lifted
Slide slide(double mu, const std::optional<Indenter>& shape, const Material& material,
            double step) {
  test::Indentation scene;
  scene.nx = scene.nz = 16, scene.ny = 4, scene.h = 0.4, scene.mu = mu, scene.reach = 3.2,
  scene.step = step;
  scene.shape = shape;
  scene.motion = {{0.2, Vec3(0, -0.3, 0)}, {0.8, Vec3(-1.5, -0.3, 0)}, {1, Vec3(-1.5, 0, 0)}};
  Slide out;
  const EnergyOf energy(scene);
  const auto result = scene.run(material, [&](const test::Indentation::Step& step) {
    CHECK(step.defect.penetration <= 1e-9);
    CHECK(step.defect.cone <= 1e-8);
    CHECK(step.defect.complementarity <= 1e-8);
    if (step.defect.force[1] < 0) out.ratio.push_back(step.defect.force[0] / step.defect.force[1]);
  });
  REQUIRE(result.path.complete);
  out.energy = energy.path->sums().back();
  return out;
}

}  // namespace

TEST_CASE("a rigid plane drawn over the body: the ratio of its forces is mu, as of a rigid block") {
  const Indenter plane = Plane{{0, 4, 0}, {0, -1, 0}};
  for (double mu : {0.1, 0.34}) {
    const Slide s = slide(mu, plane, test::table1(60, 1e-4), 0.05);
    const auto late = s.ratio[s.ratio.size() * 3 / 4 - 2];  // near the end of the slide
    // all but exact: while the body still moves sideways under the plane, its slip is not quite
    // along x
    CHECK(std::abs(late) == near(mu, 1e-5));
  }
}

TEST_CASE(
    "a sphere drawn over the body: a steady ratio near mu that grows with it, and no force across without friction") {
  double last = -1;
  for (double mu : {0.0, 0.1, 0.34}) {
    const Slide s = slide(mu, {}, test::table1(60, 1e-4), 0.05);
    double mean = 0, least = 1e9, most = -1e9;
    const std::size_t from = s.ratio.size() / 2, to = s.ratio.size() * 3 / 4;
    for (std::size_t i = from; i < to; ++i) {
      const double r = -s.ratio[i];
      mean += r / static_cast<double>(to - from), least = std::min(least, r),
                                                  most = std::max(most, r);
    }
    MESSAGE("mu " << mu << ": ratio " << mean << " (" << least << " to " << most
                  << "), energy balance " << s.energy.balance);
    // an elastic body gives back behind the sphere what it took before it; friction tilts the
    // surface a little
    CHECK(std::abs(mean) >= mu - 0.01);
    CHECK(std::abs(mean) <= 1.15 * mu + 0.01);
    CHECK(std::abs(mean) > last);
    CHECK(most - least < 0.05);  // from cell to cell of 0.4 mm
    last = std::abs(mean);
  }
  const Slide fine = slide(0.34, {}, test::table1(60, 1e-4), 0.008);
  MESSAGE("energy balance in fine steps " << fine.energy.balance);
  CHECK(std::abs(fine.energy.balance) <= 1e-3);
  CHECK(fine.energy.dissipated > 0.9 * fine.energy.work);  // what was stored has been given back
}

TEST_CASE(
    "energy of an indentation: what the sphere does is stored or taken by friction, to 1e-3") {
  test::Indentation scene;
  scene.nx = scene.nz = 16, scene.ny = 4, scene.h = 0.4;
  const EnergyOf energy(scene);
  REQUIRE(scene.run(test::table1(60, 1e-6)).path.complete);
  const PathSums sums = energy.path->sums().back();
  MESSAGE("work " << sums.work << " N mm, dissipated " << sums.dissipated << ", balance "
                  << sums.balance);
  CHECK(sums.work > 2);
  CHECK(sums.dissipated > 0);
  CHECK(std::abs(sums.balance) <= 1e-3);
}

TEST_CASE(
    "energy where sticking gives way to sliding: in balance to 1e-3 all along, and better by the square of the step") {
  const auto worst = [](double step) {
    test::Indentation scene;
    scene.nx = scene.nz = 12, scene.ny = 3, scene.h = 0.5, scene.reach = 3.2, scene.step = step;
    scene.motion = {{0.2, Vec3(0, -0.3, 0)}, {0.8, Vec3(-1, -0.3, 0)}, {1, Vec3(-1, 0, 0)}};
    const EnergyOf energy(scene);
    REQUIRE(scene.run(test::table1(60, 1e-4)).path.complete);
    double most = 0;
    for (const PathSums& s : energy.path->sums())
      if (s.path > 0.31)
        most = std::max(most, std::abs(s.balance));  // from the first movement along the surface on
    return most;
  };
  const double coarse = worst(0.0125), fine = worst(0.00625);
  MESSAGE("balance " << coarse << ", in half the step " << fine);
  CHECK(coarse <= 1e-3);
  CHECK(coarse > 3 * fine);
}

TEST_CASE(
    "a node that touches within an increment slips from there on: the force of an indentation hardly depends on the increments") {
  const auto force = [](double step) {
    test::Indentation scene;
    scene.nx = scene.nz = 16, scene.ny = 4, scene.h = 0.4, scene.step = step;
    const auto result = scene.run(test::table1(30, 1e-5, 0.317));
    REQUIRE(result.path.complete);
    return result.steps.back().force;
  };
  const double fine = force(0.0125);
  for (const auto& [step, allowed] : {std::pair{0.25, 2e-3}, {0.1, 5e-4}, {0.05, 2e-4}}) {
    const double off = force(step) / fine - 1;
    MESSAGE("increments of " << step << ": force off by " << off);
    CHECK(std::abs(off) < allowed);
  }
}

TEST_CASE("friction never gives energy back, in few steps of pressing and lifting") {
  for (const double step : {0.25, 0.125, 0.0625}) {
    test::Indentation scene;
    scene.nx = scene.nz = 16, scene.ny = 4, scene.h = 0.4, scene.step = step;
    scene.motion = {{0.5, Vec3(0, -0.5, 0)}, {1, Vec3(0, 0, 0)}};
    const EnergyOf energy(scene);
    REQUIRE(scene.run(test::table1(60, 1e-4)).path.complete);
    double last = 0, at_turn = 0;
    for (const PathSums& s : energy.path->sums()) {
      CHECK(s.dissipated >= last);
      last = s.dissipated;
      if (s.path <= 0.5 + 1e-9) at_turn = s.dissipated;
    }
    MESSAGE("step " << step << ": dissipated at the turn " << at_turn << ", at the end " << last);
    CHECK(at_turn > 0);
  }
}
