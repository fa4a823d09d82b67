// The stress of each cell in the records of a path, where the config asks for it (cell_stress).
//   stress                   Cauchy stress [MPa], mean over the cell's Gauss points, as pressure and von_mises beside it are:
//                            xx xy xz yx yy yz zx zy zz
//   principal_stress_k       its eigenvalues [MPa], greatest first
//   principal_direction_k    unit eigenvectors (x, y, z); the sign means nothing, nor does the direction where two of them are equal
// It follows from the displacements of the whole body, whatever part of it was solved, so that
// images are turned rightly.
#pragma once

#include <optional>

#include "results/post/viscous_path.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

enum class CellStress;

class CellStressRecorder {
 public:
  // Refers to the mesh. Steps come in the order of the path, from the first one.
  CellStressRecorder(const Mesh& mesh, const Scene& scene, const std::optional<CellStress>& wanted);
  void kept(const StepRecord& step);  // a step of an earlier run, which has its fields
  void add(StepRecord& whole);        // the next step: adds the fields

 private:
  bool directions_;
  std::optional<Body> body_;  // none where nothing is wanted
  std::optional<ViscousPath> branches_;
};

}  // namespace langer
