// Config and files -> the value types that mechanics works on; names are resolved here.
// Throws Failure(config) with the place of the key: a set that the mesh does not have, two
// different values for one dof, fibre angles that do not match the material, a formulation that
// does not suit the cells.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "mechanics/assembly/dofs.hpp"
#include "mechanics/assembly/loads.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/directions.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mortar/surface_contact.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

struct Scene {
  Formulation formulation = Formulation::mean_dilatation;
  std::vector<Material>
      materials;            // one for each body of the mesh; families with c1 = 0 keep their place
  Directions directions{};  // of the fibres, in every cell
  Dofs dofs;
  std::vector<SurfaceLoad> loads;             // empty: no code of loads runs
  std::vector<RigidContact> contacts;         // empty: no contact code runs
  std::vector<SurfaceContact> surfaces = {};  // deformable surfaces that touch
  std::vector<TurnedSet> turned;              // their nodes are prescribed in dofs
  std::optional<InertiaOptions> motion;       // none: equilibrium
  std::optional<double> motion_step;          // length of all increments [s]; none: by motion_error
  double motion_error = 1e-3;                 // that an increment may make
  std::vector<double> stops;  // values of t where an indenter turns, or a history has a kink

  int families()
      const;  // with c1 other than 0, in the body that has most of them: others cost nothing
};

// a family that acts, and not in all directions alike
inline bool has_direction(const Fibre& family) {
  return acts(family) && family.kappa < 1.0 / 3 - 1e-12;
}

// shape, friction and path as the config gives them; no candidates
RigidContact indenter_of(const std::string& name, const ContactConfig& contact,
                         const LoadPathOptions& path);

std::vector<TurnedSet> turned_sets(const SolveConfig& config,
                                   const Mesh& mesh);  // those whose set the mesh has

// material: of the bodies that `materials` gives none
Scene make_scene(const SolveConfig& config, const Mesh& mesh,
                 const std::optional<Material>& material,
                 const std::function<Place(const std::string&)>& where);

}  // namespace langer
