#include "identification/inverse/sensitivity.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/model/scene_motion.hpp"
#include "scene/model/torque.hpp"
#include "scene/run/by_node.hpp"
#include "scene/run/step_forces.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

// What a motion carries on from one increment to the next.
constexpr std::array motion_fields{velocity_field, acceleration_field, carried_field};
constexpr std::array motion_of_indenter{indenter_velocity, indenter_acceleration, indenter_carried};

std::string travel_of(const RigidContact& contact) { return "travel_" + contact.name; }

}  // namespace

// The derivative of a force against a direction: -d_force . way/|way|, or that of its size if there
// is no direction.
double derivative_against(const Vec3& way, const Vec3& force, const Vec3& d_force) {
  if (const double length = way.norm(); length > 0) return -d_force.dot(way) / length;
  const double size = force.norm();
  if (size > 0) return d_force.dot(force) / size;
  return 0;
}

// The force on one of several contacts, from its components in a record.
Vec3 force_on(const StepRecord& record, const std::string& contact) {
  Vec3 force;
  for (int k = 0; k < 3; ++k) force[k] = record.scalars.at("force_" + contact + "_" + "xyz"[k]);
  return force;
}

// The derivative of the size of the total contact force: d|F| = F . dF/|F|.
double length_derivative(const StepRecord& whole, const SceneParameter& parameter) {
  Vec3 d;
  for (int k = 0; k < 3; ++k)
    d[k] = whole.scalars.at(derivative_name(std::string("force_") + "xyz"[k] + "_N", parameter));
  const double size = whole.force_ind.norm();
  if (size > 0) return d.dot(whole.force_ind) / size;
  return 0;
}

double force_derivative(const StepRecord& whole, const StepRecord& derivative) {
  return derivative_against(whole.u_ind, whole.force_ind, derivative.force_ind);
}

// The undeformed state does not depend on the parameters: all derivatives start at zero.
Sensitivity::Sensitivity(Run& run, const SolveConfig& config, const Run::Where& where)
    : run_(run),
      moved_(moved_sets(config)),
      parameters_(config, run.mesh, run.scene, where),
      last_(run.increment.accepted()),
      earlier_(last_),
      loads_(run, parameters_, config, where) {
  for (std::size_t i = 0; i < parameters().size(); ++i) {
    if (!run.inertia || !parameters_.layer(i)) continue;
    const std::string key = fmt::format("sensitivity[{}]", i);
    throw Failure(Exit::config, Error{where(key), key, "found a thickness together with dynamics",
                                      "numbers of the material, of friction or of an indenter",
                                      "the mass of a layer changes with its thickness"});
  }
  if (run.body.viscous() && run.inertia && !parameters().empty())
    throw Failure(Exit::config, Error{where("sensitivity"), "sensitivity",
                                      "found a viscous material together with dynamics",
                                      "an elastic material, or no dynamics", ""});
  if (run.body.viscous()) neighbours_.emplace(run.reduction, parameters_);
  StateDerivative rest;
  rest.u = VecX::Zero(last_.u.size());
  if (run.inertia) rest.motion.v = rest.motion.a = rest.motion.b = rest.u;
  d_last_.assign(parameters().size(), rest);
  d_earlier_ = d_last_;
}

// Adds the derivatives to a listener: each accepted state is differentiated before the listener
// sees it.
RunListener Sensitivity::along(RunListener listener) {
  if (parameters().empty()) return listener;
  if (last_.t > 0)
    run_.increment
        .factorize_accepted();  // the increment after a kept step begins with it, as it would have
  const auto next_of_part = listener.of_part;
  listener.of_part = [this, next_of_part](StepRecord& record) {
    if (next_of_part && !next_of_part(record)) return false;
    advance(record);
    return true;
  };
  const auto next_of_whole = listener.of_whole;
  listener.of_whole = [this, next_of_whole](StepRecord& whole, const SolveReport& report) {
    now_.clear();
    for (const StepRecord& derivative : of_part_) now_.push_back(of_whole(derivative, whole));
    write(whole);
    if (next_of_whole) next_of_whole(whole, report);
  };
  return listener;
}

