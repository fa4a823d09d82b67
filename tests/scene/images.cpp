// Families that change places in a mirror, families without direction and indenters that are each
// other's image: the part of the body that is left gives what the whole body gives; what only looks
// alike is not taken for an image. By random draws.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "scene/model/scene_image.hpp"
#include "scene/model/scene_symmetry.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace images_tests {

using test::largest_difference, test::nowhere;

namespace {

using Random = std::mt19937;
double between_of(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
int one_of_n(Random& random, int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); }

const Vec3 middle(3, 0, -2);  // of the block: anywhere

Mesh mesh_of(int nx, int nz) {
  Mesh mesh = test::block(test::even(-4, 4, nx), test::even(0, 3, 2), test::even(-4, 4, nz));
  for (Vec3& X : mesh.X) X += middle;
  return mesh;
}

Fibre family(Random& random, double alpha, double kappa) {
  Fibre fibre;
  const double modulus = between_of(random, 0.05, 0.3);
  if (one_of_n(random, 2))
    fibre.law = HgoFibre{modulus, between_of(random, 0.1, 0.5)};
  else
    fibre.law = PowLinearFibre{modulus, between_of(random, 1.1, 1.3), between_of(random, 2, 3)};
  fibre.alpha_deg = alpha, fibre.kappa = kappa;
  return fibre;
}

void hold_bottom(Scene& scene, const Mesh& mesh) {
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  scene.dofs = number_dofs(mesh.n_nodes(), held).dofs;
}

Scene scene_of(const Mesh& mesh, const std::vector<Fibre>& fibres) {
  Scene scene;
  scene.formulation = usual_formulation(mesh.type);
  Material material = test::stable(0, 1e-2);
  material.fibres = fibres;
  scene.materials = {material};
  scene.directions = test::directions(mesh, scene.materials);
  hold_bottom(scene, mesh);
  return scene;
}

RigidContact indenter(const std::string& name, const Indenter& shape, const Mesh& mesh,
                      const std::vector<Waypoint>& motion, double mu) {
  return {name, shape, mu, mesh.node_sets.at("y_max"), motion};
}

Indenter moved(Indenter shape, const Vec3& signs) {
  const auto turned = [&](std::array<double, 3>& x) {
    const Vec3 y = middle + signs.cwiseProduct(vec(x) - middle);
    x = {y[0], y[1], y[2]};
  };
  if (auto* s = std::get_if<Sphere>(&shape)) turned(s->centre);
  if (auto* s = std::get_if<Ellipsoid>(&shape)) turned(s->centre);
  if (auto* s = std::get_if<Cylinder>(&shape)) turned(s->face);
  return shape;
}

// forces within 1e-9 N, displacements within 1e-9 mm; returns how many times fewer unknowns
double compare(const Mesh& mesh, const Scene& scene, const std::string& words) {
  const auto part = ReducedScene::find(SymmetryChoice::automatic, mesh, scene, nowhere);
  REQUIRE(part.has_value());
  CHECK(part->words().find(words) == 0);
  test::HowToSolve how;
  how.path.first = how.path.largest = 0.5;
  how.solver = NewtonOptions{.relative = 1e-12};
  const test::Solved whole = solved(mesh, scene, std::nullopt, how),
                     few = solved(mesh, scene, part, how);
  REQUIRE(whole.steps.size() == few.steps.size());
  for (std::size_t s = 0; s < whole.steps.size(); ++s) {
    const StepRecord &a = whole.steps[s], &b = few.steps[s];
    CHECK(largest_difference(a.u, b.u) < 1e-9);
    CHECK(largest_difference(a.reaction, b.reaction) < 1e-9);
    REQUIRE(a.contacts.size() == b.contacts.size());
    for (const auto& [name, contact] : a.contacts) {
      CHECK(largest_difference(contact.r, b.contacts.at(name).r) < 1e-9);
      CHECK(contact.status == b.contacts.at(name).status);
      if (a.contacts.size() < 2) continue;
      double force = 0;
      for (const char* k : {"_x", "_y", "_z"}) {
        const std::string key = "force_" + name + k;
        REQUIRE(b.scalars.count(key) == 1);
        CHECK(std::abs(a.scalars.at(key) - b.scalars.at(key)) < 1e-9);
        force = std::max(force, std::abs(a.scalars.at(key)));
      }
      CHECK(force > 0.01);
    }
    CHECK((a.force_ind - b.force_ind).norm() < 1e-9);
    CHECK((a.u_ind - b.u_ind).norm() == 0);
    CHECK(std::abs(a.scalars.at("energy") - b.scalars.at("energy")) < 1e-9);
    for (const auto& [name, values] : a.cell_fields) {
      const std::string field = name;  // clang 14 captures no structured binding
      CAPTURE(field);
      REQUIRE(b.cell_fields.at(name).size() == values.size());
      double worst = 0;
      for (std::size_t e = 0; e < values.size(); ++e)
        worst = std::max(worst, std::abs(values[e] - b.cell_fields.at(name)[e]));
      CHECK(worst < 1e-7);
    }
    const BodyState state = part->reduced(b);  // to continue from, and back
    REQUIRE(state.r.size() == part->scene().contacts.size());
    for (std::size_t c = 0; c < state.r.size(); ++c)
      CHECK(state.r[c].size() == part->scene().contacts[c].nodes.size());
  }
  return static_cast<double>(whole.free) / few.free;
}

std::string words_of(SymmetryChoice wanted, const Mesh& mesh, const Scene& scene) {
  try {
    const auto part = ReducedScene::find(wanted, mesh, scene, nowhere);
    return part ? part->words() : "none";
  } catch (const Failure& failure) {
    return failure.what();
  }
}

}  // namespace

