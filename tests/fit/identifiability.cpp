// What data tell: the paper's single curve in numbers, closed forms of a linear model, coverage of
// intervals, advice.
#include "identification/fit/identifiability.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.hpp"
#include "identification/fit/advice.hpp"
#include "identification/fit/fit.hpp"
#include "material/catalogue.hpp"
#include "support/near.hpp"
#include "support/vec.hpp"

using namespace langer;
using test::vec;

namespace {

// y = p0 + p1 x at x = 0 .. 9
LeastSquares line(const VecX& y, double lower = -100, double upper = 100) {
  LeastSquares q;
  q.residual = [y](const VecX& p, VecX& r) {
    r.resize(10);
    for (int i = 0; i < 10; ++i) r[i] = p[0] + p[1] * i - y[i];
    return true;
  };
  q.start = vec({0, 0}), q.lower = vec({lower, lower}), q.upper = vec({upper, upper}),
  q.typical = vec({1, 1});
  q.size = y.norm();
  return q;
}

Test test_of_sheet(TestKind kind, double angle, double to, int n) {
  Test t;
  t.kind = kind, t.fibre_angle_deg = angle;
  for (int i = 1; i <= n; ++i) {
    t.first.push_back(1 + to * i / n);
    t.stress_x.push_back(0);
    if (kind == TestKind::equibiaxial) t.stress_z.push_back(0);
  }
  return t;
}

const std::vector<FreeParameter> five{{"matrix.yeoh.a1", 0.269, -10, 10},
                                      {"matrix.yeoh.a2", 0.376, -10, 10},
                                      {"matrix.yeoh.a3", 0.415, -10, 10},
                                      {"fibres[0].hgo.c1", -0.317, -10, 10},
                                      {"fibres[0].hgo.c2", 0.319, 0, 5}};
const VecX table1 = vec({0.269, 0.376, 0.415, -0.317, 0.319});

// stresses of the law itself in place of measured ones
FitProblem exact(const Material& law, const std::vector<FreeParameter>& free,
                 std::vector<Test> tests) {
  FitProblem q{law, free, std::move(tests), Dilatation::incompressible};
  VecX p(static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) p[static_cast<Eigen::Index>(i)] = free[i].start;
  VecX r;
  REQUIRE(least_squares_problem(q).residual(p, r));
  Eigen::Index at = 0;
  for (Test& t : q.tests) {
    for (double& s : t.stress_x) s = r[at++];
    for (double& s : t.stress_z) s = r[at++];
  }
  return q;
}

const std::vector<bool> none_at_bound(5, false);

}  // namespace

TEST_CASE("a straight line has the errors, correlation and profiles of the textbook") {
  Random random(3);
  VecX y(10);
  for (int i = 0; i < 10; ++i) y[i] = 2 + 0.5 * i + 0.1 * random.normal();
  const LeastSquares q = line(y);
  const LeastSquaresResult best = least_squares(q);
  const Identifiability s =
      identifiability(best.J, best.p, sizes_of(q, best.p), best.at_bound, white_noise(0.1, 10));
  // sum x = 45, sum x^2 = 285, determinant 825
  CHECK(s.error[0] == near(0.1 * std::sqrt(285. / 825), 1e-9));
  CHECK(s.error[1] == near(0.1 * std::sqrt(10. / 825), 1e-9));
  CHECK(s.correlation(0, 1) == near(-45 / std::sqrt(2850.), 1e-9));
  CHECK(s.singular[0] >= s.singular[1]);
  // the product of the singular values is the determinant of the scaled Jacobian
  CHECK(s.singular[0] * s.singular[1] ==
        near(std::sqrt(825.) * std::abs(best.p[0] * best.p[1]) / 0.01, 1e-9));
  ProfileOptions options;
  const auto all = profiles([&] { return line(y); }, best.p, s.error, 0.1, options);
  for (int i = 0; i < 2; ++i) {
    const auto& profile = all[static_cast<std::size_t>(i)];
    CHECK(profile.low == near(best.p[i] - 1.959964 * s.error[i], 1e-4));
    CHECK(profile.high == near(best.p[i] + 1.959964 * s.error[i], 1e-4));
    CHECK(!profile.low_open);
    CHECK(std::is_sorted(profile.value.begin(), profile.value.end()));
    // chi-squared rises by 1 to 4 at the ends; at the best value it does not rise at all
    for (std::size_t k = 0; k < profile.value.size(); ++k)
      CHECK(profile.rise[k] ==
            near(std::pow((profile.value[k] - best.p[i]) / s.error[i], 2), 1e-6, 1e-6));
  }
  // a bound inside the interval ends it, and says so
  const auto boxed = profiles([&] { return line(y, -100, best.p[0] + 0.5 * s.error[0]); }, best.p,
                              s.error, 0.1, options);
  CHECK(boxed[0].high_open);
  CHECK(boxed[0].high == near(best.p[0] + 0.5 * s.error[0]));
  BootstrapOptions draws;
  draws.samples = 4000;
  const Bootstrap b = bootstrap([&] { return line(y); }, best.p, white_noise(0.1, 10), draws);
  CHECK(b.failed == 0);
  for (int i = 0; i < 2; ++i) {
    CHECK(b.low[i] == near(best.p[i] - 1.96 * s.error[i], 0.1 * s.error[i] / std::abs(best.p[i])));
    CHECK(b.high[i] == near(best.p[i] + 1.96 * s.error[i], 0.1 * s.error[i] / std::abs(best.p[i])));
  }
}

