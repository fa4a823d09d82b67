// Homogeneous tests of a sheet against exact states, and where Table 1's law stops being stable.
#include "mechanics/material/stability.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <ctime>

#include "core/base/random.hpp"
#include "material/catalogue.hpp"
#include "mechanics/material/at_rest.hpp"
#include "mechanics/material/ellipticity.hpp"
#include "support/near.hpp"
#include "support/slow_build.hpp"

using namespace langer;

namespace {

std::vector<double> amounts(double to, int n) {
  std::vector<double> x;
  for (int i = 0; i < n; ++i) x.push_back(to * i / (n - 1));
  return x;
}

double stress(double alpha, Path path, double amount) {
  return on_path(positive_hgo_yeoh(alpha), path, amount).cauchy;
}

}  // namespace

TEST_CASE("the tests of a sheet have the exact stresses") {
  // three independent codes, to the digits given
  CHECK(stress(0, Path::uniaxial, 0.1) == near(0.083312, 1e-5));
  CHECK(stress(0, Path::uniaxial, 0.4) == near(0.740122, 1e-6));
  CHECK(stress(30, Path::uniaxial, 0.4) == near(0.443926, 2e-6));
  CHECK(stress(60, Path::uniaxial, 0.4) == near(0.244924, 2e-6));
  CHECK(stress(0, Path::equibiaxial, 0.2) == near(0.314544, 2e-6));
  CHECK(stress(90, Path::equibiaxial, 0.4) == near(0.855348, 1e-6));
  CHECK(stress(0, Path::simple_shear, 0.5) == near(0.078750, 1e-5));
  CHECK(stress(45, Path::simple_shear, 0.5) == near(0.184156, 2e-6));
  CHECK(stress(90, Path::simple_shear, 0.5) == near(0.104223, 2e-6));
}

TEST_CASE("the work of a path is the derivative of the energy, in every test and fibre direction") {
  for (const NamedMaterial& m : catalogue())
    for (Path path : all_paths)
      for (double x : {0.07, 0.31}) {
        CAPTURE(m.name);
        CAPTURE(static_cast<int>(path));
        CAPTURE(x);
        constexpr double h = 1e-5;
        const double dW =
            (on_path(m.material, path, x + h).W - on_path(m.material, path, x - h).W) / (2 * h);
        const double work = on_path(m.material, path, x).work * (path == Path::equibiaxial ? 2 : 1);
        CHECK(work == near(dW, 1e-7));
      }
}

TEST_CASE("Table 1 along the fibre: the stress peaks at 1.627 and is negative from 1.73") {
  const Material m = table1_hgo_yeoh();
  const auto sigma = [&](double l) {
    return on_path(m, Path::uniaxial, l - 1).cauchy;
  };
  CHECK(sigma(1.627) == near(1.091, 5e-4));
  CHECK(sigma(1.627) > sigma(1.6265));
  CHECK(sigma(1.627) > sigma(1.6275));
  CHECK(sigma(1.725) > 0);
  CHECK(sigma(1.735) < 0);
  // the nominal stress falls earlier, and first near 1.1 where c1 < 0 softens the pull
  const PathStability s = path_stability(m, Path::uniaxial, amounts(0.8, 81));
  CHECK(s.slope_loss == near(0.0955, 0.2));
}

TEST_CASE("Table 1 loses strong ellipticity where an independent scan found it") {
  const auto lost = [](double alpha, Path path, double to) {
    return path_stability(table1_hgo_yeoh(alpha), path, amounts(to, 51)).ellipticity_loss;
  };
  // the scan named the first unstable state on a grid of 0.01
  const auto on_grid = [&](double alpha, Path path, double to) {
    return std::ceil(100 * lost(alpha, path, to)) / 100;
  };
  CHECK(on_grid(0, Path::uniaxial, 1) == 0.64);
  CHECK(on_grid(15, Path::uniaxial, 2) == 0.64);
  CHECK(on_grid(45, Path::uniaxial, 2) == 1.43);
  CHECK(on_grid(0, Path::equibiaxial, 1) == 0.85);
  CHECK(on_grid(45, Path::simple_shear, 1.5) == 1.10);
  CHECK(lost(0, Path::uniaxial, 1) == near(0.638, 1e-3));
  CHECK(lost(45, Path::uniaxial, 2) == near(1.424, 1e-3));
  CHECK(lost(0, Path::equibiaxial, 1) == near(0.844, 1e-3));
  CHECK(lost(45, Path::simple_shear, 1.5) == near(1.093, 1e-3));
}

