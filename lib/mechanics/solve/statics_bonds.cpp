// What Statics does where indenters adhere.
#include "mechanics/solve/statics.hpp"

namespace langer {

void Statics::begin_bonds() {
  bonds_.begin(now_.bonds, (t_ - now_.t) * options_.seconds);
  bonds_.evaluate(equilibrium_.mesh().X, u_, indenters(t_, travel_));
  jump_ = {};
}

// Called with what the last increment left in before_.
void Statics::accept_bonds() {
  const bool jumped = jump_.work_of_jumps != 0 || jump_.released != 0;
  now_.bonds = bonds_.after(r_, before_.r, u_, indenters(t_, travel_));
  now_.in_bonds = before_.in_bonds;
  if (jumped) {
    now_.in_bonds.dissipated += bonds_.dissipated_since(before_.bonds);
  } else {
    now_.in_bonds.dissipated += bonds_.dissipated();
  }
  now_.in_bonds.released += jump_.released;
  now_.in_bonds.work_of_jumps += jump_.work_of_jumps;
  now_.in_bonds.stored = stored();
}

void Statics::restore_trial(const Trial& trial) {
  u_ = trial.u;
  r_ = r_next_ = trial.r;
  K_current_ = factor_serves_ = again_ = false;
  equilibrium_.pressures_from(u_);
  bonds_.evaluate(equilibrium_.mesh().X, u_, indenters(t_, travel_));
}

double Statics::stored() const { return equilibrium_.W() + bonds_.stored(); }

double Statics::work_of_loads(const VecX& from) const {
  if (equilibrium_.loads().empty()) return 0;
  return equilibrium_.f_ext().dot(u_ - from);
}

}  // namespace langer
