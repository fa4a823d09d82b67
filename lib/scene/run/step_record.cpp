#include "scene/run/step_record.hpp"

#include <filesystem>

#include "core/base/error.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/material/at_rest.hpp"
#include "results/store/material_file.hpp"
#include "scene/model/bond_records.hpp"
#include "scene/model/scene_motion.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/motion_record.hpp"
#include "scene/run/surface_records.hpp"

namespace langer {

Material material_from(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".yaml" || extension == ".yml")
    return read_config<Material>(load_yaml(path)).config;
  return read_material(path).material;
}

// A material without stiffness at rest is refused: the first tangent would be singular.
Material material_of_body(const std::string& path) {
  const Material material = material_from(path);
  if (at_rest(material) == AtRest::without_stiffness)
    throw Failure(Exit::input, Error{{path},
                                     "",
                                     "a law with " + at_rest_in_words(material),
                                     stiffness_at_rest_cure(material),
                                     "a body without it has no first step"});
  return material;
}

// The part of a solution file that is the same for all steps.
SolutionHeader header_of(const Mesh& mesh, Formulation formulation, const Scene& scene,
                         const Identity& identity) {
  SolutionHeader header;
  header.mesh = mesh;
  header.material = scene.materials.front();
  if (scene.materials.size() > 1) header.materials = scene.materials;
  header.directions = scene.directions;
  header.formulation = names(formulation)[static_cast<int>(formulation)];
  for (const RigidContact& contact : scene.contacts) {
    header.contact_nodes[contact.name] = contact.nodes;
    if (const Triangles* triangles = triangles_of(contact.shape))
      header.indenter_surfaces[contact.name] = *triangles;
  }
  for (const SurfaceContact& surface : scene.surfaces)
    header.contact_nodes[surface.name] = surface.nodes;
  header.identity = identity;
  return header;
}

namespace {

// Adds means over the Gauss points of each cell: J, mean stress, von Mises stress of the mean
// Cauchy stress, and I4_bar of the first fibre family.
void add_cell_fields(StepRecord& record, const Assembler& body, const VecX& u) {
  const int n = body.mesh().n_cells();
  // a first family without direction (kappa = 1/3) has no stretch
  bool fibres = false;
  for (int e = 0; e < n; ++e) {
    if (body.fibres(e).empty()) continue;
    const std::vector<Fibre>& families = body.material(e).fibres;
    fibres = fibres || families.empty() || 1 - 3 * families[0].kappa > 1e-12;
  }
  for (const char* name : {"J", "pressure", "von_mises"}) record.cell_fields[name].resize(n);
  if (fibres) record.cell_fields["I4_bar"].resize(n);
  std::vector<double>& J = record.cell_fields["J"];
  std::vector<double>& pressure = record.cell_fields["pressure"];
  std::vector<double>& mises = record.cell_fields["von_mises"];
  for (int e = 0; e < n; ++e) {
    const auto a = body.fibres(e);
    Mat3 sigma = Mat3::Zero();
    std::vector<Vec6> branches;  // stresses of the viscous branches at the Gauss points
    if (body.viscous()) branches = body.viscous_points()->stresses(e);
    const auto states = gauss_states(body.formulation(), body.material(e), body.geometry(e), a,
                                     body.element_displacements(u, e), branches);
    const double w = 1.0 / static_cast<double>(states.size());
    for (const GaussState& g : states) {
      sigma += w * g.sigma;
      J[e] += w * g.J;
    }
    pressure[e] = mean_stress(sigma);
    mises[e] = von_mises(sigma);
    if (fibres) {
      if (a.empty()) {
        record.cell_fields["I4_bar"][e] = 1;
      } else {
        record.cell_fields["I4_bar"][e] = mean_I4_bar(states, a[0]);
      }
    }
  }
}

}  // namespace

// A hanging node is the mean of the four nodes of the face on which it is.
void hang(const Assembler& body, const VecX& u, std::vector<Vec3>& nodal) {
  for (const HangingNode& h : body.mesh().hanging) {
    nodal[h.node].setZero();
    for (int n : h.of) nodal[h.node] += 0.25 * displacement(body.dofs(), u, n);
  }
}

std::string of_volume(const char* name, const Loads& loads, int i) {
  if (loads.n_volumes() == 1) return name;
  return std::string(name) + "_" + loads.volume_load(i).on;
}

