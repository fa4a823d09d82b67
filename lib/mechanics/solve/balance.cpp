#include "mechanics/solve/balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace langer {

VecX trial_reactions(const IncrementState& state) {
  VecX out = VecX::Zero(state.body.dofs().n);
  for (std::size_t k = 0; k < state.contacts.size(); ++k)
    for (std::size_t i = 0; i < state.trial.r[k].size(); ++i)
      out.segment<3>(3 * state.contacts[k].nodes[i]) += state.trial.r[k][i];
  if (!state.bonds.none()) state.bonds.add_forces(out);
  if (!state.surfaces.empty())
    state.surfaces.add_forces(state.body.mesh().X, state.trial.u, state.trial.r,
                              state.contacts.size(), out);
  // Where a support holds a node, internal forces balance contact and support together.
  for (const Prescribed& p : state.body.dofs().prescribed) out[p.dof] = state.body.f_int()[p.dof];
  if (!state.body.loads().empty())
    for (const Prescribed& p : state.body.dofs().prescribed)
      out[p.dof] -= state.body.f_ext()[p.dof];
  return out;
}

VecX free_residual(const IncrementState& state) {
  VecX f = -state.body.f_int();
  if (!state.body.loads().empty()) f += state.body.f_ext();
  if (!state.bonds.none()) state.bonds.add_forces(f);
  for (std::size_t k = 0; k < state.contacts.size(); ++k)
    for (std::size_t i = 0; i < state.contacts[k].nodes.size(); ++i)
      f.segment<3>(3 * state.contacts[k].nodes[i]) += state.trial.r[k][i];
  if (!state.surfaces.empty())
    state.surfaces.add_forces(state.body.mesh().X, state.trial.u, state.trial.r,
                              state.contacts.size(), f);
  return state.on_free_rows(f);
}

// Norm of reactions, contact forces and loads: the size to which a residual is compared.
double force_scale(const IncrementState& state) {
  double sum = 0;
  for (const Prescribed& p : state.body.dofs().prescribed)
    sum += std::pow(state.body.f_int()[p.dof], 2);
  for (const auto& r : state.trial.r)
    for (const Vec3& r_i : r) sum += r_i.squaredNorm();
  if (!state.body.loads().empty()) sum += state.body.f_ext().squaredNorm();
  if (!state.bonds.none()) sum += state.bonds.squared_norm();
  if (state.options.inertia) sum += std::pow(state.options.inertia->force_scale(), 2);
  return std::sqrt(sum);
}

// Penetration, complementarity and Coulomb's cone at every candidate, to the tolerances.
bool contact_law_holds(const IncrementState& state, const VecX& u) {
  const auto is_broken = [&](const ContactDefect& d) {
    return d.penetration > state.gap_tolerance || d.complementarity > state.options.law_tolerance ||
           d.cone > state.options.law_tolerance;
  };
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const ContactDefect d =
        contact_defect(state.contacts[k], state.body.mesh().X, u, state.u_start[k],
                       indenter_displacement(state.contacts[k], state.trial.t, state.trial.travel),
                       indenter_displacement(state.contacts[k], state.now.t, state.now.travel),
                       state.trial.r[k], state.motion(state.now.t));
    if (is_broken(d)) return false;
  }
  if (state.surfaces.empty()) return true;
  for (const ContactDefect& d :
       state.surfaces.defects(state.body.mesh().X, u, state.now.u, state.trial.r,
                              state.contacts.size(), state.motion(state.now.t)))
    if (is_broken(d)) return false;
  return true;
}

// Whether the reactions of the indenter under force control sum up to the prescribed force.
bool force_is_given(const IncrementState& state) {
  const ForceControl& control = *state.controlled()->control;
  Vec3 sum = Vec3::Zero();
  const double given = state.required_force();
  double size = std::abs(given);
  for (const Vec3& r : state.trial.r[static_cast<std::size_t>(state.controlled_index)]) {
    sum += r;
    size = std::max(size, r.norm());
  }
  // Rounding of the travel of an indenter with mass.
  const double rounding = 32 * std::numeric_limits<double>::epsilon() * state.force_falls() *
                          (std::abs(state.trial.travel) + std::abs(state.now.travel));
  return std::abs(sum.dot(control.along) - given) <= state.options.law_tolerance * size + rounding;
}

// A body held by contact alone has lost it: no candidate carries a force, but in the state where
// the increment began, one would penetrate.
bool slips_away(const IncrementState& state) {
  bool in_the_way = false;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const Vec3 c = indenter_displacement(state.contacts[k], state.trial.t, state.trial.travel);
    for (std::size_t i = 0; i < state.trial.r[k].size(); ++i) {
      if (!state.trial.r[k][i].isZero(0)) return false;
      const int node = state.contacts[k].nodes[i];
      const Vec3 x = state.body.mesh().X[node] + state.now.u.segment<3>(3 * node);
      in_the_way =
          in_the_way || shape_at(state.contacts[k].shape, x - c).gap < -state.gap_tolerance;
    }
  }
  return in_the_way;
}

}  // namespace langer
