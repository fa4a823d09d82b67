// One-at-a-time effects: closed forms, what s sees and what it does not, the law of the paper.
#include "identification/sensitivity/one_at_a_time.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "material/catalogue.hpp"
#include "mechanics/material/uniaxial.hpp"
#include "support/near.hpp"
#include "support/vec.hpp"

using namespace langer;
using test::vec;

namespace {}  // namespace

TEST_CASE("a linear model has its slopes as effects and no spread, s is twice a negative slope") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({3 * p[0] - 2 * p[1], 0.5 * p[1] + 7});
    return true;
  };
  const int n = 1000;
  const OneAtATime e = one_at_a_time(phi, vec({1, 2}), vec({-4, 0}), vec({5, 10}), n);
  REQUIRE(e.complete);
  // differences over a step of 0.01 keep 1e-13
  CHECK(e.mu_star(0, 0) == near(3, 1e-12));
  CHECK(e.mu_star(1, 0) == near(2, 1e-12));
  CHECK(std::abs(e.mu_star(0, 1)) <= 1e-12);
  CHECK(e.mu_star(1, 1) == near(0.5, 1e-12));
  CHECK(e.spread.maxCoeff() <= 1e-11);
  CHECK(e.s(0, 0) <= 1e-11);
  CHECK(e.s(1, 1) <= 1e-11);
  // eq. 43: (d - mu_star)^2 = (2 d)^2 in every step
  CHECK(e.s(1, 0) == near(2 * 2 * std::sqrt(n / (n - 1.)), 1e-10));
}

TEST_CASE(
    "a parabola has the mean slope between its bounds and the spread of evenly spaced slopes") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({p[0] * p[0]});
    return true;
  };
  for (int n : {2, 10, 1000}) {
    const OneAtATime e = one_at_a_time(phi, vec({0.3}), vec({1}), vec({3}), n);
    CHECK(e.mu_star(0, 0) == near(4, 1e-11));  // (9 - 1)/2
    //   effects 2 (1 + 2 i/n) + 2/n: n values 4/n apart have the variance (4/n)^2 n (n + 1)/12
    const double spread = 4. / n * std::sqrt(n * (n + 1.) / 12);
    CHECK(e.spread(0, 0) == near(spread, 1e-9));
    CHECK(e.s(0, 0) == near(spread, 1e-9));
  }
}

TEST_CASE("effects of both signs do not cancel in mu_star") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({p[0] * p[0]});
    return true;
  };
  const OneAtATime e = one_at_a_time(phi, vec({0}), vec({-1}), vec({1}), 100);
  CHECK(e.mu_star(0, 0) == near(1, 1e-12));  // mean of |2 p| over the midpoints of 100 steps
}

TEST_CASE(
    "the others stay at their values: an interaction counts by the value of its partner only") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({p[0] * p[1]});
    return true;
  };
  const OneAtATime e = one_at_a_time(phi, vec({5, -2}), vec({0, 0}), vec({1, 1}), 10);
  CHECK(e.mu_star(0, 0) == near(2, 1e-12));
  CHECK(e.mu_star(1, 0) == near(5, 1e-12));
  CHECK(e.spread.maxCoeff() <= 1e-12);
}

TEST_CASE("a place without curve is reported") {
  const auto phi = [](const VecX& p, VecX& y) {
    y = vec({std::sqrt(std::abs(p[0]))});
    return p[0] >= 0;
  };
  const OneAtATime e = one_at_a_time(phi, vec({1}), vec({-1}), vec({1}), 4);
  CHECK(!e.complete);
  CHECK(e.missing[0] == -1);
}

TEST_CASE("zones average the points they contain, both ends included") {
  const MatX of = (MatX(2, 4) << 1, 2, 3, 4, 10, 20, 30, 40).finished();
  const MatX means = zone_means(of, {0, 0.1, 0.2, 0.3}, {{0, 0.1}, {0.1, 0.3}, {0.5, 0.6}});
  CHECK(means(0, 0) == 1.5);
  CHECK(means(1, 1) == 30);
  CHECK(std::isnan(means(0, 2)));
  // 0.1 + 0.2 is a little more than 0.3
  CHECK(zone_means(of, {0, 0.1, 0.1 + 0.2, 1}, {{0, 0.3}})(0, 0) == 2);
}

TEST_CASE(
    "the stress of the HGO-Yeoh law is linear in a1, a2, a3 and c1: closed forms, no spread, c2 has one") {
  const Material truth = table1_hgo_yeoh();
  const std::vector<double> strain{0.1, 0.3, 0.6};
  const auto phi = [&](const VecX& p, VecX& y) {
    Material m = truth;
    m.matrix = {Yeoh{p[0], p[1], p[2]}};
    std::get<HgoFibre>(m.fibres[0].law) = {p[3], p[4]};
    const auto sigma = uniaxial_curve(m, strain, StressMeasure::cauchy, Dilatation::incompressible);
    if (sigma) y = Eigen::Map<const VecX>(sigma->data(), 3);
    return sigma.has_value();
  };
  const VecX value = vec({0.269, 0.376, 0.415, -0.317, 0.319}), lower = vec({0, 0, 0, -1, 0}),
             upper = vec({1, 1, 1, 1, 2});
  const OneAtATime e = one_at_a_time(phi, value, lower, upper, 1000);
  REQUIRE(e.complete);
  for (int i = 0; i < 3; ++i) {
    const double l = 1 + strain[static_cast<std::size_t>(i)], x = l * l + 2 / l - 3, f = l * l - 1;
    const double matrix = 2 * (l * l - 1 / l), fibre = 2 * l * l * f;
    CHECK(e.mu_star(0, i) == near(matrix, 1e-10));
    CHECK(e.mu_star(1, i) == near(matrix * 2 * x, 1e-10));
    CHECK(e.mu_star(2, i) == near(matrix * 3 * x * x, 1e-10));
    CHECK(e.mu_star(3, i) == near(fibre * std::exp(0.319 * f * f), 1e-10));
    // the effects of c2 have one sign: their mean is the change from bound to bound
    CHECK(e.mu_star(4, i) == near(0.317 * fibre * (std::exp(2 * f * f) - 1) / 2, 1e-9));
    for (int j = 0; j < 4; ++j) CHECK(e.spread(j, i) <= 1e-9 * e.mu_star(j, i));
    CHECK(e.spread(4, i) > 1e-3 * e.mu_star(4, i));
    CHECK(e.s(4, i) > 2 * e.mu_star(4, i));  // as printed: c1 < 0 makes the effects negative
  }
}
