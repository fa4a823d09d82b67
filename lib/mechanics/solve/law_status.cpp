#include "mechanics/solve/law_status.hpp"

#include <algorithm>

namespace langer {

LawStatus law_status(const Vec3& r, const Vec3& x, double mu, double rho) {
  LawStatus out;
  const double A = r[0] - rho * x[0];
  if (!(A > 0)) return out;
  out.status = ContactStatus::slip;
  if (mu == 0) return out;
  const Eigen::Vector2d s = r.tail<2>() - rho * x.tail<2>();
  if (s.norm() <= mu * A) {
    out.status = ContactStatus::stick;
    return out;
  }
  const double share = std::min(mu * A / s.norm(), 1 - 1e-6);
  out.e = s.normalized();
  out.k = share * rho / (1 - share);
  return out;
}

void put_on_cone(Vec3& r, double mu, bool slips) {
  const double tangential = r.tail<2>().norm();
  const double most = mu * r[0];
  if (tangential > most || (slips && tangential > 0)) r.tail<2>() *= most / tangential;
}

Eigen::Matrix2d across_direction(const Eigen::Vector2d& e) {
  return Eigen::Matrix2d::Identity() - e * e.transpose();
}

}  // namespace langer
