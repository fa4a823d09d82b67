// The choice of the model that is solved for a scene, and of the next one:
//   body        the block, or an axisymmetric section in its place (section_in_place.hpp)
//   mesh        cells and increments of a level (accuracy.hpp), or cells that are cut
//               (adaptive_cells.hpp)
//   one point   instead of the mesh of a body that deforms homogeneously
// decide() follows each solution, until one is accepted or no further model is left.
#pragma once

#include "accuracy/refinement/accuracy.hpp"
#include "accuracy/refinement/adaptive_cells.hpp"
#include "accuracy/refinement/section_in_place.hpp"

namespace langer {

class ModelChoice {
 public:
  using Where = Accuracy::Where;
  // config as it was written; file: of the mesh, empty where it is the config's. material: of the
  // bodies that the config names none for
  ModelChoice(const Voice& voice, const SolveConfig& config, const std::string& file,
              const std::optional<Material>& material, Where where, bool dry);

  const SolveConfig& config() const { return accuracy_.config(); }  // to be solved
  Mesh mesh();  // on it; says where its cells are cut before the first solution
  bool at_a_point() const { return at_a_point_; }
  // Symmetry leaves this share of the cells to be solved.
  void solves_part(double share) { accuracy_.solves_part(share); }
  // What follows from the errors of a solution on this mesh. After `refine`, config() and mesh()
  // are those of the next level: a finer one if the errors are too large, or the level before if a
  // finer one had larger errors. That level is then the last. Prints what it does.
  Decision decide(const PathErrors& errors, const Mesh& mesh);
  // The same after a level that found no equilibrium: whether there is another level to solve.
  bool retry_after(const Failure& failure);
  // The body has ceased to deform homogeneously: its mesh continues from the recorded steps.
  // Prints it.
  void leave_homogeneous_point();

  // CPU seconds that the meshes of cut cells will take after this one. The error of the first mesh
  // decides, so `run` is solved if that is quick; 0 and a message where it is not.
  double seconds_of_cuts(Run& run) const;
  // CPU seconds that forecasts took so far, which a run does not need
  double seconds_of_forecasts() const { return accuracy_.seconds_of_forecasts(); }

  // Marks errors whose limit is accurate enough while their value is not.
  void name_answers(std::vector<ErrorEstimate>& errors) const;
  std::vector<Summary> summary(const std::vector<ErrorEstimate>& errors) const;
  // Throws Failure(not_accurate) where the errors exceed what was asked for.
  void require_accuracy(const std::vector<ErrorEstimate>& errors, const std::string& output) const {
    std::string cheaper;
    if (section_.offered()) {
      cheaper = "reduce: auto solves a section, on which short cells are cheap; ";
    }
    accuracy_.require(errors, output, cheaper);
  }

 private:
  // Solves `run`: the share of its error that is wanted; nothing where it is met or not known.
  std::optional<double> wanted_share_on(Run& run) const;
  Accuracy of_model() const;
  bool cut(const PathErrors& errors, const Mesh& mesh);

  Voice voice_;
  SolveConfig asked_;
  std::string file_;
  std::optional<Material> material_;
  Where where_;
  bool dry_;
  SectionInPlace section_;
  Accuracy accuracy_;
  std::optional<CutMesh> cells_;
  bool file_was_read_ = false;  // of the geometry: what was found in it has been printed
  struct Level {
    Accuracy accuracy;
    std::optional<CutMesh> cells;
    std::optional<double> percent = {};  // reached
  };
  void back_to_level_before(const std::string& why);
  std::optional<Level> before_;  // whose errors are known
  bool is_last_ = false;
  bool at_a_point_;
};

}  // namespace langer
