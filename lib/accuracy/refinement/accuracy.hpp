// The accuracy that a config asks for, and the loop that reaches it.
//
//   Level     element type, mesh size and largest increment
//   Estimate  error of the forces of its solution (accuracy/estimate)
//   Decision  accept, refine (to the next level) or stop with a reason
//
//           +--- refine ---+
//           v              |
//   Level -> solve -> Estimate -> Decision -> accept, or stop (exit code 5)
//
// The first level comes from a refinement study of three indentations (pipelines/
// refinement_study.yaml): isotropic without friction, and Table 1 of the paper at 60 degrees and
// c1 = +0.317 at 30 degrees with friction. Scenes of other kinds begin with coarse elements, whose
// estimate decides. Isotropic bodies without friction get hex27 below 1 %: their error falls
// fastest. All others get hex8. With friction the shear at the edge of the contact decides, and
// hex8 have more nodes there for the same time; with fibres, hex27 were up to 1.3 % off where hex8
// were 0.4 % (make accuracy). The constants are in accuracy/refinement/constants.hpp.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/refinement/decision.hpp"
#include "accuracy/refinement/level_cost.hpp"
#include "core/base/voice.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

struct AccuracyLevel {
  CellType cells;
  double edge;   // of the cells, in contact radii (IndentedBlock, IndentedDisc); in their own
                 // lengths where a config has no such key
  double step;   // largest increment, as a share of the path to the first waypoint's end
  double error;  // [%]
  bool in_contact_radii = true;
};
std::string in_words(const AccuracyLevel& level);
const std::vector<AccuracyLevel>& accuracy_levels(
    bool plain);  // by falling error; plain: isotropic, without friction

struct ChosenLevel {
  AccuracyLevel level;
  double wanted = 0;  // [%]
  // the study's kind of scene: one sphere above the middle of one layer that is thicker than the
  // contact is wide
  bool shown = true;
  // the study promises it; false: the finest there is does not promise that much, or the scene is
  // of another kind
  bool met = false;
  std::string words;
  double finest = 0;      // edge of the shortest cells that are tried
  Geometry written = {};  // of the config, its cells placed
  // of a scene of several bodies, in place of `written`; with lines along the edges of pads
  std::map<std::string, Block> bodies = {};
  bool cut = false;  // cells, where the error comes from (accuracy/refinement/adaptive_cells.hpp)
};
// Puts the level's cells, increments and symmetry into the config, and the cells to where the
// indenters are; nothing where no accuracy is wanted. Scenes that are not of the study's kind get
// the coarsest hex8, or the config's own cells and increments where these are no lengths in contact
// radii: their own error decides (Accuracy). Shorter cells and increments than the level's stay, if
// the config has them; what does not is named in `words`. material: of the bodies that the config
// names none for. by_estimate: who solves it judges the solution by its own estimate. Then cells
// may be coarser, since they are cut where the error comes from
// (accuracy/refinement/adaptive_cells.hpp) or the limit of the meshes may be the answer.
std::optional<ChosenLevel> choose_accuracy(SolveConfig& config,
                                           const std::optional<Material>& material,
                                           bool by_estimate = false);

// What was reached of it: the largest estimated error of a force; what the level promises where
// nothing was estimated.
struct ReachedAccuracy {
  double percent = 0;
  bool met = false;
  std::string words;  // where it is not: what was asked for, what was found, what to do
};
ReachedAccuracy reached(const ChosenLevel& chosen, const std::vector<ErrorEstimate>& estimates);

// The order with which each error of cells has fallen from one level to the next, by name.
using OrdersSeen = std::map<std::string, double>;

// The level at which these errors, of one that was solved, fall below four fifths of what is
// wanted: cells' with the length of the cells to their order, or that which was seen, increments'
// with the square of their length; but at most some times as many cells as there are: the next
// error tells more than this one. Nothing where it is the finest that there is, or not even that
// would do.
std::optional<AccuracyLevel> finer_level(const ChosenLevel& chosen,
                                         const std::vector<ErrorEstimate>& estimates,
                                         const OrdersSeen& seen = {});

// The error [%] that a level is expected to have, from these errors and the orders of their cells;
// of the finest level that there is.
double percent_at(const ChosenLevel& chosen, const std::vector<ErrorEstimate>& estimates,
                  const AccuracyLevel& level);
