// The error of a result by refinement: the scene is solved again on other meshes and increments.
//
// The values of three meshes are fitted by
//   q = f + A h^p,    p = 2, or 1 where the exact solution is singular: greatest stress, force of a
//                     plane or a flat punch, reaction of a clamped face
// f is the limit, q - f the error. The meshes are one family: all their elements differ by one
// factor (Block::instead). Only then does the error follow one law, since errors of layers and of
// cells to the side have opposite signs. The parts of an error bar, those of cells and increments
// with their sign:
//   cells       q - f of the solved mesh
//   increments  (q(dt) - q(dt / r)) r^2 / (r^2 - 1), of second order, with r >= 2 so that
//               dt / r <= 1/8; of increments below 0.1 the effect of doubling them; none where
//               neither friction nor time makes the path matter. Between deformable surfaces with
//               friction of first order: r / (r - 1)
//   scatter     root mean square of what the fit leaves, and at least a share that falls with the
//               number n of nodes in contact, which come into contact one by one
//               (accuracy/estimate/least_scatter.hpp)
//   solver      the last residual relative to the forces that it balances
//   total       F |cells| + |increments| + 2 scatter + solver. F = 1; where p = 1 Roache's factor
//               of safety for three meshes, 1.25; 2 where the order is only observed
//   limit       q - cells - increments
//   limit_bar   F |cells| / 2 + |increments| + 2 scatter + solver, with a doubled lower limit of the
//               scatter; for forces of indenters on blocks
//               (docs/study_estimates.md, "The limit as the answer")
//   left out    effect of what a body leaves out that stands for a larger one, if the config asks
//               for it (accuracy/estimate/truncation.hpp); not in total
// Meshes without a study (MeshFamily, no indenter, several bodies) have the smaller one of p and of
// the order that they show. A greatest stress without an order grows without bound and gets no bar.
//
// Which meshes are solved for which scene, and the lower limits of the scatter with their
// constants: docs/accuracy.md, "Estimates by refinement". Meshes need numbers of cells that follow
// from the config (has_numbers_of_cells).
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/store/provenance.hpp"
#include "scene/run/run.hpp"
#include "scene/run/step_forces.hpp"