Observer Sensitivity::observer() {
  if (parameters().empty()) return {};
  return {[this](const StepRecord& whole) { kept(whole); },
          [this](RunListener listener) {
            return along(std::move(listener));
          }};
}

// The derivatives at the last state, for the summary of the run.
std::vector<Summary> Sensitivity::summary(const StepRecord& last) const {
  std::vector<Summary> out;
  for (const auto& [name, value] : last.scalars)
    for (const SceneParameter& p : parameters()) {
      if (!name.starts_with("d_") || !name.ends_with("_d_" + p.name)) continue;
      double derivative = value;
      if (name == derivative_name("force_N", p)) derivative = length_derivative(last, p);
      out.push_back({name, derivative, "-"});
    }
  return out;
}

// Two states next to the last one, where the number is a little less and a little more: the
// Rayleigh quotient of a mode is stationary, so its difference is that of the eigenvalue.
void Sensitivity::add_frequencies(const Modes& modes, const std::vector<double>& density,
                                  ModesRecord& record) {
  if (neighbours_) return;  // the stiffness of a mode then has what the branches remember
  const BodyState now = run_.increment.accepted();
  const Scene& scene = run_.reduction.scene();
  const Mesh& mesh = run_.reduction.mesh();
  const std::vector<Dofs> breaking = run_.reduction.symmetry_breaking_dofs();
  for (std::size_t i = 0; i < parameters().size(); ++i) {
    if (parameters_.layer(i) || parameters_.shape(i) || parameters_.load(i)) continue;
    if (d_last_[i].u.size() != now.u.size()) continue;
    // where forces are linear in the number, its step is as large as a modulus
    const double h = parameters_.linear(i) ? 1e-4 * parameters_.step(i) : parameters_.step(i);
    const auto put_at = [&](double by) {
      BodyState state = now;
      state.u += by * d_last_[i].u;
      state.travel += by * d_last_[i].travel;
      for (std::size_t k = 0; k < d_last_[i].r.size(); ++k)
        for (std::size_t c = 0; c < d_last_[i].r[k].size(); ++c)
          state.r[k][c] += by * d_last_[i].r[k][c];
      if (parameters_.of_laws(i)) {
        SceneParameters::Laws laws = parameters_.varied(scene, mesh, i, by);
        run_.body.set_materials(std::move(laws.materials), std::move(laws.directions));
      }
      run_.put_at(run_.t(), state, state);
      run_.body.pressures_from(state.u);
    };
    // With less friction than the indenter has, nodes that slip would count as sticking: there the
    // difference is taken on one side, also of second order.
    struct Sample {
      double by, weight;  // weight: over h
    };
    std::vector<Sample> samples{{h, 0.5}, {-h, -0.5}};
    if (!parameters_.of_laws(i)) samples = {{0, -1.5}, {h, 2}, {2 * h, -0.5}};
    std::vector<double> differences(modes.modes.size(), 0.0);  // of the eigenvalues, over h
    for (const Sample& sample : samples) {
      put_at(sample.by);
      const std::vector<double> found =
          rayleigh_quotients(run_.body, run_.increment, density, breaking, modes.modes);
      for (std::size_t m = 0; m < found.size(); ++m) differences[m] += sample.weight * found[m];
    }
    std::vector<double> derivative;
    for (std::size_t m = 0; m < modes.modes.size(); ++m) {
      // omega = 2 pi f, so d(omega^2) = 8 pi^2 f df
      const double f = modes.modes[m].frequency();
      const double of_frequency = 8 * std::numbers::pi * std::numbers::pi * f;
      derivative.push_back(f > 0 ? differences[m] / h / of_frequency
                                 : std::numeric_limits<double>::quiet_NaN());
    }
    put_at(0);
    record.derivatives.emplace_back(derivative_name("frequency_Hz", parameters()[i]),
                                    std::move(derivative));
  }
}