TEST_CASE("parameters that only act together are not determined, and the words say which") {
  //   y depends on p0 + p1 alone
  MatX J(3, 3);
  J << 1, 1, 0, 2, 2, 0, 0, 0, 5;
  const Identifiability s = identifiability(J, vec({1, 2, 3}), vec({1, 2, 3}),
                                            {false, false, false}, white_noise(0.1, 3));
  CHECK(std::isnan(s.error[0]));
  CHECK(std::isnan(s.error[1]));
  CHECK(s.error[2] == near(0.02));
  const std::string words = sloppy_words(s, {"a", "b", "c"}, 2);
  CHECK(words.find("a +") != std::string::npos);
  CHECK(words.find("b -") != std::string::npos);
  CHECK(words.find("c ") == std::string::npos);
  // on a bound: left out
  const Identifiability held =
      identifiability(J, vec({1, 2, 3}), vec({1, 2, 3}), {true, false, false}, white_noise(0.1, 3));
  CHECK(std::isnan(held.error[0]));
  CHECK(held.error[1] == near(0.1 / std::sqrt(5.)));
  CHECK(held.combination.cols() == 2);
}

TEST_CASE(
    "one test along the fibre: 44, 45, 8, 46 and 24 % at 1 % noise, one sloppy combination, of all but a3") {
  const FitProblem q =
      exact(table1_hgo_yeoh(), five, {test_of_sheet(TestKind::uniaxial, 0, 0.6, 30)});
  const LeastSquares problem = least_squares_problem(q);
  MatX J;
  REQUIRE(jacobian(problem, table1, J));
  const double noise = 0.01 * largest_stress(q.tests[0]);
  const Identifiability s = identifiability(J, table1, sizes_of(problem, table1), none_at_bound,
                                            white_noise(noise, J.rows()));
  const double percent[] = {44, 45, 8, 46, 24};
  for (int i = 0; i < 5; ++i)
    CHECK(100 * s.error[i] / std::abs(table1[i]) == near(percent[i], 0.05));
  CHECK(s.correlation(0, 3) == near(-0.9988, 2e-4));
  for (int i : {0, 1, 3, 4}) CHECK(s.correlation_worst[i] > 0.98);
  const std::string words = sloppy_words(s, {"a1", "a2", "a3", "c1", "c2"}, 4);
  CHECK(words.find("a3 ") == std::string::npos);
  for (const char* name : {"a1 ", "a2 ", "c1 ", "c2 "})
    CHECK(words.find(name) != std::string::npos);
  CHECK(s.singular[0] / s.singular[4] > 100);
}

