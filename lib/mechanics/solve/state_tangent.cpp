#include "mechanics/solve/state_tangent.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/contact/touch.hpp"
#include "mechanics/solve/staged_solution.hpp"

namespace langer {

// Linearises the accepted state once: the factor of its tangent, and the contact laws at the nodes
// that touch. Every derivative then costs one solution.
StateTangent::StateTangent(Increment& increment, const BodyState& earlier)
    : increment_(increment.state()),
      factor_(increment.condensed_factor()),
      solvable_(increment.factorize_accepted()) {
  if (!solvable_) return;
  if (!increment_.surfaces.empty()) surfaces_.emplace(increment_, factor_);
  if (increment_.contacts.empty()) return;
  const BodyState& was = increment_.before;
  expected_ = was.u + increment_.trial.extrapolated * (was.u - earlier.u);
  const BodyState& now = increment_.now;
  if (!increment_.bonds.none())
    bonds_.emplace(increment_.bonds, increment_.contacts, increment_.body.mesh().X, now.u,
                   increment_.indenters(now.t, now.travel));
  take_candidates();
  if (!near_.empty()) take_rows();
}

// Collects the candidates that touch or are bonded, with their laws linearised at the accepted
// state. Others count only where springs support a free body, since the springs act on them.
void StateTangent::take_candidates() {
  const BodyState &now = increment_.now, &before = increment_.before;
  const std::vector<Vec3>& X = increment_.body.mesh().X;
  const auto defects = increment_.defects();
  for (std::size_t k = 0; k < increment_.contacts.size(); ++k) {
    const RigidContact& contact = increment_.contacts[k];
    const Vec3 c = indenter_displacement(contact, now.t, now.travel);
    const Vec3 c0 = indenter_displacement(contact, before.t, before.travel);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      Touching touching{defects[k].status[i], bonds_ && bonds_->holds(k, i)};
      if (!touching.bears() && !factor_.with_springs()) continue;
      const int node = contact.nodes[i];
      const Vec3 x = X[node] + now.u.segment<3>(3 * node);
      const Vec3 x0 = X[node] + increment_.u_start[k].segment<3>(3 * node);
      Near n{k, i, linearise(contact, x, x0, c, c0, now.r[k][i]), {}, Vec3::Zero()};
      n.r = n.law.frame.transpose() * now.r[k][i];
      if (touching.bonded) n.law.D += n.law.frame.transpose() * bonds_->tangent(k, i) * n.law.frame;
      touching.slip = n.law.q.tail<2>().norm();
      touching.approach = n.law.frame.col(0).dot((x - x0) - (c - c0));
      pushed_ = pushed_ || (static_cast<int>(k) == increment_.controlled_index &&
                            touching.status != ContactStatus::open);
      near_.push_back(n);
      touching_.push_back(touching);
    }
  }
  if (near_.empty()) return;
  const std::vector<Vec3> c(increment_.contacts.size(), Vec3::Zero());
  ContactState state{increment_.contacts,
                     X,
                     now.u,
                     increment_.u_start,
                     c,
                     c,
                     now.r,
                     pushed_ ? increment_.controlled_index : -1};
  if (pushed_ && increment_.starts_with_travel())
    state.start_moves = slip_origin_change_with_travel(*increment_.controlled(), increment_move(),
                                                       increment_.slip_tolerance());
  c_ = condensed(state, factor_, near_);
}

