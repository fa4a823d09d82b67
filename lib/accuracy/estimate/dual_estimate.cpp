#include "accuracy/estimate/dual_estimate.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "accuracy/estimate/cell_parts.hpp"
#include "accuracy/estimate/energy_error.hpp"
#include "accuracy/estimate/least_scatter.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/solve/state_tangent.hpp"
#include "scene/run/step_forces.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

// shares of the sum without signs
constexpr double of_others = 0.1, of_quadratic = 0.2, of_clamped = 0.6;
constexpr double too_rough = 0.25;  // the sum itself, of the quantity
constexpr double most_alone = 0.2;  // of the volume
constexpr double balanced = 1e-4;  // dual solutions: on fine meshes of nearly incompressible bodies
                                   // rounding leaves more than 1e-7

Failure not_known(const std::string& why) {
  return Failure(
      Exit::not_converged,
      Error{{}, "estimate", why, "", "estimate: recovery compares the stress with a smooth one"});
}

// Throws where no scene of the kind was measured.
void need_known_kind(const SolveConfig& config, const Run& run) {
  if (run.reduction.kind() == Reduction::Kind::homogeneous)
    throw not_known("a body that deforms alike everywhere has no error of cells");
  if (run.body.viscous())
    throw not_known("the dual solution is that of an elastic body, and this one is viscous");
  if (has_friction(config))
    throw not_known("with friction the force is no derivative of an energy");
  if (!run.body.loads().empty() && run.body.loads().follow())
    throw not_known("the tangent has half of a following pressure alone");
  if (run.scene.formulation == Formulation::displacement)
    throw not_known("formulation: displacement has no pressures of its own");
  if (!run.mesh.cell().hexahedron()) throw not_known("no scene of tetrahedra was measured");
  for (const RigidContact& contact : run.scene.contacts)
    if (is_from_file(contact.shape)) throw not_known("no indenter from a file was measured");
  if (run.reduction.scene().contacts.size() != run.scene.contacts.size())
    throw not_known("symmetry exchanges the indenters");
}

// nodes of the part
std::map<std::array<double, 3>, int> nodes_by_place(const Mesh& mesh) {
  std::map<std::array<double, 3>, int> out;
  for (int i = 0; i < mesh.n_nodes(); ++i) out[{mesh.X[i][0], mesh.X[i][1], mesh.X[i][2]}] = i;
  return out;
}

// Whether a load ends at the only node of a set: beside it are loaded facets and others of the same
// side. Stresses are singular there.
bool is_at_end_of_load(const SolveConfig& config, const Mesh& mesh, const std::string& point) {
  const int node = mesh.node_sets.at(point)[0];
  const auto around = [&](const std::string& set) {
    const auto facets = mesh.facet_sets.find(set);
    if (facets == mesh.facet_sets.end()) return std::ptrdiff_t{0};
    return std::ranges::count_if(facets->second, [&](const Facet& facet) {
      return std::ranges::count(facet_nodes(mesh, facet), node) > 0;
    });
  };
  return std::ranges::any_of(config.loads, [&](const LoadConfig& load) {
    if (!load.on_surface() || !config.mesh) return false;
    const auto set = config.mesh->sets.find(load.on);
    if (set == config.mesh->sets.end() || !set->second.of) return false;
    const auto loaded = around(load.on);
    return loaded > 0 && loaded < around(*set->second.of);
  });
}

// A quantity whose error is wanted, and the load or displacement of size 1 whose answer is its dual
// solution.
struct Asked {
  std::size_t quantity;
  ParameterChange by;           // of the part
  std::vector<Vec3> indenters;  // of the whole
  double sign = 1;              // energy's derivative to the quantity
  bool of_set = false;
};

// Finds the dual problem of each quantity. A force is the derivative of the energy by the motion of
// the indenter, a reaction by that of the set, and a displacement answers a force of size 1.
class Questions {
 public:
  Questions(const Run& run, const StepRecord& last)
      : run_(run), last_(last), place_(nodes_by_place(run.reduction.mesh())) {}

  std::optional<Asked> of(std::size_t i, const Valued& q) const {
    const auto after = [&](const std::string& begins) {
      return q.name.starts_with(begins) ? std::optional(q.name.substr(begins.size()))
                                        : std::nullopt;
    };
    Asked asked{i, {}, std::vector<Vec3>(run_.scene.contacts.size(), Vec3::Zero())};
    if (q.name == "force") return of_force(asked, "");
    if (const auto contact = after("force_")) return of_force(asked, *contact);
    if (const auto set = after("reaction_")) return of_set(asked, *set);
    if (const auto point = after("displacement_")) return of_point(asked, *point);
    return std::nullopt;
  }

