#include "mechanics/solve/statics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "mechanics/linear/krylov.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/solve/edge_slip.hpp"

namespace langer {

namespace {

TangentFactor timed_factor(const Assembler& body, const std::vector<RigidContact>& contacts,
                           const StaticsOptions& options, double& seconds) {
  const Stopwatch watch(seconds);
  return {body, contacts, options.threads, options.contact_by, options.linear_by};
}

}  // namespace

Statics::Statics(Assembler& equilibrium, std::vector<RigidContact> contacts,
                 const StaticsOptions& options)
    : equilibrium_(equilibrium),
      contacts_(std::move(contacts)),
      options_(options),
      factor_(timed_factor(equilibrium_, contacts_, options_, cost_.analysis)),
      bonds_(contacts_) {
  scale_ = scale_of(equilibrium_);
  gap_tolerance_ = options_.gap_tolerance.value_or(1e-11 * scale_.length);
  now_.u = VecX::Zero(equilibrium_.dofs().n);
  for (const RigidContact& contact : contacts_)
    now_.r.emplace_back(contact.nodes.size(), Vec3::Zero());
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_[k].control) controlled_ = static_cast<int>(k);
  now_.bonds = bonds_.at_rest(equilibrium_.mesh().X);
  before_ = now_;
  u_ = now_.u;
  r_ = r_next_ = now_.r;
  u_start_.assign(contacts_.size(), now_.u);
}

Statics::Cost Statics::cost() const {
  Cost cost = cost_;
  cost.factorizations = factor_.counts().factorizations;
  return cost;
}

void Statics::restore(const BodyState& accepted, const BodyState* before) {
  now_ = accepted;
  if (before) {
    before_ = *before;
  } else {
    before_ = accepted;
  }
  K_current_ = factor_serves_ = again_ = of_accepted_ = false;
  t_ = now_.t;
  u_ = now_.u;
  r_ = r_next_ = now_.r;
  travel_ = now_.travel;
  equilibrium_.load_to(t_);
  u_start_.assign(contacts_.size(), now_.u);
  if (!bonds_.none()) begin_bonds();
}

void Statics::begin(double t) {
  t_ = t;
  K_current_ = again_ = unsettled_ = false;
  extrapolated_ = 0;
  factor_serves_ = std::exchange(of_accepted_, false);
  factor_.begin_increment();
  u_ = now_.u;
  r_ = r_next_ = now_.r;
  travel_ = now_.travel;
  u_start_.assign(contacts_.size(), now_.u);
  if (!bonds_.none()) begin_bonds();
  equilibrium_.begin_increment((t - now_.t) * options_.seconds);
  equilibrium_.load_to(t);
  equilibrium_.pressures_from(now_.u);
  const bool pushed = controlled_ >= 0 &&
                      controlled()->control->force.at(t) != controlled()->control->force.at(now_.t);
  // then the last movement does not go on
  const bool rests = motion(now_.t) == 0 && !equilibrium_.loads().moves(now_.t, t) && !pushed;
  if (const double last = now_.t - before_.t; last > 0 && !rests && keeps_rate())
    extrapolate(std::min((t - now_.t) / last, 2.0));
  if (controlled_ >= 0) bring_to_touch();
  slip_from_touch();
  if (starts_with_travel()) expected_ = u_;
}

// Behind a kink of what moves nodes the last movement says nothing.
bool Statics::keeps_rate() const {
  for (const Prescribed& p : equilibrium_.dofs().prescribed)
    if (!p.in_proportion() && !p.keeps_rate(before_.t, now_.t, t_)) return false;
  for (const RigidContact& contact : contacts_)
    if (contact.rotation && !contact.rotation->angle.keeps_rate(before_.t, now_.t, t_))
      return false;
  return equilibrium_.loads().keeps_rate(before_.t, now_.t, t_);
}

void Statics::extrapolate(double s) {
  const VecX step = s * (now_.u - before_.u);
  if (!options_.extrapolate || !admissible(now_.u + step)) return;
  equilibrium_.extrapolate_pressures(before_.u, s);
  u_ += step;
  extrapolated_ = s;
  travel_ += s * (now_.travel - before_.travel);
}