// The explicit derivatives of internal forces and energy by each parameter at fixed displacements,
// by central differences; one difference where they are linear. The tangent has been made there
// before.
std::vector<ParameterChange> Sensitivity::changes(std::vector<double>& energies) {
  Assembler& body = run_.body;
  const VecX& u = run_.increment.accepted().u;
  const Scene& scene = run_.reduction.scene();
  std::vector<ParameterChange> out(parameters().size());
  energies.assign(out.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    add_contact_change(i, out[i]);
    if (neighbours_) out[i].f = neighbours_->change(i, u).f;
    loads_.add_change(i, run_.increment.accepted().t, u, out[i]);
    if (neighbours_) continue;
    if (parameters_.layer(i)) {
      const Assembler::Forces rate = change_by_thickness(i);
      out[i].f = rate.f;
      energies[i] = rate.W;
      continue;
    }
    if (!parameters_.of_laws(i)) continue;
    const double h = parameters_.step(i);
    const auto with = [&](double by) {
      SceneParameters::Laws laws = parameters_.varied(scene, run_.reduction.mesh(), i, by);
      return body.forces_of(std::move(laws.materials), std::move(laws.directions), u);
    };
    const Assembler::Forces more = with(h);
    const bool linear = parameters_.linear(i);
    // forces that are linear in the number need one difference
    Assembler::Forces less{body.f_int(), body.W()};
    double width = h;
    if (!linear) {
      less = with(-h);
      width = 2 * h;
    }
    out[i].f = (more.f - less.f) / width;
    energies[i] = (more.W - less.W) / width;
  }
  return out;
}

// What a number changes of the contact laws: the friction, the shape or the bonds of one indenter.
void Sensitivity::add_contact_change(std::size_t i, ParameterChange& change) const {
  if (parameters_.contact(i).empty()) return;
  for (const RigidContact& contact : run_.reduction.scene().contacts) {
    const bool is_it = contact.name == parameters_.contact(i);
    if (parameters_.bonds(i)) {
      change.adhesion.push_back(is_it ? *parameters_.bonds(i) : Adhesion{});
      continue;
    }
    if (!parameters_.shape(i)) {
      change.mu.push_back(static_cast<double>(is_it));
      continue;
    }
    auto& shape = change.shapes.emplace_back();
    if (is_it) shape = parameters_.shape(i);
  }
  for (const SurfaceContact& surface : run_.reduction.scene().surfaces)
    change.mu.push_back(static_cast<double>(surface.name == parameters_.contact(i)));
}

namespace {

// The pressures of all Gauss points of cells with linear pressures, cell after cell [MPa].
VecX point_pressures(const Assembler& body, const std::vector<double>& modal) {
  std::vector<double> out;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const ElementGeometry& geometry = body.geometry(e);
    const double* p = &modal[n_modes * static_cast<std::size_t>(e)];
    for (int g = 0; g < geometry.n_gauss(); ++g) {
      double here = 0;
      for (int k = 0; k < n_modes; ++k) here += geometry.mode[g][k] * p[k];
      out.push_back(here);
    }
  }
  return Eigen::Map<const VecX>(out.data(), static_cast<Eigen::Index>(out.size()));
}

// Change of the bubble moduli with the pressures of Gauss points: that of the point with the most
// compression. At its bounds, 0 and kappa, a modulus does not change.
std::vector<double> bubble_modulus_change(const Assembler& body, const PressureField::State& state,
                                          const VecX& rate) {
  const VecX pressure = point_pressures(body, state.p);
  std::vector<double> change(state.bubble_modulus.size());
  Eigen::Index first = 0;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const Eigen::Index n = body.geometry(e).n_gauss();
    const double modulus = state.bubble_modulus[static_cast<std::size_t>(e)];
    Eigen::Index most = 0;
    pressure.segment(first, n).minCoeff(&most);
    const bool capped = -pressure[first + most] > modulus * (1 + 1e-9);
    if (modulus > 0 && !capped) change[static_cast<std::size_t>(e)] = -rate[first + most];
    first += n;
  }
  return change;
}

}  // namespace

