// What the contact law makes a candidate do, by its reaction r and its gap and slip x, local: as in
// contact/alart_curnier.hpp with the trial reaction r - rho x.
//   open     r_n - rho x_n <= 0
//   sticks   |r_t - rho x_t| <= mu (r_n - rho x_n)
//   slips    else; linearised  r_t = mu r_n e - k (1 - e e^T) x_t,
//            e the direction of r_t - rho x_t,  k = rho p / (1 - p),
//            p = mu (r_n - rho x_n) / |r_t - rho x_t|
// Of frictionless contact slip is all that is closed.
#pragma once

#include "core/tensor/types.hpp"
#include "mechanics/contact/coulomb_cone.hpp"

namespace langer {

struct LawStatus {
  ContactStatus status = ContactStatus::open;
  Eigen::Vector2d e = Eigen::Vector2d::Zero();
  double k = 0;
};

// rho: of the order of a stiffness [N/mm]
LawStatus law_status(const Vec3& r, const Vec3& x, double mu, double rho);

// Shortens the tangential part of a reaction that is past Coulomb's cone, and puts that of a
// candidate that slips exactly on it.
void put_on_cone(Vec3& r, double mu, bool slips);

// 1 - e e^T
Eigen::Matrix2d across_direction(const Eigen::Vector2d& e);

}  // namespace langer