TEST_CASE(
    "the map: losses by direction, the plane of stretches, the safe radius, whatever the number of threads") {
  StabilityOptions options;
  options.points = 21, options.angles = {0, 45}, options.stretches = 9, options.threads = 3;
  const StabilityMap map = stability_map(table1_hgo_yeoh(30), options);  // turned to 0 and 45
  CHECK(map.stretch.front() == options.stretch_from);
  CHECK(map.stretch.back() == near(options.stretch_to));
  REQUIRE(map.paths.size() == 8);
  CHECK(map.paths[0].ellipticity_loss == near(0.638, 2e-3));
  CHECK(std::isinf(map.paths[1].ellipticity_loss));  // 1.42 lies beyond
  CHECK(map.plane.minCoeff() < 0);
  CHECK(map.plane(2, 2) > 0);  // near rest
  CHECK(map.safe_hencky > 0.3);
  CHECK(map.safe_hencky <= std::sqrt(1.5) * std::log(1.638) + 1e-3);
  options.threads = 1;
  const StabilityMap again = stability_map(table1_hgo_yeoh(30), options);
  CHECK((map.plane.array() == again.plane.array()).all());
  CHECK(map.safe_hencky == again.safe_hencky);

  Material positive = table1_hgo_yeoh();
  std::get<HgoFibre>(positive.fibres[0].law).c1 = 0.317;
  CHECK(std::isinf(safe_hencky(positive, 1.2)));
  for (Path path : all_paths)
    for (double alpha : {0., 30., 90.}) {
      positive.fibres[0].alpha_deg = alpha;
      const PathStability s = path_stability(positive, path, amounts(0.8, 17));
      CHECK(std::isinf(s.ellipticity_loss));
      if (path == Path::uniaxial) CHECK(std::isinf(s.slope_loss));
    }
  CHECK(safe_hencky({{Yeoh{-0.059, 0.291, 0.016}}, {}, {QuadraticVolume{1}}}, 1.2) ==
        0);  // unstable at rest
}

namespace {

// moduli >= 0, up to two families with any exponent and dispersion: polyconvex
Material polyconvex(Random& random) {
  const auto up_to = [&](double x) {
    return x * random.uniform();
  };
  Material m;
  switch (random.below(3)) {
    case 0:
      m.matrix = {Yeoh{up_to(0.1), up_to(0.1), up_to(0.1)}};
      break;
    case 1:
      m.matrix = {Yeoh{0, up_to(0.1), up_to(0.01)}};  // without stiffness at rest
      break;
    default:
      m.matrix = {MooneyRivlin{up_to(0.1), up_to(0.1)}};
  }
  for (std::uint64_t k = random.below(3); k > 0; --k) {
    Fibre f{HgoFibre{up_to(2), std::pow(10, up_to(2))}, up_to(180)};
    f.kappa = random.below(2) ? up_to(1. / 3) : 0;
    m.fibres.push_back(f);
  }
  m.volume = {QuadraticVolume{1e-3}};
  return m;
}

}  // namespace

TEST_CASE("a law that is polyconvex is nowhere said to be unstable, however stiff its fibres get") {
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    Random random(17, trial);
    const Material m = polyconvex(random);
    const auto a = fibre_directions(m);
    CAPTURE(trial);
    for (int state = 0; state < 10; ++state) {
      const Mat3 F =
          Mat3::Identity() + 0.5 * Mat3::NullaryExpr([&] { return random.uniform() - 0.5; });
      if (F.determinant() < 0.1) continue;
      const double s = smallest_shear_stiffness(m, F / std::cbrt(F.determinant()), a).value;
      CHECK_FALSE(std::isless(s, 0));  // no number is no loss
    }
    if (trial % 20) continue;
    CHECK(std::isinf(safe_hencky(m, 1.2)));
    for (Path path : all_paths)
      CHECK(std::isinf(path_stability(m, path, amounts(1, 11)).ellipticity_loss));
  }
}

