// The law of a bond: force and tangent from its potential, what it takes, when it heals.
#include "mechanics/contact/adhesion.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mechanics/contact/rigid.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

const Indenter plane = Plane{{0, 0, 0}, {0.2, 1, -0.1}}, ball = Sphere{2, {0, -2, 0}};

// y: where the node is relative to the indenter; it bonded at rest
Adhesive at(const Adhesion& law, const Indenter& shape, const Vec3& X, const Vec3& v,
            double viscous = 0, double beta = 1) {
  return adhesive(law, shape_at(shape, X + v), v, {beta, Vec3::Zero(), true}, viscous);
}

// what the law makes least [N/mm]
double potential(const Adhesion& law, const Adhesive& bond, double viscous, double beta_0) {
  const double lost = beta_0 - bond.beta;
  return bond.stored - law.work * bond.beta +
         (std::isfinite(viscous) ? 0.5 * viscous * lost * lost : 0);
}

}  // namespace

TEST_CASE("a bond's force is the slope of its potential, and its tangent that of the force") {
  const double step = 1e-6;
  const struct {
    Indenter shape;
    double tangential, viscous, beta;
    Vec3 v;
  } cases[]{{plane, 0, 0, 1, {0.001, 0.002, 0}},
            {plane, 30, 0, 1, {0.01, 0.02, -0.03}},
            {plane, 30, 0.02, 0.7, {0.05, 0.02, -0.03}},
            {ball, 0, 0, 1, {0.001, 0.0499, 0}},
            {ball, 0, 0.3, 0.4, {0.1, 0.08, 0.02}},
            {ball, 0, std::numeric_limits<double>::infinity(), 0.6, {0.1, 0.08, 0.02}}};
  for (const auto& c : cases) {
    const Adhesion law{0.02, 50, c.tangential};
    CAPTURE(c.v.transpose());
    const Adhesive here = at(law, c.shape, Vec3::Zero(), c.v, c.viscous, c.beta);
    CHECK(here.force.norm() > 0);
    for (int j = 0; j < 3; ++j) {
      const Vec3 d = step * Vec3::Unit(j);
      const Adhesive more = at(law, c.shape, Vec3::Zero(), c.v + d, c.viscous, c.beta),
                     less = at(law, c.shape, Vec3::Zero(), c.v - d, c.viscous, c.beta);
      const double slope =
          (potential(law, more, c.viscous, c.beta) - potential(law, less, c.viscous, c.beta)) /
          (2 * step);
      CHECK(-here.force[j] == near(slope, 1e-6));
      const Vec3 change = (more.force - less.force) / (2 * step);
      CHECK((here.tangent.col(j) - change).norm() <= 1e-5 * here.tangent.norm());
    }
    CHECK((here.tangent - here.tangent.transpose()).norm() <= 1e-12 * here.tangent.norm());
  }
}

// The gradient of the normal part of a slip needs the shape's curvature; its Hessian needs the
// curvature twice, and the derivative of the curvature, which the tangent leaves out.
TEST_CASE(
    "on a curved surface the tangent of a bond against sliding has the curvature of the shape") {
  const double step = 1e-6;
  const double curvature = 0.5;  // of the ball [1/mm]
  const Adhesion law{0.02, 50, 30};
  for (const Vec3& v : {Vec3(0.1, 0.08, 0.02), Vec3(0.02, 0.1, -0.01), Vec3(-0.03, 0.06, 0.05)}) {
    CAPTURE(v.transpose());
    // bonds that stay as they are: the tangent is then that of the springs alone
    const double held = std::numeric_limits<double>::infinity();
    const Adhesive here = at(law, ball, Vec3::Zero(), v, held, 0.6);
    Mat3 differences;
    for (int j = 0; j < 3; ++j) {
      const Vec3 d = step * Vec3::Unit(j);
      const Adhesive more = at(law, ball, Vec3::Zero(), v + d, held, 0.6);
      const Adhesive less = at(law, ball, Vec3::Zero(), v - d, held, 0.6);
      differences.col(j) = (more.force - less.force) / (2 * step);
    }
    const double error = (here.tangent - differences).norm() / here.tangent.norm();
    const double slip_n = std::abs(v.dot(shape_at(ball, v).normal));
    // the term left out has the square of the curvature, those kept the curvature itself
    const double left_out = 2 * slip_n * v.norm() * curvature * curvature;
    const double kept = slip_n * curvature;
    CHECK(error <= left_out);
    CHECK(left_out < 0.5 * kept);
  }
}

