// Increments of a body with inertia (dynamics/inertia.hpp).
//   begin    the trial state goes on with the velocities that the body and an indenter with mass
//            have; M a + C v joins the balance as an added term of the assembly
//   accept   velocities and accelerations at the end, and the account of energies:
//              kinetic + stored + viscous + damped  =  at the beginning + work from outside + balance
//            Work from outside is that of supports, loads, weight and indenters, with friction as
//            work that these take, and of friction between deformable surfaces; `balance` is what
//            the scheme gains or loses.
#include <cmath>
#include <utility>

#include "mechanics/solve/statics.hpp"

namespace langer {

void Statics::begin_motion(double seconds) {
  Inertia& inertia = *options_.inertia;
  inertia.begin(now_.u, now_.travel, now_.motion, seconds);
  if (inertia.conserves()) equilibrium_.begin_conserving(now_.u);
  equilibrium_.load_to(now_.t);
  if (equilibrium_.loads().empty()) {
    equilibrium_.pressures_from(now_.u);
  } else {
    equilibrium_.assemble(now_.u, false);
    equilibrium_.pressures_from(now_.u);
    f_ext_start_ = equilibrium_.f_ext();
  }
  equilibrium_.load_to(inertia.conserves() ? 0.5 * (now_.t + t_) : t_);
  const VecX du = predicted_move();
  if (options_.extrapolate && admissible(now_.u + du)) {
    equilibrium_.predict_pressures(du, 1);
    u_ += du;
  }
  if (controlled_ >= 0 && controlled()->control->free()) travel_ += inertia.predicted_travel();
  if (controlled_ >= 0 && !controlled()->control->free()) move_to_touch();
  slip_from_touch();
  if (!bodies_.empty())
    bodies_.turn(equilibrium_.mesh().X, now_.u, u_ - now_.u, r_, contacts_.size());
  if (starts_with_travel()) expected_ = u_;
}

// Where the body goes with the mean velocity of the last increment. The velocity at its end serves
// for the first one only: where a step is long beside the periods of the mesh, it alternates from
// step to step, and pressures that follow from it mean nothing.
VecX Statics::predicted_move() const {
  const Inertia& inertia = *options_.inertia;
  const double last = now_.t - before_.t;
  if (!(last > 0)) return inertia.predicted();
  double share = (t_ - now_.t) / last;
  if (inertia.conserves()) share *= 0.5;
  VecX du = VecX::Zero(now_.u.size());
  for (int dof : equilibrium_.dofs().free) du[dof] = share * (now_.u[dof] - before_.u[dof]);
  return du;
}

// The force that an indenter which is pushed, or has a mass, gives to the body at its travel.
double Statics::required_force() const {
  const ForceControl& control = *controlled()->control;
  if (control.free()) return options_.inertia->travel_force(travel_);
  return control.force.at(t_);
}

double Statics::force_falls() const {
  if (controlled_ < 0 || !controlled()->control->free()) return 0;
  return options_.inertia->travel_stiffness();
}

// Work of forces that are those at one end of the increment, on its whole movement du. A contact
// does none along its normal where it is closed and the indenter rests: what the gap closes by in
// the increment of the touch does not count.
double Statics::work_from_outside(const VecX& du, const VecX& f_ext, const VecX& reactions,
                                  const Reactions& r) const {
  double work = 0;
  if (f_ext.size() > 0) {
    for (int dof : equilibrium_.dofs().free) work += f_ext[dof] * du[dof];
  }
  for (const Prescribed& p : equilibrium_.dofs().prescribed) {
    double force = reactions[p.dof];
    if (f_ext.size() > 0) force += f_ext[p.dof];
    work += force * du[p.dof];
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const RigidContact& contact = contacts_[k];
    const Vec3 c = indenter_displacement(contact, t_, travel_);
    const Vec3 dc = c - indenter_displacement(contact, now_.t, now_.travel);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      if (r[k][i].isZero(0)) continue;
      const int node = contact.nodes[i];
      const Vec3 moved = du.segment<3>(3 * node);
      const Vec3 x = equilibrium_.mesh().X[node] + now_.u.segment<3>(3 * node) + moved;
      const Vec3 n = shape_at(contact.shape, x - c).normal;
      work += r[k][i].dot(moved - n * n.dot(moved - dc));
    }
    // An indenter with mass is a part of the moving system: it loses what it does on the body.
    if (static_cast<int>(k) != controlled_ || !contact.control->free()) continue;
    for (const Vec3& force : r[k]) {
      work -= force.dot(contact.control->along) * (travel_ - now_.travel);
    }
  }
  return work;
}

// Of deformable surfaces, in the movement du to u1, as work_from_outside() of a rigid wall: what
// they lose along their normal is a matter of the scheme.
double Statics::work_of_friction(const VecX& u1, const VecX& du) {
  const std::vector<Vec3>& X = equilibrium_.mesh().X;
  const std::size_t first = contacts_.size();
  if (options_.inertia->uses_impulses()) return bodies_.work_of_friction(X, u1, du, r_, first);
  const double at_start = bodies_.work_of_friction(X, now_.u, du, now_.r, first);
  return 0.5 * (at_start + bodies_.work_of_friction(X, u1, du, r_, first));
}

double Statics::motion_error() const {
  const Inertia& inertia = *options_.inertia;
  const MotionState end = inertia.end(inertia.end_of(u_), travel_, VecX::Zero(u_.size()));
  return inertia.error(end, end.kinetic + equilibrium_.W());
}

void Statics::accept_motion() {
  const Inertia& inertia = *options_.inertia;
  const VecX u1 = inertia.end_of(u_);
  const VecX du = u1 - now_.u;
  const double scale = inertia.reaction_scale();
  const VecX reactions = scale * trial_reactions();
  if (scale != 1) {
    for (std::vector<Vec3>& of_contact : r_) {
      for (Vec3& force : of_contact) force *= scale;
    }
  }
  VecX net = inertia.last_force() - equilibrium_.f_int();
  if (!equilibrium_.loads().empty()) net += equilibrium_.f_ext();
  MotionState motion = inertia.end(u1, travel_, net);
  motion.reactions = reactions;
  motion.stored = equilibrium_.W();

  VecX f_ext;
  if (!equilibrium_.loads().empty()) f_ext = equilibrium_.f_ext();
  double work = work_from_outside(du, f_ext, reactions, r_);
  // The balance of generalised_alpha holds at the ends of increments, that of the others on
  // average.
  if (!inertia.conserves() && !inertia.uses_impulses()) {
    work += work_from_outside(du, f_ext_start_, now_.motion.reactions, now_.r);
    work *= 0.5;
  }
  if (!bodies_.empty()) work += work_of_friction(u1, du);
  work += inertia.work_of_gravity(du, travel_ - now_.travel);
  equilibrium_.accept_increment(now_.u, u1);
  motion.damped = now_.motion.damped + inertia.damped(now_.motion, motion);
  motion.total = motion.kinetic + motion.stored + motion.damped;
  if (equilibrium_.viscous()) motion.total += equilibrium_.viscous_work();
  motion.balance = now_.motion.balance + motion.total - now_.motion.total - work;
  motion.error = inertia.error(motion, motion.kinetic + motion.stored);

  u_ = u1;
  before_ = std::move(now_);
  now_ = {t_, u_, r_, travel_, {}, {}, {}, std::move(motion)};
  now_.bonds = before_.bonds;
  equilibrium_.load_to(t_);
}

}  // namespace langer
