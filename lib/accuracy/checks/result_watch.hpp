// What a converged state may get wrong all the same; looked at after every accepted increment.
//   formulation  cells that lock or are too soft (locking.hpp)
//   rounding     a tolerance raised to what rounding leaves of the residual, and a residual that is not small beside the reactions
//   branches     points of a viscous body where the work against them is negative: the law has given that for nothing
//   chains       those of arruda_boyce beyond their locking stretch, where the series of five terms goes on
// Nothing is computed for a body whose formulation, stiffness and law give no reason for it.
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
  double reactions_ = 0, asked_ = 0;   // largest on the path [N]
  double raised_ = 0, raised_at_ = 0;  // largest tolerance that was, and where
  double chains_ = 0, locking_stretch_ = 0;
  Vec3 chains_place_ = Vec3::Zero();
  double given_ = 0, given_at_ = 0;  // largest share of the volume with such points, and where
  Vec3 given_place_ = Vec3::Zero();
};

}  // namespace langer
