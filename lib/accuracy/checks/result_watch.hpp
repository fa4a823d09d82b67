// Errors that a converged state may contain; checked after every accepted increment.
//   formulation  cells that lock or are too soft (locking.hpp)
//   rounding     a tolerance that was raised to the rounding error of the residual; a residual that
//                is not small compared with the reactions
//   branches     points of a viscous body where the work against branches is negative: the model
//                creates energy there
//   chains       of arruda_boyce beyond their locking stretch, where its series of five terms still
//                has a value
// A check costs nothing where formulation, stiffness and law give no reason for it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/checks/locking.hpp"
#include "core/base/error.hpp"
#include "mechanics/nonlinear/newton.hpp"

namespace langer {

class ResultWatch {
 public:
  explicit ResultWatch(const Assembler& body);
  void look(double t, const VecX& u, const SolveReport& report);
  // of the state looked at last: not to be kept
  std::optional<Error> refusal() const;
  // of the whole path
  std::vector<std::string> warnings() const;

 private:
  void look_at_chains(const VecX& u);
  void look_at_branches();
  std::string stiffness() const;    // of the volume: its key and number
  std::string soft_enough() const;  // such a key with a number that rounding bears

  const Assembler& body_;
  bool may_lock_, has_chains_;
  Volume stiffest_;  // of all materials
  Locking locking_;  // where the stored energy was largest
  double t_ = 0, residual_ = 0;
  double reactions_ = 0, asked_ = 0;  // largest on the path [N]
  struct Raised {                     // the largest tolerance that was
    double tolerance = 0, t = 0;      // [N]
  };
  Raised raised_;
  struct Chains {  // that are longest for their locking stretch
    double stretch = 0, locking_stretch = 0;
    Vec3 place = Vec3::Zero();
  };
  Chains chains_;
  struct Given {              // where branches give energy
    double share = 0, t = 0;  // largest of the volume
    Vec3 place = Vec3::Zero();
  };
  Given given_;
};

}  // namespace langer