std::vector<Vec3> Statics::indenters(double t, double travel) const {
  std::vector<Vec3> c;
  for (const RigidContact& contact : contacts_)
    c.push_back(indenter_displacement(contact, t, travel));
  return c;
}

// Out of touch no travel balances a force: the first one that does is behind the touch. Without a
// force it rests there.
void Statics::bring_to_touch() {
  const auto k = static_cast<std::size_t>(controlled_);
  if (std::any_of(r_[k].begin(), r_[k].end(), [](const Vec3& r) { return !r.isZero(0); })) return;
  const auto position = [&](int node) {
    return Vec3(equilibrium_.mesh().X[node] + u_.segment<3>(3 * node));
  };
  if (const auto touch = travel_to_touch(contacts_[k], t_, travel_, position)) travel_ = *touch;
}

void Statics::slip_from_touch() {
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_[k].mu > 0) slip_from_touch(k, u_);
}

void Statics::slip_from_touch(std::size_t k, const VecX& expected) {
  const IncrementMove move = increment_move(expected);
  for (int node : contacts_[k].nodes)
    u_start_[k].segment<3>(3 * node) =
        slip_origin(contacts_[k], move.of(contacts_[k], node), gap_tolerance_);
}

IncrementMove Statics::increment_move(const VecX& expected) const {
  return {equilibrium_.mesh().X, now_.u, expected, now_.t, now_.travel, t_, travel_};
}

// A node slips from where the way of the indenter has it touch. Where that way is an unknown, the
// start of the slip follows it: then a pushed indenter and a moved one that go the same way have
// the same slip.
bool Statics::starts_with_travel() const { return controlled_ >= 0 && controlled()->mu > 0; }

std::vector<Vec3> Statics::start_moves() const {
  if (!starts_with_travel()) return {};
  return slip_origin_change_with_travel(*controlled(), increment_move(expected_), gap_tolerance_);
}

double Statics::time_error() { return equilibrium_.end_increment(u_); }

void Statics::replay(const BodyState& next) {
  equilibrium_.begin_increment((next.t - now_.t) * options_.seconds);
  equilibrium_.end_increment(next.u);
  equilibrium_.accept_increment(now_.u, next.u);
  // Bonds come with the state: nothing of them is computed again.
  before_ = std::move(now_);
  now_ = next;
  t_ = now_.t;
  u_ = now_.u;
  r_ = now_.r;
  travel_ = now_.travel;
}

void Statics::accept() {
  equilibrium_.accept_increment(now_.u, u_);
  before_ = std::move(now_);
  now_ = {t_, u_, r_, travel_};
  if (!bonds_.none()) accept_bonds();
}

double Statics::motion(double t0) const {
  double largest = 0;
  const double travel = t0 == now_.t ? now_.travel : before_.travel;
  for (const RigidContact& contact : contacts_)
    largest = std::max(
        {largest,
         (indenter_displacement(contact, t_, travel_) - indenter_displacement(contact, t0, travel))
             .norm(),
         turning(contact, t0, indenter_displacement(contact, t0, travel))});
  for (const Prescribed& p : equilibrium_.dofs().prescribed)
    largest =
        std::max(largest, std::abs(p.in_proportion() ? p.value * (t_ - t0) : p.at(t_) - p.at(t0)));
  return largest;
}

double Statics::turning(const RigidContact& contact, double t0, const Vec3& c0) const {
  if (!contact.rotation) return 0;
  const double angle = contact.rotation->angle.at(t_) - contact.rotation->angle.at(t0);
  const std::vector<Vec3>& r = r_[static_cast<std::size_t>(&contact - contacts_.data())];
  double largest = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const int node = contact.nodes[i];
    if (r[i].isZero(0)) continue;
    const Vec3 x = equilibrium_.mesh().X[node] + u_.segment<3>(3 * node);
    largest = std::max(largest, carried(contact, angle, x, c0).norm());
  }
  return largest;
}

VecX Statics::remaining_prescribed(const VecX& u) const {
  VecX du = VecX::Zero(u.size());
  for (const Prescribed& p : equilibrium_.dofs().prescribed) du[p.dof] = p.at(t_) - u[p.dof];
  return du;
}

