#include "mechanics/solve/increment_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace langer {

namespace {

bool bears_nothing(const std::vector<Vec3>& reactions) {
  return std::all_of(reactions.begin(), reactions.end(), [](const Vec3& r) { return r.isZero(0); });
}

// The share of the way after which a gap closes that changes in proportion; 1: it does not close.
double share_to_close(double gap0, double gap) {
  if (!(gap < 0)) return 1;
  if (!(gap0 > 0)) return 0;
  return gap0 / (gap0 - gap);
}

}  // namespace

BodyState at_rest(BodyState shape) {
  shape.t = 0;
  shape.travel = 0;
  shape.u.setZero();
  shape.pressures.setZero();
  for (std::vector<Vec3>& reactions : shape.r)
    std::fill(reactions.begin(), reactions.end(), Vec3(Vec3::Zero()));
  return shape;
}

IncrementState::IncrementState(Assembler& assembler, std::vector<RigidContact> rigid,
                               const IncrementOptions& chosen,
                               std::vector<SurfaceContact> deformable)
    : body(assembler),
      contacts(std::move(rigid)),
      surfaces(std::move(deformable)),
      options(chosen),
      bonds(contacts, &surfaces),
      scale(scale_of(body)),
      gap_tolerance(options.gap_tolerance.value_or(1e-11 * scale.length)) {
  now.u = VecX::Zero(body.dofs().n);
  for (const RigidContact& contact : contacts)
    now.r.emplace_back(contact.nodes.size(), Vec3::Zero());
  for (const SurfaceContact& surface : surfaces.surfaces())
    now.r.emplace_back(surface.nodes.size(), Vec3::Zero());
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (contacts[k].control) controlled_index = static_cast<int>(k);
  now.bonds = bonds.at_rest(body.mesh().X);
  now.pressures = VecX::Zero(body.loads().n_volumes());
  before = now;
  trial.u = now.u;
  trial.r = next.r = now.r;
  trial.pressures = now.pressures;
  u_start.assign(contacts.size(), now.u);
  if (options.inertia) now.motion = before.motion = options.inertia->at_start();
}

const RigidContact* IncrementState::controlled() const {
  if (controlled_index >= 0) return &contacts[static_cast<std::size_t>(controlled_index)];
  return nullptr;
}

void IncrementState::turn_surfaces() {
  if (surfaces.empty()) return;
  surfaces.turn(body.mesh().X, now.u, trial.u - now.u, trial.r, contacts.size());
}

ContactState IncrementState::contact_state(const std::vector<Vec3>& c,
                                           const std::vector<Vec3>& c_start) const {
  return {contacts, body.mesh().X, trial.u, u_start, c, c_start, trial.r};
}

std::vector<Vec3> IncrementState::indenters(double t, double travel) const {
  std::vector<Vec3> c;
  for (const RigidContact& contact : contacts)
    c.push_back(indenter_displacement(contact, t, travel));
  return c;
}

std::vector<ContactDefect> IncrementState::defects() const {
  const bool accepted = now.t == trial.t;
  const double t0 = accepted ? before.t : now.t;
  const double travel0 = accepted ? before.travel : now.travel;
  std::vector<ContactDefect> out;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    out.push_back(contact_defect(contacts[k], body.mesh().X, trial.u, u_start[k],
                                 indenter_displacement(contacts[k], trial.t, trial.travel),
                                 indenter_displacement(contacts[k], t0, travel0), trial.r[k],
                                 motion(t0)));
  return out;
}

std::vector<ContactDefect> IncrementState::surface_defects() const {
  if (surfaces.empty()) return {};
  const bool accepted = now.t == trial.t;
  const double t0 = accepted ? before.t : now.t;
  const VecX& u0 = accepted ? before.u : now.u;
  return surfaces.defects(body.mesh().X, trial.u, u0, trial.r, contacts.size(), motion(t0));
}

// An indenter under force control that touches nothing finds no equilibrium: no travel balances
// the force. Moves it to its first touch.
void IncrementState::move_to_touch() {
  const auto k = static_cast<std::size_t>(controlled_index);
  if (!bears_nothing(trial.r[k])) return;
  const auto position = [&](int node) {
    return Vec3(body.mesh().X[node] + trial.u.segment<3>(3 * node));
  };
  if (const auto touch = travel_to_touch(contacts[k], trial.t, trial.travel, position))
    trial.travel = *touch;
}

void IncrementState::slip_from_touch() {
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (contacts[k].mu > 0) slip_from_touch(k, trial.u);
}

// Sets where the slip of each candidate of contact k starts within this increment.
void IncrementState::slip_from_touch(std::size_t k, const VecX& end) {
  const IncrementMove move = increment_move(end);
  for (int node : contacts[k].nodes)
    u_start[k].segment<3>(3 * node) =
        slip_origin(contacts[k], move.of(contacts[k], node), slip_tolerance());
}

// The gap up to which a node slips from the beginning of an increment on, and not from its touch. A
// body in motion has a velocity there: the law is that of the mean velocity in the increment
// (Moreau, Jean), for nodes that touch within it, too. Measured from the touch, or where that was
// not foreseen from the expected end, a node that goes on sliding would stick.
double IncrementState::slip_tolerance() const {
  if (options.inertia) return std::numeric_limits<double>::infinity();
  return gap_tolerance;
}

bool IncrementState::may_touch() const {
  return std::any_of(now.r.begin(), now.r.end(), bears_nothing);
}