 private:
  std::optional<Asked> of_force(Asked asked, const std::string& contact) const {
    Vec3 force = last_.force_ind;
    for (int j = 0; j < 3 && !contact.empty(); ++j)
      force[j] = last_.scalars.at("force_" + contact + "_" + "xyz"[j]);
    if (!(force.norm() > 0)) return std::nullopt;
    const std::vector<RigidContact>& part = run_.reduction.scene().contacts;
    asked.by.indenters.assign(part.size(), Vec3::Zero());
    for (std::size_t k = 0; k < run_.scene.contacts.size(); ++k)
      if (contact.empty() || run_.scene.contacts[k].name == contact)
        asked.indenters[k] = -force.normalized();
    for (std::size_t k = 0; k < part.size(); ++k)
      if (contact.empty() || part[k].name == contact) asked.by.indenters[k] = -force.normalized();
    return asked;
  }

  // The set moves by 1 along its reaction. Of nodes that symmetry removed, those that it left move
  // instead if there are no others; the caller corrects for what symmetry moves with them.
  std::optional<Asked> of_set(Asked asked, const std::string& set) const {
    Vec3 reaction = Vec3::Zero();
    for (int n : run_.mesh.node_sets.at(set))
      reaction += last_.reaction[static_cast<std::size_t>(n)];
    if (!(reaction.norm() > 0)) return std::nullopt;
    const Dofs& dofs = run_.body.dofs();
    asked.by.prescribed = VecX::Zero(dofs.n);
    asked.of_set = true;
    const std::vector<int>& nodes = run_.mesh.node_sets.at(set);
    const bool is_left = std::ranges::any_of(nodes, [&](int n) { return place_.contains(key(n)); });
    for (int n : nodes) {
      if (is_left && !place_.contains(key(n))) continue;
      const std::optional<Image> image = in_part(n);
      if (!image) continue;
      const Vec3 move = image->T.transpose() * reaction.normalized();
      for (int j = 0; j < 3; ++j)
        if (dofs.equation[3 * image->of + j] < 0) asked.by.prescribed[3 * image->of + j] = move[j];
    }
    if (asked.by.prescribed.isZero(0)) return std::nullopt;
    return asked;
  }

  // A force of size 1 against the displacement; at a hanging node it is shared by the four nodes
  // around it.
  std::optional<Asked> of_point(Asked asked, const std::string& point) const {
    const int n = run_.mesh.node_sets.at(point)[0];
    const Vec3 u = last_.u[static_cast<std::size_t>(n)];
    const std::optional<Image> image = in_part(n);
    if (!(u.norm() > 0) || !image) return std::nullopt;
    const Dofs& dofs = run_.body.dofs();
    asked.by.f = VecX::Zero(dofs.n);
    const auto act = [&](int node, double share) {
      Vec3 force = -share * (image->T.transpose() * u.normalized());
      if (!dofs.tie.empty()) force = dofs.tie[static_cast<std::size_t>(node)].T.transpose() * force;
      asked.by.f.segment<3>(3 * dofs.node(node)) += force;
    };
    if (const HangingNode* hangs = hanging_at(run_.reduction.mesh().hanging, image->of))
      for (int node : hangs->of) act(node, 0.25);
    else
      act(image->of, 1);
    asked.sign = -1;
    return asked;
  }

  // The node of the part with which a node of the whole body moves.
  std::optional<Image> in_part(int n) const {
    if (const auto found = place_.find(key(n)); found != place_.end())
      return Image{found->second, Mat3::Identity()};
    if (const ReducedScene* part = run_.reduction.part())
      return part->node_images()[static_cast<std::size_t>(n)];
    return std::nullopt;
  }

  std::array<double, 3> key(int n) const {
    return {run_.mesh.X[n][0], run_.mesh.X[n][1], run_.mesh.X[n][2]};
  }

  const Run& run_;
  const StepRecord& last_;
  std::map<std::array<double, 3>, int> place_;
};

// of the whole body
DualSolution whole(const Run& run, const StepRecord& last, const Asked& asked,
                   const StateDerivative& part) {
  StepRecord record;
  record.t = last.t;
  for (int i = 0; i < run.reduction.mesh().n_nodes(); ++i)
    record.u.push_back(part.u.segment<3>(3 * i));
  hang(run.body, part.u, record.u);
  record.reaction.assign(record.u.size(), Vec3::Zero());
  const auto& contacts = run.reduction.scene().contacts;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    ContactRecord& contact = record.contacts[contacts[k].name];
    contact.r = part.r[k];
    contact.status.assign(part.r[k].size(), 0);
    contact.gap.assign(part.r[k].size(), 0);
    for (char axis : {'x', 'y', 'z'}) record.scalars["force_" + contacts[k].name + "_" + axis] = 0;
  }
  const std::optional<StepRecord> all = run.reduction.whole(record);
  DualSolution out{all->u, asked.indenters, {}};
  for (const RigidContact& contact : run.scene.contacts)
    out.r.push_back(all->contacts.at(contact.name).r);
  return out;
}