// What the thickness of a layer changes of forces and energy where displacements stand still: nodes
// at rest move, and with them the deformation of the cells. A central difference of fourth order.
// A nearly incompressible body amplifies its errors by the ratio of bulk to shear modulus: with
// d = 1e-6 1/MPa steps of 2e-3 of the thickness are 3e-3 off in a force, and these are 1e-6 off.
//
// Over such steps the pressures of a nearly incompressible body change sign, and the bubble moduli
// of cells of second order, which are the largest compression of each, have a kink there. They
// stay what they are in the differences. Their own change follows from that of the pressures,
// which are smooth.
Assembler::Forces Sensitivity::change_by_thickness(std::size_t i) {
  constexpr std::array<double, 4> place{-2, -1, 1, 2};
  constexpr std::array<double, 4> weight{1. / 12, -8. / 12, 8. / 12, -1. / 12};
  const LayerThickness& layer = *parameters_.layer(i);
  ThicknessSteps& steps = by_thickness_[i];
  if (steps.bodies.empty()) {
    steps.step = 2e-4 * layer.value();
    for (const double at : place)
      steps.meshes.push_back(layer.with(run_.reduction.mesh(), layer.value() + at * steps.step));
    for (const Mesh& mesh : steps.meshes) steps.bodies.push_back(run_.reduction.assembler_on(mesh));
  }
  const VecX& u = run_.increment.accepted().u;
  const bool bubbles = run_.reduction.scene().formulation == Formulation::linear_dilatation;
  const PressureField::State own = run_.body.pressures().state();
  VecX rate_of_pressures;
  Assembler::Forces rate;
  rate.f = VecX::Zero(u.size());
  for (std::size_t k = 0; k < place.size(); ++k) {
    Assembler& body = *steps.bodies[k];
    const double share = weight[k] / steps.step;
    body.assemble(u, false);
    body.pressures_from(u);
    if (bubbles) {
      PressureField::State state = body.pressures().state();
      const VecX of_points = share * point_pressures(body, state.p);
      if (rate_of_pressures.size() == 0) rate_of_pressures = VecX::Zero(of_points.size());
      rate_of_pressures += of_points;
      state.bubble_modulus = own.bubble_modulus;
      body.set_pressures(state);
    }
    body.assemble(u, false);
    rate.f += share * body.f_int();
    rate.W += share * body.W();
  }
  if (bubbles) {
    const Assembler::Forces of_bubbles =
        run_.body.bubble_change(u, bubble_modulus_change(run_.body, own, rate_of_pressures));
    rate.f += of_bubbles.f;
    rate.W += of_bubbles.W;
  }
  return rate;
}

// Direct differentiation of one increment: K du/dp = -df/dp with the factorized tangent of the
// accepted state, contact and history included. It follows the two last states.
void Sensitivity::advance(const StepRecord& record) {
  refuse_jump();
  const StateTangent tangent(run_.increment, earlier_);
  std::vector<double> energies, of_movement;
  const BodyState& now = run_.increment.accepted();
  if (neighbours_) neighbours_->begin((now.t - last_.t) * run_.increment.state().options.seconds);
  const std::vector<ParameterChange> all = changes(energies);
  std::vector<StateDerivative> d;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto found = tangent.derivative(all[i], d_last_[i], d_earlier_[i]);
    if (!found)
      throw Failure(
          Exit::not_converged,
          Error{
              {},
              "sensitivity",
              fmt::format(
                  "the tangent at t = {:.6g} is singular: the state has no derivative with respect to {}",
                  record.t, parameters()[i].key),
              "",
              "without the key the path continues"});
    d.push_back(*found);
  }
  const std::vector<VecX> reactions = tangent.reactions(all, d, &of_movement);
  for (std::size_t i = 0; i < d.size() && neighbours_; ++i) {
    energies[i] = neighbours_->accept(i, last_.u, d_last_[i].u, now.u, d[i].u);
    of_movement[i] = 0;  // the energy is that of the moved neighbours
  }
  of_part_.clear();
  for (std::size_t i = 0; i < d.size(); ++i)
    of_part_.push_back(of_part(record, d[i], reactions[i], energies[i] + of_movement[i]));
  earlier_ = std::move(last_);
  last_ = now;
  d_earlier_ = std::move(d_last_);
  d_last_ = std::move(d);
}

