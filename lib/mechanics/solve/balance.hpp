// Whether the trial state of an increment is in equilibrium: its residual on the free rows, the
// forces it is compared with, the law of contact, and the force of a pushed indenter. Forces are
// those of the last assembly.
#pragma once

#include "mechanics/solve/increment_state.hpp"

namespace langer {

VecX free_residual(const IncrementState& state);    // -(F_int - F_ext - R) on the free rows [N]
VecX trial_reactions(const IncrementState& state);  // (3 n) at supports and contact nodes [N]
double force_scale(const IncrementState& state);    // size of the forces that act on the body [N]
bool contact_law_holds(const IncrementState& state, const VecX& u);
bool force_is_given(const IncrementState& state);  // on the indenter under force control
bool slips_away(const IncrementState& state);      // a body that contact alone holds

}  // namespace langer