bool Statics::prescribed_reached(const VecX& u, const VecX& remaining) const {
  const double size = 0.1 * scale_.length + u.lpNorm<Eigen::Infinity>();
  return remaining.lpNorm<Eigen::Infinity>() <= 1e-14 * size;
}

VecX Statics::on_free_rows(const VecX& all) const {
  const Dofs& dofs = equilibrium_.dofs();
  VecX free(dofs.n_free());
  for (int row = 0; row < dofs.n_free(); ++row) free[row] = all[dofs.free[row]];
  return free;
}

VecX Statics::free_residual() const {
  VecX f = -equilibrium_.f_int();
  if (!equilibrium_.loads().empty()) f += equilibrium_.f_ext();
  if (!bonds_.none()) bonds_.add_forces(f);
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    for (std::size_t i = 0; i < contacts_[k].nodes.size(); ++i)
      f.segment<3>(3 * contacts_[k].nodes[i]) += r_[k][i];
  return on_free_rows(f);
}

double Statics::force_scale() const {
  double sum = 0;
  for (const Prescribed& p : equilibrium_.dofs().prescribed)
    sum += std::pow(equilibrium_.f_int()[p.dof], 2);
  for (const auto& r : r_)
    for (const Vec3& r_i : r) sum += r_i.squaredNorm();
  if (!equilibrium_.loads().empty()) sum += equilibrium_.f_ext().squaredNorm();
  if (!bonds_.none()) sum += bonds_.squared_norm();
  return std::sqrt(sum);
}

bool Statics::contact_law_holds(const VecX& u) const {
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactDefect d = contact_defect(contacts_[k], equilibrium_.mesh().X, u, u_start_[k],
                                           indenter_displacement(contacts_[k], t_, travel_),
                                           indenter_displacement(contacts_[k], now_.t, now_.travel),
                                           r_[k], motion(now_.t));
    if (d.penetration > gap_tolerance_ || d.complementarity > options_.law_tolerance ||
        d.cone > options_.law_tolerance)
      return false;
  }
  return true;
}

bool Statics::force_is_given() const {
  const ForceControl& control = *controlled()->control;
  Vec3 sum = Vec3::Zero();
  double size = control.force.at(t_);
  const double given = size;
  for (const Vec3& r : r_[static_cast<std::size_t>(controlled_)]) {
    sum += r;
    size = std::max(size, r.norm());
  }
  return std::abs(sum.dot(control.along) - given) <= options_.law_tolerance * size;
}

Assessment Statics::assess(const VecX& u, bool with_tangent) {
  const Stopwatch watch(cost_.assembly);
  Assessment out;
  const VecX du = remaining_prescribed(u);
  if (std::exchange(unsettled_, false)) equilibrium_.pressures_from(u);
  out.admissible = equilibrium_.assemble(u, with_tangent, &du);
  K_current_ = with_tangent;
  if (!out.admissible) {
    if (equilibrium_.J_min() > 0) {
      out.missing =
          "a force is not finite: the exponential of a fibre overflows where c2 (I4_bar - 1)^2 > 300, or the start "
          "of the step is too far away";
    } else {
      out.missing = "an element is turned inside out";
    }
    return out;
  }
  if (!bonds_.none()) bonds_.evaluate(equilibrium_.mesh().X, u, indenters(t_, travel_));
  out.residual = free_residual().norm();
  out.reference = force_scale();
  out.floor = 3 * equilibrium_.rounding_floor();
  if (!contact_law_holds(u))
    out.missing = "the contact law does not hold";
  else if (controlled_ >= 0 && !force_is_given())
    out.missing = "the force on the indenter is not the given one";
  else if (!prescribed_reached(u, du))
    out.missing = "prescribed displacements not reached";
  else if (factor_.held_by_contact() && slips_away())
    out.missing = "the body slips away from under the indenter, and nothing else holds it";
  out.others = out.missing.empty();
  return out;
}

// nothing touches the body, but something would if it were where the increment began
bool Statics::slips_away() const {
  bool in_the_way = false;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Vec3 c = indenter_displacement(contacts_[k], t_, travel_);
    for (std::size_t i = 0; i < r_[k].size(); ++i) {
      if (!r_[k][i].isZero(0)) return false;
      const int node = contacts_[k].nodes[i];
      const Vec3 x = equilibrium_.mesh().X[node] + now_.u.segment<3>(3 * node);
      in_the_way = in_the_way || shape_at(contacts_[k].shape, x - c).gap < -gap_tolerance_;
    }
  }
  return in_the_way;
}

