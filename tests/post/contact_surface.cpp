#include "post/contact_surface.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "element/surface.hpp"
#include "mesh/select.hpp"
#include "support/block.hpp"

using namespace langer;

namespace {

// a block stretched by 1.2 along x and 0.9 along z, its top under 0.3 MPa: nodal forces from the areas of the deformed mesh as it lies
struct Pressed {
  static constexpr double pressure = 0.3;
  Mesh mesh = test::block({0, 1, 3, 4}, {0, 1, 2}, {0, 2, 3, 5});
  std::vector<Vec3> u;
  std::vector<int> top = mesh.node_sets.at("y_max");
  ContactRecord contact;
  VecX areas;
  Pressed() {
    Mesh deformed = mesh;
    for (Vec3& x : deformed.X) x = Vec3(1.2 * x[0], x[1] - 0.1, 0.9 * x[2]);
    for (std::size_t i = 0; i < mesh.X.size(); ++i) u.push_back(deformed.X[i] - mesh.X[i]);
    areas = nodal_areas(deformed, facets_within(deformed, boundary(deformed), top));
    for (const int node : top) {
      contact.r.push_back(Vec3(0, -pressure * areas[node], 0));
      contact.status.push_back(1);
      contact.gap.push_back(0);
    }
  }
};

}  // namespace

TEST_CASE("a uniform pressure comes back at every node, over the deformed area") {
  const Pressed p;
  const ContactPerArea state = ContactSurface(p.mesh, p.top).at(p.u, p.contact);
  for (const int node : p.top) {
    CHECK(state.pressure[static_cast<std::size_t>(node)] == doctest::Approx(Pressed::pressure).epsilon(1e-12));
    CHECK(state.traction[static_cast<std::size_t>(node)].isApprox(Vec3(0, -Pressed::pressure, 0), 1e-12));
  }
  CHECK(state.area == doctest::Approx(1.2 * 4 * 0.9 * 5).epsilon(1e-12));
  CHECK(state.radius == doctest::Approx(std::sqrt(1.2 * 4 * 0.9 * 5 / std::numbers::pi)).epsilon(1e-12));
  CHECK(state.pressure_max == doctest::Approx(Pressed::pressure).epsilon(1e-12));
}

TEST_CASE("friction is in the traction and not in the pressure, and what does not touch has neither") {
  Pressed p;
  for (std::size_t i = 0; i < p.top.size(); ++i) p.contact.r[i] += Vec3(0.1 * p.areas[p.top[i]], 0, 0);
  p.contact.status[0] = 0;
  const ContactPerArea state = ContactSurface(p.mesh, p.top).at(p.u, p.contact);
  const auto open = static_cast<std::size_t>(p.top[0]), slips = static_cast<std::size_t>(p.top[1]);
  CHECK(state.pressure[open] == 0);
  CHECK(state.traction[open].norm() == 0);
  CHECK(state.traction[slips].isApprox(Vec3(0.1, -Pressed::pressure, 0), 1e-12));
  CHECK(state.pressure[slips] == doctest::Approx(Pressed::pressure).epsilon(1e-12));
  CHECK(state.area == doctest::Approx(p.areas.sum() - p.areas[p.top[0]]).epsilon(1e-12));
  CHECK(state.pressure[static_cast<std::size_t>(p.mesh.node_sets.at("y_min")[0])] == 0);
}
