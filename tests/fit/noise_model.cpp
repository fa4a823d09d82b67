// The likelihood of a fit: that of dense matrices, at its maximum in parameters and noise alike,
// and never larger for a nested law.
#include "identification/fit/noise_model.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "identification/fit/left_out.hpp"
#include "identification/setup/fit_report.hpp"
#include "support/correlated.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

const std::array kinds{NoiseKind::white, NoiseKind::proportional, NoiseKind::autoregressive,
                       NoiseKind::both};

// -2 ln L of residuals e of a fit by the dense covariance, at the best deviation
double dense_likelihood(const VecX& e, const VecX& measured,
                        const std::vector<Eigen::Index>& curves, double rho, double share) {
  const Eigen::Index n = e.size();
  const double m2 = measured.squaredNorm() / static_cast<double>(n);
  MatX V = MatX::Zero(n, n);
  Eigen::Index first = 0;
  for (Eigen::Index size : curves) {
    for (Eigen::Index i = first; i < first + size; ++i)
      for (Eigen::Index j = first; j < first + size; ++j)
        V(i, j) = std::pow(rho, static_cast<double>(std::abs(i - j)));
    first += size;
  }
  VecX s(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double f = e[i] + measured[i];
    s[i] = std::sqrt(1 - share + share * f * f / m2);
  }
  V = s.asDiagonal() * V * s.asDiagonal();
  const Eigen::PartialPivLU<MatX> lu(V);
  const double log_det = lu.matrixLU().diagonal().cwiseAbs().array().log().sum();
  const double count = static_cast<double>(n);
  return count * std::log(e.dot(lu.solve(e)) / count) + log_det;
}

// noise of one of the kinds on every stress
FitProblem with_noise(FitProblem q, NoiseKind kind, double part, std::uint64_t seed) {
  Random random(77, seed);
  const double largest = test::largest_of(q);
  const bool correlated = kind == NoiseKind::autoregressive || kind == NoiseKind::both;
  const bool grows = kind == NoiseKind::proportional || kind == NoiseKind::both;
  for (Test& t : q.tests)
    for (auto* list : {&t.stress_x, &t.stress_z}) {
      std::vector<double> noise(list->size(), 0.);
      test::add_noise(noise, 1, correlated ? 0.9 : 0, random);
      for (std::size_t i = 0; i < list->size(); ++i) {
        double size = part * largest;
        if (grows) size = 5 * part * (std::abs((*list)[i]) + 0.01 * largest);
        (*list)[i] += size * noise[i];
      }
    }
  return q;
}

}  // namespace

TEST_CASE(
    "the likelihood of residuals is that of the dense covariance, and its slope that of differences") {
  Random random(5);
  const std::vector<Eigen::Index> curves{6, 1, 9};
  VecX measured(16);
  for (double& x : measured) x = 1 + random.normal();
  LeastSquares q;
  q.residual = [measured](const VecX& p, VecX& r) {
    r = -measured;
    for (Eigen::Index i = 0; i < r.size(); ++i)
      r[i] += p[0] + p[1] * static_cast<double>(i % 7) + 0.1 * p[0] * p[1];
    return true;
  };
  q.start = VecX::Constant(2, 0.7);
  q.typical = VecX::Ones(2);
  q.lower = VecX::Constant(2, -10);
  q.upper = VecX::Constant(2, 10);
  const std::vector<bool> rest(16, false);
  for (const auto& [rho, share] : {std::pair{0., 0.}, {0.8, 0.}, {0., 0.9}, {0.6, 0.99}}) {
    NoiseModel noise{NoiseKind::both, rho, share};
    const Standardizer by(measured, curves, rest, noise);
    VecX e;
    q.residual(q.start, e);
    CHECK(minus_two_log_likelihood(by.residual(e)) ==
          near(dense_likelihood(e, measured, curves, rho, share), 1e-11));
    const LeastSquares u = standardized(q, by);
    MatX slope;
    MatX differences;
    REQUIRE(jacobian(u, q.start, slope));
    LeastSquares without = u;
    without.slope = {};
    REQUIRE(jacobian(without, q.start, differences));
    CHECK((slope - differences).norm() <= 1e-8 * slope.norm());
  }
}