bool Statics::admissible(const VecX& u) const {
  return u.allFinite() && equilibrium_.smallest_J(u) > 0.02;
}

void Statics::moved(const VecX& du, double step) {
  const Stopwatch watch(cost_.assembly);
  if (dp_.size() > 0)
    equilibrium_.move_pressures(dp_, step);
  else
    equilibrium_.predict_pressures(du, step, again_);
  const std::vector<Vec3>& X = equilibrium_.mesh().X;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Vec3 c = indenter_displacement(contacts_[k], t_, travel_);
    const Vec3 dc = indenter_displacement(contacts_[k], t_, travel_ + step * travel_next_) - c;
    for (std::size_t i = 0; i < r_[k].size(); ++i) {
      if (r_next_[k][i].isZero(0) && r_[k][i].isZero(0)) continue;
      const int node = contacts_[k].nodes[i];
      const Vec3 x = X[node] + u_.segment<3>(3 * node) - c;
      const Vec3 moved_x = x + step * du.segment<3>(3 * node) - dc;
      const Vec3 r = step == 1 ? r_next_[k][i] : Vec3(r_[k][i] + step * (r_next_[k][i] - r_[k][i]));
      r_[k][i] = turn_with_normal(r, shape_at(contacts_[k].shape, x).normal,
                                  shape_at(contacts_[k].shape, moved_x).normal);
    }
  }
  if (controlled_ >= 0) travel_ += step * travel_next_;
  if (starts_with_travel()) slip_from_touch(static_cast<std::size_t>(controlled_), expected_);
}

Problem Statics::problem() {
  Problem p;
  p.size = scale_.length;
  p.least_force = scale_.least_force;
  p.assess = [this](const VecX& u, bool with_tangent) {
    return assess(u, with_tangent);
  };
  p.correction = [this] {
    return correction();
  };
  if (equilibrium_.formulation() != Formulation::displacement && !iterative()) {
    p.correction_again = [this] {
      return correction_again();
    };
    // bonds that let go solve several times within an increment, and only the first time with what
    // the state before left
    p.price = price();
    p.begins_again = factor_serves_ && bonds_.none();
  }
  p.admissible = [this](const VecX& u) {
    return admissible(u);
  };
  p.moved = [this](const VecX& du, double step) {
    moved(du, step);
  };
  return p;
}

std::optional<std::string> Statics::edge_passed() const {
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Vec3 begin = indenter_displacement(contacts_[k], now_.t, now_.travel);
    const Vec3 end = indenter_displacement(contacts_[k], t_, travel_);
    if (node_past_edge({contacts_[k], equilibrium_.mesh().X, now_.u, u_, begin, end, r_[k]}))
      return contacts_[k].name;
  }
  return std::nullopt;
}

std::vector<ContactDefect> Statics::defects() const {
  const bool accepted = now_.t == t_;
  const double t0 = accepted ? before_.t : now_.t;
  const double travel0 = accepted ? before_.travel : now_.travel;
  std::vector<ContactDefect> out;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    out.push_back(contact_defect(contacts_[k], equilibrium_.mesh().X, u_, u_start_[k],
                                 indenter_displacement(contacts_[k], t_, travel_),
                                 indenter_displacement(contacts_[k], t0, travel0), r_[k],
                                 motion(t0)));
  return out;
}

VecX Statics::reactions() const {
  VecX out = VecX::Zero(equilibrium_.dofs().n);
  for (const Prescribed& p : equilibrium_.dofs().prescribed)
    out[p.dof] = equilibrium_.f_int()[p.dof];
  if (!equilibrium_.loads().empty())
    for (const Prescribed& p : equilibrium_.dofs().prescribed)
      out[p.dof] -= equilibrium_.f_ext()[p.dof];
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    for (std::size_t i = 0; i < r_[k].size(); ++i)
      out.segment<3>(3 * contacts_[k].nodes[i]) += r_[k][i];
  if (!bonds_.none()) bonds_.add_forces(out);
  return out;
}

}  // namespace langer