TEST_CASE("the advice after one test along the fibre is a test across it") {
  const Material law = table1_hgo_yeoh();
  const FitProblem q = exact(law, five, {test_of_sheet(TestKind::uniaxial, 0, 0.6, 30)});
  const LeastSquares problem = least_squares_problem(q);
  const VecX size = table1.cwiseAbs();
  MatX J;
  REQUIRE(jacobian(problem, table1, J));
  const MatX known = information(J, size, 0.01 * largest_stress(q.tests[0]));
  std::vector<Candidate> candidates;
  for (double angle : {0., 45., 90.}) {
    const FitProblem more = exact(law, five, {test_of_sheet(TestKind::uniaxial, angle, 0.6, 30)});
    MatX J_more;
    REQUIRE(jacobian(least_squares_problem(more), table1, J_more));
    candidates.push_back(
        {std::to_string(static_cast<int>(angle)), J_more, 0.01 * largest_stress(more.tests[0])});
  }
  const auto advice = advise(known, size, candidates);
  CHECK(advice[0].name == "90");
  CHECK(advice[2].name == "0");
  CHECK(advice[0].worst < 0.05);  // from 46 %
  // the same test again: everything better by root two
  CHECK(advice[2].worst == near(0.46 / std::sqrt(2.), 0.03));
  CHECK(advice[2].gain == near(std::log(2.), 1e-6));
}

TEST_CASE("95 % intervals of noisy tests hold the true parameters 90 to 99 times of 100") {
  const std::vector<FreeParameter> free{{"matrix.yeoh.a1", 0.05, -1, 10},
                                        {"matrix.yeoh.a2", 0.05, -1, 10},
                                        {"matrix.yeoh.a3", 0.02, -1, 10},
                                        {"fibres[0].hgo.c1", 0.10, 0, 10},
                                        {"fibres[0].hgo.c2", 0.30, 0, 5}};
  const VecX truth = vec({0.05, 0.05, 0.02, 0.10, 0.30});
  FitProblem q = exact(positive_hgo_yeoh(), free,
                       {test_of_sheet(TestKind::uniaxial, 0, 0.5, 20),
                        test_of_sheet(TestKind::uniaxial, 90, 0.5, 20)});
  const FitProblem clean = q;
  constexpr int seeds = 200;
  Eigen::VectorXi held = Eigen::VectorXi::Zero(5), held_by_profile = held;
  for (int seed = 0; seed < seeds; ++seed) {
    Random random(77, static_cast<std::uint64_t>(seed));
    const double noise = 0.01 * largest_stress(clean.tests[0]);
    for (std::size_t t = 0; t < 2; ++t)
      for (std::size_t i = 0; i < q.tests[t].stress_x.size(); ++i)
        q.tests[t].stress_x[i] = clean.tests[t].stress_x[i] + noise * random.normal();
    const LeastSquares problem = least_squares_problem(q);
    const LeastSquaresResult best = least_squares(problem);
    REQUIRE(best.converged);
    // the noise is estimated, as for real data; Student's factor for 35 degrees of freedom
    const double estimated = std::sqrt(2 * best.cost / 35);
    const Identifiability s = identifiability(best.J, best.p, sizes_of(problem, best.p),
                                              best.at_bound, white_noise(estimated, 40));
    for (int i = 0; i < 5; ++i) {
      held[i] += std::abs(best.p[i] - truth[i]) <= 2.0301 * s.error[i];
      held_by_profile[i] +=
          profile_rise(problem, i, truth[i], best.p, estimated) <= 2.0301 * 2.0301;
    }
  }
  for (int i = 0; i < 5; ++i) {
    CAPTURE(i);
    for (int n : {held[i], held_by_profile[i]}) {
      CHECK(n >= 0.90 * seeds);
      CHECK(n <= 0.99 * seeds);
    }
  }
}

