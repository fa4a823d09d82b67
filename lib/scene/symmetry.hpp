// A scene that is its own image under a mirror plane or a half turn is solved on the part of the body that decides the rest.
//   recognised from  mesh and bodies, fibre directions (up to their sign), supports and imposed displacements, indenters and
//                    their paths; all of them must agree
//   not recognised   indenters read from a file; planes and axes that are not parallel to the coordinate planes or do not pass
//                    through the middle of the body
// The reduced scene finds symmetric equilibria only: it cannot leave them where they become unstable, and the signs of its
// tangent are those for symmetric movements. Results are written for the whole body.
// A mesh that is a section (mesh/section.hpp) is another such part: the nodes behind z = 0 move as those in it. Its results are
// written for its own nodes, those in z = 0 with the forces of the whole circle or slab; those of them along x are radial there,
// and only the resultant along y is a force on the indenter.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "mesh/symmetry.hpp"
#include "scene/scene.hpp"
#include "scene/solve_config.hpp"
#include "solve/statics.hpp"
#include "store/solution_file.hpp"

namespace langer {

class ReducedScene {
 public:
  // Nothing where `wanted` is none, or auto and nothing is found; a section always.
  // Throws Failure(config) where a named symmetry is not there, saying what breaks it.
  static std::optional<ReducedScene> find(SymmetryChoice wanted, const Mesh& mesh, const Scene& scene,
                                          const std::function<Place(const std::string&)>& where);

  const Mesh& mesh() const { return quotient_.mesh; }
  const Scene& scene() const { return scene_; }
  const std::vector<double>& cell_share() const { return quotient_.cell_share; }
  const std::string& words() const { return words_; }  // "half turn about y through (18, 18): 6160 of 12320 cells"

  StepRecord whole(const StepRecord& reduced) const;  // of the whole body
  BodyState reduced(const StepRecord& whole) const;   // to continue from

 private:
  static ReducedScene of_section(const Mesh& mesh, const Scene& scene);
  void take_contact(const RigidContact& contact);

  Quotient quotient_;
  Scene scene_;
  std::string words_;
  // by contact, by candidate of the whole body: the candidate of the reduced scene that is like it, and how its force turns
  std::vector<std::vector<Image>> candidate_;
  std::vector<std::vector<double>> candidate_share_;  // by reduced candidate
  Vec3 kept_directions_ = Vec3::Ones();               // 0 where the resultant of any symmetric field vanishes
};

}  // namespace langer