double IncrementState::share_before_touch() const {
  double share = 1;
  const std::vector<Vec3>& X = body.mesh().X;
  const std::vector<Vec3> c0 = indenters(now.t, now.travel);
  const std::vector<Vec3> c = indenters(trial.t, trial.travel);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (!bears_nothing(now.r[k])) continue;
    for (int node : contacts[k].nodes) {
      const Vec3 x0 = X[node] + now.u.segment<3>(3 * node) - c0[k];
      const Vec3 x = X[node] + trial.u.segment<3>(3 * node) - c[k];
      const double gap0 = shape_at(contacts[k].shape, x0).gap;
      share = std::min(share, share_to_close(gap0, shape_at(contacts[k].shape, x).gap));
    }
  }
  for (std::size_t s = 0; s < surfaces.surfaces().size(); ++s) {
    if (!bears_nothing(now.r[contacts.size() + s])) continue;
    std::map<int, double> gap0;  // by candidate
    for (const MortarNode& node : surfaces.at(X, now.u)[s]) gap0[node.candidate] = node.gap();
    for (const MortarNode& node : surfaces.at(X, trial.u)[s]) {
      const auto earlier = gap0.find(node.candidate);
      if (earlier == gap0.end()) continue;
      share = std::min(share, share_to_close(earlier->second, node.gap()));
    }
  }
  return share;
}

IncrementMove IncrementState::increment_move(const VecX& end) const {
  return {body.mesh().X, now.u, end, now.t, now.travel, trial.t, trial.travel};
}

// The slip of a node is measured from where the path of the indenter touches it. Under force
// control that path is an unknown, and the start of the slip follows it: an indenter that is pushed
// and one that is moved along the same path have the same slip.
bool IncrementState::starts_with_travel() const {
  return controlled_index >= 0 && controlled()->mu > 0;
}

std::vector<Vec3> IncrementState::start_moves() const {
  if (!starts_with_travel()) return {};
  return slip_origin_change_with_travel(*controlled(), increment_move(trial.expected),
                                        slip_tolerance());
}

// The largest movement that is imposed from t0 to the trial: it scales the error allowed in slip.
double IncrementState::motion(double t0) const {
  double largest = 0;
  double travel = before.travel;
  if (t0 == now.t) travel = now.travel;
  for (const RigidContact& contact : contacts) {
    const Vec3 start = indenter_displacement(contact, t0, travel);
    const Vec3 end = indenter_displacement(contact, trial.t, trial.travel);
    largest = std::max({largest, (end - start).norm(), turning(contact, t0, start)});
  }
  for (const Prescribed& p : body.dofs().prescribed) {
    double moved = p.at(trial.t) - p.at(t0);
    if (p.in_proportion()) moved = p.value * (trial.t - t0);
    largest = std::max(largest, std::abs(moved));
  }
  return largest;
}

double IncrementState::turning(const RigidContact& contact, double t0, const Vec3& c0) const {
  if (!contact.rotation) return 0;
  const double angle = contact.rotation->angle.at(trial.t) - contact.rotation->angle.at(t0);
  const std::vector<Vec3>& r = trial.r[static_cast<std::size_t>(&contact - contacts.data())];
  double largest = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const int node = contact.nodes[i];
    if (r[i].isZero(0)) continue;
    const Vec3 x = body.mesh().X[node] + trial.u.segment<3>(3 * node);
    largest = std::max(largest, carried(contact, angle, x, c0).norm());
  }
  return largest;
}

VecX IncrementState::remaining_prescribed(const VecX& u) const {
  VecX du = VecX::Zero(u.size());
  for (const Prescribed& p : body.dofs().prescribed) du[p.dof] = p.at(trial.t) - u[p.dof];
  return du;
}

bool IncrementState::prescribed_reached(const VecX& u, const VecX& remaining) const {
  const double size = 0.1 * scale.length + u.lpNorm<Eigen::Infinity>();
  return remaining.lpNorm<Eigen::Infinity>() <= 1e-14 * size;
}

VecX IncrementState::on_free_rows(const VecX& all) const {
  const Dofs& dofs = body.dofs();
  VecX free(dofs.n_free());
  for (int row = 0; row < dofs.n_free(); ++row) free[row] = all[dofs.free[row]];
  return free;
}

// Whether elements keep their orientation: a cheap test before a state is assembled. Of an
// increment that is solved in its middle, at its end.
bool IncrementState::admissible(const VecX& u) const {
  if (!u.allFinite()) return false;
  if (body.conserves()) return body.smallest_J(2 * u - now.u) > 0.02;
  return body.smallest_J(u) > 0.02;
}

// How far each indenter goes from t0 to t1 [mm].
std::vector<Vec3> IncrementState::moves_of_indenters(double t0, double travel0, double t1,
                                                     double travel1) const {
  std::vector<Vec3> moves = indenters(t1, travel1);
  const std::vector<Vec3> from = indenters(t0, travel0);
  for (std::size_t k = 0; k < moves.size(); ++k) moves[k] -= from[k];
  return moves;
}

// The force that an indenter which is pushed, or has a mass, gives to the body at its travel.
double IncrementState::required_force() const {
  const ForceControl& control = *controlled()->control;
  if (control.free()) return options.inertia->travel_force(trial.travel);
  return control.force.at(trial.t);
}

double IncrementState::force_falls() const {
  if (controlled_index < 0 || !controlled()->control->free()) return 0;
  return options.inertia->travel_stiffness();
}

}  // namespace langer
