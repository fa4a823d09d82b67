// A body between plane faces that are held or moved as wholes may deform alike everywhere: then one
// hexahedron between the same faces says what it does, on any mesh.
//   recognised  cells that fill their box, one material, the same fibres in all of them, no contact; every support, imposed
//               displacement, traction, force and pressure on whole faces of the box
//   proved      each state, expanded to the mesh, balances there: what is left at free nodes is rounding and the solver's tolerance
// The signs of the hexahedron's tangent are not those of the mesh, which buckles in more ways: the
// stability of the mesh is checked on the mesh (solve/cell_stability.hpp, or its factor).
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/solve/increment.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

class HomogeneousScene {
 public:
  // Nothing where the scene is not of this kind, or the first increment of its path says so. Refers
  // to the mesh.
  static std::unique_ptr<HomogeneousScene> find(const Mesh& mesh, const Scene& scene,
                                                const SolveConfig& config);

  const Mesh& mesh() const { return mesh_; }  // the hexahedron
  const Scene& scene() const { return scene_; }
  Assembler assembler() const;
  std::variant<NewtonOptions, KinsolOptions> solver() const {
    return solver_;
  }  // more exact than the config's: it costs nothing

  std::optional<StepRecord> whole(
      const StepRecord& one) const;  // of the mesh; nothing where that does not balance
  BodyState reduced(const StepRecord& whole) const;  // to continue from
  // what a solution on the mesh that ends in this state reports of its residual, by the config's
  // own tolerance
  SolveReport report(const SolveReport& of_point, const StepRecord& whole) const;
  const std::vector<std::array<double, 8>>& weights() const {
    return N_;
  }                                               // by node of the mesh: of the corners
  Assembler& of_mesh() const { return *whole_; }  // at the state that whole() was asked for last
  void replay(const StepRecord& whole) const;     // a step that was found before

 private:
  HomogeneousScene(const Mesh& mesh, const Scene& scene, const SolveConfig& config);
  bool recognise(const Mesh& mesh, const Scene& scene);
  bool first_increment_balances(const LoadPathOptions& path);
  bool balance(const VecX& u, double t) const;
  SolveReport on_mesh(double residual, double reactions,
                      SolveReport report) const;  // [N]; with the mesh's tolerances

  Mesh mesh_;
  Scene scene_;
  std::variant<NewtonOptions, KinsolOptions> asked_, solver_;  // the config's, and more exact
  std::array<int, 8> corner_node_;                             // of the mesh
  std::vector<std::array<double, 8>> N_;  // by node of the mesh: weights of the corners
  std::unique_ptr<Assembler> whole_;      // balance of the mesh
  double seconds_ = 0;                    // of the path
  double rounding_of_J_ = 0;  // kappa eps over the largest face: what that of det F leaves [N]
  mutable double t_ = 0;      // of the last step of a viscous body, and its displacements
  mutable VecX u_;
};

}  // namespace langer