namespace langer {

inline bool asks_for_accuracy(const SolveConfig& config) {
  return config.accuracy || config.fidelity;
}

struct Valued {
  std::string name, unit;
  double value = 0;
  // A greatest stress at a face that is clamped, or that a pad touches: it is singular there.
  bool at_edge = false;
  bool of_force() const { return unit == langer::unit::N || unit == "N mm"; }  // or a torque
  bool of_travel() const { return name.starts_with("travel_"); }
  bool of_contact() const;  // what single nodes in contact change
};
std::vector<Valued> valued_forces(const StepForces& forces);
// of a state of the whole body: force on the indenter (of several the sum, and force_<name> of
// each), reaction_<set> of each set that is moved, torque_<name> of what turns, greatest von Mises
// stress of the nodes (of a viscous body not), displacement of each named point
std::vector<Valued> valued(const SolveConfig& config, const Scene& scene, const Mesh& mesh,
                           const StepRecord& state);

// Throws Failure(not_converged) where the run of another scene did not reach t = 1, or one with the
// signal's code where one has come.
void need_the_end_of_other(const RunEnd& end);

// A config that holds its mesh, solved without a file.
struct SolvedPath {
  std::vector<Valued> found;     // at t = 1
  std::vector<StepForces> path;  // at each step
  double seconds = 0;            // of CPU
};
// Throws Failure(not_converged) where there is no state at t = 1, or one with the signal's code
// where one has come.
SolvedPath solved_path(const SolveConfig& config, const std::optional<Material>& material,
                       const std::function<Place(const std::string&)>& where,
                       const std::function<RunListener(const Run&)>& listener = {});
std::vector<Valued> end_of_path(const SolveConfig& config, const std::optional<Material>& material,
                                const std::function<Place(const std::string&)>& where,
                                const std::function<RunListener(const Run&)>& listener = {});

struct ErrorEstimate {
  Valued of;
  double cells = 0, increments = 0;  // signed, in the unit of the quantity
  double scatter = 0, solver = 0;
  double order = 2;       // p of the error of the cells
  bool has_limit = true;  // false: by recovery, which knows no sign
  double t = 1;           // where on the path
  // It has no limit: the exact solution is singular where the cells find its largest value, and
  // shorter cells find more. No bar is given then.
  bool grows = false;
  bool asked = false;  // by accuracy.of
  // What percentages relate to where that is not the value itself: of the worst of all steps
  // (accuracy.at: every_step) the largest value on the path.
  std::optional<double> largest = {};
  // Three meshes show an order by themselves that is smaller than the theoretical one. Such an
  // order is known less well than one that both agree on: Roache's factor is 1.25 for these.
  bool order_observed = false;
  bool cells_with_increments = false;  // `cells` is the error of both, found together
  // The least scatter, from nodes that come into contact one by one. The fit of three meshes
  // multiplies it, so that their limit has twice as much.
  double by_single_nodes = 0;
  bool limit_has_bar = false;  // scenes of its kind have been measured
  bool limit_answers = false;  // the limit is what was asked for, and not the value
  struct Part {
    std::string name;
    double value;
  };
  std::vector<Part> left_out = {};  // by a body that stands for a larger one
                                    // (accuracy/estimate/truncation.hpp); signed, not in total
  // Parts of opposite signs are added up, as nothing shows that they stay so; meshes that do not
  // follow one law leave more open than their scatter.
  double factor() const {
    if (order_observed) return 2;
    return order < 2 ? 1.25 : 1;
  }
  double total() const {
    return factor() * std::abs(cells) + std::abs(increments) + 2 * scatter + solver;
  }
  bool none_yet() const {
    return of.value == 0 && total() == 0;
  }  // as the force of an indenter that touches nothing: no percent
  double limit() const { return of.value - cells - increments; }
  double limit_share() const { return of.value == 0 ? 1 : limit() / of.value; }
  double limit_bar() const {
    return 0.5 * factor() * std::abs(cells) + std::abs(increments) +
           2 * std::max(scatter, 2 * by_single_nodes) + solver;
  }
  double limit_percent() const { return 100 * limit_bar() / std::max(std::abs(limit()), 1e-300); }
  double in_percent(double part) const {
    return 100 * part / std::max(std::abs(largest.value_or(of.value)), 1e-300);
  }  // of the value, or of `largest`
  // of what an accuracy is asked for: the value or, if it has a bar and is known better, the limit
  double percent() const {
    const double of_value = in_percent(total());
    if (!limit_has_bar) return of_value;
    return std::min(of_value, limit_percent());
  }
};

double order_of_force(const SolveConfig& config);  // p of its error

// Whether the config gives a force, and the travel of the indenter is the result. Such a force has
// no error.
bool is_given(const SolveConfig& config, const std::string& name);

// Whether an accuracy needs the value on the mesh itself, and not its limit alone.
bool needs_the_mesh(const SolveConfig& config);

// The forces that an accuracy is asked of: those on indenters, of several their own, since a sum
// may be none; without indenters the reactions; and torques; where forces alone load the body, the
// displacements of its named points.
std::vector<Valued> forces_judged(const std::vector<Valued>& found);
std::vector<ErrorEstimate> forces_judged(const std::vector<ErrorEstimate>& estimates);

// Where on the path a quantity is judged: as accuracy.at says; without it at the end, or where it
// is largest if the path ends below half of that, as after an unloading.
double judged_at(const SolveConfig& config, const std::vector<StepForces>& path,
                 const std::string& name);
// For accuracy.at: every_step: of the steps the one with the largest error; its percentages relate
// to the largest value of all of them.
ErrorEstimate worst_of(const std::vector<ErrorEstimate>& steps);
// Marks the estimates of what accuracy.of names. Throws Failure(config) where none is of it; found:
// what the scene has.
void mark_asked(const SolveConfig& config, const std::function<Place(const std::string&)>& where,
                const std::vector<Valued>& found, std::vector<ErrorEstimate>& estimates);

// The residual of a state, relative to the forces that it balances; 0 where there are none but
// rounding.
inline double relative_residual(const StepRecord& state) {
  return state.residual <= 1 ? state.residual : 0;
}

// who goes along with the n-th of the scenes that an estimate solves
using EstimateListener = std::function<RunListener(const Run& run, int n, int of)>;

// Of the state that `config` led to. Throws Failure(not_converged) where a coarser scene has no
// equilibrium, Failure(config) for another kind of mesh.
std::vector<ErrorEstimate> estimate_errors(const SolveConfig& config,
                                           const std::optional<Material>& material,
                                           const std::function<Place(const std::string&)>& where,
                                           const std::vector<Valued>& found, double residual,
                                           const EstimateListener& listener = {});

struct PathErrors {
  std::vector<ErrorEstimate> at_end;
  std::map<std::string, std::vector<double>>
      along;  // by quantity: total() at each step of the run; empty by dual solutions
  struct Limits {
    std::vector<double> shares;  // limit over value
    std::vector<double> bars;
  };
  std::map<std::string, Limits> limits;  // the same of its limit, where limit_has_bar
  double growth = 0;  // power of 1 / length of the cells with which the CPU time grew; 0: not known
  std::vector<std::string> not_known;  // why a quantity is not in at_end, a sentence each
  std::vector<double> of_cells =
      {};  // dual and by recovery, for an accuracy: of the force whose error is largest, each
           // cell's part of the bar, in parts of it
};
// The same, at each step of itself.path too: the forces of the other meshes there, linear between
// their own steps.
PathErrors estimate_along(const SolveConfig& config, const std::optional<Material>& material,
                          const std::function<Place(const std::string&)>& where,
                          const SolvedPath& itself, double residual,
                          const EstimateListener& listener = {});

// as config.estimate says (recovery: accuracy/estimate/recovered_path.hpp), of the last state of
// its run and of the forces on its path
PathErrors estimated(const SolveConfig& config, const std::optional<Material>& material,
                     const std::function<Place(const std::string&)>& where, Run& run,
                     const StepRecord& last, const std::vector<StepForces>& path,
                     const EstimateListener& listener);

// "force 10.7 N +- 0.9 % (cells +0.8, increments -0.1, scatter 0.2, solver 1e-7 %); limit 10.6"
std::string in_words(const ErrorEstimate& estimate);
std::vector<Summary> summary_of(
    const std::vector<ErrorEstimate>& estimates);  // what gather can collect
// The numbers of the last state, with the limit instead of a value where that is the answer.
std::vector<Summary> with_answers(std::vector<Summary> numbers, const PathErrors& errors);

// CPU seconds that an estimate by refinement takes, about (solve/forecast.hpp)
double estimate_seconds(const SolveConfig& config, const std::optional<Material>& material,
                        const std::function<Place(const std::string&)>& where);

}  // namespace langer