TEST_CASE(
    "two families at +theta and -theta leave a quarter, beside others without direction, in whatever order") {
  Random random(21);
  for (int n = 0; n < 6; ++n) {
    CAPTURE(n);
    const double theta = between_of(random, 10, 80);
    std::vector<Fibre> fibres{family(random, theta, n % 2 ? between_of(random, 0, 0.3) : 0)};
    fibres.push_back(fibres[0]), fibres[1].alpha_deg = n % 3 ? -theta : 180 - theta;
    if (n % 3 == 1) fibres.push_back(family(random, between_of(random, -90, 90), 1.0 / 3));
    if (n % 3 == 2) fibres.push_back(family(random, one_of_n(random, 2) ? 0 : 90, 0));
    std::shuffle(fibres.begin(), fibres.end(), random);
    const Mesh mesh = mesh_of(n == 3 ? 5 : 6, n == 4 ? 5 : 6);
    Scene scene = scene_of(mesh, fibres);
    scene.contacts = {indenter("ball", Sphere{2, {middle[0], 5, middle[2]}}, mesh,
                               {{1, Vec3(0, -between_of(random, 0.3, 0.6), 0)}}, n % 2 ? 0.3 : 0)};
    CHECK(compare(mesh, scene, "mirror x and mirror z") > 2.2);
  }
}

