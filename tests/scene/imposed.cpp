// Displacements that are imposed on one node by two keys: alike, they are one; unlike, they are
// refused.
#include <doctest/doctest.h>

#include "support/block.hpp"
#include "support/solved_scene.hpp"

using namespace langer;
using test::config_of, test::nowhere;

namespace {

std::string said_of(const std::string& text) {
  return test::said_of_scene(
      text + "\nmaterial: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1e-3}}}\n",
      test::block(test::even(0, 1, 2), test::even(0, 1, 2), test::even(0, 1, 2)));
}

}  // namespace

TEST_CASE(
    "two unlike displacements of one node are refused by the keys of both, two alike are one") {
  const std::string held = "supports: [{on: x_min, hold: [x, y, z]}, {on: y_min, hold: [y]}]\n";
  CHECK(said_of(held + "loads: [{on: x_max, displacement: {x: 0.2}}]") == "accepted");
  CHECK(said_of(held + "loads: [{on: x_max, displacement: {x: 0.2, y: 0}}]") == "accepted");
  const std::string refused =
      said_of(held + "loads: [{on: x_max, displacement: {x: 0.2, y: 0.1}}]");
  CHECK(refused.find("loads[0].displacement") != std::string::npos);
  CHECK(refused.find("y = 0.1 mm at a node that supports[1] sets to 0 mm") != std::string::npos);
  const std::string twice = said_of(
      held + "loads: [{on: x_max, displacement: {x: 0.2}}, {on: x_max, displacement: {x: -0.2}}]");
  CHECK(twice.find("loads[1].displacement") != std::string::npos);
  CHECK(twice.find("loads[0]") != std::string::npos);
}

TEST_CASE(
    "what cannot be turned is refused by its key: a set that is moved otherwise, one with an indenter's name, a section") {
  const std::string held = "supports: [{on: y_min, hold: [x, y, z]}]\n";
  CHECK(said_of(held + "loads: [{on: y_max, rotation: {angle: 20}, displacement: {y: 0.1}}]") ==
        "accepted");
  const std::string twice = said_of(
      held + "loads: [{on: y_max, rotation: {angle: 20}}, {on: y_max, displacement: {y: 0.1}}]");
  CHECK(twice.find("loads[0].rotation") != std::string::npos);
  CHECK(twice.find("and a rotation at a node that loads[1].displacement sets to 0.1 mm") !=
        std::string::npos);
  const std::string named = said_of(
      held +
      "loads: [{on: y_max, rotation: {angle: 20}}]\n"
      "contacts: {y_max: {on: x_max, rigid: {plane: {point: [1, 0, 0], normal: [-1, 0, 0]}}, motion: [{t: 1, to: [-0.1, 0, 0]}]}}");
  CHECK(named.find("an indenter has the same name") != std::string::npos);
  const std::string wide = said_of(
      held +
      "contacts: {plate: {on: y_max, rigid: {aperture: {radius: 2, edge: 0.1, face: [0.5, 1, 0.5]}}, motion: [{t: 1, to: [0, -0.1, 0]}]}}");
  CHECK(wide.find("contacts.plate.rigid.aperture.radius") != std::string::npos);
  CHECK(wide.find("a hole of 2 mm") != std::string::npos);
}