TEST_CASE("a stiff fibre hides no loss of the matrix across it") {
  // along the fibre the tangent is 1e12 times as stiff as the matrix, whose shear modulus is
  // negative
  const Material m{{Yeoh{-0.01, 0, 0}}, {Fibre{HgoFibre{1, 5}, 0}}, {QuadraticVolume{1e-3}}};
  const Mat3 F = Vec3(1.9, 1 / std::sqrt(1.9), 1 / std::sqrt(1.9)).asDiagonal();
  const ShearStiffness s = smallest_shear_stiffness(m, F, fibre_directions(m));
  CHECK(s.value ==
        near(-0.02 / 1.9, 1e-6));  // waves in the plane across the fibre, n.b n = 1 / 1.9
}

TEST_CASE("where a law has no number it is not said to be lost") {
  const Material m{{Yeoh{0.01, 0.03, 0}}, {Fibre{HgoFibre{0.02, 100}, 0}}, {QuadraticVolume{1e-3}}};
  const PathStability s = path_stability(m, Path::uniaxial, amounts(1, 51));
  CHECK(std::isinf(s.slope_loss));
  CHECK(std::isinf(s.ellipticity_loss));
  CHECK(s.end == near(std::sqrt(1 + std::sqrt(3.)) - 1, 1e-3));  // 100 (lambda^2 - 1)^2 = 300
  const HenckyReach reach = hencky_reach(m, 1.2);
  CHECK(std::isinf(reach.safe));
  CHECK(reach.end < 1.2);
}

TEST_CASE(
    "the map takes seconds where fibres are stiff, and a law without stiffness at rest loses nothing on it") {
  for (double a1 : {0.01, 0.}) {
    const std::clock_t began = std::clock();
    StabilityOptions options;
    options.points = 51, options.stretches = 41;
    const StabilityMap map = stability_map(
        {{Yeoh{a1, 0.03, 0}}, {Fibre{HgoFibre{0.02, 10}, 0}}, {QuadraticVolume{1e-3}}}, options);
    CHECK(static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC < 10 * test::stride);
    CHECK(std::isinf(map.safe_hencky));
    for (const PathStability& p : map.paths) {
      CHECK(std::isinf(p.ellipticity_loss));
      if (p.path == Path::uniaxial) CHECK(std::isinf(p.slope_loss));
    }
  }
}

TEST_CASE("stiffness at rest is that of the matrix alone") {
  const Material with{{Yeoh{1e-6, 1, 0}}, {Fibre{HgoFibre{5, 1}, 0}}, {QuadraticVolume{1}}};
  CHECK(at_rest(with) == AtRest::stiff);
  CHECK(at_rest_in_words(with).empty());
  const Material without{
      {Yeoh{0, 1, 0}}, {Fibre{HgoFibre{5, 1}, 0}, Fibre{HgoFibre{5, 1}, 60}}, {QuadraticVolume{1}}};
  CHECK(at_rest(without) == AtRest::without_stiffness);
  CHECK(at_rest_in_words(without) ==
        "no stiffness at rest: the shear modulus of yeoh is 0 MPa there");
  CHECK(stiffness_at_rest_cure(without).starts_with("matrix.yeoh.a1 other than 0"));
  CHECK(at_rest({{MooneyRivlin{0.1, -0.1}}, {}, {QuadraticVolume{1}}}) ==
        AtRest::without_stiffness);
  CHECK(at_rest({{Yeoh{-0.059, 0.291, 0.016}}, {}, {QuadraticVolume{1}}}) == AtRest::unstable);
  CHECK(at_rest({{}, {Fibre{HgoFibre{5, 1}, 0}}, {QuadraticVolume{1}}}) ==
        AtRest::without_stiffness);
}