// The equations of all touching nodes: X (gap and slip) = R (reaction), with the condensed
// compliance W between them, and one more row for an indenter with a given force. Rows have the
// size of a compliance, so that the matrix is well scaled.
void StateTangent::take_rows() {
  const auto m = static_cast<Eigen::Index>(near_.size());
  const auto n = 3 * m + (pushed_ ? 1 : 0);
  const double typical = std::max(c_.W.diagonal().sum() / static_cast<double>(3 * m),
                                  std::numeric_limits<double>::min());
  MatX M = MatX::Zero(n, n);
  for (Eigen::Index p = 0; p < m; ++p) {
    const auto q = static_cast<std::size_t>(p);
    Touching& touching = touching_[q];
    touching.typical = typical;
    touching.rows = law_rows({touching.status, c_.mu[p], near_[q].r, touching.slip}, typical);
    const LawRows& rows = touching.rows;
    M.block(3 * p, 0, 3, 3 * m) = (rows.x * c_.T[q] - rows.r * c_.E[q]) * c_.W.middleRows<3>(3 * p);
    M.block<3, 3>(3 * p, 3 * p) += rows.r;
    // a node that cannot move along an axis has no compliance there: what it sticks by there is
    // nothing
    const RigidContact& contact = increment_.contacts[near_[q].contact];
    for (int j = 0; j < 3; ++j)
      if (factor_.last_of(3 * contact.nodes[near_[q].candidate] + j) < 0) {
        const Vec3 h = near_[q].law.frame.row(j).transpose();
        M.block<3, 3>(3 * p, 3 * p) += typical * rows.x * h * h.transpose();
      }
    if (!pushed_) continue;
    const Vec3 along = c_.along.segment<3>(3 * p);
    Mat3 springs = Mat3::Zero();
    if (!c_.springs.empty()) springs = c_.springs[q];
    M.block<3, 1>(3 * p, 3 * m) = (rows.r * (c_.E[q] - springs) - rows.x * c_.T[q]) * along;
    if (c_.start_moves.size() > 0)
      M.block<3, 1>(3 * p, 3 * m) -= rows.x * c_.start_moves.segment<3>(3 * p);
    M.row(3 * m).segment<3>(3 * p) += typical * along.transpose();
    M.row(3 * m).head(3 * m) -= typical * (along.transpose() * springs) * c_.W.middleRows<3>(3 * p);
  }
  // an indenter with mass gives less force where it has travelled further
  if (pushed_) M(3 * m, 3 * m) += typical * increment_.force_falls();
  lu_.compute(M);
  singular_ = !(lu_.rcond() > 1e-14);
  if (singular_) least_.compute(M);
}

// Movements of the candidates in their local frames: normal first, then two tangents.
VecX StateTangent::local_of(const VecX& last) const {
  VecX d(3 * static_cast<Eigen::Index>(near_.size()));
  for (std::size_t p = 0; p < near_.size(); ++p) {
    const int node = increment_.contacts[near_[p].contact].nodes[near_[p].candidate];
    Vec3 moved = Vec3::Zero();
    for (int j = 0; j < 3; ++j)
      if (const int row = factor_.last_of(3 * node + j); row >= 0) moved[j] = last[row];
    d.segment<3>(3 * static_cast<Eigen::Index>(p)) = near_[p].law.frame.transpose() * moved;
  }
  return d;
}

// The increment that led to the state: slip is measured over it.
IncrementMove StateTangent::increment_move() const {
  const BodyState &now = increment_.now, &was = increment_.before;
  return {increment_.body.mesh().X, was.u, expected_, was.t, was.travel, now.t, now.travel};
}

// Of the two states before; an indenter's travel in this increment is an unknown of its own.
std::vector<Vec3> StateTangent::slip_of_history(const ParameterChange& change,
                                                const StateDerivative& before,
                                                const StateDerivative& earlier) const {
  std::vector<Vec3> out(near_.size(), Vec3::Zero());
  for (std::size_t p = 0; p < near_.size(); ++p) {
    const Near& n = near_[p];
    const RigidContact& contact = increment_.contacts[n.contact];
    if (contact.mu == 0 || touching_[p].status == ContactStatus::open) continue;
    const int node = contact.nodes[n.candidate];
    const Vec3 d_u0 = before.u.segment<3>(3 * node);
    const Vec3 d_u = d_u0 + increment_.trial.extrapolated * (d_u0 - earlier.u.segment<3>(3 * node));
    const Vec3 d_c0 =
        contact.control ? Vec3(before.travel * contact.control->along) : Vec3(Vec3::Zero());
    const ExpectedMove move = increment_move().of(contact, node);
    ExpectedMove d{Vec3::Zero(), d_u0, d_u, d_c0, Vec3::Zero()};
    d.gap0 = shape_change(change, n.contact, move.X + move.u0 - move.c0).gap;
    d.gap = shape_change(change, n.contact, move.X + move.u - move.c).gap;
    const Vec3 from = slip_origin_change(contact, move, d, increment_.slip_tolerance()) - d_c0;
    out[p] = n.law.frame.transpose() * -from;
    out[p][0] = 0;
  }
  return out;
}