TEST_CASE("families whose laws or angles differ leave no mirror plane") {
  Random random(22);
  const Mesh mesh = mesh_of(4, 4);
  for (int n = 0; n < 12; ++n) {
    CAPTURE(n);
    const double theta = between_of(random, 10, 80);
    Fibre one = family(random, theta, between_of(random, 0, 0.2)), other = one;
    one.law = HgoFibre{0.2, 0.3}, other.law = one.law, other.alpha_deg = -theta;
    const double away = between_of(random, 1e-3, 0.2);
    switch (n % 6) {
      case 0:
        other.law = HgoFibre{0.2 + away, 0.3};
        break;
      case 1:
        other.law = HgoFibre{0.2, 0.3 + away};
        break;
      case 2:
        other.kappa += 0.5 * away;
        break;
      case 3:
        other.alpha_deg += away;
        break;
      case 4:
        other.tension_switch = FibreSwitch::I4;
        break;
      case 5:
        other.law = PowLinearFibre{0.2, 1.1, 2};
        break;
    }
    Scene scene = scene_of(mesh, {one, other});
    scene.contacts = {
        indenter("ball", Sphere{2, {middle[0], 5, middle[2]}}, mesh, {{1, Vec3(0, -0.3, 0)}}, 0.3)};
    CHECK(words_of(SymmetryChoice::mirror_x, mesh, scene).find("fibres") != std::string::npos);
    CHECK(words_of(SymmetryChoice::automatic, mesh, scene).find("half turn") == 0);
  }
  // two of one law beside one of another: the set is its own image only where each law's is
  Fibre a = family(random, 40, 0), b = a;
  b.law = HgoFibre{1, 1};
  Fibre a_other = a, b_other = b;
  a_other.alpha_deg = b_other.alpha_deg = -40;
  CHECK(words_of(SymmetryChoice::quarter, mesh, scene_of(mesh, {a, b, b_other, a_other}))
            .find("mirror x") == 0);
  CHECK(
      words_of(SymmetryChoice::quarter, mesh, scene_of(mesh, {a, b, b, a_other})).find("fibres") !=
      std::string::npos);
}

TEST_CASE("a family without direction alone is isotropic, at any angle") {
  Random random(23);
  const Mesh mesh = mesh_of(6, 6);
  Scene scene = scene_of(mesh, {family(random, 37, 1.0 / 3)});
  scene.contacts = {
      indenter("ball", Sphere{2, {middle[0], 5, middle[2]}}, mesh, {{1, Vec3(0, -0.5, 0)}}, 0.3)};
  CHECK(compare(mesh, scene, "mirror x and mirror z") > 2.2);
}

namespace {

struct Pair {
  Mesh mesh;
  Scene scene;
};

// two indenters, the second the first one's image by `signs`, off both planes or on one
Pair pair_of(Random& random, const Vec3& signs, bool own_nodes, double apart) {
  Pair p{mesh_of(6 + one_of_n(random, 2), 6 + one_of_n(random, 2)), {}};
  const double alpha =
      signs[0] * signs[2] > 0 ? between_of(random, 10, 80) : 90.0 * one_of_n(random, 2);
  p.scene = scene_of(p.mesh, {family(random, alpha, 0)});
  const Vec3 beside = between_of(random, 0.9, 1.1) * apart *
                      Vec3(signs[0] < 0 ? 1 : 0.2, 0, signs[2] < 0 ? 1 : 0.2);
  const Vec3 at = middle + beside;
  const double radius = between_of(random, 1.2, 1.8);
  Indenter shape = Sphere{radius, {at[0], 3 + radius, at[2]}};
  if (const int kind = one_of_n(random, 3); kind == 1)
    shape = Ellipsoid{{radius, 1, 1.4}, {at[0], 4, at[2]}};
  else if (kind == 2)
    shape = Cylinder{1, 0.4, {at[0], 3, at[2]}};
  const Vec3 to(between_of(random, -0.1, 0.1), -between_of(random, 0.2, 0.3),
                between_of(random, -0.1, 0.1));
  const std::vector<Waypoint> motion{{0.5, Vec3(0, to[1], 0)}, {1, to}};
  std::vector<Waypoint> image = motion;
  for (Waypoint& w : image) w.to = signs.cwiseProduct(w.to);
  const double mu = one_of_n(random, 2) ? 0.25 : 0;
  p.scene.contacts = {indenter("left", shape, p.mesh, motion, mu),
                      indenter("right", moved(shape, signs), p.mesh, image, mu)};
  p.scene.stops = {0.5};
  if (own_nodes)
    for (RigidContact& contact : p.scene.contacts)
      std::erase_if(contact.nodes,
                    [&](int n) { return shape_at(contact.shape, p.mesh.X[n]).gap > 0.8; });
  return p;
}

const Vec3 mirrors[]{{-1, 1, 1}, {1, 1, -1}, {-1, 1, -1}};

}  // namespace