TEST_CASE("the work of a viscous bond is stored, taken by the surface or by its viscosity") {
  const Adhesion law{0.02, 50, 0, 0.01};
  const Indenter flat = Plane{{0, 0, 0}, {0, 1, 0}};
  const double g_0 = std::sqrt(law.work / law.stiffness);
  const double seconds = 1;
  constexpr int n = 20000;
  const double viscous = law.viscosity / (seconds / n);
  Bond bond{1, Vec3::Zero(), true};
  double work = 0;
  double taken = 0;
  double stored = 0;
  double last = 0;
  for (int i = 1; i <= n; ++i) {
    const double g = 4 * g_0 * i / n;
    const Adhesive now = adhesive(law, shape_at(flat, Vec3(0, g, 0)), Vec3(0, g, 0), bond, viscous);
    const double traction = -now.force[1];
    work += 0.5 * (traction + last) * 4 * g_0 / n;
    taken += now.dissipated;
    stored = now.stored;
    bond.beta = now.beta;
    last = traction;
  }
  // backward Euler: the error is that of one step in n, times the few sizes that beta changes by
  CHECK(work == near(stored + taken, 1e-3));
  // otherwise the check says nothing of viscosity
  const double by_surface = law.work * (1 - bond.beta);
  CHECK(taken - by_surface > 0.1 * work);
}

namespace {

// A bond with a viscosity on a plane, opened at an even rate to `widest` and closed again as far as
// half of that, in n increments.
double intensity_after(const Adhesion& law, double widest, int n, bool second_order) {
  const Indenter flat = Plane{{0, 0, 0}, {0, 1, 0}};
  Bond bond{1, Vec3::Zero(), true};
  double last = 0;
  for (int i = 1; i <= n; ++i) {
    const double t = 1.5 * i / n;
    const double g = widest * (t <= 1 ? t : 2 - t);
    const Vec3 v(0, g, 0);
    if (second_order) bond.opening = law.stiffness * last * last;
    bond.beta = adhesive(law, shape_at(flat, v), v, bond, law.viscosity * n / 1.5).beta;
    last = g;
  }
  return bond.beta;
}

}  // namespace

TEST_CASE("a bond with a viscosity is of second order in the increments") {
  for (const double viscosity : {0.003, 0.01, 0.05}) {
    for (const bool healing : {false, true}) {
      CAPTURE(viscosity);
      CAPTURE(healing);
      const Adhesion law{0.02, 50, 0, viscosity, healing};
      const double widest = 2 * std::sqrt(law.work / law.stiffness);
      const double right = intensity_after(law, widest, 30000, true);
      CHECK(right > 0.2);
      CHECK(right < 0.95);
      // worst of several numbers: where the bond begins to come loose lies between increments
      const auto off = [&](int n, bool second_order) {
        double worst = 0;
        for (const int more : {0, 1, 2, 3, 4})
          worst = std::max(worst,
                           std::abs(intensity_after(law, widest, n + more, second_order) - right));
        return worst;
      };
      // 16 times shorter: 256 times more exact, if all were smooth
      CHECK(off(480, true) < off(30, true) / 100);
      CHECK(off(120, true) < 0.2 * off(120, false));
      CHECK(off(30, true) < 5e-3);
    }
  }
}

TEST_CASE("a bond with a viscosity follows its opening at once where it is small") {
  const Adhesion law{0.02, 50, 0, 1e-9};
  const Indenter flat = Plane{{0, 0, 0}, {0, 1, 0}};
  const double g = 3 * std::sqrt(law.work / law.stiffness);
  Bond bond{0.8, Vec3::Zero(), true, 0.5 * law.stiffness * g * g};
  const Vec3 v(0, g, 0);
  const double beta = adhesive(law, shape_at(flat, v), v, bond, law.viscosity / 0.1).beta;
  CHECK(beta == near(law.work / (law.stiffness * g * g), 1e-6));
}