// The state behind a jump of bonds follows from how many of them it took, which is not a smooth
// function of any number.
void Sensitivity::refuse_jump() const {
  const BondEnergy& now = run_.increment.accepted().in_bonds;
  const BondEnergy& before = last_.in_bonds;
  if (now.released == before.released && now.work_of_jumps == before.work_of_jumps) return;
  throw Failure(
      Exit::not_converged,
      Error{{},
            "sensitivity",
            fmt::format("bonds of the adhesion let go in a jump between t = {:.6g} and {:.6g}: the "
                        "state behind it has no derivative",
                        last_.t, run_.increment.accepted().t),
            "",
            "a path that ends before the jump, or no `sensitivity`"});
}

// Whether an indenter flies by itself.
bool Sensitivity::has_mass_of_its_own() const {
  return run_.inertia && run_.inertia->options().travel_mass > 0;
}

// The derivative of a state of the reduced body, as a record.
StepRecord Sensitivity::of_part(const StepRecord& record, const StateDerivative& d,
                                const VecX& reactions, double energy) const {
  StepRecord out;
  out.t = record.t;
  out.u = by_node(d.u);
  out.reaction = by_node(reactions);
  out.scalars["energy"] = energy;
  const auto& contacts = run_.increment.contacts();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    ContactRecord& contact = out.contacts[contacts[k].name] = record.contacts.at(contacts[k].name);
    contact.r = d.r[k];
    Vec3 force = Vec3::Zero();
    for (const Vec3& r : d.r[k]) force -= r;
    if (!d.adhesive.empty() && !contact.beta.empty()) {
      contact.adhesive = d.adhesive[k];
      for (const Vec3& pull : d.adhesive[k]) force -= pull;
    }
    for (int j = 0; j < 3 && contacts.size() > 1; ++j)
      out.scalars["force_" + contacts[k].name + "_" + "xyz"[j]] = force[j];
    if (contacts[k].control) out.scalars[travel_of(contacts[k])] = d.travel;
    out.force_ind += force;
  }
  const auto& surfaces = run_.increment.surfaces();
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    ContactRecord& contact = out.contacts[surfaces[s].name] = record.contacts.at(surfaces[s].name);
    contact.r = d.r[contacts.size() + s];
    Vec3 force = Vec3::Zero();
    for (const Vec3& r : contact.r) force -= r;
    for (int j = 0; j < 3; ++j)
      out.scalars["force_" + surfaces[s].name + "_" + "xyz"[j]] = force[j];
  }
  if (d.motion.present()) {
    out.point_fields[velocity_field] = by_node(d.motion.v);
    out.point_fields[acceleration_field] = by_node(d.motion.a);
    out.point_fields[carried_field] = by_node(d.motion.b);
    if (has_mass_of_its_own()) {
      out.scalars[indenter_velocity] = d.motion.travel_v;
      out.scalars[indenter_acceleration] = d.motion.travel_a;
      out.scalars[indenter_carried] = d.motion.travel_b;
    }
  }
  return out;
}

