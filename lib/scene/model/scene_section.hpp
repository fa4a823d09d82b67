// What a scene on a section (mesh/section.hpp) may hold:
//   axisymmetric  indenters of revolution about the y axis that move along it
//   plane_strain  indenters that stand in z = 0; each is a bar along z with the section that it has there
//   both          no imposed movement along z, fibres only where they have no direction, or one that the section's symmetry keeps
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "scene/model/scene.hpp"

namespace langer {

// scene: with materials, fibres and contacts
std::vector<Error> section_errors(const SolveConfig& config, const Mesh& mesh, const Scene& scene,
                                  const std::function<Place(const std::string&)>& where);

std::string section_words(
    const Mesh& mesh);  // "axisymmetric section: forces and energies are those of the whole body"

}  // namespace langer