TEST_CASE(
    "two indenters, one the other's image: a part with one of them gives the forces of both by name") {
  Random random(24);
  for (int n = 0; n < 9; ++n) {
    CAPTURE(n);
    const Pair p = pair_of(random, mirrors[n % 3], n % 2 == 0, 1.8);
    CHECK(compare(p.mesh, p.scene,
                  n % 3 == 0   ? "mirror x"
                  : n % 3 == 1 ? "mirror z"
                               : "half turn") > 1.5);
  }
}

TEST_CASE(
    "two indenters that stand in one mirror plane and are each other's image in the other leave a quarter") {
  Random random(25);
  for (int n = 0; n < 4; ++n) {
    CAPTURE(n);
    const Mesh mesh = mesh_of(6, 6);
    Fibre one = family(random, 50, 0), other = one;
    other.alpha_deg = -50;
    Scene scene = scene_of(mesh, {one, other});
    const Vec3 beside = n % 2 ? Vec3(1.9, 0, 0) : Vec3(0, 0, 1.9), aside = 0.1 * beside;
    for (double side : {-1.0, 1.0}) {
      const Vec3 at = middle + side * beside;
      scene.contacts.push_back(indenter(side > 0 ? "b" : "a", Sphere{1.5, {at[0], 4.5, at[2]}},
                                        mesh, {{1, Vec3(0, -0.4, 0) + side * aside}},
                                        n < 2 ? 0.3 : 0));
    }
    CHECK(compare(mesh, scene, "mirror x and mirror z") > 2.8);
  }
}

// without friction: two that stick to one node may push it from both sides, and how hard is not
// unique
TEST_CASE("indenters so close that both touch nodes of the plane between them") {
  const Mesh mesh = mesh_of(8, 6);
  Scene scene = scene_of(mesh, {});
  for (double side : {-1.0, 1.0})
    scene.contacts.push_back(indenter(side > 0 ? "b" : "a",
                                      Sphere{2, {middle[0] + side * 0.4, 5, middle[2]}}, mesh,
                                      {{1, Vec3(0, -0.4, 0)}}, 0));
  const auto part = ReducedScene::find(SymmetryChoice::automatic, mesh, scene, nowhere);
  REQUIRE(part.has_value());
  CHECK(part->swaps_indenters());
  CHECK(compare(mesh, scene, "mirror x and mirror z") > 2.5);
}

TEST_CASE(
    "indenters that only look alike are not images: shape, place, friction, path, its times, the nodes they may touch") {
  Random random(27);
  for (int n = 0; n < 21; ++n) {
    CAPTURE(n);
    const Vec3& signs = mirrors[n % 3];
    Pair p = pair_of(random, signs, true, 1.8);
    RigidContact& right = p.scene.contacts[1];
    const double away = between_of(random, 1e-4, 0.1);
    switch (n / 3) {
      case 0:
        right.shape = Sphere{1 + away, {middle[0], 6, middle[2]}};
        break;
      case 1:
        std::visit(
            []<class S>(S& s) {
              if constexpr (requires { s.centre; }) s.centre[1] += 1e-3;
              if constexpr (requires { s.face; }) s.face[1] += 1e-3;
            },
            right.shape);
        break;
      case 2:
        right.mu += away;
        break;
      case 3:
        right.motion.back().to[1] -= away;
        break;
      case 4:
        right.motion.back().to[n % 3 == 1 ? 2 : 0] *= -1;
        break;
      case 5:
        right.motion.front().t += away;
        break;
      case 6:
        right.nodes.pop_back();
        break;
    }
    CHECK(words_of(SymmetryChoice::automatic, p.mesh, p.scene) == "none");
  }
}

}  // namespace images_tests
