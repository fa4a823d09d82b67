#include "results/post/contact_surface.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "mechanics/contact/rigid.hpp"
#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/section.hpp"
#include "mechanics/mesh/select.hpp"
#include "results/post/energy_columns.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// a block stretched by 1.2 along x and 0.9 along z, its top under 0.3 MPa: nodal forces from the
// areas of the deformed mesh as it lies
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
    CHECK(state.pressure[static_cast<std::size_t>(node)] == near(Pressed::pressure, 1e-12));
    CHECK(state.traction[static_cast<std::size_t>(node)].isApprox(Vec3(0, -Pressed::pressure, 0),
                                                                  1e-12));
  }
  CHECK(state.area == near(1.2 * 4 * 0.9 * 5, 1e-12));
  CHECK(state.radius == near(std::sqrt(1.2 * 4 * 0.9 * 5 / std::numbers::pi), 1e-12));
  CHECK(state.pressure_max == near(Pressed::pressure, 1e-12));
}

TEST_CASE(
    "friction is in the traction and not in the pressure, and what does not touch has neither") {
  Pressed p;
  for (std::size_t i = 0; i < p.top.size(); ++i)
    p.contact.r[i] += Vec3(0.1 * p.areas[p.top[i]], 0, 0);
  p.contact.status[0] = 0;
  const ContactPerArea state = ContactSurface(p.mesh, p.top).at(p.u, p.contact);
  const auto open = static_cast<std::size_t>(p.top[0]), slips = static_cast<std::size_t>(p.top[1]);
  CHECK(state.pressure[open] == 0);
  CHECK(state.traction[open].norm() == 0);
  CHECK(state.traction[slips].isApprox(Vec3(0.1, -Pressed::pressure, 0), 1e-12));
  CHECK(state.pressure[slips] == near(Pressed::pressure, 1e-12));
  CHECK(state.area == near(p.areas.sum() - p.areas[p.top[0]], 1e-12));
  CHECK(state.pressure[static_cast<std::size_t>(p.mesh.node_sets.at("y_min")[0])] == 0);
}

TEST_CASE("on a section the area is that of the whole circle, pressed and stretched") {
  Mesh mesh = test::block({0, 0.5, 1.25, 2}, {0, 1, 2}, {0, 1});
  make_section(mesh, {SectionOf::axisymmetric, 1e-3});
  const int front = n_front(mesh);
  std::vector<int> top;
  std::vector<Vec3> u;
  for (std::size_t i = 0; i < mesh.X.size(); ++i) {
    if (static_cast<int>(i) < front && std::abs(mesh.X[i][1] - 2) < 1e-12)
      top.push_back(static_cast<int>(i));
    u.push_back(Vec3(0.2 * mesh.X[i][0], -0.1, 0.2 * mesh.X[i][2]));
  }
  REQUIRE(top.size() == 4);
  const double stretch = 1.2, pressure = 0.3;
  ContactRecord contact;
  for (const int node : top) {  // integral over the circle of N_a 2 pi r dr, linear N_a
    double area = 0;
    for (const int other : top) {
      const double a = stretch * mesh.X[static_cast<std::size_t>(node)][0],
                   b = stretch * mesh.X[static_cast<std::size_t>(other)][0];
      bool between = false;
      for (const int third : top) {
        const double c = stretch * mesh.X[static_cast<std::size_t>(third)][0];
        between = between || (c > std::min(a, b) && c < std::max(a, b));
      }
      if (other != node && !between)
        area += 2 * std::numbers::pi * std::abs(b - a) * (a / 3 + b / 6);
    }
    contact.r.push_back(Vec3(0, -pressure * area, 0)), contact.status.push_back(1),
        contact.gap.push_back(0);
  }
  const ContactPerArea state = ContactSurface(mesh, top).at(u, contact);
  CHECK(state.area == near(std::numbers::pi * std::pow(stretch * 2, 2), 1e-9));
  for (const int node : top)
    CHECK(state.pressure[static_cast<std::size_t>(node)] == near(pressure, 1e-9));
}

TEST_CASE(
    "what indenters do to a node: pressure, friction, status and slip of the one that presses most") {
  Pressed p;
  for (std::size_t i = 0; i < p.top.size(); ++i)
    p.contact.r[i] += Vec3(0.1 * p.areas[p.top[i]], 0, 0);
  p.contact.status[1] = 2;
  const ContactPerArea state = ContactSurface(p.mesh, p.top).at(p.u, p.contact);
  std::vector<double> slip(p.top.size(), 0.0);
  slip[1] = 0.25;
  std::vector<ContactNode> nodes(p.mesh.X.size());
  add_contact_nodes(nodes, p.top, state, p.contact, slip);
  const ContactNode &slips = nodes[static_cast<std::size_t>(p.top[1])],
                    &sticks = nodes[static_cast<std::size_t>(p.top[2])];
  CHECK(slips.pressure == near(Pressed::pressure, 1e-12));
  CHECK(slips.friction == near(0.1, 1e-9));
  CHECK(slips.status == 2);
  CHECK(slips.slip == 0.25);
  CHECK(sticks.status == 1);
  CHECK(sticks.slip == 0);
  CHECK(nodes[static_cast<std::size_t>(p.mesh.node_sets.at("y_min")[0])].status == -1);
}

TEST_CASE(
    "slip is the way along the indenter while it touches, there and back, and nothing of the way along its normal") {
  const Pressed p;
  const Plane plane{{0, 2, 0}, {0, -1, 0}};
  RigidContact flat{"flat", plane, 0.3, p.top, {{1, Vec3(0.5, 0, 0)}}};
  EnergyPath path(p.mesh, {flat});
  // it moves by 0.5 t along x; the body by +0.3 along x and up and down, then stays: slip 0.2 - 0.3
  // = 0.1 there, then 0.3
  const auto state = [&](double t, const Vec3& u, double force) {
    std::vector<Vec3> moved(p.mesh.X.size(), u), r(p.top.size(), Vec3(0, -force, 0));
    return EnergyPath::State{t, moved, std::vector<Vec3>(p.mesh.X.size(), Vec3::Zero()), {r}, 0};
  };
  path.add(state(0, Vec3::Zero(), 0));
  path.add(state(0.2, Vec3(0.7, 0, 0), 1));  // comes to the body: not known, and not counted
  for (const double s : path.slip(0)) CHECK(s == 0);
  path.add(state(0.6, Vec3(1.0, 0.4, 0), 1));
  for (const double s : path.slip(0)) CHECK(s == near(0.1, 1e-12));
  path.add(state(1, Vec3(1.0, 0.1, 0), 1));
  for (const double s : path.slip(0)) CHECK(s == near(0.3, 1e-12));
}
