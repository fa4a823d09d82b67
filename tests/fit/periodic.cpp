// Angles: periodic boxes, places of symmetry, and what is known of the other numbers there; ties
// between families.
#include "identification/fit/periodic.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "identification/fit/identifiability.hpp"
#include "material/catalogue.hpp"
#include "support/correlated.hpp"
#include "support/near.hpp"

using namespace langer;

namespace periodic_tests {

namespace {

const Volume volume{QuadraticVolume{1e-6}};

Material goh(double a1, double c1, double c2, double alpha, double kappa) {
  return {{NeoHooke{a1}}, {hgo_fibre(c1, c2, alpha, FibreSwitch::I4_bar, kappa)}, volume};
}

// biaxial protocols, which do not tell an angle from its mirror image
std::vector<Test> measured(const Material& truth, double noise, std::uint64_t seed) {
  FitProblem q = test::protocols(25);
  Random random(17, seed);
  for (Test& t : q.tests) {
    std::vector<double> s(t.values());
    REQUIRE(model_stress(truth, t, Dilatation::incompressible, s.data()));
    for (double& x : s) x += noise * random.normal();
    const auto middle = s.begin() + static_cast<std::ptrdiff_t>(t.points());
    t.stress_x.assign(s.begin(), middle), t.stress_z.assign(middle, s.end());
  }
  return q.tests;
}

FitProblem goh_fit(const std::vector<Test>& tests, double start, double lower, double upper) {
  return {goh(0.1, 0.1, 1, start, 0.2),
          {{"matrix.neo_hooke.a1", 0.1, 0, 10},
           {"fibres[0].hgo.c1", 0.1, 0, 10},
           {"fibres[0].hgo.c2", 1, 0, 10},
           {"fibres[0].alpha", start, lower, upper},
           {"fibres[0].kappa", 0.2, 0, 1. / 3}},
          tests};
}

Profile profile_of(const FitProblem& q, const FitResult& f, Eigen::Index which) {
  ProfileOptions options;
  options.factor = interval_factors(f.columns, f.left_out, f.noise);
  const VecX error = f.covariance.diagonal().cwiseSqrt();
  return profiles([&] { return least_squares_problem(q); }, f.best.p, error, f.noise.total(),
                  options)[static_cast<std::size_t>(which)];
}

double apart(double a, double b) { return std::abs(std::remainder(a - b, 180)); }

}  // namespace

TEST_CASE(
    "an angle is the same in every box of 180 degrees and more, with its errors and intervals") {
  const std::vector<Test> tests = measured(goh(0.05, 0.2, 0.8, 62, 0.1), 0.0005, 1);
  const FitProblem narrow = goh_fit(tests, 50, 30, 80);
  const FitResult expected = fit(narrow, {.starts = 1});
  REQUIRE(expected.best.converged);
  const Profile known = profile_of(narrow, expected, 3);
  for (const auto& [lower, upper] :
       {std::pair{-90., 90.}, {0., 180.}, {61., 241.}, {-125., 60.}, {-180., 180.}}) {
    const auto from = lower;
    CAPTURE(from);
    const FitProblem q = goh_fit(tests, std::clamp(50., lower, upper), lower, upper);
    const FitResult f = fit(q, {.starts = 1});
    REQUIRE(f.best.converged);
    CHECK(f.best.p[3] >= lower);
    CHECK(f.best.p[3] <= upper);
    CHECK(!f.best.at_bound[3]);
    CHECK(!f.symmetric[3]);
    const bool mirrored = apart(f.best.p[3], -expected.best.p[3]) < 1;
    CHECK(apart(f.best.p[3], mirrored ? -expected.best.p[3] : expected.best.p[3]) <= 1e-4);
    CHECK(f.covariance(3, 3) == near(expected.covariance(3, 3), 1e-4));
    const Profile p = profile_of(q, f, 3);
    const double below = f.best.p[3] - p.low, above = p.high - f.best.p[3],
                 centre = expected.best.p[3];
    CHECK((mirrored ? above : below) == near(centre - known.low, 1e-2));
    CHECK((mirrored ? below : above) == near(known.high - centre, 1e-2));
  }
}

TEST_CASE(
    "at an angle of symmetry the angle leaves the covariance, the others' errors are those of a held angle") {
  int symmetric = 0;
  for (double truth : {0., 90.})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      CAPTURE(truth);
      CAPTURE(seed);
      const std::vector<Test> tests = measured(goh(0.05, 0.2, 0.8, truth, 0.15), 0.002, seed);
      const FitProblem q = goh_fit(tests, truth, -90, 90);
      const FitResult f = fit(q, {.starts = 3});
      REQUIRE(f.best.converged);
      FitProblem held = q;
      held.law.fibres[0].alpha_deg = f.best.p[3];
      held.free.erase(held.free.begin() + 3);
      const FitResult without = fit(held, {.starts = 3});
      // noise may put the optimum off the axis, farther than its own standard error: then the angle
      // is an angle like others
      if (!f.symmetric[3]) continue;
      ++symmetric;
      CHECK(apart(f.best.p[3], truth) <= 1);
      CHECK(std::isnan(f.covariance(3, 3)));
      for (int i : {0, 1, 2}) {
        CAPTURE(i);
        CHECK(std::sqrt(f.covariance(i, i)) == near(std::sqrt(without.covariance(i, i)), 0.02));
      }
      const Profile p = profile_of(q, f, 3);
      CHECK(p.low < f.best.p[3]);
      CHECK(p.high > f.best.p[3]);
      CHECK(p.high - p.low < 60);
      // it holds the axis
      const double axis = f.best.p[3] + std::remainder(truth - f.best.p[3], 180);
      CHECK(p.low < axis);
      CHECK(p.high > axis);
    }
  CHECK(symmetric >= 2);  // of eight
}

