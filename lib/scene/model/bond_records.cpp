#include "scene/model/bond_records.hpp"

#include <algorithm>

namespace langer {

// Adds the adhesive forces, the damage of each bond and the energies to a record. Adhesion pulls at
// the indenter too: its resultant belongs to the recorded force.
void record_bonds(const Increment& increment, StepRecord& record) {
  const Bonds& bonds = increment.bonds();
  const BodyState& state = increment.accepted();
  double bonded = 0;
  const auto add = [&](std::size_t k, const auto& law) {
    ContactRecord& contact = record.contacts.at(law.name);
    contact.adhesive = bonds.forces(k);
    for (const Bond& bond : state.bonds[k]) {
      contact.beta.push_back(bond.made ? bond.beta : -1);
      contact.bonded_at.push_back(bond.at);
    }
    for (std::size_t i = 0; i < law.nodes.size(); ++i)
      bonded += law.area[i] * state.bonds[k][i].beta;
  };
  const std::size_t n_rigid = increment.contacts().size();
  const bool several = n_rigid > 1 || !increment.surfaces().empty();
  for (std::size_t k = 0; k < n_rigid; ++k) {
    if (!bonds.of(k)) continue;
    const RigidContact& law = increment.contacts()[k];
    add(k, law);
    const Vec3 sum = bonds.sum(k);
    record.force_ind -= sum;
    for (int j = 0; j < 3 && several; ++j)
      record.scalars.at("force_" + law.name + "_" + "xyz"[j]) -= sum[j];
  }
  for (std::size_t s = 0; s < increment.surfaces().size(); ++s)
    if (bonds.of(n_rigid + s)) add(n_rigid + s, increment.surfaces()[s]);
  record.scalars["bonded_area"] = bonded;
  record.scalars["adhesion_stored"] = bonds.stored();
  record.scalars["adhesion_dissipated"] = state.in_bonds.dissipated;
  record.scalars["energy_released"] = state.in_bonds.released;
  record.scalars["work_of_jumps"] = state.in_bonds.work_of_jumps;
}

// The recorded beta is -1 for a candidate that has never touched.
Bond bond_of(const ContactRecord& contact, std::size_t candidate) {
  return {std::max(contact.beta[candidate], 0.0), contact.bonded_at[candidate],
          contact.beta[candidate] >= 0};
}

BondEnergy bond_energies(const StepRecord& step) {
  const auto& of = step.scalars;
  if (!of.count("adhesion_stored")) return {};
  return {of.at("adhesion_dissipated"), of.at("energy_released"), of.at("work_of_jumps"),
          of.at("energy") + of.at("adhesion_stored")};
}

// The inverse of record_bonds: the bonds of a recorded state, from which a run continues.
void take_bonds(const StepRecord& step, const Scene& scene, BodyState& state) {
  state.in_bonds = bond_energies(step);
  if (!step.scalars.count("adhesion_stored")) return;
  const auto take = [&](const std::string& contact) {
    const ContactRecord& record = step.contacts.at(contact);
    std::vector<Bond>& bonds = state.bonds.emplace_back();
    for (std::size_t i = 0; i < record.beta.size(); ++i) bonds.push_back(bond_of(record, i));
  };
  for (const RigidContact& contact : scene.contacts) take(contact.name);
  for (const SurfaceContact& surface : scene.surfaces) take(surface.name);
}

}  // namespace langer
