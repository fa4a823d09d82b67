#include "scene/run/reduction.hpp"

#include <fmt/format.h>

#include "scene/model/scene_parameters.hpp"
#include "scene/model/scene_section.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

Reduction::Reduction(const Mesh& mesh, const Scene& scene, std::optional<ReducedScene> part,
                     int threads)
    : mesh_(mesh), scene_(scene), threads_(threads), part_(std::move(part)) {}

Reduction::Reduction(const Mesh& mesh, const Scene& scene, std::unique_ptr<HomogeneousScene> point)
    : mesh_(mesh), scene_(scene), point_(std::move(point)) {}

// The smallest model with the same solution: one hexahedron, else a part bounded by planes of
// symmetry (or a section), else the whole body. Parameters whose derivatives are asked for have to
// keep the symmetry, so a scene with all of them changed is examined too.
Reduction Reduction::find(const Mesh& mesh, const Scene& scene, const SolveConfig& config,
                          const std::function<Place(const std::string&)>& where, bool at_a_point) {
  const SceneParameters parameters(config, mesh, scene, where);
  // A mode has the shape that a hexahedron alone or a part of the body does not have.
  const bool all_of_it = config.branch || config.imperfection;
  const bool on_a_mesh = all_of_it || config.path.arc_length;
  for (const LoadConfig& load : config.loads) at_a_point = at_a_point && !load.volume;
  at_a_point = at_a_point && !on_a_mesh;
  const SymmetryChoice wanted = all_of_it ? SymmetryChoice::none : config.symmetry;
  // A change of fibre angles would shear a body that is only stretched: no single hexahedron then.
  if (at_a_point && !scene.motion && !parameters.turns_fibres() && !parameters.moves_mesh())
    if (auto point = HomogeneousScene::find(mesh, scene, config))
      return {mesh, scene, std::move(point)};
  if (config.sensitivity.empty()) {
    // the length of an arc is that of displacements as they are seen from rest
    auto seen = ReducedScene::Seen::from_half_way;
    if (config.path.arc_length) seen = ReducedScene::Seen::from_rest;
    return {mesh, scene, ReducedScene::find(wanted, mesh, scene, where, nullptr, seen),
            config.threads};
  }
  const Scene varied = parameters.varied_unlike(scene, mesh);
  if (mesh.section)
    if (const auto errors = section_errors(config, mesh, varied, where); !errors.empty())
      throw Failure(Exit::config, Error{where("sensitivity"), "sensitivity",
                                        "found a number that a section has to leave as it is",
                                        "others", errors.front().found});
  return {mesh, scene, ReducedScene::find(wanted, mesh, scene, where, &varied), config.threads};
}

Reduction::Kind Reduction::kind() const {
  if (point_) return Kind::homogeneous;
  if (!part_) return Kind::none;
  return mesh_.section ? Kind::section : Kind::symmetry;
}

const Mesh& Reduction::mesh() const {
  if (point_) return point_->mesh();
  if (part_) return part_->mesh();
  return mesh_;
}

const Scene& Reduction::scene() const {
  if (point_) return point_->scene();
  if (part_) return part_->scene();
  return scene_;
}

// Cells on a plane of symmetry belong to the part with a share only; loads are shared likewise.
Assembler Reduction::assembler(std::optional<Division> division) const {
  std::vector<double> share;
  if (part_) share = part_->cell_share();
  Loads loads;
  if (!scene().loads.empty()) loads = Loads(mesh(), scene().loads, share);
  const int threads = point_ ? 1 : threads_;
  return Assembler(mesh(), scene().materials, scene().directions, scene().formulation, scene().dofs,
                   threads, Kernel::packets, share, std::move(division), std::move(loads));
}

std::unique_ptr<Assembler> Reduction::assembler_on(const Mesh& moved) const {
  return assembler_on(moved, scene().materials, scene().directions);
}

std::unique_ptr<Assembler> Reduction::assembler_on(const Mesh& mesh,
                                                   std::vector<Material> materials,
                                                   Directions directions) const {
  std::vector<double> share;
  if (part_) share = part_->cell_share();
  return std::make_unique<Assembler>(mesh, std::move(materials), std::move(directions),
                                     scene().formulation, scene().dofs, threads_, Kernel::packets,
                                     share);
}

Solver Reduction::solver(const Solver& asked) const {
  if (point_) return point_->solver();
  return asked;
}

std::string Reduction::words() const {
  switch (kind()) {
    case Kind::homogeneous:
      return fmt::format("homogeneous: one hexahedron stands for {} cells", mesh_.n_cells());
    case Kind::symmetry:
      return "symmetry: " + part_->words();
    case Kind::section:
      return part_->words();
    case Kind::none:
      break;
  }
  return "";
}

// The step on the user's mesh. Nothing if the body no longer deforms homogeneously.
std::optional<StepRecord> Reduction::whole(const StepRecord& of_part) const {
  if (point_) return point_->whole(of_part);
  if (part_) return part_->whole(of_part);
  return of_part;
}

SolveReport Reduction::report(const SolveReport& of_part, const StepRecord& of_whole) const {
  if (point_) return point_->report(of_part, of_whole);
  return of_part;
}

std::vector<Dofs> Reduction::symmetry_breaking_dofs() const {
  if (!part_) return {};
  return part_->symmetry_breaking_dofs();
}

const HomogeneousScene* Reduction::point() const { return point_.get(); }

const ReducedScene* Reduction::part() const {
  if (part_) return &*part_;
  return nullptr;
}

Assembler* Reduction::mesh_of_point() const {
  if (point_) return &point_->of_mesh();
  return nullptr;
}

void Reduction::replay(const StepRecord& of_whole) const {
  if (point_) point_->replay(of_whole);
}

// A recorded step of the whole body as a state of the model that is solved.
BodyState Reduction::reduced(const StepRecord& of_whole) const {
  if (point_) return point_->reduced(of_whole);
  if (part_) return part_->reduced(of_whole);
  return state_of(of_whole, scene_);
}

}  // namespace langer
