// Parameters from uniaxial curves: known ones come back, and Table 1 of the paper with the reason
// for each column.
#include "support/uniaxial.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "core/base/error.hpp"
#include "material/catalogue.hpp"
#include "support/near.hpp"

using namespace langer;

namespace uniaxial_fit_tests {

using test::Curve, test::fit_uniaxial, test::curve_error;

namespace {

std::vector<double> strains(int n, double to) {
  std::vector<double> e;
  for (int i = 1; i <= n; ++i) e.push_back(to * i / n);
  return e;
}

Curve made_by(const Material& material, StressMeasure measure = StressMeasure::cauchy,
              Dilatation dilatation = Dilatation::incompressible) {
  Curve c;
  c.measure = measure;
  c.strain = strains(30, 0.6);
  c.stress = uniaxial_curve(material, c.strain, measure, dilatation).value();
  return c;
}

FreeParameter free(const char* key, double start, double lower = -10, double upper = 10) {
  return {key, start, lower, upper};
}

std::vector<FreeParameter> yeoh_parameters(double lower = -10) {
  return {free("matrix.yeoh.a1", 0.1, lower), free("matrix.yeoh.a2", 0.1, lower),
          free("matrix.yeoh.a3", 0.1, lower)};
}

std::vector<FreeParameter> hgo_yeoh_parameters(double lower = -10) {
  auto p = yeoh_parameters(lower);
  p.push_back(free("fibres[0].hgo.c1", 0.1, lower));
  p.push_back(free("fibres[0].hgo.c2", 0.1, 0, 5));
  return p;
}

std::vector<FreeParameter> hgo_parameters() {
  return {free("matrix.neo_hooke.a1", 0.1), free("fibres[0].hgo.c1", 0.1),
          free("fibres[0].hgo.c2", 0.1, 0, 5)};
}

const Volume volume{QuadraticVolume{1e-6}};
const Material yeoh{{Yeoh{0.1, 0.1, 0.1}}, {}, volume};
const Material hgo{{NeoHooke{0.1}}, {hgo_fibre(0.1, 0.1, 0)}, volume};
const Material hgo_yeoh{{Yeoh{0.1, 0.1, 0.1}}, {hgo_fibre(0.1, 0.1, 0)}, volume};

Curve abdomen() {
  const std::string path = SOURCE_DIR "/data/abdomen_socci2007_reconstructed.csv";
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return test::parse_curve(text.str(), path);
}

double stress_at(const Material& m, double strain) {
  return uniaxial_incompressible(m, 1 + strain).sigma;
}

}  // namespace

TEST_CASE(
    "known parameters come back from their own curve, along and off the fibre, nominal and compressible") {
  struct Case {
    double alpha;
    StressMeasure measure;
    Dilatation dilatation;
    double d;
  };
  for (const Case& c : {Case{0, StressMeasure::cauchy, Dilatation::incompressible, 1e-6},
                        Case{0, StressMeasure::nominal, Dilatation::compressible, 1e-2},
                        Case{30, StressMeasure::cauchy, Dilatation::incompressible, 1e-6}}) {
    CAPTURE(c.alpha);
    const Material truth = positive_hgo_yeoh(c.alpha, c.d);
    Material law = hgo_yeoh;
    law.fibres[0].alpha_deg = c.alpha;
    law.volume = truth.volume;
    const FitResult f = fit_uniaxial(made_by(truth, c.measure, c.dilatation), law,
                                     hgo_yeoh_parameters(), {c.dilatation, 4, 1});
    REQUIRE(f.best.converged);
    const double expected[] = {0.05, 0.05, 0.02, 0.10, 0.30};
    for (int i = 0; i < 5; ++i) CHECK(std::abs(f.best.p[i] - expected[i]) <= 1e-6 * expected[i]);
    CHECK(f.quality.max_error_percent <= 1e-6);
    CHECK(std::get<QuadraticVolume>(f.material.volume).d == c.d);
  }
}

TEST_CASE("a fitted fibre angle comes back") {
  Material law = hgo_yeoh;
  const FitResult f =
      fit_uniaxial(made_by(positive_hgo_yeoh(25)),
                   Material{{Yeoh{0.05, 0.05, 0.02}}, {hgo_fibre(0.1, 0.3, 5)}, volume},
                   {free("fibres[0].alpha", 5, 0, 90), free("fibres[0].hgo.c1", 0.5, 0, 5)}, {});
  CHECK(f.best.converged);
  CHECK(f.best.p[0] == near(25, 1e-6));
  CHECK(f.best.p[1] == near(0.1, 1e-6));
}

TEST_CASE(
    "the same seed gives the same answer to the last bit, and every start of this curve finds it") {
  const Curve curve = abdomen();
  const auto run = [&](unsigned seed) {
    return fit_uniaxial(curve, hgo_yeoh, hgo_yeoh_parameters(), {.starts = 10, .seed = seed});
  };
  const FitResult a = run(1), b = run(1), c = run(2);
  CHECK((a.starts - b.starts).norm() == 0);
  CHECK((a.best.p - b.best.p).norm() == 0);
  CHECK((a.starts - c.starts).norm() > 0);
  for (int k = 0; k < 10; ++k)
    CHECK((a.starts.row(k).head(5).transpose() - a.best.p).norm() <= 1e-6);
}

TEST_CASE("the reconstructed curve is Table 1's HGO-Yeoh law to the digits it is written with") {
  const Curve curve = abdomen();
  CHECK(curve.strain.size() == 31);
  CHECK(curve.strain.front() == 0);
  CHECK(curve.strain.back() == 0.6);
  for (std::size_t i = 0; i < curve.strain.size(); ++i)
    CHECK(std::abs(stress_at(table1_hgo_yeoh(), curve.strain[i]) - curve.stress[i]) <= 5.01e-7);
}

TEST_CASE(
    "Table 1, HGO-Yeoh: refitted within 0.5 percent on average and 2.5 percent at most, with the printed parameters") {
  const FitResult f = fit_uniaxial(abdomen(), hgo_yeoh, hgo_yeoh_parameters());
  CHECK(f.best.converged);
  CHECK(f.best.kkt <= 1e-8);
  CHECK(f.quality.mean_error_percent <= 0.5);
  CHECK(f.quality.max_error_percent <= 2.5);
  const double printed[] = {0.269, 0.376, 0.415, -0.317, 0.319};
  for (int i = 0; i < 5; ++i) CHECK(std::abs(f.best.p[i] - printed[i]) <= 5e-4);  // three decimals
  // one test along the fibre hardly separates matrix and fibre
  CHECK(f.covariance(0, 3) / std::sqrt(f.covariance(0, 0) * f.covariance(3, 3)) < -0.99);
}

TEST_CASE("Table 1, Yeoh: the printed column is 3/2 of a least-squares fit with the right stress") {
  const Curve curve = abdomen();
  const FitResult f = fit_uniaxial(curve, yeoh, yeoh_parameters());
  CHECK(f.best.converged);
  const Material printed{{Yeoh{-0.059, 0.291, 0.016}}, {}, volume};
  Material scaled{{Yeoh{-0.059 / 1.5, 0.291 / 1.5, 0.016 / 1.5}}, {}, volume};
  const auto error = [&](const Material& m) {
    return curve_error(
        uniaxial_curve(m, curve.strain, StressMeasure::cauchy, Dilatation::incompressible).value(),
        curve.stress);
  };
  // as printed: 1.718 MPa at 60 percent where the curve has 1.056
  CHECK(std::abs(stress_at(printed, 0.6) - 1.718) <= 5e-4);
  CHECK(error(printed).max_percent > 60);
  // two thirds of it: what the paper says of its fit (2.1 percent on average), and close to ours
  CHECK(std::abs(error(scaled).mean_percent - 2.1) <= 0.2);
  CHECK(error(scaled).mean_percent <= 1.2 * f.quality.mean_error_percent);
  // (-0.041, 0.199, 0.004): a3 is the soft combination, within one standard error of the paper's
  CHECK(f.best.p[0] == near(-0.059 / 1.5, 0.06));
  CHECK(f.best.p[1] == near(0.291 / 1.5, 0.03));
  CHECK(std::abs(f.best.p[2] - 0.016 / 1.5) <= std::sqrt(f.covariance(2, 2)));
}

TEST_CASE("Table 1, HGO: the printed column is -3/2 of a least-squares fit with the right stress") {
  const Curve curve = abdomen();
  const FitResult f = fit_uniaxial(curve, hgo, hgo_parameters());
  CHECK(f.best.converged);
  const Material printed{{NeoHooke{0.312}}, {hgo_fibre(-0.297, 0.087, 0)}, volume};
  const Material turned{{NeoHooke{-0.312 / 1.5}}, {hgo_fibre(0.297 / 1.5, 0.087, 0)}, volume};
  const auto error = [&](const Material& m) {
    return curve_error(
        uniaxial_curve(m, curve.strain, StressMeasure::cauchy, Dilatation::incompressible).value(),
        curve.stress);
  };
  CHECK(std::abs(stress_at(printed, 0.6) + 1.724) <= 5e-4);  // it pushes where the skin pulls
  CHECK(std::abs(error(turned).mean_percent - 2.5) <= 0.2);
  CHECK(f.best.p[0] == near(-0.312 / 1.5, 0.04));
  CHECK(f.best.p[1] == near(0.297 / 1.5, 0.04));
  CHECK(std::abs(f.best.p[2] - 0.087) <= std::sqrt(f.covariance(2, 2)));
}

TEST_CASE("with every modulus positive the best fit of the curve has no fibre") {
  const FitResult f = fit_uniaxial(abdomen(), hgo_yeoh, hgo_yeoh_parameters(0));
  CHECK(f.best.converged);
  CHECK(f.best.kkt <= 1e-8);
  CHECK(f.best.p[3] == 0);
  CHECK(f.best.at_bound[3]);
  CHECK(std::isnan(f.covariance(4, 4)));  // c2 of a fibre that is not there
  CHECK(f.best.p[0] == 0);
  const double cost = fit_uniaxial(abdomen(), yeoh, yeoh_parameters(0)).best.cost;
  CHECK(f.best.cost == near(cost, 1e-12));
}

TEST_CASE(
    "one percent of noise leaves errors of 44, 45, 8, 46 and 24 percent: one test along the fibre does not identify it") {
  // standard errors of the linearised problem for noise of 1 percent of the largest stress
  const Curve curve = abdomen();
  const FitResult f = fit_uniaxial(curve, hgo_yeoh, hgo_yeoh_parameters());
  const MatX J = f.best.J;
  const MatX cov = std::pow(0.01 * curve.stress.back(), 2) * (J.transpose() * J).inverse();
  const double percent[] = {44, 45, 8, 46, 24};
  for (int i = 0; i < 5; ++i)
    CHECK(std::abs(100 * std::sqrt(cov(i, i)) / std::abs(f.best.p[i]) - percent[i]) <= 0.5);
}

TEST_CASE("too few points and a curve without stress are refused") {
  Curve c;
  c.strain = {0.1, 0.2}, c.stress = {0.1, 0.2};
  CHECK_THROWS_AS(fit_uniaxial(c, yeoh, yeoh_parameters()), Failure);
  c.strain = {0.1, 0.2, 0.3}, c.stress = {0, 0, 0};
  CHECK_THROWS_AS(fit_uniaxial(c, yeoh, yeoh_parameters()), Failure);
}

}  // namespace uniaxial_fit_tests