// How far a parameter moves the node against its indenter directly, in the local frame.
Vec3 StateTangent::moved_against(const ParameterChange& change, const Near& near) const {
  Vec3 moved = Vec3::Zero();
  if (change.prescribed.size() > 0)
    moved +=
        change.prescribed.segment<3>(3 * increment_.contacts[near.contact].nodes[near.candidate]);
  if (!change.indenters.empty()) moved -= change.indenters[near.contact];
  return near.law.frame.transpose() * moved;
}

// What another shape changes where nothing moves: the gap, and with the normal the frame, in which
// the slip is seen and with which the reaction turns (dt = -(t.dn) n, as in linearise()).
StateTangent::ShapeEffect StateTangent::shape_effect(const ParameterChange& change,
                                                     std::size_t p) const {
  ShapeEffect effect;
  if (change.shapes.empty()) return effect;
  const Near& n = near_[p];
  const RigidContact& contact = increment_.contacts[n.contact];
  const BodyState& now = increment_.now;
  const int node = contact.nodes[n.candidate];
  const Vec3 x =
      increment_.body.mesh().X[static_cast<std::size_t>(node)] + now.u.segment<3>(3 * node);
  const ShapePoint rate =
      shape_change(change, n.contact, x - indenter_displacement(contact, now.t, now.travel));
  const Eigen::Vector2d turn = n.law.frame.rightCols<2>().transpose() * rate.normal;
  effect.x[0] = rate.gap;
  effect.x.tail<2>() = -touching_[p].approach * turn;
  effect.r[0] = -n.r.tail<2>().dot(turn);
  effect.r.tail<2>() = n.r[0] * turn;
  return effect;
}

// How a parameter changes the contact laws themselves: by the slip that the states before have
// left, by prescribed movements, and by the coefficient of friction.
VecX StateTangent::right_hand_side(const ParameterChange& change,
                                   const std::vector<Vec3>& history) const {
  VecX h = VecX::Zero(3 * static_cast<Eigen::Index>(near_.size()) + (pushed_ ? 1 : 0));
  for (std::size_t p = 0; p < near_.size(); ++p) {
    const Near& n = near_[p];
    const auto row = 3 * static_cast<Eigen::Index>(p);
    h.segment<3>(row) -=
        touching_[p].rows.x * history[p] +
        (touching_[p].rows.x * c_.T[p] - touching_[p].rows.r * n.law.D) * moved_against(change, n);
    const ShapeEffect shape = shape_effect(change, p);
    h.segment<3>(row) -= touching_[p].rows.x * shape.x - touching_[p].rows.r * shape.r;
    double d_mu = 0;
    if (!change.mu.empty()) d_mu = change.mu[n.contact];
    if (d_mu == 0 || touching_[p].status != ContactStatus::slip) continue;
    const Eigen::Vector2d s = -n.r.tail<2>().normalized();
    h.segment<2>(row + 1) -= touching_[p].rows.r(1, 1) * d_mu * n.r[0] * s;
  }
  return h;
}

// Of an indenter with mass, by what the state before has changed.
double StateTangent::travel_force_change(const StateDerivative& before) const {
  if (increment_.controlled_index < 0 || !increment_.controlled()->control->free()) return 0;
  return increment_.options.inertia->travel_force_of_history(before.travel, before.motion);
}

