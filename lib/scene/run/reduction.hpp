// The part of a body that is solved in place of the whole.
//   none         the body itself
//   symmetry     what mirror planes or a half turn leave of it (scene/model/scene_symmetry.hpp)
//   section      a section as a part of the body that it stands for (mesh/section.hpp)
//   homogeneous  one hexahedron, where all cells deform alike (run/homogeneous.hpp)
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "scene/model/scene_symmetry.hpp"
#include "scene/run/homogeneous.hpp"

namespace langer {

using Solver = std::variant<NewtonOptions, KinsolOptions>;

class Reduction {
 public:
  enum class Kind { none, symmetry, section, homogeneous };

  // What `config` lets be found; at_a_point: one hexahedron may do. All refer to mesh and scene.
  // Throws Failure(config) where the config names a symmetry that is not there.
  static Reduction find(const Mesh& mesh, const Scene& scene, const SolveConfig& config,
                        const std::function<Place(const std::string&)>& where,
                        bool at_a_point = false);
  // by symmetry or to a section, or none
  Reduction(const Mesh& mesh, const Scene& scene, std::optional<ReducedScene> part,
            int threads = 1);
  Reduction(const Mesh& mesh, const Scene& scene, std::unique_ptr<HomogeneousScene> point);

  Kind kind() const;
  const Mesh& mesh() const;  // of the part, as what follows
  const Scene& scene() const;
  Assembler assembler(std::optional<Division> division = {}) const;
  // Of the elements alone where nodes of mesh() lie elsewhere at rest; refers to `moved`.
  std::unique_ptr<Assembler> assembler_on(const Mesh& moved) const;
  // The same with other materials and directions.
  std::unique_ptr<Assembler> assembler_on(const Mesh& mesh, std::vector<Material> materials,
                                          Directions directions) const;
  Solver solver(
      const Solver& asked) const;  // more exact for a hexahedron, where that costs nothing
  std::string words()
      const;  // "symmetry: half turn about y through (18, 18): 6160 of 12320 cells"; empty for none

  // Of the whole body; nothing where that does not balance though its part does: it is not
  // homogeneous.
  std::optional<StepRecord> whole(const StepRecord& of_part) const;
  SolveReport report(const SolveReport& of_part,
                     const StepRecord& of_whole) const;  // as if the body had been solved
  BodyState reduced(const StepRecord& of_whole) const;   // to continue from
  void replay(const StepRecord& of_whole) const;  // of a viscous body: a step that was found before
  // Constraints of the part for movements that break the symmetry it was found by, one for each
  // kind; empty where there is none.
  std::vector<Dofs> symmetry_breaking_dofs() const;
  const HomogeneousScene* point() const;  // or nullptr
  const ReducedScene* part() const;       // or nullptr
  Assembler* mesh_of_point() const;       // the mesh that a hexahedron stands for, at the state
                                          // whole() was asked for last; else nullptr

 private:
  const Mesh& mesh_;
  const Scene& scene_;
  int threads_ = 1;
  std::optional<ReducedScene> part_;
  std::unique_ptr<HomogeneousScene> point_;
};

}  // namespace langer