AccuracyLevel finest_level(const ChosenLevel& chosen);

AccuracyLevel finest_at_once(const ChosenLevel& chosen);  // the most that finer_level takes
// of numbers_of_cells, without symmetry; at the level: of the chosen geometry or bodies
double n_cells(const Geometry& geometry);
double n_cells(const ChosenLevel& chosen, const AccuracyLevel& level);

// without an error that would say which: cells of 0.7 times the length; nothing where these would
// be shorter than the finest
std::optional<AccuracyLevel> with_shorter_cells(const ChosenLevel& chosen);
void put(const ChosenLevel& chosen, SolveConfig& config);  // its cells and increments

// The loop around a solve that an accuracy was asked for: solved, judged by its own estimate, and
// again with shorter cells or increments until that is within what was asked for or there are no
// shorter ones.
class Accuracy {
 public:
  using Where = std::function<Place(const std::string&)>;
  // config as it was written. Scenes unlike those of the study begin with coarse cells, whose
  // estimate tells which ones they need.
  Accuracy(const Voice& voice, const SolveConfig& config, const std::optional<Material>& material,
           Where where, bool dry);

  const SolveConfig& config() const { return config_; }  // to be solved
  bool cuts() const { return chosen_ && chosen_->cut; }  // cells, where the error comes from
  double seconds_of_forecasts() const { return seconds_of_forecasts_; }  // of CPU, so far
  // Symmetry leaves this share of the cells to be solved: so many more may be tried.
  void solves_part(double share);
  // Whether to accept the solution, or to solve again with config() as it is then (a message says
  // so), or to stop short of the request.
  Decision decide(const std::vector<ErrorEstimate>& estimates);
  // The same for a level that nothing follows: accept or stop.
  Decision final_decision(const std::vector<ErrorEstimate>& estimates) const;
  // The share of what was reached that is wanted, where that is less; 0 where it is not known.
  // Nothing where it is met, or none is asked for.
  std::optional<double> wanted_share(const std::vector<ErrorEstimate>& estimates) const;
  // What was reached, where it is not what was asked for [%]; nothing where it is, or is not known.
  std::optional<double> missed_percent(const std::vector<ErrorEstimate>& estimates) const;
  // Why a locally refined mesh (adaptive_cells.hpp) exceeds the time or memory that is left; empty
  // if it does not. Prints its cost.
  std::string reason_too_expensive(const Mesh& mesh) const;
  void set_stop_reason(const std::string& why) { stop_reason_ = why; }
  // If the first mesh finds no equilibrium: whether to solve again with smaller elements. Prints
  // it.
  bool retry_after(const Failure& failure);
  // Marks the estimates whose limit is accurate enough while their value is not.
  void name_answers(std::vector<ErrorEstimate>& estimates) const;
  std::vector<Summary> summary(
      const std::vector<ErrorEstimate>& estimates) const;  // accuracy, of what was reached
  // Throws Failure(not_accurate) where the estimates exceed what was asked for. cheaper: what would
  // take less; may be empty
  void require(const std::vector<ErrorEstimate>& estimates, const std::string& output,
               const std::string& cheaper = "") const;

 private:
  void take(const AccuracyLevel& level);
  bool shorter_cells();
  SolveConfig with(const AccuracyLevel& level) const;
  OrdersSeen orders_since_before(const std::vector<ErrorEstimate>& estimates);
  std::string reason_too_expensive(const AccuracyLevel& level) const;  // as that of a mesh
  std::string reason_too_expensive(const std::string& level, double cells,
                                   const std::function<LevelCost()>& cost) const;

  Voice voice_;
  SolveConfig config_;
  std::optional<Material> material_;
  Where where_;
  std::optional<ChosenLevel> chosen_;
  double edge_before_ = 0;  // of the level before, and its errors of cells [%]
  std::map<std::string, double> cells_before_;
  std::string stop_reason_;
  int without_estimate_ = 0;
  double share_ = 1;  // of the cells that is solved, as `finest` of the level knows it
  double seconds_of_forecasts_ = 0;  // of CPU
  bool begins_ = false;              // with cells that no study and no estimate stands for
};

}  // namespace langer