TEST_CASE("of second order a bond's tangent and changes are those of its force") {
  const double step = 1e-6;
  for (const double viscous : {0.01, 0.2})
    for (const bool healing : {false, true}) {
      CAPTURE(viscous);
      CAPTURE(healing);
      const Adhesion law{0.02, 50, 30, 0.01, healing};
      const Bond bond{0.7, Vec3(0.004, 0, 0.001), true, healing ? 0.05 : 0.03};
      const Vec3 v = healing ? Vec3(0.004, 0.01, 0.006) : Vec3(0.05, 0.03, -0.03);
      const auto force = [&](double beta, double opened, const Vec3& moved, double damped) {
        Bond from = bond;
        from.beta = beta;
        from.opening = opened;
        return adhesive(law, shape_at(plane, moved), moved, from, damped);
      };
      const Adhesive here = force(bond.beta, bond.opening, v, viscous);
      CHECK(here.beta != near(bond.beta, 1e-3));
      for (int j = 0; j < 3; ++j) {
        const Vec3 d = step * Vec3::Unit(j);
        const Vec3 change = (force(bond.beta, bond.opening, v + d, viscous).force -
                             force(bond.beta, bond.opening, v - d, viscous).force) /
                            (2 * step);
        CHECK((here.tangent.col(j) - change).norm() <= 1e-5 * here.tangent.norm());
      }
      const auto agrees = [&](const BondChange& by, const Adhesive& more, const Adhesive& less) {
        const AdhesiveChange found = adhesive_change(law, shape_at(plane, v), v, bond, viscous, by);
        CHECK(found.beta == near((more.beta - less.beta) / (2 * step), 1e-6));
        CHECK((found.force - (more.force - less.force) / (2 * step)).norm() <=
              1e-6 * found.force.norm());
      };
      BondChange by;
      by.beta = 1;
      agrees(by, force(bond.beta + step, bond.opening, v, viscous),
             force(bond.beta - step, bond.opening, v, viscous));
      by = {};
      by.opening = 1;
      agrees(by, force(bond.beta, bond.opening + step, v, viscous),
             force(bond.beta, bond.opening - step, v, viscous));
      by = {};
      by.viscous = 1;
      agrees(by, force(bond.beta, bond.opening, v, viscous + step),
             force(bond.beta, bond.opening, v, viscous - step));
    }
}

TEST_CASE("a bond that is pulled off bears sqrt(w C) at most and takes w, in steps of any size") {
  const Adhesion law{0.02, 50};
  const Indenter flat = Plane{{0, 0, 0}, {0, 1, 0}};
  const double g_0 = std::sqrt(law.work / law.stiffness);
  Bond bond{1, Vec3::Zero(), true};
  double work = 0, taken = 0, most = 0, last = 0;
  constexpr int n = 4000;
  for (int i = 1; i <= n; ++i) {
    const double g = 100 * g_0 * std::pow(double(i) / n, 2);
    const Adhesive now = adhesive(law, shape_at(flat, Vec3(0, g, 0)), Vec3(0, g, 0), bond, 0);
    const double traction = -now.force[1], before = 100 * g_0 * std::pow(double(i - 1) / n, 2);
    work += 0.5 * (traction + last) * (g - before), taken += now.dissipated;
    bond.beta = now.beta, last = traction, most = std::max(most, traction);
    if (i == n) CHECK(work == near(now.stored + taken, 1e-5));
  }
  CHECK(most == near(std::sqrt(law.work * law.stiffness), 1e-3));
  CHECK(taken == near(law.work * (1 - 1e-4), 1e-6));
  const Adhesive once = adhesive(law, shape_at(flat, Vec3(0, 100 * g_0, 0)), Vec3(0, 100 * g_0, 0),
                                 {1, Vec3::Zero(), true}, 0);
  CHECK(once.dissipated == near(taken, 1e-9));
}

