#include "mechanics/solve/tangent_factor.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "mechanics/assembly/separate_bodies.hpp"
#include "mechanics/assembly/zero_energy_modes.hpp"
#include "mechanics/mesh/quality.hpp"

namespace langer {

namespace {

constexpr std::size_t many_candidates = 400;
// candidates at rest this close to the path of the indenter count [mm]
constexpr double reach = 0.05;
// flops of a factorization over (3 candidates)^3, the cost of a condensed law: above it,
// factorizations that follow every change of stick and slip cost more than they save (langer-bench
// wide, with friction)
constexpr double deep = 8;
// rows from which on an iterative solution is cheaper than a factor (langer-bench growth)
constexpr int large = 100000;

// of the order of what the body opposes to a movement of one node
double node_stiffness(const Assembler& body) {
  double mu = 0;
  const int n_cells = body.mesh().n_cells();
  for (int e = 0; e < n_cells; ++e) mu = std::max(mu, std::abs(shear_modulus(body.material(e))));
  return mu * std::cbrt(quality(body.mesh()).volume / n_cells);
}

bool with_friction(const std::vector<RigidContact>& contacts) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const RigidContact& contact) { return contact.mu > 0; });
}

}  // namespace

std::string why_by_factor(const Mesh& mesh, const Dofs& dofs, Formulation formulation,
                          const std::vector<RigidContact>& contacts, bool follows,
                          LinearBy linear_by) {
  if (linear_by == LinearBy::direct) return "linear: direct asks for one";
  if (linear_by == LinearBy::automatic && dofs.n_free() < large)
    return "it is small, and quickly factorized";
  if (!contacts.empty() && !zero_energy_modes(mesh, dofs).empty())
    return "only contact holds the body";
  if (!ContactInTangent::serves(contacts))
    return "an indenter adheres or is pushed with a given force, or two may touch one node";
  if (follows) return "pressures follow the surface";
  if (formulation != Formulation::mean_dilatation || mesh.cell().n_nodes != 8)
    return "only 8-node hexahedra with a mean dilatation";
  return "";
}

TangentFactor::TangentFactor(const Assembler& body, const std::vector<RigidContact>& contacts,
                             int threads, ContactBy contact_by, LinearBy linear_by)
    : threads_(threads) {
  const Dofs& dofs = body.dofs();
  if (take_iterative(body, contacts, linear_by)) return;
  // Inertia resists every motion.
  const bool loose =
      !body.added_term() && !contacts.empty() && !zero_energy_modes(body.mesh(), dofs).empty();
  levels_ = CandidateLevels(contacts, body.mesh().X);
  for (const RigidContact& contact : contacts) candidates_.push_back(contact.nodes);
  const std::size_t candidates = levels_.on_the_path(reach);
  const bool wide = contact_by == ContactBy::tangent ||
                    (contact_by == ContactBy::by_cost && candidates >= many_candidates);
  const bool tangent_serves =
      wide && levels_.size() > 0 && !loose && ContactInTangent::serves(contacts);
  if (tangent_serves && (contact_by == ContactBy::tangent || !with_friction(contacts))) {
    take_into_tangent(body, contacts);
    return;
  }
  level_ = tangent_serves ? levels_.holding(candidates) : levels_.all();
  list_last(dofs);
  linear_ = std::make_unique<LinearSolver>(body.pattern(), last_, threads);
  if (tangent_serves &&
      linear_->size().flops < deep * std::pow(3.0 * static_cast<double>(candidates), 3)) {
    last_.clear();
    last_of_.clear();
    take_into_tangent(body, contacts);
    return;
  }
  if (last_.empty() || !loose) return;
  springs_.loose = node_stiffness(
      body);  // the weak resistance of contact to a free motion stays visible beside it
}

// The rows of the candidates of the level, and their places.
void TangentFactor::list_last(const Dofs& dofs) {
  last_.clear();
  last_of_.clear();
  if (!candidates_.empty()) last_of_.assign(dofs.n, -1);
  for (std::size_t k = 0; k < candidates_.size(); ++k)
    for (std::size_t i = 0; i < candidates_[k].size(); ++i) {
      if (levels_.of(k, i) > level_) continue;
      const int node = candidates_[k][i];
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof) {
        if (dofs.equation[dof] < 0 || last_of_[dof] >= 0) continue;
        last_of_[dof] = static_cast<int>(last_.size());
        last_.push_back(dofs.equation[dof]);
      }
    }
}

void TangentFactor::take_level(const Assembler& body, int level) {
  if (level == level_ || !may_leave_out()) return;
  level_ = level;
  list_last(body.dofs());
  linear_->eliminate_last(last_);
  kind_ = Kind::none;
}

TangentFactor::TangentFactor(const Assembler& body, const std::vector<RigidContact>& contacts,
                             const std::vector<int>& further, int threads)
    : threads_(threads) {
  const Dofs& dofs = body.dofs();
  last_of_.assign(dofs.n, -1);
  for (const RigidContact& contact : contacts) eliminate_last(dofs, contact.nodes);
  eliminate_last(dofs, further);
  linear_ = std::make_unique<LinearSolver>(body.pattern(), last_, threads);
  // Inertia resists every motion.
  if (body.added_term() || last_.empty()) return;
  if (any_is_free(body.mesh(), dofs)) springs_.loose = node_stiffness(body);
}

