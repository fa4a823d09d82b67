// Bodies whose fibres lie as the angles of their laws and the frames of their cells say.
#pragma once

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/mesh/directions.hpp"
#include "results/post/nodal_fields.hpp"

namespace langer::test {

inline Directions directions(const Mesh& mesh, const std::vector<Material>& materials) {
  return make_directions(mesh, fibre_angles(materials));
}

inline Assembler equilibrium(const Mesh& mesh, const std::vector<Material>& materials,
                             Formulation formulation, Dofs dofs, int threads = 1,
                             Kernel kernel = Kernel::packets,
                             std::optional<Division> division = {}) {
  return Assembler(mesh, materials, directions(mesh, materials), formulation, std::move(dofs),
                   threads, kernel, {}, std::move(division));
}

inline Body body(const Mesh& mesh, const std::vector<Material>& materials,
                 Formulation formulation) {
  return Body(mesh, materials, directions(mesh, materials), formulation);
}

}  // namespace langer::test