TEST_CASE("bonds come back with healing only, and nothing holds what never touched") {
  const Indenter flat = Plane{{0, 0, 0}, {0, 1, 0}};
  const Vec3 far(0, 0.1, 0), near(0, 0.001, 0);
  Adhesion law{0.02, 50};
  const Bond lost{at(law, flat, Vec3::Zero(), far).beta, Vec3::Zero(), true};
  CHECK(lost.beta < 0.05);
  CHECK(adhesive(law, shape_at(flat, near), near, lost, 0).beta == lost.beta);
  law.healing = true;
  CHECK(adhesive(law, shape_at(flat, near), near, lost, 0).beta == 1);
  CHECK(adhesive(law, shape_at(flat, near), near, lost, 1).beta < 0.1);  // slowly
  CHECK(adhesive(law, shape_at(flat, far), far, {}, 0).force == Vec3(0, 0, 0));
}

namespace {

// A bond with all of its numbers.
struct Case {
  Adhesion law;
  double radius = 2;  // of a ball below the node
  Vec3 v;
  Bond bond;
  double viscous = 0;
};

ShapePoint ball_at(double radius, const Vec3& v) {
  return shape_at(Indenter(Sphere{radius, {0, -2, 0}}), v);
}

Adhesive of(const Case& c) {
  return adhesive(c.law, ball_at(c.radius, c.v), c.v, c.bond, c.viscous);
}

// The case moved by a step along a change, of the radius as well.
Case moved(Case c, const BondChange& change, double radius, double step) {
  c.law.work += step * change.law.work;
  c.law.stiffness += step * change.law.stiffness;
  c.law.tangential += step * change.law.tangential;
  c.radius += step * radius;
  c.v += step * change.v;
  c.bond.beta += step * change.beta;
  c.bond.at += step * change.at;
  c.viscous += step * change.viscous;
  return c;
}

}  // namespace

TEST_CASE(
    "a bond changes with each number of its law, its past and its indenter as differences say") {
  const Case loosening{{0.02, 50, 30}, 2, {0.05, 0.09, 0.02}, {0.9, {0.01, 0, -0.02}, true}, 0.01};
  Case at_once = loosening;
  at_once.viscous = 0;
  Case holding = loosening;
  holding.law.work = 5;
  Case healing = holding;
  healing.law.healing = true;
  healing.bond.beta = 0.4;
  healing.viscous = 20;
  Case pressed = loosening;
  pressed.v[1] = -0.01;  // inside: it opens by sliding alone
  std::vector<std::pair<BondChange, double>> changes(9);
  changes[0].first.beta = 1;
  changes[1].first.at = {0.3, -1, 0.5};
  changes[2].first.v = {1, 0.4, -0.7};
  changes[3].first.law = {1, 0, 0};
  changes[4].first.law = {0, 1, 0};
  changes[5].first.law = {0, 0, 1};
  changes[6].first.viscous = 1;
  changes[7].second = 1;
  changes[8] = {{0.2, {0.1, 0.2, 0.3}, {-0.3, 0.2, 1}, {0.1, 20, -10}, 0.05}, 0.7};
  for (const Case& c : {loosening, at_once, holding, healing, pressed})
    for (auto& [change, radius] : changes) {
      const auto number = &change - &changes[0].first;
      CAPTURE(c.law.work);
      CAPTURE(c.v[1]);
      CAPTURE(number);
      const double h = 1e-6;
      const ShapePoint more = ball_at(c.radius + h * radius, c.v);
      const ShapePoint less = ball_at(c.radius - h * radius, c.v);
      const Mat3 along = (ball_at(c.radius, c.v + h * change.v).curvature -
                          ball_at(c.radius, c.v - h * change.v).curvature) /
                         (2 * h);
      change.shape = {(more.gap - less.gap) / (2 * h), (more.normal - less.normal) / (2 * h),
                      (more.curvature - less.curvature) / (2 * h) + along};
      const AdhesiveChange told =
          adhesive_change(c.law, ball_at(c.radius, c.v), c.v, c.bond, c.viscous, change);
      const Adhesive high = of(moved(c, change, radius, h));
      const Adhesive low = of(moved(c, change, radius, -h));
      const Vec3 force = (high.force - low.force) / (2 * h);
      CHECK((told.force - force).norm() <= 1e-6 * (force.norm() + of(c).force.norm()));
      CHECK(told.beta == near((high.beta - low.beta) / (2 * h), 1e-6, 1e-7));
    }
}
