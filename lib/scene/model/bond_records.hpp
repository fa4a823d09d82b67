// Bonds of contacts that adhere, and their energies, in the record of a step and from there.
#pragma once

#include "mechanics/solve/increment.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

// Adds what bonds bear to forces that the record has of the contact law alone.
void record_bonds(const Increment& increment, StepRecord& record);

Bond bond_of(const ContactRecord& contact, std::size_t candidate);
BondEnergy bond_energies(const StepRecord& step);
void take_bonds(const StepRecord& step, const Scene& scene, BodyState& state);

}  // namespace langer