VecX pressures_of(const StepRecord& step, const Loads& loads) {
  VecX pressures = VecX::Zero(loads.n_volumes());
  for (int i = 0; i < loads.n_volumes(); ++i) {
    const auto found = step.scalars.find(of_volume("load_pressure", loads, i));
    if (found != step.scalars.end()) pressures[i] = found->second;
  }
  return pressures;
}

Vec3 indenter_at(const RigidContact& indenter, const StepRecord& step) {
  return indenter_displacement(indenter, load_factor_of(step),
                               indenter.control ? step.scalars.at("travel_" + indenter.name) : 0);
}

// What is written of an accepted state: displacements, reactions, contact and energies.
StepRecord step_record(const Increment& increment, const Assembler& body, double taken, double next,
                       const SolveReport& report) {
  const BodyState& state = increment.accepted();
  StepRecord record;
  record.t = state.t;
  record.increment = taken;
  record.iterations = report.iterations;
  if (report.reference > 0) {
    record.residual = report.residual / report.reference;
  } else {
    record.residual = report.residual;
  }
  const VecX reactions = increment.reactions();
  for (int i = 0; i < body.mesh().n_nodes(); ++i) {
    record.u.push_back(state.u.segment<3>(3 * i));
    record.reaction.push_back(reactions.segment<3>(3 * i));
  }
  hang(body, state.u, record.u);
  add_cell_fields(record, body, state.u);
  record.scalars["next_increment"] = next;  // a run that is continued takes the same increments
  record.scalars["J_min"] = body.J_min();
  record.scalars["energy"] = body.W();
  if (body.viscous()) record.scalars["viscous_work"] = body.viscous_work();
  for (int i = 0; i < body.loads().n_volumes(); ++i) {
    record.scalars[of_volume("load_pressure", body.loads(), i)] = state.pressures[i];
    record.scalars[of_volume("pumped_volume", body.loads(), i)] = body.swept_volume(i, state.u);
  }
  if (!increment.surfaces().empty()) record_surfaces(increment, record);
  if (increment.inertia()) record_motion(increment, body, record);
  const auto& contacts = increment.contacts();
  const auto defects = increment.defects();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const ContactDefect& d = defects[k];
    ContactRecord& contact = record.contacts[contacts[k].name];
    contact.r = state.r[k];
    contact.gap = d.gap;
    for (ContactStatus status : d.status) contact.status.push_back(static_cast<int>(status));
    for (const auto& [name, value] : {std::pair{"penetration", d.penetration},
                                      {"cone", d.cone},
                                      {"complementarity", d.complementarity}})
      record.scalars[name] = std::max(record.scalars[name], value);
    if (contacts.size() > 1 || !increment.surfaces().empty())
      for (int j = 0; j < 3; ++j)
        record.scalars["force_" + contacts[k].name + "_" + "xyz"[j]] = -d.force[j];
  }
  if (const RigidContact* controlled = increment.controlled())
    record.scalars["travel_" + controlled->name] = state.travel;
  if (!contacts.empty()) record.u_ind = indenter_at(contacts[0], record);
  for (const ContactDefect& d : defects) record.force_ind -= d.force;  // of all indenters
  if (!increment.bonds().none()) record_bonds(increment, record);
  return record;
}

// The inverse of step_record: the state from which a run continues.
BodyState state_of(const StepRecord& record, const Scene& scene) {
  BodyState state;
  state.t = load_factor_of(record);
  state.u.resize(3 * static_cast<Eigen::Index>(record.u.size()));
  for (std::size_t i = 0; i < record.u.size(); ++i)
    state.u.segment<3>(3 * static_cast<Eigen::Index>(i)) = record.u[i];
  for (const RigidContact& contact : scene.contacts) {
    state.r.push_back(record.contacts.at(contact.name).r);
    if (contact.control) state.travel = record.scalars.at("travel_" + contact.name);
  }
  for (const SurfaceContact& surface : scene.surfaces)
    state.r.push_back(record.contacts.at(surface.name).r);
  take_bonds(record, scene, state);
  if (!scene.motion) return state;
  const auto kept = [](const std::vector<Vec3>& nodal, bool) {
    VecX all(3 * static_cast<Eigen::Index>(nodal.size()));
    for (std::size_t i = 0; i < nodal.size(); ++i)
      all.segment<3>(3 * static_cast<Eigen::Index>(i)) = nodal[i];
    return all;
  };
  state.motion = recorded_motion(record, kept);
  return state;
}

}  // namespace langer