TEST_CASE(
    "bootstrap: percentiles of each parameter spread from its estimate as told, not beyond a bound; samples stay") {
  VecX y(10);
  for (int i = 0; i < 10; ++i) y[i] = 1 + 0.5 * i + (i % 3 - 1) * 0.2;
  const VecX best = least_squares(line(y)).p;
  BootstrapOptions plain;
  plain.samples = 50;
  BootstrapOptions wide = plain;
  wide.spread = vec({2, 0.5});
  const auto draw = [&](const BootstrapOptions& options, double upper = 100) {
    return bootstrap([&] { return line(y, -100, upper); }, best, white_noise(0.2, 10), options);
  };
  const Bootstrap a = draw(plain), b = draw(wide);
  CHECK(a.samples == b.samples);
  for (int i = 0; i < 2; ++i) {
    CHECK(a.low[i] < best[i]);
    CHECK(b.low[i] - best[i] == near(wide.spread[i] * (a.low[i] - best[i]), 1e-12));
    CHECK(b.high[i] - best[i] == near(wide.spread[i] * (a.high[i] - best[i]), 1e-12));
  }
  const double bound = best[0] + 1.2 * (a.high[0] - best[0]);
  CHECK(draw(wide, bound).high[0] == bound);
}

TEST_CASE(
    "intervals grow most for the parameter that the correlation hides best: a level more than what a few values tell") {
  // a level, and a peak of three values in the middle of 100
  MatX columns = MatX::Zero(100, 2);
  columns.col(0).setOnes();
  columns.col(1).segment(48, 3).setOnes();
  VecX r(100);
  Random random(3, 1);
  double e = random.normal();
  for (double& x : r) x = e, e = 0.9 * e + std::sqrt(1 - 0.81) * random.normal();
  const ResidualNoise noise = residual_noise(r, columns, {100}, 100);
  REQUIRE(noise.rho > 0.6);
  const VecX growth = growth_of_intervals(columns, {false, false}, noise);
  CHECK(growth.minCoeff() > 1);
  CHECK(growth[0] > 1.05 * growth[1]);
  CHECK(growth_of_intervals(columns, {false, false}, white_noise(1, 100)) == VecX::Ones(2));
}

TEST_CASE("profiles and bootstrap do not depend on the number of threads") {
  const FitProblem q =
      exact(positive_hgo_yeoh(), {{"matrix.yeoh.a1", 0.05, 0, 1}, {"fibres[0].hgo.c1", 0.10, 0, 1}},
            {test_of_sheet(TestKind::uniaxial, 0, 0.5, 20)});
  const auto maker = [&] {
    return least_squares_problem(q);
  };
  const VecX best = vec({0.05, 0.10}), error = vec({0.002, 0.004});
  BootstrapOptions one, three;
  one.samples = three.samples = 20, three.threads = 3;
  const Bootstrap a = bootstrap(maker, best, white_noise(0.005, 20), one),
                  b = bootstrap(maker, best, white_noise(0.005, 20), three);
  CHECK(a.samples.rows() == 20);
  CHECK((a.samples.array() == b.samples.array()).all());
  ProfileOptions p1, p3;
  p3.threads = 3;
  const auto x = profiles(maker, best, error, 0.005, p1),
             y = profiles(maker, best, error, 0.005, p3);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(x[i].value == y[i].value);
    CHECK(x[i].high == y[i].high);
  }
}

TEST_CASE(
    "profiles and bootstrap tell how far they are, growing to the whole, on any number of threads") {
  const FitProblem q =
      exact(positive_hgo_yeoh(), {{"matrix.yeoh.a1", 0.05, 0, 1}, {"fibres[0].hgo.c1", 0.10, 0, 1}},
            {test_of_sheet(TestKind::uniaxial, 0, 0.5, 20)});
  const auto maker = [&] {
    return least_squares_problem(q);
  };
  std::vector<double> told;
  const auto listen = [&](double part) {
    told.push_back(part);
  };
  BootstrapOptions draws;
  draws.samples = 10, draws.threads = 3, draws.progress = listen;
  bootstrap(maker, vec({0.05, 0.10}), white_noise(0.005, 20), draws);
  CHECK(told.size() == 10);
  CHECK(std::is_sorted(told.begin(), told.end()));
  CHECK(told.back() == 1);
  told.clear();
  ProfileOptions options;
  options.threads = 2, options.progress = listen;
  profiles(maker, vec({0.05, 0.10}), vec({0.002, 0.004}), 0.005, options);
  CHECK(told.size() == 4);
  CHECK(std::is_sorted(told.begin(), told.end()));
  CHECK(told.back() == 1);
}