// rhs: on the free rows; h: of the candidates' rows
std::optional<StateTangent::Change> StateTangent::solve(const VecX& rhs, const VecX& h) const {
  Change out;
  if (near_.empty()) {
    out.move = factor_.linear().solve(rhs);
    if (out.move.allFinite()) return std::optional(out);
    return std::nullopt;
  }
  const StagedSolution staged(factor_, rhs);
  const VecX d = local_of(staged.last());
  VecX b = h;
  for (std::size_t p = 0; p < near_.size(); ++p) {
    const auto row = 3 * static_cast<Eigen::Index>(p);
    b.segment<3>(row) +=
        (touching_[p].rows.r * c_.E[p] - touching_[p].rows.x * c_.T[p]) * d.segment<3>(row);
    if (pushed_ && !c_.springs.empty())
      b[b.size() - 1] +=
          touching_[p].typical * c_.along.segment<3>(row).dot(c_.springs[p] * d.segment<3>(row));
  }
  const VecX answer = singular_ ? least_.solve(b) : lu_.solve(b);
  if (!answer.allFinite()) return std::nullopt;
  out.s = answer.head(d.size());
  out.travel = 0;
  if (pushed_) out.travel = answer[d.size()];
  out.d = d + c_.W * out.s;
  out.move = staged.with(c_.B * out.s);
  if (out.move.allFinite()) return std::optional(out);
  return std::nullopt;
}

// Adds the answer of one solution to a derivative: displacements, the travel of a pushed indenter,
// and reactions.
void StateTangent::add(const Change& change, StateDerivative& to) const {
  const Dofs& dofs = increment_.body.dofs();
  for (int row = 0; row < dofs.n_free(); ++row) to.u[dofs.free[row]] += change.move[row];
  to.travel += change.travel;
  for (std::size_t p = 0; p < near_.size(); ++p) {
    if (!touching_[p].bears()) continue;
    const Near& n = near_[p];
    const auto row = 3 * static_cast<Eigen::Index>(p);
    // less the share of the springs; what turns with the normal is the reaction's own
    const Vec3 r = change.s.segment<3>(row) - (c_.E[p] - n.law.D) * change.d.segment<3>(row);
    to.r[n.contact][n.candidate] += n.law.frame * r;
  }
}

// The same with deformable surfaces in place of indenters.
std::optional<StateDerivative> StateTangent::derivative_with_surfaces(const ParameterChange& change,
                                                                      const StateDerivative& before,
                                                                      double enough) const {
  constexpr double exact = 1e-11;
  // Forces of surfaces are differentiated by differences. Where a corner of a facet lies on an edge
  // of the other side, their error is a share of their step (1e-5), and no correction removes it.
  enough = std::max(enough, 1e-6);
  StateDerivative out = of_rest();
  if (change.prescribed.size() > 0) out.u = change.prescribed;
  const VecX f = -on_free_rows(change);
  VecX rhs = f;
  SurfaceTangent::Loads loads = surfaces_->loads(change, before.u);
  double size = rhs.norm();
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 30; ++i) {
    const auto next = surfaces_->solve(rhs, loads);
    if (!next) return std::nullopt;
    StateDerivative trial = out;
    const Dofs& dofs = increment_.body.dofs();
    for (int row = 0; row < dofs.n_free(); ++row) trial.u[dofs.free[row]] += next->move[row];
    surfaces_->add_reactions(*next, trial.r);
    trial.surface_forces = surfaces_->forces(trial.u, trial.r);
    rhs = f + on_free_rows(trial);
    if (i == 0) size = std::max(size, trial.surface_forces.norm());
    loads = {};
    const double left = rhs.norm();
    if (!(left < last)) break;  // that is rounding
    out = std::move(trial);
    last = left;
    if (left <= exact * size) break;
  }
  if (!(last <= enough * size)) return std::nullopt;
  surfaces_->turn_reactions(out.u, out.r);
  return out;
}

// A derivative of size zero.
StateDerivative StateTangent::of_rest() const {
  StateDerivative d;
  d.u = VecX::Zero(increment_.body.dofs().n);
  for (const RigidContact& contact : increment_.contacts)
    d.r.emplace_back(contact.nodes.size(), Vec3::Zero());
  for (const SurfaceContact& surface : increment_.surfaces.surfaces())
    d.r.emplace_back(surface.nodes.size(), Vec3::Zero());
  if (increment_.options.inertia) d.motion.v = d.motion.a = d.motion.b = d.u;
  return d;
}

