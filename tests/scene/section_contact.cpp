// Sections under indenters: forces of the block, of Hertz, of models of others; no matter how thin
// the wedge is.
#include <doctest/doctest.h>

#include <cmath>

#include "scene/model/scene_section.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;
using namespace langer::test;

namespace section_contact_tests {

TEST_CASE("how thin the wedge is makes no difference to what an indentation gives") {
  const SolveConfig config = config_of(indentation(disc(0.35, "hex8"), ball(0.34) + tight));
  std::vector<double> force, stress;
  for (int power : {-9, -12, -14, -17, -20}) {
    Mesh mesh = mesh_in(config);
    for (Vec3& X : mesh.X) X[2] *= std::ldexp(1, power) / mesh.section->depth;
    mesh.section->depth = std::ldexp(1, power);
    const Ended r = run(config, mesh);
    force.push_back(r.last().force_ind.norm()),
        stress.push_back(r.last().cell_fields.at("von_mises")[0]);
    MESSAGE("depth 2^" << power << ": force " << doctest::toString(force.back()) << " N, off by "
                       << force.back() / force[0] - 1);
  }
  CHECK(force[2] > 5);
  for (std::size_t k : {1, 3, 4}) {
    CHECK(force[k] == near(force[2], 1e-7));
    CHECK(stress[k] == near(stress[2], 1e-6));
  }
}

TEST_CASE("a disc under a sphere gives the reference force, and that of the block") {
  // converged forces of an axisymmetric model of other elements, +-0.3 %
  SolveConfig config = config_of(indentation(disc(0.125, "hex27"), ball(0)));
  config.contacts.at("ball").motion.clear();
  const std::vector<std::pair<double, double>> reference{{0.1, 0.1668}, {0.2, 0.511}, {0.3, 1.0095},
                                                         {0.5, 2.507},  {0.7, 4.842}, {1, 10.76}};
  for (const auto& [depth, force] : reference)
    config.contacts.at("ball").motion.push_back({depth, {0, -depth, 0}});
  const Ended r = run(config, mesh_in(config));
  std::size_t met = 0;
  for (const StepRecord& step : r.steps)
    for (const auto& [depth, force] : reference)
      if (std::abs(step.t - depth) < 1e-12) {
        ++met;
        CAPTURE(step.t);
        CHECK(-step.force_ind[1] == near(-force, depth < 0.15 ? 0.01 : 0.005));
        CHECK(step.force_ind[0] == 0);
      }
  CHECK(met == reference.size());
  // the resultant at the base, and what the sphere's work left in the body
  CHECK(r.reaction("bottom")[1] == near(r.last().force_ind.norm(), 1e-8));

  const std::string block =
      "{indented_block: {origin: [-15, 0, -15], size: [30, 4, 30], radius: 2.5, depth: 1, edge: 0.3536}}\n  cells: hex27";
  const Ended deep = run(indentation(block, ball(0) + "symmetry: quarter\n"));
  CHECK(r.last().force_ind.norm() == near(deep.last().force_ind.norm(), 0.005));
}

TEST_CASE("friction raises the force on a disc as on the block") {
  const std::string block =
      "{indented_block: {origin: [-15, 0, -15], size: [30, 4, 30], radius: 2.5, depth: 1, edge: 0.25}}";
  const double deep =
      run(indentation(block, ball(0.34) + "symmetry: quarter\n")).last().force_ind.norm();
  const double flat = run(indentation(disc(0.0625, "hex8"), ball(0.34))).last().force_ind.norm();
  MESSAGE("block " << deep << " N, disc " << flat << " N");
  CHECK(flat == near(deep, 0.015));
  CHECK(flat > 1.05 * 10.76);
}

TEST_CASE("a shallow indentation of a deep body gives the force of Hertz") {
  const double R = 10, depth = 0.02, E = 3 * 2 * 0.5;  // incompressible, small strains
  const Ended r = run(
      "mesh:\n  geometry: {indented_disc: {size: [150, 150], radius: 10, depth: 0.02, edge: 0.0884}}\n  cells: hex27\n"
      "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 0.7}}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.5}}, volume: {quadratic: {d: 1.0e-5}}}\nsupports: [{on: bottom, hold: [x, y]}]\n"
      "contacts: {ball: {on: contact, rigid: {sphere: {radius: 10, centre: [0, 160, 0]}}, motion: [{t: 1, to: [0, -0.02, 0]}]}}\n"
      "path: {first: 1, largest: 1}\n");
  CHECK(r.last().force_ind.norm() ==
        near(16.0 / 9 * E * std::sqrt(R) * std::pow(depth, 1.5), 0.01));
}

TEST_CASE("a strip under a bar is a slab of the block under the same bar") {
  // an ellipsoid so long that it is a bar for the block too
  const std::string rest =
      yeoh +
      "supports: [{on: bottom, hold: [x, y]}]\ncontacts: {bar: {on: top, "
      "rigid: {ellipsoid: {half_axes: [1, 1, 500], centre: [0, 2, 0]}}, "
      "motion: [{t: 1, to: [0.1, -0.3, 0]}], friction: 0.2}}\npath: {first: 0.25, largest: 0.25}\n";
  const SolveConfig config = config_of(
      "mesh: {geometry: {section: {of: plane_strain, origin: [-2, 0], size: [4, 1], divisions: [16, 4]}}}\n" +
      rest);
  const Ended flat = run(config, mesh_in(config));
  Mesh layer = test::block(test::even(-2, 2, 16), test::even(0, 1, 4), {0, 1});
  layer.node_sets["bottom"] = layer.node_sets["y_min"],
  layer.node_sets["top"] = layer.node_sets["y_max"];
  for (int i = 0; i < layer.n_nodes(); ++i) layer.node_sets["all"].push_back(i);
  SolveConfig held = config;
  held.supports.push_back({"all", {Axis::z}});
  const Ended deep = run(held, layer);
  for (int k : {0, 1}) CHECK(flat.last().force_ind[k] == near(deep.last().force_ind[k], 1e-4));
  CHECK(flat.last().force_ind.norm() > 0.1);
}

}  // namespace section_contact_tests
