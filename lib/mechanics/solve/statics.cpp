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
                           const TouchingBodies& bodies, const StaticsOptions& options,
                           double& seconds) {
  const Stopwatch watch(seconds);
  if (!bodies.empty()) return {body, contacts, bodies.nodes(), options.threads};
  return {body, contacts, options.threads, options.contact_by, options.linear_by};
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

Statics::Statics(Assembler& equilibrium, std::vector<RigidContact> contacts,
                 const StaticsOptions& options, std::vector<SurfaceContact> surfaces)
    : equilibrium_(equilibrium),
      contacts_(std::move(contacts)),
      bodies_(std::move(surfaces)),
      options_(options),
      factor_(timed_factor(equilibrium_, contacts_, bodies_, options_, cost_.analysis)),
      bonds_(contacts_) {
  scale_ = scale_of(equilibrium_);
  gap_tolerance_ = options_.gap_tolerance.value_or(1e-11 * scale_.length);
  now_.u = VecX::Zero(equilibrium_.dofs().n);
  for (const RigidContact& contact : contacts_)
    now_.r.emplace_back(contact.nodes.size(), Vec3::Zero());
  for (const SurfaceContact& surface : bodies_.surfaces())
    now_.r.emplace_back(surface.nodes.size(), Vec3::Zero());
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_[k].control) controlled_ = static_cast<int>(k);
  now_.bonds = bonds_.at_rest(equilibrium_.mesh().X);
  now_.pressures = VecX::Zero(equilibrium_.loads().n_volumes());
  p_ = now_.pressures;
  before_ = now_;
  u_ = now_.u;
  r_ = r_next_ = now_.r;
  u_start_.assign(contacts_.size(), now_.u);
  if (options_.inertia) now_.motion = before_.motion = options_.inertia->at_start();
}

Statics::Cost Statics::cost() const {
  Cost cost = cost_;
  cost.factorizations = factor_.counts().factorizations;
  return cost;
}

std::vector<Vec3> Statics::indenters(double t, double travel) const {
  std::vector<Vec3> c;
  for (const RigidContact& contact : contacts_)
    c.push_back(indenter_displacement(contact, t, travel));
  return c;
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
  const bool conserves = options_.inertia && options_.inertia->conserves();
  if (equilibrium_.formulation() != Formulation::displacement && !iterative() && !conserves) {
    p.correction_again = [this] {
      return correction_again();
    };
    // bonds that let go solve several times within an increment, and only the first time with what
    // the state before left
    p.cost_ratio = cost_ratio();
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

std::vector<ContactDefect> Statics::surface_defects() const {
  if (bodies_.empty()) return {};
  const bool accepted = now_.t == t_;
  const double t0 = accepted ? before_.t : now_.t;
  const VecX& u0 = accepted ? before_.u : now_.u;
  return bodies_.defects(equilibrium_.mesh().X, u_, u0, r_, contacts_.size(), motion(t0));
}

const std::vector<std::vector<MortarNode>>& Statics::surface_averages() const {
  return bodies_.at(equilibrium_.mesh().X, u_);
}

std::vector<double> Statics::surface_penetrations() const {
  return bodies_.penetrations(equilibrium_.mesh().X, u_);
}

VecX Statics::reactions() const {
  if (options_.inertia) return now_.motion.reactions;
  return trial_reactions();
}

VecX Statics::trial_reactions() const {
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
  if (!bodies_.empty()) bodies_.add_forces(equilibrium_.mesh().X, u_, r_, contacts_.size(), out);
  return out;
}

}  // namespace langer