// What bonds bear beyond their tangent times the movement: what the number changes of their states
// before and of their laws, and where a bond slides along a curved indenter, the change of the
// curvature.
VecX StateTangent::bonds_on_free_rows(const BondMoves& moves, const VecX& du) const {
  VecX all = VecX::Zero(increment_.body.dofs().n);
  for (std::size_t p = 0; p < near_.size(); ++p) {
    if (!touching_[p].bonded) continue;
    const std::size_t k = near_[p].contact;
    const std::size_t i = near_[p].candidate;
    const Vec3 by_tangent = bonds_->tangent(k, i) * bonds_->moved(k, i, moves.change, du);
    all.segment<3>(3 * static_cast<Eigen::Index>(increment_.contacts[k].nodes[i])) +=
        bonds_->at(k, i, moves, du).force - by_tangent;
  }
  return increment_.on_free_rows(all);
}

// The forces of candidates that the solution gives are those of contact and bond together.
void StateTangent::part_bonds_from_reactions(const BondMoves& moves, StateDerivative& d) const {
  for (std::size_t p = 0; p < near_.size(); ++p) {
    if (!touching_[p].bonded) continue;
    const std::size_t k = near_[p].contact;
    const std::size_t i = near_[p].candidate;
    d.r[k][i] -= bonds_->tangent(k, i) * bonds_->moved(k, i, moves.change, d.u);
    if (touching_[p].status == ContactStatus::open) d.r[k][i].setZero();
  }
  d.adhesive = bonds_->forces(moves, d.u);
  d.bonds = bonds_->after(moves, d.u, increment_.now.r, increment_.before.r);
}

// What a derivative leaves unbalanced: reactions and the skew part of pressures minus K times the
// movement.
VecX StateTangent::on_free_rows(const StateDerivative& d) const {
  Assembler& body = increment_.body;
  VecX all = VecX::Zero(body.dofs().n);
  if (d.surface_forces.size() > 0) all = d.surface_forces;
  for (std::size_t k = 0; k < increment_.contacts.size(); ++k)
    for (std::size_t i = 0; i < d.r[k].size(); ++i)
      all.segment<3>(3 * increment_.contacts[k].nodes[i]) += d.r[k][i];
  if (const VecX beside = body.nonsymmetric_part(increment_.now.u, d.u); beside.size() > 0)
    all -= beside;
  return increment_.on_free_rows(all) - body.K_times(increment_.on_free_rows(d.u));
}

// The change of the internal forces by the parameter at fixed free displacements.
VecX StateTangent::on_free_rows(const ParameterChange& change) const {
  Assembler& body = increment_.body;
  VecX all = change.f.size() > 0 ? change.f : VecX(VecX::Zero(body.dofs().n));
  if (change.prescribed.size() > 0) {
    body.assemble(increment_.now.u, true, &change.prescribed);
    all += body.K_du();
  }
  return increment_.on_free_rows(all);
}

