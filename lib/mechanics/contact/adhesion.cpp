#include "mechanics/contact/adhesion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/AutoDiff>

namespace langer {

namespace {

// How far a bond is open: s of the law, and its gradient.
struct Opening {
  double gap = 0;
  Vec3 slip = Vec3::Zero();  // since it bonded, along the normal as well
  double slip_n = 0;
  Vec3 m = Vec3::Zero();  // gradient of slip_n
  double s = 0;
  Vec3 ds = Vec3::Zero();
};

Opening opening_of(const Adhesion& law, const ShapePoint& shape, const Vec3& v, const Bond& bond) {
  Opening open;
  const Vec3& n = shape.normal;
  open.gap = std::max(shape.gap, 0.0);
  open.slip = v - bond.at;
  open.slip_n = open.slip.dot(n);
  // 1/2 grad of |slip_t|^2 = |slip|^2 - slip_n^2, with dn = curvature dx
  open.m = n + shape.curvature * open.slip;
  open.s = law.stiffness * open.gap * open.gap +
           law.tangential * (open.slip.squaredNorm() - open.slip_n * open.slip_n);
  open.ds =
      2 * (law.stiffness * open.gap * n + law.tangential * (open.slip - open.slip_n * open.m));
  return open;
}

// What the intensity at the end of an increment depends on.
enum On { start, opening_at_start, opening_at_end, work, viscosity, n_on };
using Gradient = Eigen::Matrix<double, n_on, 1>;
// a number with its derivatives by all of these
using Number = Eigen::AutoDiffScalar<Gradient>;

struct Intensity {
  double beta = 0;
  Gradient by = Gradient::Unit(start);
  double error = 0;  // by the length of the increment
};

Number backward_euler(const Number& beta, const Number& s, const Number& w, const Number& B) {
  return (B * beta + w) / (B + s);
}

// K = dt/b; falls: the bond cannot come back.
Number two_stages(const Number& beta, const Number& s_0, const Number& s_1, const Number& w,
                  const Number& K, bool falls) {
  const double gamma = 1 - std::sqrt(0.5);
  const Number s_g = (1 - gamma) * s_0 + gamma * s_1;
  Number beta_g = (beta + gamma * K * w) / (1 + gamma * K * s_g);
  if (falls && beta_g.value() > beta.value()) beta_g = beta;
  Number out =
      (beta + (1 - gamma) * K * (w - beta_g * s_g) + gamma * K * w) / (1 + gamma * K * s_1);
  if (!falls) return out;
  // it comes to rest where beta s = w, at the largest s that it meets
  if (out.value() > beta.value()) return beta;
  const Number& largest = s_1.value() > s_0.value() ? s_1 : s_0;
  if (out.value() * largest.value() < w.value()) return w / largest;
  return out;
}

// The difference from the exact solution for the mean of s. It shrinks with the third power of the
// increment. Where the bond follows s at once it would tell of s alone, and is left out.
double error_of(double beta, double beta_0, double mean, double w, double K) {
  const double rest = w / mean;
  const double exact = rest + (beta_0 - rest) * std::exp(-K * mean);
  return std::abs(beta - exact) / (1 + K * mean);
}

// A bond begins to come loose, or comes to rest, within an increment where beta_0 s passes w: then
// the part of the increment counts in which it comes loose.
Intensity of_second_order(const Adhesion& law, const Bond& bond, double s, double viscous) {
  const bool before = bond.beta * bond.opening > law.work;
  const bool after = bond.beta * s > law.work;
  const bool comes_back = law.healing && bond.beta < 1;
  if (!before && !after && !comes_back) return {bond.beta};
  const Number beta_0(bond.beta, Gradient::Unit(start));
  const Number w(law.work, Gradient::Unit(work));
  Number s_0(bond.opening, Gradient::Unit(opening_at_start));
  Number s_1(s, Gradient::Unit(opening_at_end));
  Number K = 1 / Number(viscous, Gradient::Unit(viscosity));
  const Number rest = w / beta_0;
  if (after && !before && !comes_back) {
    K = K * (s_1 - rest) / (s_1 - s_0);
    s_0 = rest;
  } else if (before && !after && !law.healing) {
    K = K * (s_0 - rest) / (s_0 - s_1);
    s_1 = rest;
  }
  const Number beta = two_stages(beta_0, s_0, s_1, w, K, !law.healing);
  if (!(beta.value() < 1)) return {1, Gradient::Zero()};
  const double mean = 0.5 * (s_0.value() + s_1.value());
  const double error = error_of(beta.value(), bond.beta, mean, law.work, K.value());
  return {beta.value(), beta.derivatives(), error};
}

Intensity intensity_of(const Adhesion& law, const Bond& bond, double s, double viscous) {
  if (!std::isfinite(viscous)) return {bond.beta};
  if (bond.opening >= 0 && viscous > 0) return of_second_order(law, bond, s, viscous);
  const bool loosens = bond.beta * s > law.work;
  const bool heals = law.healing && bond.beta < 1 && bond.beta * s < law.work;
  if (!(loosens || heals)) return {bond.beta};
  const Number beta = backward_euler(
      Number(bond.beta, Gradient::Unit(start)), Number(s, Gradient::Unit(opening_at_end)),
      Number(law.work, Gradient::Unit(work)), Number(viscous, Gradient::Unit(viscosity)));
  if (!(beta.value() < 1)) return {1, Gradient::Zero()};
  return {beta.value(), beta.derivatives()};
}

}  // namespace

double opening(const Adhesion& law, const ShapePoint& shape, const Vec3& v, const Bond& bond) {
  return opening_of(law, shape, v, bond).s;
}

Adhesive adhesive(const Adhesion& law, const ShapePoint& shape, const Vec3& v, const Bond& bond,
                  double viscous) {
  Adhesive out;
  if (!bond.made) return out;
  const Vec3& n = shape.normal;
  const Opening open = opening_of(law, shape, v, bond);
  Mat3 dds = 2 * law.tangential *
             (Mat3::Identity() - open.m * open.m.transpose() - 2 * open.slip_n * shape.curvature);
  if (open.gap > 0) dds += 2 * law.stiffness * (n * n.transpose() + open.gap * shape.curvature);
  const Intensity intensity = intensity_of(law, bond, open.s, viscous);
  out.beta = intensity.beta;
  out.error = intensity.error;
  out.force = -0.5 * out.beta * out.beta * open.ds;
  out.tangent = -out.beta * (0.5 * out.beta * dds +
                             intensity.by[opening_at_end] * open.ds * open.ds.transpose());
  out.stored = 0.5 * out.beta * out.beta * open.s;
  const double loosened = bond.beta - out.beta;
  out.dissipated =
      law.work * loosened + (std::isfinite(viscous) ? viscous * loosened * loosened : 0);
  return out;
}

// The product rule, term by term of opening_of() and intensity_of(), with the side of each switch
// on which the state is.
AdhesiveChange adhesive_change(const Adhesion& law, const ShapePoint& shape, const Vec3& v,
                               const Bond& bond, double viscous, const BondChange& change) {
  AdhesiveChange out;
  if (!bond.made) return out;
  const Vec3& n = shape.normal;
  const Opening open = opening_of(law, shape, v, bond);
  const Vec3 d_slip = change.v - change.at;
  const Vec3 d_n = shape.curvature * change.v + change.shape.normal;
  double d_gap = 0;
  if (open.gap > 0) d_gap = n.dot(change.v) + change.shape.gap;
  const double d_slip_n = d_slip.dot(n) + open.slip.dot(d_n);
  const Vec3 d_m = d_n + shape.curvature * d_slip + change.shape.curvature * open.slip;
  const double slip_t = open.slip.squaredNorm() - open.slip_n * open.slip_n;
  const Vec3 towards_slip = open.slip - open.slip_n * open.m;
  const double d_s = 2 * law.stiffness * open.gap * d_gap +
                     2 * law.tangential * (open.slip.dot(d_slip) - open.slip_n * d_slip_n) +
                     change.law.stiffness * open.gap * open.gap + change.law.tangential * slip_t;
  const Vec3 d_ds =
      2 * law.stiffness * (d_gap * n + open.gap * d_n) +
      2 * law.tangential * (d_slip - d_slip_n * open.m - open.slip_n * d_m) +
      2 * (change.law.stiffness * open.gap * n + change.law.tangential * towards_slip);
  const Intensity now = intensity_of(law, bond, open.s, viscous);
  out.opening = d_s;
  out.beta = now.by[start] * change.beta + now.by[opening_at_start] * change.opening +
             now.by[opening_at_end] * d_s + now.by[work] * change.law.work +
             now.by[viscosity] * change.viscous;
  out.force = -now.beta * out.beta * open.ds - 0.5 * now.beta * now.beta * d_ds;
  return out;
}

}  // namespace langer