// Patches need elements that lie inside: a body of one layer must be refined first.
PathErrors in_one_layer(const SolveConfig& config, const Mesh& mesh) {
  if (!asks_for_accuracy(config)) throw not_known(across_one_cell);
  return to_be_cut_everywhere(mesh, across_one_cell);
}

}  // namespace

PathErrors dual_errors(const SolveConfig& config, Run& run, const StepRecord& last,
                       const std::vector<Valued>& found) {
  need_known_kind(config, run);
  if (!run.increment.bonds().none()) throw not_known("the tangent has no bonds of adhesion");
  const Questions questions(run, last);
  const StateTangent tangent(run.increment, run.increment.accepted());
  std::vector<Asked> asked;
  std::vector<DualSolution> duals;
  bool none = true;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (is_given(config, found[i].name)) continue;
    auto question = questions.of(i, found[i]);
    if (!question) continue;
    none = false;
    const auto answer =
        tangent.derivative(question->by, tangent.of_rest(), tangent.of_rest(), balanced);
    if (!answer) continue;
    duals.push_back(whole(run, last, *question, *answer));
    asked.push_back(std::move(*question));
  }
  if (none)
    throw not_known(
        "no force, reaction or displacement is there that is not 0, as where no indenter touches");
  if (duals.empty()) throw not_known("a singular tangent has no dual solution");
  const EnergyErrors errors = energy_errors(run.scene, run.mesh, last, duals);
  if (errors.alone > most_alone) return in_one_layer(config, run.mesh);
  PathErrors out;

  // The error of each quantity is the sum over the elements. How far it may be off is a share of
  // the sum without signs; the shares were measured on known solutions (docs/study_estimates.md).
  const bool quadratic = run.mesh.cell().second_order();
  const std::vector<StepForces> end{step_forces(config, run.scene, run.mesh, last)};
  std::vector<Valued> judged;
  if (asks_for_accuracy(config)) {
    judged = forces_judged(found);
  } else {
    judged = std::vector<Valued>();
  }
  double worst = 0;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const Valued& q = found[asked[k].quantity];
    const auto& d = errors.along[k];
    double times = 1;  // symmetry moves other sets with it
    if (asked[k].of_set) {
      times = 0;
      for (std::size_t n = 0; n < last.u.size(); ++n)
        times += last.reaction[n].dot(duals[k].u[n]) / q.value;
    }
    const double size = d.size / std::abs(times);
    ErrorEstimate e{q, asked[k].sign * d.sum() / times, 0, 0, last.residual * std::abs(q.value)};
    if (q.of_force()) e.order = order_of_force(config);
    double scatter = of_others;
    if (quadratic) scatter = of_quadratic;
    const std::string displacement = "displacement_";
    const bool at_end_of_load =
        q.name.starts_with(displacement) &&
        is_at_end_of_load(config, run.mesh, q.name.substr(displacement.size()));
    if (e.order < 2 || at_end_of_load) scatter = of_clamped;
    e.scatter = scatter * size;
    const double smooth = e.total();
    if (!asked[k].of_set && q.of_force())  // smooth fields do not know that nodes touch one by one
      e.scatter = std::max(
          e.scatter,
          0.5 * std::abs(q.value) *
              one_by_one(
                  touching_at(end, end[0].touching.contains(q.name) ? q.name : "force", last.t),
                  run.mesh.section.has_value()));
    if (size > too_rough * std::abs(q.value))
      out.not_known.push_back(fmt::format(
          "the error of {} is not known: the cells are too long, their parts of it add up to {:.0f} %",
          q.name, e.in_percent(size)));
    else
      out.at_end.push_back(e);
    const bool is_judged =
        std::ranges::any_of(judged, [&](const Valued& v) { return v.name == q.name; });
    if (const double percent = e.in_percent(e.total()); is_judged && percent > worst) {
      worst = percent;
      out.of_cells =
          parts_of(d.of_cell, smooth / d.size, touched_cells(run, last), e.total() - smooth);
      for (double& part : out.of_cells) part /= std::max(std::abs(q.value), 1e-300);
    }
  }
  if (out.at_end.empty() && !asks_for_accuracy(config)) throw not_known(out.not_known.front());
  return out;
}

}  // namespace langer
