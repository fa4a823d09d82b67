// The sampled shear stiffness of eight points at once against the exact one.
#include "mechanics/element/point_check.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <random>

#include "mechanics/material/ellipticity.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE(
    "eight points at once: never below the exact smallest shear stiffness and close above it") {
  Material two = test::table1(20, 1e-4);
  two.fibres.push_back(Fibre{HgoFibre{0.4, 2}, -50, FibreSwitch::off, 0.1});
  Material general;  // a law of I2, point by point
  general.matrix = {MooneyRivlin{0.2, 0.1}};
  general.volume = QuadraticVolume{1e-3};
  Material toe = test::stable(35, 1e-6);
  toe.fibres = {{PowLinearFibre{0.4, 1.1, 3}, 35}, {ExpPowFibre{0.3, 0.8, 2.5}, -50}};
  ElementNodes X(8, 3);
  for (int a = 0; a < 8; ++a)
    for (int k = 0; k < 3; ++k) X(a, k) = 0.5 * Hex8::corner[a][k];
  const ElementGeometry geometry = element_geometry(X);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.15, 0.15);
  double worst = 0;
  int lost = 0;
  int spared = 0;
  for (const Material& material :
       {test::table1(0, 1e-6), test::stable(35, 1e-6), two, toe, general}) {
    const std::vector<Vec3> a = fibre_directions(material);
    for (int trial = 0; trial < 20; ++trial) {
      ElementNodes u(8, 3);
      for (int i = 0; i < 24; ++i) u(i / 3, i % 3) = uniform(random);
      u.col(0) += 0.8 * trial / 20 * X.col(0),
          u.rightCols<2>() -= 0.25 * trial / 20 * X.rightCols<2>();
      PointCheck points;
      check_points(material, geometry, a, u, points);
      // where only points below a limit are asked for, none of these is left out
      for (double enough : {-0.1, 0., 0.05, 0.2}) {
        PointCheck some;
        check_points(material, geometry, a, u, some, enough);
        for (int g = 0; g < 8; ++g) {
          if (some.stiffness[g] == points.stiffness[g]) continue;
          ++spared;
          CHECK(some.stiffness[g] == std::numeric_limits<double>::max());
          CHECK(points.stiffness[g] > std::max(enough, 0.));
        }
      }
      for (int g = 0; g < 8; ++g) {
        if (points.J[g] < 0.3) continue;
        CHECK(points.J[g] == near(points.F[g].determinant()));
        const double exact = smallest_shear_stiffness(material, points.F[g], a).value;
        double most =
            -1e300;  // the spread of A over the normals is what the grid's error is measured by
        for (int i = 0; i < 96; ++i)
          most = std::max(most, std::abs(sampled_shear_stiffness(material, points.F[g], a, 1 + i)));
        CHECK(points.stiffness[g] > exact - 1e-6 * most);
        worst = std::max(worst, (points.stiffness[g] - exact) / most);
        lost += exact < 0;
      }
    }
  }
  MESSAGE("largest error of the grid: " << worst << " of the spread; " << lost
                                        << " points without strong ellipticity");
  CHECK(worst < 0.1);
  CHECK(lost > 5);
  CHECK(spared > 100);
}
