// A body at an accepted state, linearised for small movements about it.
//
// Contact is frozen as it is there: a node that sticks moves with its indenter, one that slips
// stays on the indenter's surface and glides along it without a change of friction, an open one is
// free. What is left of the movements of the body are columns of a matrix P,
//   u = P q,        A = P' K P - R' B R,        M = P' M P
// B is the turning of the contact reactions on a curved indenter, and R what of a movement is
// relative to the indenter. Where something drives the body, its movement by 1 mm along its
// direction is the last column of P. A, M and what follows from them are those of the whole body,
// also where symmetry reduces it or a section stands for a circle.
//                                                              docs/vibration.md
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/solve/increment.hpp"
#include "mechanics/vibration/eigenpairs.hpp"

namespace langer {

// What oscillates: an indenter, or nodes of the body as a whole.
struct Driver {
  int contact = -1;           // index of Increment::contacts(), or
  std::vector<int> nodes;     // of the body that is solved, which have unknowns of their own
  Vec3 along = Vec3::Zero();  // of length 1
};

class FrozenBody {
 public:
  // dofs: the constraints of the movements: those of the body, or of movements that break its
  // symmetry. symmetric: movements of the former kind, in which an indenter under force control
  // takes part. density: by body [t/mm3]. Refers to body.
  // Throws std::invalid_argument with a text for users where the driver cannot move as it should.
  FrozenBody(Assembler& body, const Increment& increment, const std::vector<double>& density,
             Dofs dofs, bool symmetric, const std::optional<Driver>& driver = {});

  bool driven() const { return driven_; }
  Eigen::Index size() const { return P_.cols(); }
  // A, at the state of the body and with the branches of its materials as they were begun last.
  SparseX stiffness();
  const SparseX& mass() const { return M_; }
  // u (3 n) of a vector of the movements that are left; of tied and hanging nodes 0.
  VecX displacements(const VecX& q) const;
  VecX coordinates(const VecX& u) const;  // q of the movement (3 n), as far as it is possible

 private:
  Assembler& body_;
  VecX u_;  // of the state
  OtherTangent tangent_;
  bool driven_ = false;
  SparseX P_, turning_, M_;
};

}  // namespace langer
