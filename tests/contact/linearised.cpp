// The linearised law of a candidate against differences of the law itself, for every shape: what
// Newton's method takes from contact.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "mechanics/contact/contact.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

std::mt19937 random_numbers(21);
Vec3 in_cube(double half) {
  std::uniform_real_distribution<double> u(-half, half);
  return {u(random_numbers), u(random_numbers), u(random_numbers)};
}

const std::vector<Indenter> smooth{
    Sphere{2.5, {0.1, 3, -0.2}},         Sphere{0.4, {0, 0, 0}},
    Plane{{0, 1, 0}, {0.2, 1, 0.3}},     Cylinder{2, 0.5, {0, 4, 0}, {0.1, 1, 0.2}},
    Ellipsoid{{3, 1.5, 2}, {0, 3, 0.5}}, Aperture{2, 0.5, {0, 1, 0}, {0.1, 1, 0.2}}};

// a closed candidate: its node at X, u, in an increment that began at u0, the shape displaced from
// c0 to c
struct Candidate {
  RigidContact contact;
  Vec3 X, u, u0, c, c0;
  ContactDefect defect(const Vec3& r) const {
    VecX now(3), then(3);
    now << u, then << u0;
    return contact_defect(contact, {X}, now, then, c, c0, {r}, 0);
  }
};

}  // namespace

TEST_CASE("a movement changes gap and slip by T d, and turns the reaction by D d") {
  for (const Indenter& shape : smooth) {
    RigidContact contact;
    contact.shape = shape, contact.mu = 0.3;
    int checked = 0;
    for (int k = 0; k < 100; ++k) {
      const Vec3 c = in_cube(0.5), c0 = c + in_cube(0.3), x = in_cube(5), x0 = x + in_cube(0.4),
                 r = in_cube(2), d = in_cube(1);
      const LinearisedContact law = linearise(contact, x, x0, c, c0, r);
      const double h = 1e-6;
      const ShapePoint at = shape_at(shape, x - c), ahead = shape_at(shape, x + h * d - c),
                       behind = shape_at(shape, x - h * d - c);
      if (at.gap < 0.05 || (ahead.curvature - at.curvature).norm() > 1e-3 ||
          (behind.curvature - at.curvature).norm() > 1e-3)
        continue;
      const Vec3 n = at.normal, dn = (ahead.normal - behind.normal) / (2 * h),
                 v = (x - x0) - (c - c0), local = law.frame.transpose() * d;
      const auto tangents = law.frame.rightCols<2>();
      CHECK((law.frame.transpose() * law.frame - Mat3::Identity()).norm() < 1e-12);
      CHECK((law.frame.col(0) - n).norm() < 1e-14);
      CHECK(std::abs(law.q[0] - at.gap) < 1e-14);
      CHECK((law.q.tail<2>() - tangents.transpose() * v).norm() < 1e-14);
      // tangents carried along with the normal: dt = -(t.dn) n
      const Vec3 moved = law.T * local, turned = law.frame * (law.D * local);
      CHECK(std::abs(moved[0] - (ahead.gap - behind.gap) / (2 * h)) < 1e-7);
      for (int t = 0; t < 2; ++t) {
        const Vec3 tangent = tangents.col(t), dt = -tangent.dot(dn) * n;
        CHECK(std::abs(moved[1 + t] - (tangent.dot(d) + dt.dot(v))) < 1e-6);
      }
      Vec3 dr = r.dot(n) * dn;
      for (int t = 0; t < 2; ++t) dr -= r.dot(tangents.col(t)) * tangents.col(t).dot(dn) * n;
      CHECK((turned - dr).norm() < 1e-6);
      ++checked;
    }
    CHECK(checked > 30);
  }
}

TEST_CASE("a reaction turns with the normal by the smallest rotation") {
  for (int k = 0; k < 100; ++k) {
    const Vec3 r = in_cube(3), a = in_cube(1).normalized(), b = (a + in_cube(0.6)).normalized();
    if (a.dot(b) < -0.4) continue;
    const Vec3 turned = turn_with_normal(r, a, b);
    CHECK((turned - Eigen::Quaterniond::FromTwoVectors(a, b) * r).norm() < 1e-12);
    CHECK(std::abs(turned.dot(b) - r.dot(a)) < 1e-12);
    CHECK((turn_with_normal(r, a, a) - r).norm() < 1e-14);
  }
}

TEST_CASE(
    "what is left of the law: stick up to the cone, slip on it, and every way of breaking it is seen") {
  Candidate at{{}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  at.contact.shape = Plane{{0, 0, 0}, {0, 1, 0}}, at.contact.nodes = {0};
  for (double mu : {0.05, 0.34, 2.0}) {
    CAPTURE(mu);
    at.contact.mu = mu, at.u = at.u0 = Vec3::Zero();
    const double r_n = 3;
    const auto with = [&](double share) {
      return at.defect({share * mu * r_n, r_n, 0});
    };
    for (double share : {0.0, 0.5, 0.991, 0.9999, 1 - 1e-6, 1 - 1e-8})
      CHECK(with(share).status[0] == ContactStatus::stick);
    for (double share : {1.0, 1 - 1e-12}) CHECK(with(share).status[0] == ContactStatus::slip);
    CHECK(with(1).stick == 0);
    CHECK(with(1).slip == 1);
    CHECK(with(0.5).stick == 1);
    CHECK(with(0.5).cone <= 0);
    CHECK(with(1.01).cone == near(0.01 * mu * r_n / std::hypot(1.01 * mu * r_n, r_n)));
    CHECK(at.defect({0, -r_n, 0}).cone == near(std::max(1.0, mu)));  // a pull
    CHECK(at.defect(Vec3::Zero()).status[0] == ContactStatus::open);
    CHECK((with(0.7).force - Vec3(0.7 * mu * r_n, r_n, 0)).norm() < 1e-15);
    // friction against the slip, of full size: no defect; short of it or the other way: one
    at.u = Vec3(-0.02, 0, 0);
    CHECK(with(1).complementarity < 1e-15);
    CHECK(with(0.9).complementarity ==
          near(0.1 * mu * r_n / at.defect({0.9 * mu * r_n, r_n, 0}).force.norm()));
    CHECK(with(-1).complementarity == near(2 * mu / std::hypot(1, mu)));
    // a reaction across a gap and a node inside
    at.u = at.u0 = Vec3(0, 0.01, 0);
    CHECK(with(0.5).penetration == near(0.01));
    CHECK(at.defect(Vec3::Zero()).penetration <= 0);
    at.u = at.u0 = Vec3(0, -0.01, 0);
    CHECK(at.defect(Vec3::Zero()).penetration == near(0.01));
  }
}

TEST_CASE(
    "Newton's method keeps its order where the contact turns: a small sphere pressed in and drawn along") {
  test::Indentation scene;
  scene.nx = scene.nz = 10, scene.ny = 3, scene.h = 0.4, scene.radius = 0.8, scene.reach = 2.2,
  scene.step = 0.1;
  scene.newton.reuse_tangent = false;
  for (double mu : {0.0, 0.6}) {
    CAPTURE(mu);
    scene.mu = mu;
    scene.motion = {{0.4, Vec3(0, -0.5, 0)}, {1, Vec3(-0.7, -0.5, 0.2)}};
    const auto result = scene.run(test::table1(60, 1e-3));
    REQUIRE(result.path.complete);
    CHECK(result.path.cut_backs == 0);
    CHECK(result.steps.size() == 10);
    CHECK(result.path.iterations <= 43);  // 39 and 40; reactions that do not turn: 47 and 48;
                                          // without their part of the tangent: 118
  }
}
