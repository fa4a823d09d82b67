#include "mechanics/contact/adhesion.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

Adhesive adhesive(const Adhesion& law, const ShapePoint& shape, const Vec3& v, const Bond& bond,
                  double viscous) {
  Adhesive out;
  if (!bond.made) return out;
  const Vec3& n = shape.normal;
  const double g = std::max(shape.gap, 0.0);
  const Vec3 slip = v - bond.at;
  const double slip_n = slip.dot(n);
  // 1/2 grad of |slip_t|^2 = |slip|^2 - slip_n^2, with dn = curvature dx
  const Vec3 m = n + shape.curvature * slip;
  const double s = law.stiffness * g * g + law.tangential * (slip.squaredNorm() - slip_n * slip_n);
  const Vec3 ds = 2 * (law.stiffness * g * n + law.tangential * (slip - slip_n * m));
  Mat3 dds =
      2 * law.tangential * (Mat3::Identity() - m * m.transpose() - 2 * slip_n * shape.curvature);
  if (g > 0) dds += 2 * law.stiffness * (n * n.transpose() + g * shape.curvature);
  out.beta = bond.beta;
  double softening = 0;  // -d beta/ds / beta
  const bool loosens = bond.beta * s > law.work,
             heals = law.healing && bond.beta < 1 && bond.beta * s < law.work;
  if ((loosens || heals) && std::isfinite(viscous)) {
    const double towards = viscous * bond.beta + law.work;
    if (towards < viscous + s) {
      out.beta = towards / (viscous + s);
    } else {
      out.beta = 1;
    }
    if (out.beta < 1) softening = 1 / (viscous + s);
  }
  out.force = -0.5 * out.beta * out.beta * ds;
  out.tangent = -out.beta * out.beta * (0.5 * dds - softening * ds * ds.transpose());
  out.stored = 0.5 * out.beta * out.beta * s;
  const double loosened = bond.beta - out.beta;
  out.dissipated =
      law.work * loosened + (std::isfinite(viscous) ? viscous * loosened * loosened : 0);
  return out;
}

}  // namespace langer
