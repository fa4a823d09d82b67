#include "export/rigid_cap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace langer {

namespace {

// Components that are rounding errors become 0.
double direction_without_rounding(double x) {
  if (std::abs(x) < 1e-12) return 0;
  return x;
}

}  // namespace

RigidCap rigid_cap(const Ball& sphere, const Vec3& towards, const std::vector<Vec3>& places,
                   double side) {
  const Vec3 centre = sphere.centre;
  const double R = sphere.radius;
  const double degree = std::numbers::pi / 180;
  // (e1, e2) span the plane across `towards`. e1 is close to the axis most perpendicular to it.
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(towards[k]) < std::abs(towards[axis])) axis = k;
  const Vec3 e1 = (Vec3::Unit(axis) - towards[axis] * towards).normalized();
  const Vec3 e2 = towards.cross(e1);

  // The rectangle of the places in this plane, and the polar angle of the rim around them.
  Eigen::Vector2d low(1e300, 1e300);
  Eigen::Vector2d high(-1e300, -1e300);
  double farthest = 0;
  for (const Vec3& x : places) {
    const Eigen::Vector2d p((x - centre).dot(e1), (x - centre).dot(e2));
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    farthest = std::max(farthest, p.norm());
  }
  const double margin = 0.1 * R + side;
  const double rim = std::min(75 * degree, std::asin(std::min(0.99, farthest / R)) + 10 * degree);
  // At least six facets from the pole to the rim, so that the cap is round.
  const int n = std::max(6, static_cast<int>(std::ceil(rim * R / side)));

  // A square grid whose lines become circles towards the rim. r is 0 at the pole and 1 at the
  // rim.
  RigidCap cap;
  cap.side = rim * R / n;
  const double raised = R + cap.side * cap.side / (6 * R);
  const int row = 2 * n + 1;
  std::vector<Vec3> direction;
  for (int j = -n; j <= n; ++j)
    for (int i = -n; i <= n; ++i) {
      const Eigen::Vector2d q(static_cast<double>(i) / n, static_cast<double>(j) / n);
      const double r = q.cwiseAbs().maxCoeff();
      const double round = 0.5 * r;
      if (r == 0) {
        direction.push_back(towards);
        continue;
      }
      // |q| keeps the grid square, r makes its lines circles. The weight of r grows from the pole
      // to the rim.
      const double polar = rim * q.norm() * (1 - round + round * r / q.norm());
      const Eigen::Vector2d d = q.normalized();
      direction.push_back(std::cos(polar) * towards + std::sin(polar) * (d[0] * e1 + d[1] * e2));
    }
  // Only facets close to the rectangle are kept. Their points are numbered in order of first use.
  std::vector<int> number(direction.size(), -1);
  for (int j = 0; j < 2 * n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const int at = j * row + i;
      std::array<int, 4> corners{at, at + 1, at + row + 1, at + row};
      Eigen::Vector2d least(1e300, 1e300);
      Eigen::Vector2d most(-1e300, -1e300);
      for (int c : corners) {
        const Eigen::Vector2d p(R * direction[c].dot(e1), R * direction[c].dot(e2));
        least = least.cwiseMin(p);
        most = most.cwiseMax(p);
      }
      if ((least.array() > high.array() + margin).any() ||
          (most.array() < low.array() - margin).any())
        continue;
      for (int& c : corners) {
        if (number[c] < 0) {
          number[c] = static_cast<int>(cap.outer.size());
          const Vec3 d = direction[c].unaryExpr(&direction_without_rounding);
          cap.outer.push_back(centre + raised * d);
          cap.inner.push_back(centre + 0.8 * R * d);
        }
        c = number[c];
      }
      cap.facets.push_back(corners);
    }
  return cap;
}

}  // namespace langer