// Solves for the derivative of the state with iterative refinement: the factor is that of a
// symmetric tangent with springs, and what it leaves is corrected until rounding is reached.
std::optional<StateDerivative> StateTangent::derivative(const ParameterChange& change,
                                                        const StateDerivative& before,
                                                        const StateDerivative& earlier,
                                                        double enough) const {
  constexpr double exact = 1e-12;
  if (!solvable_) return std::nullopt;
  if (surfaces_) return derivative_with_surfaces(change, before, enough);
  StateDerivative out = of_rest();
  if (change.prescribed.size() > 0) out.u = change.prescribed;
  VecX f = -on_free_rows(change);
  const Inertia* inertia = increment_.options.inertia;
  if (inertia) f -= increment_.on_free_rows(inertia->force_of_history(before.u, before.motion));
  const BondMoves moves{change, before.bonds};
  VecX rhs = f;
  if (bonds_) rhs += bonds_on_free_rows(moves, out.u);
  VecX h =
      near_.empty() ? VecX() : right_hand_side(change, slip_of_history(change, before, earlier));
  if (pushed_)
    h[h.size() - 1] = touching_.front().typical * (travel_force_change(before) + change.control);
  double size = rhs.norm();
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100; ++i) {
    const auto next = solve(rhs, h);
    if (!next) return std::nullopt;
    StateDerivative trial = out;
    add(*next, trial);
    rhs = f + on_free_rows(trial);
    if (bonds_) rhs += bonds_on_free_rows(moves, trial.u);
    if (i == 0) {
      if (!near_.empty()) h.setZero();
      for (const auto& reactions : trial.r)
        for (const Vec3& r : reactions) size = std::max(size, r.norm());
      out = trial;
    }
    const double left = rhs.norm();
    if (!(left < last)) break;  // that is rounding, or for ever
    out = std::move(trial);
    if (left <= exact * size) {
      last = left;
      break;
    }
    if (left > 0.5 * last && left <= enough * size) {
      last = left;
      break;
    }
    last = left;
  }
  if (!(last <= enough * size)) return std::nullopt;
  if (bonds_) part_bonds_from_reactions(moves, out);
  if (increment_.force_falls() > 0 && !pushed_) {  // it flies
    out.travel = travel_force_change(before) / increment_.force_falls();
  } else if (increment_.controlled_index >= 0 && !pushed_) {  // it rests where it touches
    const std::vector<Vec3>& X = increment_.body.mesh().X;
    const auto position = [&](int node) {
      return Vec3(X[node] + increment_.now.u.segment<3>(3 * node));
    };
    const Vec3 c =
        indenter_displacement(*increment_.controlled(), increment_.now.t, increment_.now.travel);
    const auto moved = [&](int node) {
      Vec3 by = out.u.segment<3>(3 * node);
      if (change.shapes.empty()) return by;
      const Vec3 x = position(node) - c;
      const auto contact = static_cast<std::size_t>(increment_.controlled_index);
      by +=
          shape_change(change, contact, x).gap * shape_at(increment_.controlled()->shape, x).normal;
      return by;
    };
    out.travel = touch_travel_change(*increment_.controlled(), increment_.now.t,
                                     increment_.now.travel, position, moved);
  }
  if (inertia)
    out.motion = inertia->end_of_move(out.u - before.u, out.travel - before.travel, before.motion);
  return out;
}

std::vector<VecX> StateTangent::reactions(const std::vector<ParameterChange>& changes,
                                          const std::vector<StateDerivative>& derivatives,
                                          std::vector<double>* energies) const {
  Assembler& body = increment_.body;
  if (energies) energies->assign(derivatives.size(), 0);
  std::vector<VecX> u;
  for (const StateDerivative& d : derivatives) u.push_back(d.u);
  std::vector<VecX> out = body.prescribed_rows_times(increment_.now.u, u);
  const Inertia* inertia = increment_.options.inertia;
  VecX f_int = body.f_int();  // of the stored energy alone
  if (inertia) f_int -= inertia->last_force();
  for (std::size_t j = 0; j < out.size(); ++j) {
    double of_moduli = 0;
    const VecX beside = body.nonsymmetric_part(increment_.now.u, u[j], &of_moduli);
    if (energies) (*energies)[j] = f_int.dot(u[j]) + of_moduli;
    VecX of_mass;
    if (inertia) of_mass = inertia->force_of(derivatives[j].motion);
    for (const Prescribed& p : body.dofs().prescribed) {
      if (of_mass.size() > 0) out[j][p.dof] += of_mass[p.dof];
      if (changes[j].f.size() > 0) out[j][p.dof] += changes[j].f[p.dof];
      if (beside.size() > 0) out[j][p.dof] += beside[p.dof];
    }
    VecX of_contact = VecX::Zero(out[j].size());
    if (derivatives[j].surface_forces.size() > 0) of_contact = derivatives[j].surface_forces;
    for (std::size_t k = 0; k < increment_.contacts.size(); ++k)
      for (std::size_t i = 0; i < derivatives[j].r[k].size(); ++i)
        of_contact.segment<3>(3 * increment_.contacts[k].nodes[i]) += derivatives[j].r[k][i];
    for (std::size_t k = 0; k < derivatives[j].adhesive.size(); ++k)
      for (std::size_t i = 0; i < derivatives[j].adhesive[k].size(); ++i)
        of_contact.segment<3>(3 * increment_.contacts[k].nodes[i]) += derivatives[j].adhesive[k][i];
    // internal forces at held nodes balance contact and support together
    for (const Prescribed& p : body.dofs().prescribed) of_contact[p.dof] = 0;
    out[j] += of_contact;
  }
  return out;
}

}  // namespace langer
