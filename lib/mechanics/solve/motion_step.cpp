#include "mechanics/solve/motion_step.hpp"

#include <cmath>
#include <utility>

#include "mechanics/solve/balance.hpp"

namespace langer {

void MotionStep::begin(double seconds) {
  Inertia& inertia = *state_.options.inertia;
  inertia.begin(now_.u, now_.travel, now_.motion, seconds);
  if (inertia.conserves()) body_.begin_conserving(now_.u);
  body_.load_to(now_.t);
  if (body_.loads().empty()) {
    body_.pressures_from(now_.u);
  } else {
    body_.assemble(now_.u, false);
    body_.pressures_from(now_.u);
    f_ext_start_ = body_.f_ext();
  }
  body_.load_to(inertia.conserves() ? 0.5 * (now_.t + trial_.t) : trial_.t);
  const VecX du = predicted_move();
  if (state_.options.extrapolate && state_.admissible(now_.u + du)) {
    if (inertia.conserves()) body_.predict_pressures(du, 1);
    trial_.u += du;
  }
  if (state_.controlled_index >= 0 && state_.controlled()->control->free())
    trial_.travel += inertia.predicted_travel();
  if (state_.controlled_index >= 0 && !state_.controlled()->control->free()) state_.move_to_touch();
  state_.slip_from_touch();
  state_.turn_surfaces();
  if (state_.starts_with_travel()) trial_.expected = trial_.u;
}

// Where the body goes with the mean velocity of the last increment. The velocity at its end serves
// for the first one only: where a step is long beside the periods of the mesh, it alternates from
// step to step. Pressures stay as they are, since the predicted movement keeps volumes to first
// order only: near incompressibility the pressures that belong to it would outweigh all else. The
// conserving scheme, whose Newton's method goes to the last digits, keeps one more by them.
VecX MotionStep::predicted_move() const {
  const Inertia& inertia = *state_.options.inertia;
  const double last = now_.t - before_.t;
  if (!(last > 0)) return inertia.predicted();
  double share = (trial_.t - now_.t) / last;
  if (inertia.conserves()) share *= 0.5;
  VecX du = VecX::Zero(now_.u.size());
  for (int dof : body_.dofs().free) du[dof] = share * (now_.u[dof] - before_.u[dof]);
  return du;
}

// Work of forces that are those at one end of the increment, on its whole movement du. A contact
// does none along its normal where it is closed and the indenter rests: what the gap closes by in
// the increment of the touch does not count.
double MotionStep::work_from_outside(const VecX& du, const VecX& f_ext, const VecX& reactions,
                                     const Reactions& r) const {
  double work = 0;
  if (f_ext.size() > 0) {
    for (int dof : body_.dofs().free) work += f_ext[dof] * du[dof];
  }
  for (const Prescribed& p : body_.dofs().prescribed) {
    double force = reactions[p.dof];
    if (f_ext.size() > 0) force += f_ext[p.dof];
    work += force * du[p.dof];
  }
  for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
    const RigidContact& contact = state_.contacts[k];
    const Vec3 c = indenter_displacement(contact, trial_.t, trial_.travel);
    const Vec3 dc = c - indenter_displacement(contact, now_.t, now_.travel);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      if (r[k][i].isZero(0)) continue;
      const int node = contact.nodes[i];
      const Vec3 moved = du.segment<3>(3 * node);
      const Vec3 x = body_.mesh().X[node] + now_.u.segment<3>(3 * node) + moved;
      const Vec3 n = shape_at(contact.shape, x - c).normal;
      work += r[k][i].dot(moved - n * n.dot(moved - dc));
    }
    // An indenter with mass is a part of the moving system: it loses what it does on the body.
    if (static_cast<int>(k) != state_.controlled_index || !contact.control->free()) continue;
    for (const Vec3& force : r[k]) {
      work -= force.dot(contact.control->along) * (trial_.travel - now_.travel);
    }
  }
  return work;
}

// Of deformable surfaces, in the movement du to u1, as work_from_outside() of a rigid wall: what
// they lose along their normal is a matter of the scheme.
double MotionStep::work_of_friction(const VecX& u1, const VecX& du) {
  const std::vector<Vec3>& X = body_.mesh().X;
  const std::size_t first = state_.contacts.size();
  if (state_.options.inertia->uses_impulses())
    return state_.surfaces.work_of_friction(X, u1, du, trial_.r, first);
  const double at_start = state_.surfaces.work_of_friction(X, now_.u, du, now_.r, first);
  return 0.5 * (at_start + state_.surfaces.work_of_friction(X, u1, du, trial_.r, first));
}

double MotionStep::error() const {
  const Inertia& inertia = *state_.options.inertia;
  const MotionState end =
      inertia.end(inertia.end_of(trial_.u), trial_.travel, VecX::Zero(trial_.u.size()));
  return inertia.error(end, end.kinetic + body_.W());
}

void MotionStep::accept() {
  const Inertia& inertia = *state_.options.inertia;
  const VecX u1 = inertia.end_of(trial_.u);
  const VecX du = u1 - now_.u;
  const double scale = inertia.reaction_scale();
  const VecX reactions = scale * trial_reactions(state_);
  if (scale != 1) {
    for (std::vector<Vec3>& of_contact : trial_.r) {
      for (Vec3& force : of_contact) force *= scale;
    }
  }
  VecX net = inertia.last_force() - body_.f_int();
  if (!body_.loads().empty()) net += body_.f_ext();
  MotionState motion = inertia.end(u1, trial_.travel, net);
  motion.reactions = reactions;
  motion.stored = body_.W();

  VecX f_ext;
  if (!body_.loads().empty()) f_ext = body_.f_ext();
  double work = work_from_outside(du, f_ext, reactions, trial_.r);
  // The balance of generalised_alpha holds at the ends of increments, that of the others on
  // average.
  if (!inertia.conserves() && !inertia.uses_impulses()) {
    work += work_from_outside(du, f_ext_start_, now_.motion.reactions, now_.r);
    work *= 0.5;
  }
  if (!state_.surfaces.empty()) work += work_of_friction(u1, du);
  work += inertia.work_of_gravity(du, trial_.travel - now_.travel);
  body_.accept_increment(now_.u, u1);
  motion.damped = now_.motion.damped + inertia.damped(now_.motion, motion);
  motion.total = motion.kinetic + motion.stored + motion.damped;
  if (body_.viscous()) motion.total += body_.viscous_work();
  motion.balance = now_.motion.balance + motion.total - now_.motion.total - work;
  motion.error = inertia.error(motion, motion.kinetic + motion.stored);

  trial_.u = u1;
  before_ = std::move(now_);
  now_ = {trial_.t, trial_.u, trial_.r, trial_.travel, {}, {}, {}, std::move(motion)};
  now_.bonds = before_.bonds;
  body_.load_to(trial_.t);
}

}  // namespace langer