TEST_CASE("a value that is zero by definition says nothing of how noise grows with the stress") {
  VecX measured(6);
  measured << 0, 1, 2, 4, 8, 9;
  VecX e(6);
  e << 0, 0.3, -0.2, 0.3, -0.3, 0.2;
  std::vector<bool> rest(6, false);
  rest[0] = true;
  const NoiseModel with = most_likely_noise(e, measured, {6}, rest, NoiseKind::proportional);
  // constant deviations: the point at rest alone would speak for a share at its limit
  CHECK(with.share < 0.5);
  const NoiseModel without =
      most_likely_noise(e, measured, {6}, std::vector<bool>(6, false), NoiseKind::proportional);
  CHECK(without.share > 0.9);
}

TEST_CASE("a fit ends where the likelihood is largest in parameters and noise together") {
  const FitProblem exact = test::protocols(12);
  for (NoiseKind kind : kinds)
    for (NoiseKind actual : {NoiseKind::proportional, NoiseKind::both}) {
      CAPTURE(static_cast<int>(kind));
      CAPTURE(static_cast<int>(actual));
      FitProblem q = with_noise(exact, actual, 0.01, 3);
      q.noise = kind;
      const FitResult f = fit(q, {.starts = 2});
      REQUIRE(f.best.converged);
      const VecX measured = measured_stress(q.tests);
      const LeastSquares plain = least_squares_problem(q);
      const std::vector<Eigen::Index> curves = curve_sizes(q);
      const auto value = [&](const VecX& p, double rho, double share) {
        VecX e;
        REQUIRE(plain.residual(p, e));
        return dense_likelihood(e, measured, curves, rho, share);
      };
      const double rho = f.noise_model.rho;
      const double share = f.noise_model.share;
      const double best = value(f.best.p, rho, share);
      CHECK(minus_two_log_likelihood(f.best.r) == near(best, 1e-9));
      // a step of a tenth of a standard error raises -2 ln L by about 0.01, to either side alike
      const MatX white =
          covariance(f.best.J, f.left_out, white_noise(f.best.r.norm() / 8, f.best.r.size()));
      for (Eigen::Index i = 0; i < f.best.p.size(); ++i) {
        CAPTURE(i);
        const double h = 0.1 * std::sqrt(white(i, i));
        VecX p = f.best.p;
        p[i] += h;
        const double up = value(p, rho, share) - best;
        p[i] -= 2 * h;
        const double down = value(p, rho, share) - best;
        CHECK(up > 0);
        CHECK(down > 0);
        CHECK(std::abs(up - down) < 0.1 * (up + down));
      }
      if (f.noise_model.correlated() && rho > 0 && rho < largest_correlation(curves) - 1e-9)
        for (double h : {0.01, -0.01}) CHECK(value(f.best.p, rho + h, share) > best);
      if (f.noise_model.grows() && share > 0 && share < largest_share)
        for (double factor : {0.8, 1.25})
          CHECK(value(f.best.p, rho, 1 - factor * (1 - share)) > best);
    }
}

TEST_CASE("the kind of noise that made the data is found, and exact data have none") {
  const FitProblem exact = test::protocols(25);
  for (NoiseKind actual : kinds) {
    CAPTURE(static_cast<int>(actual));
    int right = 0;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      FitProblem q = with_noise(exact, actual, 0.005, seed);
      q.noise = NoiseKind::automatic;
      const FitResult f = fit(q, {.starts = 1});
      REQUIRE(f.best.converged);
      REQUIRE(f.noise_candidates.size() == 4);
      right += f.noise_model.kind == actual ? 1 : 0;
      for (const NoiseCandidate& one : f.noise_candidates) CHECK(one.aicc >= f.quality.aicc - 1e-9);
      // both contains each of the others
      for (int k = 0; k < 3; ++k)
        CHECK(f.noise_candidates[3].minus_two_log_likelihood <=
              f.noise_candidates[static_cast<std::size_t>(k)].minus_two_log_likelihood + 1e-6);
    }
    CHECK(right >= 4);
  }
  FitProblem q = exact;
  q.noise = NoiseKind::automatic;
  CHECK(fit(q, {.starts = 1}).noise_model.is_white());
}

