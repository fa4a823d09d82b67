#include "mechanics/contact/adhesion.hpp"

#include <algorithm>
#include <cmath>

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

// The intensity at the end of an increment.
struct Intensity {
  double beta = 0;
  bool follows = false;  // what opens the bond; else it stays, or is whole again
  bool whole = false;
};

Intensity intensity_of(const Adhesion& law, const Bond& bond, double s, double viscous) {
  const bool loosens = bond.beta * s > law.work;
  const bool heals = law.healing && bond.beta < 1 && bond.beta * s < law.work;
  if (!(loosens || heals) || !std::isfinite(viscous)) return {bond.beta};
  const double towards = viscous * bond.beta + law.work;
  if (!(towards < viscous + s)) return {1, false, true};
  return {towards / (viscous + s), true};
}

}  // namespace

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
  double softening = 0;  // -d beta/ds / beta
  if (intensity.follows && out.beta < 1) softening = 1 / (viscous + open.s);
  out.force = -0.5 * out.beta * out.beta * open.ds;
  out.tangent = -out.beta * out.beta * (0.5 * dds - softening * open.ds * open.ds.transpose());
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
  if (now.follows) {
    const double d_towards = change.viscous * bond.beta + viscous * change.beta + change.law.work;
    out.beta = (d_towards - now.beta * (change.viscous + d_s)) / (viscous + open.s);
  } else if (!now.whole) {
    out.beta = change.beta;
  }
  out.force = -now.beta * out.beta * open.ds - 0.5 * now.beta * now.beta * d_ds;
  return out;
}

}  // namespace langer