// The same on the full body, as the symmetry reduction unfolds it.
StepRecord Sensitivity::of_whole(const StepRecord& derivative, const StepRecord& whole) const {
  if (run_.reduction.point()) return of_mesh(derivative, whole);
  StepRecord out = *run_.reduction.whole(derivative);
  out.u_ind.setZero();
  if (!run_.scene.contacts.empty() && run_.scene.contacts[0].control)
    out.u_ind =
        out.scalars.at(travel_of(run_.scene.contacts[0])) * run_.scene.contacts[0].control->along;
  return out;
}

// On a mesh that a homogeneous state replaced: u' is linear in X, and the nodal forces of a
// homogeneous deformation are P' times the integrals of the shape function gradients, with P' = 1/V
// sum f'_c X_c^T over the corners of the hexahedron.
StepRecord Sensitivity::of_mesh(const StepRecord& derivative, const StepRecord& whole) const {
  const Mesh& point = run_.reduction.mesh();
  const Assembler& mesh = *run_.reduction.mesh_of_point();
  StepRecord out = derivative;
  out.u.clear();
  out.reaction.assign(whole.u.size(), Vec3::Zero());
  for (const std::array<double, 8>& N : run_.reduction.point()->weights()) {
    Vec3& u = out.u.emplace_back(Vec3::Zero());
    for (std::size_t c = 0; c < 8; ++c) u += N[c] * derivative.u[c];
  }
  Mat3 P = Mat3::Zero();
  for (std::size_t c = 0; c < 8; ++c) P += derivative.reaction[c] * point.X[c].transpose();
  double volume = 0;
  for (int e = 0; e < mesh.mesh().n_cells(); ++e) volume += mesh.geometry(e).V;
  P /= volume;
  VecX f = VecX::Zero(3 * static_cast<Eigen::Index>(whole.u.size()));
  for (int e = 0; e < mesh.mesh().n_cells(); ++e) {
    const ElementGeometry& geometry = mesh.geometry(e);
    const auto nodes = mesh.mesh().cell(e);
    for (int g = 0; g < geometry.n_gauss(); ++g)
      for (std::size_t a = 0; a < nodes.size(); ++a)
        f.segment<3>(3 * nodes[a]) +=
            geometry.w[g] * P * geometry.dN_dX[g].row(static_cast<Eigen::Index>(a)).transpose();
  }
  for (const Prescribed& p : mesh.dofs().prescribed)
    out.reaction[static_cast<std::size_t>(p.dof / 3)][p.dof % 3] = f[p.dof];
  return out;
}

// Writes the derivatives of displacements, reactions, forces, torques and energy into the record.
void Sensitivity::write(StepRecord& whole) const {
  const std::vector<RigidContact>& contacts = run_.scene.contacts;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const SceneParameter& p = parameters()[i];
    const StepRecord& d = now_[i];
    whole.point_fields[derivative_name("u", p)] = d.u;
    whole.point_fields[derivative_name("reaction", p)] = d.reaction;
    auto& scalars = whole.scalars;
    for (const auto& [field, values] : d.point_fields)
      whole.point_fields[derivative_name(field, p)] = values;
    if (has_mass_of_its_own())
      for (const char* name : motion_of_indenter)
        scalars[derivative_name(name, p)] = d.scalars.at(name);
    scalars[derivative_name("energy_N_mm", p)] = d.scalars.at("energy");
    if (!contacts.empty()) scalars[derivative_name("force_N", p)] = force_derivative(whole, d);
    for (int k = 0; k < 3 && !contacts.empty(); ++k)
      scalars[derivative_name(std::string("force_") + "xyz"[k] + "_N", p)] = d.force_ind[k];
    for (const RigidContact& contact : contacts) {
      if (contacts.size() > 1)
        scalars[derivative_name("force_" + contact.name + "_N", p)] = derivative_against(
            indenter_at(contact, whole), force_on(whole, contact.name), force_on(d, contact.name));
      if (contact.control)
        scalars[derivative_name(travel_of(contact) + "_mm", p)] = d.scalars.at(travel_of(contact));
    }
    for (const SurfaceContact& surface : run_.scene.surfaces) {
      const Vec3 force = force_on(d, surface.name);
      scalars[derivative_name("force_" + surface.name + "_N", p)] =
          derivative_against(Vec3::Zero(), force_on(whole, surface.name), force);
      for (int k = 0; k < 3; ++k)
        scalars[derivative_name("force_" + surface.name + "_" + "xyz"[k] + "_N", p)] = force[k];
    }
    for (const std::string& set : moved_) {
      Vec3 sum = Vec3::Zero();
      for (int node : run_.mesh.node_sets.at(set))
        sum += d.reaction[static_cast<std::size_t>(node)];
      for (int k = 0; k < 3; ++k)
        scalars[derivative_name("reaction_" + set + "_" + "xyz"[k] + "_N", p)] = sum[k];
    }
    for (const auto& [torque, value] : torque_derivatives(whole, d, run_.mesh, run_.scene))
      scalars[derivative_name(torque + "_N_mm", p)] = value;
    for (const auto& [name, nodes] : run_.mesh.node_sets)  // what forces and pressures move
      for (int k = 0; k < 3 && nodes.size() == 1 && !run_.scene.loads.empty(); ++k)
        scalars[derivative_name("u_" + std::string(1, "xyz"[k]) + "_" + name + "_mm", p)] =
            d.u[static_cast<std::size_t>(nodes[0])][k];
  }
}

