#include "mechanics/contact/coulomb_cone.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace langer;

TEST_CASE("the projection gives the worked values at mu = 0.34") {
  // tau_t, tau_n -> r_t, r_n, by hand from r = tau - s (t - mu n)
  const double cases[4][4] = {{1, 1, 0.4084, 1.2011},
                              {1, 0.2, 0.1646, 0.4840},
                              {1, 0, 0.1036, 0.3048},
                              {1, -0.3, 0.0122, 0.0359}};
  for (const auto& c : cases) {
    const auto p = project_on_cone(Vec3(c[1], c[0], 0), 0.34);
    CHECK(p.status == ContactStatus::slip);
    // worked out to four decimals
    CHECK(p.r[1] == near(c[2], 0, 0.5e-4));
    CHECK(p.r[0] == near(c[3], 0, 0.5e-4));
  }
}

TEST_CASE("the projection is idempotent, admissible and the closest point") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1), friction(0, 2);
  for (int k = 0; k < 2000; ++k) {
    const double mu = k % 10 == 0 ? 0 : friction(random);
    const Vec3 tau(u(random), u(random), u(random));
    const Vec3 r = project_on_cone(tau, mu).r;
    CHECK(std::hypot(r[1], r[2]) <= mu * r[0] + 1e-15);
    CHECK((project_on_cone(r, mu).r - r).norm() <= 1e-15);
    // variational inequality: (tau - r).(y - r) <= 0 for every y in the cone
    for (int j = 0; j < 5; ++j) {
      const double y_n = std::abs(u(random)) * 2, angle = 3.2 * u(random),
                   y_t = mu * y_n * std::abs(u(random));
      const Vec3 y(y_n, y_t * std::cos(angle), y_t * std::sin(angle));
      CHECK((tau - r).dot(y - r) <= 1e-14);
    }
  }
}

TEST_CASE("mu = 0 is the frictionless half-line") {
  CHECK(project_on_cone(Vec3(2, 1, -1), 0).r == Vec3(2, 0, 0));
  CHECK(project_on_cone(Vec3(-2, 1, -1), 0).r == Vec3(0, 0, 0));
  CHECK(project_on_cone(Vec3(-2, 0, 0), 0).r == Vec3(0, 0, 0));
}

TEST_CASE("the projection is continuous across the borders of its three states") {
  const double mu = 0.34, small = 1e-9;
  for (double t : {0.1, 1.0, 3.0}) {
    const Vec3 stick_border(t / mu, t, 0), open_border(-mu * t, t, 0);
    for (const Vec3& border : {stick_border, open_border})
      CHECK((project_on_cone(border + Vec3(small, 0, 0), mu).r -
             project_on_cone(border - Vec3(small, 0, 0), mu).r)
                .norm() < 3 * small);
  }
}
