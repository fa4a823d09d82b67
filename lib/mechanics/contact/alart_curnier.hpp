// The contact law of one candidate as the root of a function, for Newton's method.        [AC91]
//   r reaction [N], x gap and slip [mm], both (n, t1, t2);   any rho > 0 [N/mm]
//   A = r_n - rho x_n,   s = r_t - rho x_t
//   F_n = r_n - max(0, A),   F_t = r_t - (s, or where |s| > mu A its shortened mu A s / |s|)
// F = 0 holds exactly where r and x satisfy Signorini's and Coulomb's laws. The function has a kink
// between open (A <= 0), stick (|s| <= mu A) and slip; each state has a derivative of its own, so
// that Newton's method is a semismooth one.
#pragma once

#include "core/tensor/types.hpp"
#include "mechanics/contact/coulomb_cone.hpp"

namespace langer {

class AlartCurnier {
 public:
  AlartCurnier(const Vec3& r, const Vec3& x, double rho, double mu) : mu_(mu) {
    const double A = r[0] - rho * x[0];
    if (A <= 0) {
      F = r;
      status = ContactStatus::open;
      return;
    }
    F = rho * x;
    status = ContactStatus::stick;
    const Eigen::Vector2d s = r.tail<2>() - rho * x.tail<2>();
    const double radius = mu * A;
    const double size = s.norm();
    if (size <= radius) return;
    status = ContactStatus::slip;
    direction_ = s / size;
    turn_ = (radius / size) * (Eigen::Matrix2d::Identity() - direction_ * direction_.transpose());
    F.tail<2>() = r.tail<2>() - radius * direction_;
  }

  Vec3 F;
  ContactStatus status;

  // Change of F where r changes by dr and rho x by rho_dx, column by column.
  template <int n>
  Eigen::Matrix<double, 3, n> change(const Eigen::Matrix<double, 3, n>& dr,
                                     const Eigen::Matrix<double, 3, n>& rho_dx) const {
    if (status == ContactStatus::open) return dr;
    Eigen::Matrix<double, 3, n> dF = rho_dx;
    if (status == ContactStatus::slip)
      dF.template bottomRows<2>() =
          dr.template bottomRows<2>() -
          mu_ * direction_ * (dr.template topRows<1>() - rho_dx.template topRows<1>()) -
          turn_ * (dr.template bottomRows<2>() - rho_dx.template bottomRows<2>());
    return dF;
  }

 private:
  double mu_;
  Eigen::Vector2d direction_;  // of s
  Eigen::Matrix2d turn_;       // derivative of the projection across it
};

}  // namespace langer