TEST_CASE("an angle of symmetry beside its bound has no standard error either") {
  const FitProblem q =
      goh_fit(measured(goh(0.05, 0.2, 0.8, 90, 0.15), 0.0005, 1), 80, 0, 90 + 1e-7);
  const FitResult f = fit(q, {.starts = 1});
  CHECK(apart(f.best.p[3], 90) <= 3);
  CHECK((f.best.at_bound[3] || f.symmetric[3] || f.covariance(3, 3) < 100));
}

TEST_CASE(
    "porcine skin P12AC1: intervals hold their estimates, the angle's is that of bounds 0 to 180") {
  const std::string file = SOURCE_DIR "/../shared/data/porcine_skin_biaxial_P12AC1.csv";
  if (!std::filesystem::exists(file)) {
    MESSAGE("skipped: the measured specimen is not here");
    return;
  }
  TestFormat format;
  format.like.kind = TestKind::biaxial, format.like.measure = StressMeasure::nominal;
  format.strain = StrainMeasure::stretch;
  format.strain_x = "lambda_x", format.strain_z = "lambda_y", format.stress_x = "P_x_MPa",
  format.stress_z = "P_y_MPa";
  format.split = "protocol";
  const std::vector<Test> tests = tests_of(read_table(file), format);
  const FitProblem one = goh_fit(tests, 80, 0, 180), other = goh_fit(tests, 80, -90, 90);
  const FitResult a = fit(one, {.starts = 6}), b = fit(other, {.starts = 6});
  const Profile x = profile_of(one, a, 3), y = profile_of(other, b, 3);
  MESSAGE("GOH: residuals correlated by " << a.noise.rho << ", 900 values count as "
                                          << a.noise.effective << "; alpha " << b.best.p[3]
                                          << ", interval " << y.low << " to " << y.high);
  CHECK(a.noise.rho > 0.8);
  CHECK(a.noise.effective < 90);
  CHECK(apart(a.best.p[3], b.best.p[3]) <= 0.05);
  CHECK(!x.low_open);
  CHECK(!y.high_open);
  CHECK(y.high - b.best.p[3] == near(x.high - a.best.p[3], 0.02));
  CHECK(b.best.p[3] - y.low == near(a.best.p[3] - x.low, 0.02));
  FitProblem yeoh = other;
  yeoh.law = {{Yeoh{0.01, 0.1, 0.1}}, {hgo_fibre(0.1, 1, 80)}, volume};
  yeoh.free = {{"matrix.yeoh.a1", 0.01, 0, 10}, {"matrix.yeoh.a2", 0.1, 0, 10},
               {"matrix.yeoh.a3", 0.1, 0, 10},  {"fibres[0].hgo.c1", 0.1, 0, 10},
               {"fibres[0].hgo.c2", 1, 0, 100}, {"fibres[0].alpha", 80, -90, 90}};
  const FitResult c = fit(yeoh, {.starts = 2});
  for (const auto& [q, f] : {std::pair{&other, &b}, {&yeoh, &c}}) {
    const FitProblem& problem = *q;
    const Bootstrap samples = bootstrap([&] { return least_squares_problem(problem); }, f->best.p,
                                        f->noise, {.samples = 60});
    for (Eigen::Index i = 0; i < f->best.p.size(); ++i) {
      const std::string& key = problem.free[static_cast<std::size_t>(i)].key;
      CAPTURE(key);
      CHECK(samples.low[i] <= f->best.p[i]);
      CHECK(samples.high[i] >= f->best.p[i]);
    }
  }
}