void TangentFactor::eliminate_last(const Dofs& dofs, const std::vector<int>& nodes) {
  for (int node : nodes)
    for (int dof = 3 * node; dof < 3 * node + 3; ++dof)
      if (dofs.equation[dof] >= 0 && last_of_[dof] < 0) {
        last_of_[dof] = static_cast<int>(last_.size());
        last_.push_back(dofs.equation[dof]);
      }
}

void TangentFactor::take_into_tangent(const Assembler& body,
                                      const std::vector<RigidContact>& contacts) {
  in_tangent_ = std::make_unique<ContactInTangent>(body, contacts, node_stiffness(body));
  linear_ = std::make_unique<LinearSolver>(body.pattern(), std::vector<int>{}, threads_);
}

bool TangentFactor::take_iterative(const Assembler& body, const std::vector<RigidContact>& contacts,
                                   LinearBy linear_by) {
  std::string why = why_by_factor(body.mesh(), body.dofs(), body.formulation(), contacts,
                                  body.loads().follow(), linear_by);
  if (why.empty()) mixed_ = MixedTangent::of(body, threads_, why);
  if (mixed_) {
    in_tangent_ = std::make_unique<ContactInTangent>(body, contacts, node_stiffness(body));
  } else if (linear_by == LinearBy::iterative) {
    throw Failure(Exit::config, Error{{},
                                      "solver.newton.linear",
                                      "found iterative, which does not serve here: " + why,
                                      "direct",
                                      ""});
  }
  return mixed_ != nullptr;
}

void TangentFactor::take_factor(const Assembler& body) {
  by_factor_ = gave_up_ = true;
  linear_ = std::make_unique<LinearSolver>(body.pattern(), std::vector<int>{}, threads_);
}

LinearSolver::Size TangentFactor::size() const {
  if (linear_) return linear_->size();
  return {mixed_->solver().entries(), 0, mixed_->solver().bytes(), 0};
}

void TangentFactor::begin_increment() {
  springs_.act = false;
  if (!mixed_) return;
  if (by_factor_) {
    linear_.reset();
    by_factor_ = false;
  }
  mixed_->solver().forget();
  in_tangent_->begin_increment();
}

bool TangentFactor::factorize(const Assembler& body) {
  ++counts_.factorizations;
  kind_ = Kind::whole;
  if (!springs_.act && springs_.loose == 0 && linear_->factorize(body.K())) return true;
  ++counts_.indefinite;
  // springs on all candidates hold what contact may hold
  take_level(body, levels_.all());
  if (!last_.empty()) return factorize_supported(body);
  ++counts_.unstable;
  kind_ = Kind::indefinite;
  return linear_->factorize_indefinite(body.K());
}

bool TangentFactor::factorize_whole(const Assembler& body) {
  ++counts_.factorizations;
  kind_ = Kind::whole;
  if (linear_->factorize(body.K())) return true;
  ++counts_.indefinite;
  kind_ = Kind::none;
  return false;
}

bool TangentFactor::factorize_supported(const Assembler& body) {
  kind_ = Kind::supported;
  const Pattern& pattern = body.pattern();
  double diagonal = 0;  // a column starts with its diagonal
  for (int row : last_)
    diagonal += std::abs(body.K()[pattern.column_start[row]]) / static_cast<double>(last_.size());
  const auto K_with_springs = [&] {
    std::vector<double> K = body.K();
    for (int row : last_) K[pattern.column_start[row]] += springs_.gamma;
    return K;
  };
  for (double spring : {springs_.loose, diagonal, 30 * diagonal, 1000 * diagonal}) {
    if (spring == 0 || (springs_.act && spring < 0.5 * springs_.gamma))
      continue;  // softer springs were not enough in this increment
    springs_.gamma = spring;
    if (linear_->factorize(K_with_springs())) return springs_.act = true;
  }
  // The body itself gives way. In a few directions stabilisation springs help; where they are many,
  // the increment was too long: K there says nothing, and the same point comes within reach by
  // shorter ones.
  kind_ = Kind::indefinite;
  ++counts_.unstable;
  return springs_.act = linear_->factorize_with_springs(K_with_springs());
}

bool TangentFactor::factorize_with_contact(const std::vector<double>& values) {
  ++counts_.factorizations;
  kind_ = Kind::whole;
  if (linear_->factorize(values)) return true;
  ++counts_.indefinite;
  ++counts_.unstable;
  kind_ = Kind::indefinite;
  return linear_->factorize_indefinite(values);
}

bool TangentFactor::factorize_fixed_reactions(const Assembler& body) {
  ++counts_.factorizations;
  kind_ = Kind::whole;
  springs_.act = false;
  if (linear_->factorize(body.K())) return true;
  ++counts_.indefinite;
  kind_ = Kind::indefinite;
  return linear_->factorize_indefinite(body.K());
}

}  // namespace langer