// From the states before and at the step that is kept last, and their derivatives.
BondRates Sensitivity::kept_bonds(std::size_t i) const {
  const IncrementState& state = run_.increment.state();
  Bonds bonds(state.contacts);
  if (bonds.none()) return {};
  const std::vector<Vec3>& X = state.body.mesh().X;
  const std::vector<Vec3> c = state.indenters(last_.t, last_.travel);
  bonds.begin(earlier_.bonds, (last_.t - earlier_.t) * state.options.seconds, X, earlier_.u,
              state.indenters(earlier_.t, earlier_.travel));
  bonds.evaluate(X, last_.u, c);
  ParameterChange change;
  add_contact_change(i, change);
  const BondChanges changes(bonds, state.contacts, X, last_.u, c);
  return changes.after({change, d_earlier_[i].bonds}, d_last_[i].u, last_.r, earlier_.r);
}

// Restores the derivatives of a state that an earlier run kept, to continue from it.
void Sensitivity::kept(const StepRecord& whole) {
  earlier_ = std::move(last_);
  last_ = run_.reduction.reduced(whole);
  d_earlier_ = std::move(d_last_);
  d_last_.clear();
  for (const SceneParameter& p : parameters()) {
    StepRecord like = whole;
    like.u = whole.point_fields.at(derivative_name("u", p));
    if (run_.inertia)
      for (const char* field : motion_fields)
        like.point_fields[field] = whole.point_fields.at(derivative_name(field, p));
    if (has_mass_of_its_own())
      for (const char* name : motion_of_indenter)
        like.scalars[name] = whole.scalars.at(derivative_name(name, p));
    StateDerivative& d = d_last_.emplace_back();
    BodyState of_part = run_.reduction.reduced(like);
    d.u = std::move(of_part.u);
    d.motion = std::move(of_part.motion);
    for (const RigidContact& contact : run_.scene.contacts)
      if (contact.control)
        d.travel = whole.scalars.at(derivative_name(travel_of(contact) + "_mm", p));
  }
  for (std::size_t i = 0; i < d_last_.size(); ++i) d_last_[i].bonds = kept_bonds(i);
  if (!neighbours_) return;
  neighbours_->begin((last_.t - earlier_.t) * run_.increment.state().options.seconds);
  for (std::size_t i = 0; i < d_last_.size(); ++i)
    neighbours_->accept(i, earlier_.u, d_earlier_[i].u, last_.u, d_last_[i].u);
}

}  // namespace langer
