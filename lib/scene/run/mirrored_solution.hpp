// A solution that is the image of one that is there: of a member of a sweep by another that differs
// in its fibre angles only. Mirror planes, half and quarter turns about y through the middle of the
// mesh are tried, the identity too (0 and 180 degrees are the same fibres); scene and mesh have to
// be images by scene/model/scene_image.hpp, and each indenter and the first family of fibres its
// own.
//   u, reactions, forces    turned, of the node that is the image
//   J, stresses, I4_bar     of the cell that is the image
// The file is that of langer-solve to the last dataset; /provenance/image_of says what it is the
// image of.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/voice.hpp"
#include "mechanics/mesh/mirror_image.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

struct Mirrored {
  std::string
      words;  // "mirror x of ../alpha_010/solve/solution.h5"; empty where it is not the image
  std::string why_not;  // then
  std::vector<Summary> summary = {};
};

// What is to be solved, and a solution that may be its image. Nothing is written where it is not.
struct MirrorTask {
  const SolveConfig& config;
  const std::optional<Material>& material;  // that of the bodies that `materials` gives none
  std::function<Place(const std::string&)> where;
  const Identity& identity;
  std::string mesh_file;  // empty: the config has the mesh
  std::string of;         // the other solution
  std::string output;
};
Mirrored mirrored(const MirrorTask& task);
// The results of the image, written; nothing where it is not one. Says which, or why not.
std::optional<std::vector<Summary>> copy_mirrored_solution(const Voice& voice,
                                                           const MirrorTask& task);

struct MirrorOperation {
  std::string name;
  MeshImage symmetry;
};
// One by which `scene` becomes `image`; nothing and in `why_not` what keeps it, by the operation
// that came farthest.
std::optional<MirrorOperation> operation_between(const Mesh& mesh, const Scene& scene,
                                                 const Scene& image, std::string& why_not);

StepRecord image_of_step(const StepRecord& step, const MeshImage& g,
                         const std::vector<RigidContact>& contacts);

}  // namespace langer
