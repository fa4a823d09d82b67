// Maps of one field on two meshes, compared where the indenter does not press.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "results/post/map.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

SurfaceMap square(double value) {
  SurfaceMap map;
  map.places = {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}};
  map.values = {value, value, value, value};
  map.facets = {{0, 1, 2, 3}};
  return map;
}

// a node at 4 mm that agrees, and a ring of nodes that do not
SurfaceMap ring(double radius) {
  SurfaceMap map;
  map.places = {{4, 0}}, map.values = {1};
  for (int i = 0; i < 32; ++i) {
    const double angle = 2 * std::numbers::pi * i / 32;
    map.places.push_back({radius * std::cos(angle), radius * std::sin(angle)}),
        map.values.push_back(0.5);
  }
  return map;
}

}  // namespace

TEST_CASE(
    "nodes nearer than `beyond` do not count in the difference of two maps, a ring of nodes just there does as a whole") {
  CHECK(difference(square(1), ring(2.9), 3) == 0);
  CHECK(difference(square(1), ring(3.1), 3) == near(0.5));
  // as other programs and roundings place it
  for (const double radius : {3.0, 2.9999999999989373, std::nextafter(3.0, 4.0)}) {
    const SurfaceMap whole = ring(radius);
    for (std::size_t i = 1; i < whole.places.size(); ++i) {
      SurfaceMap one = whole;
      one.places = {whole.places[0], whole.places[i]}, one.values = {1, 0.5};
      CHECK(difference(square(1), one, 3) == near(0.5));
    }
  }
}