TEST_CASE("a nested law is never likelier than the one that contains it") {
  // random biaxial protocols of stiffening tissue that no law below follows, with noise of each
  // kind
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    CAPTURE(seed);
    Random random(50, seed);
    FitProblem made = test::protocols(8 + static_cast<int>(random.below(14)));
    std::get<HgoFibre>(made.law.fibres[0].law).c2 = 1 + 9 * random.uniform();
    made.law.fibres[0].alpha_deg = 90 * random.uniform();
    for (Test& t : made.tests) {
      std::vector<double> s(t.values());
      REQUIRE(model_stress(made.law, t, Dilatation::incompressible, s.data()));
      const auto middle = s.begin() + static_cast<std::ptrdiff_t>(t.points());
      t.stress_x.assign(s.begin(), middle);
      t.stress_z.assign(middle, s.end());
    }
    made = with_noise(made, kinds[seed % 4], 0.01, seed);
    const auto volume = made.law.volume;
    const FitProblem neo_hooke{
        {{NeoHooke{0.1}}, {}, volume}, {{"matrix.neo_hooke.a1", 0.1, -10, 10}}, made.tests};
    const FitProblem mooney{
        {{MooneyRivlin{0.1, 0.1}}, {}, volume},
        {{"matrix.mooney_rivlin.c10", 0.1, -10, 10}, {"matrix.mooney_rivlin.c01", 0.1, -10, 10}},
        made.tests};
    FitProblem narrow{{{Yeoh{0.1, 0.1, 0}}, {}, volume},
                      {{"matrix.yeoh.a1", 0.1, 0, 10}, {"matrix.yeoh.a2", 0.1, 0, 10}},
                      made.tests};
    FitProblem wide = narrow;
    wide.free[0].lower = wide.free[1].lower = -10;
    FitProblem cubic = wide;
    cubic.free.push_back({"matrix.yeoh.a3", 0.1, -10, 10});
    for (const auto& [inner, outer] :
         {std::pair{neo_hooke, mooney}, {neo_hooke, wide}, {narrow, wide}, {wide, cubic}})
      for (NoiseKind kind : kinds) {
        CAPTURE(static_cast<int>(kind));
        FitProblem a = inner;
        FitProblem b = outer;
        a.noise = b.noise = kind;
        const double of_inner = minus_two_log_likelihood(fit(a, {.starts = 2}).best.r);
        const double of_outer = minus_two_log_likelihood(fit(b, {.starts = 2}).best.r);
        CHECK(of_outer <= of_inner + 1e-6 * std::abs(of_inner));
      }
  }
}

TEST_CASE("a correlation at its limit is stated") {
  // neo-Hooke misses curves of a stiffening tissue smoothly: residuals are alike along all of a
  // curve
  FitProblem q = test::protocols(21);
  q.law = {{NeoHooke{0.1}}, {}, q.law.volume};
  q.free = {{"matrix.neo_hooke.a1", 0.1, -10, 10}};
  q.noise = NoiseKind::automatic;
  const FitResult f = fit(q, {.starts = 1});
  REQUIRE(f.best.converged);
  CHECK(f.noise_model.rho == near(1 - 1. / 21, 1e-9));
  const FitRecord record = fit_record(q, f);
  CHECK(record.noise.at_limit);
  std::string all;
  for (const std::string& line : fit_warnings(record, f.material)) all += line + "\n";
  CHECK(all.find("correlated by 0.952") != std::string::npos);
  CHECK(all.find("the largest value that curves of this length allow") != std::string::npos);
  // and what was compared
  all.clear();
  for (const std::string& line : fit_results(record)) all += line + "\n";
  CHECK(all.find("chosen by AICc: white") != std::string::npos);
}

TEST_CASE("a left-out test is predicted from the others") {
  // neo-Hooke is linear in its modulus: each prediction by hand
  FitProblem q = test::protocols(10);
  q.law = {{NeoHooke{0.1}}, {}, q.law.volume};
  q.free = {{"matrix.neo_hooke.a1", 0.1, -10, 10}};
  const FitResult f = fit(q, {.starts = 1});
  const Material unit{{NeoHooke{1}}, {}, q.law.volume};
  double expected = 0;
  for (std::size_t left = 0; left < 3; ++left) {
    double xy = 0;
    double xx = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == left) continue;
      VecX x(20);
      REQUIRE(model_stress(unit, q.tests[k], q.dilatation, x.data()));
      xy += x.dot(measured_stress({q.tests[k]}));
      xx += x.squaredNorm();
    }
    VecX x(20);
    REQUIRE(model_stress(unit, q.tests[left], q.dilatation, x.data()));
    const VecX error = xy / xx * x - measured_stress({q.tests[left]});
    expected += error.squaredNorm() / 20 / std::pow(largest_stress(q.tests[left]), 2) / 3;
  }
  CHECK(left_out_error(q, f) == near(100 * std::sqrt(expected), 1e-8));
  // of one test nothing is left
  q.tests.resize(1);
  CHECK(std::isnan(left_out_error(q, fit(q, {.starts = 1}))));
}