TEST_CASE(
    "two families tied to each other: symmetric angles, shared c1, c2 and kappa come back and stay tied") {
  const Material start{{NeoHooke{0.1}},
                       {hgo_fibre(0.1, 1, 30, FibreSwitch::I4_bar, 0.2), hgo_fibre(3, 3, 3)},
                       volume};
  const std::vector<Tie> ties{{"fibres[1].alpha", "fibres[0].alpha", -1, 0},
                              {"fibres[1].hgo.c1", "fibres[0].hgo.c1", 1, 0},
                              {"fibres[1].hgo.c2", "fibres[0].hgo.c2", 1, 0},
                              {"fibres[1].kappa", "fibres[0].kappa", 1, 0}};
  for (double alpha : {25., 41., 70.}) {
    CAPTURE(alpha);
    const Material truth{{NeoHooke{0.05}},
                         {hgo_fibre(0.2, 2, alpha, FibreSwitch::I4_bar, 0.1),
                          hgo_fibre(0.2, 2, -alpha, FibreSwitch::I4_bar, 0.1)},
                         volume};
    FitProblem q = goh_fit(measured(truth, 0, 1), 40, 1, 89);
    q.law = start, q.ties = ties;
    const FitResult f = fit(q, {.starts = 4});
    REQUIRE(f.best.converged);
    const double expected[] = {0.05, 0.2, 2, alpha, 0.1};
    for (int i = 0; i < 5; ++i) CHECK(std::abs(f.best.p[i] - expected[i]) <= 1e-6 * expected[i]);
    const auto& [first, second] = std::pair{f.material.fibres[0], f.material.fibres[1]};
    CHECK(second.alpha_deg == -first.alpha_deg);
    CHECK(std::get<HgoFibre>(second.law).c1 == std::get<HgoFibre>(first.law).c1);
    CHECK(std::get<HgoFibre>(second.law).c2 == std::get<HgoFibre>(first.law).c2);
    CHECK(second.kappa == first.kappa);
    // the columns are those of the law whose families vary together
    LeastSquares problem = least_squares_problem(q);
    MatX J, careful;
    REQUIRE(jacobian(problem, f.best.p, J));
    problem.linear.clear();
    REQUIRE(jacobian(problem, f.best.p, careful));
    CHECK((J - careful).norm() <= 1e-8 * careful.norm());
  }
}

TEST_CASE("a tie to a number that is not fitted, and one with factor and offset") {
  Material law{{NeoHooke{0.05}}, {hgo_fibre(0.2, 2, 20), hgo_fibre(9, 9, 9)}, volume};
  FitProblem q = goh_fit({}, 20, -90, 90);
  q.law = law, q.free = {{"fibres[0].hgo.c1", 0.1, 0, 10}};
  q.ties = {{"fibres[1].hgo.c1", "fibres[0].hgo.c1", 0.5, 0.01},
            {"fibres[1].alpha", "fibres[0].alpha", 1, 90},
            {"fibres[1].hgo.c2", "fibres[0].hgo.c2", 1, 0}};
  const Material truth = with_parameters(q, VecX::Constant(1, 0.3));
  CHECK(std::get<HgoFibre>(truth.fibres[1].law).c1 == 0.5 * 0.3 + 0.01);
  CHECK(truth.fibres[1].alpha_deg == 110);
  CHECK(std::get<HgoFibre>(truth.fibres[1].law).c2 == 2);
  q.tests = measured(truth, 0, 1);
  CHECK(fit(q, {.starts = 2}).best.p[0] == near(0.3, 1e-9));
}

}  // namespace periodic_tests
