// The matrices of the condensed contact problem (solve/contact_linearisation.hpp).
//
// A force s on the candidates moves them by W s, the compliance
//   W = B^T K^-1 B,   B: frames of the candidates in the rows that are eliminated last
// The factor of the body ends with the Cholesky factor of these rows' Schur complement, so W costs
// solutions with that small factor only (linear/linear.hpp).
#pragma once

#include <vector>

#include "mechanics/solve/contact_linearisation.hpp"

namespace langer {

// a candidate whose law is looked at
struct Near {
  std::size_t contact, candidate;
  LinearisedContact law;
  Vec3 r, move;  // local: present reaction, movement without any change of reaction
};

// A force change s on the body moves the near candidates by  d = move + W s  and leaves the
// reactions  r = present + s - E d.
struct Condensed {
  MatX B, W;                  // of forces on the rows of last(); compliance
  VecX move, present, q, mu;  // q: positions without movement
  std::vector<Mat3> T,
      E;  // the law feels q + T d; force that follows the movement: turning frame, and springs
  bool follows = false;  // some E is not 0
  VecX along;  // under force control: of its candidates its direction, of others 0; else empty
  std::vector<Mat3> springs;  // their part of E, where there are any
  VecX start_moves;  // under force control: what slip is measured from, per travel; empty without
                     // friction
  MatX slipping(MatX M) const {  // T times the rows of each contact
    for (std::size_t p = 0; p < T.size(); ++p) {
      const auto row = 3 * static_cast<Eigen::Index>(p);
      M.middleRows<3>(row) = (T[p] * M.middleRows<3>(row)).eval();
    }
    return M;
  }
};

Condensed condensed(const ContactState& state, const TangentFactor& factor,
                    const std::vector<Near>& near);

}  // namespace langer
