// What a result is worth: the scene is solved again on other meshes, all of whose cells differ by one factor (Block::instead), and q is
// set against f of q = f + A h^p fitted to them; p = 2; for the greatest stress, and the force of a plane or a flat punch,
// p = 1. Only where all cells grow alike does an error follow such a law: layers and cells to the side have errors of opposite signs.
//   hex8        themselves and cells longer by 1.25 and 1.5; where nodes under the indenter are further apart than 0.18 contact
//               radii (of a disc 0.07), which is too coarse for the law, hex8 of 0.125 (0.0442) and by as much longer, whatever that
//               costs
//   hex27       the force by such hex8, of at most half their edge: they have more nodes in contact for the time; all else by
//               hex27 longer by sqrt 2 and by 2
// Errors have a sign: what is found lies above its limit by
//   cells       q - f
//   increments  (q(2 dt) - q(dt)) / 3, of second order (Statics::slip_from_touch), on the longest of these cells; nothing where no
//               friction makes the path matter. Of a single increment: what halving it changes
//   scatter     root mean square of what the fit leaves
//   solver      the last residual relative to the forces that it balances
//   total       |cells + increments| + scatter + solver;   limit   found - cells - increments
// For meshes of the kind indented_block, whose cells one number scales.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "run/run.hpp"
#include "store/provenance.hpp"

namespace langer {

struct Valued {
  std::string name, unit;
  double value = 0;
  bool of_force() const { return unit == langer::unit::N; }
};
// of a state of the whole body: force on the indenter (of several the sum, and force_<name> of each), greatest von Mises stress of the
// nodes, displacement of each named point
std::vector<Valued> valued(const Scene& scene, const Mesh& mesh, const StepRecord& state);

// of the state at t = 1 of a config that holds its mesh; nothing is written
// Throws Failure(not_converged) where there is none, or one with the signal's code where one has come.
std::vector<Valued> end_of_path(const SolveConfig& config, const std::optional<Material>& material,
                                const std::function<Place(const std::string&)>& where,
                                const std::function<RunListener(const Run&)>& listener = {});

struct ErrorEstimate {
  Valued of;
  double cells = 0, increments = 0;  // signed, in the unit of the quantity
  double scatter = 0, solver = 0;
  double order = 2;       // p of the error of the cells
  bool has_limit = true;  // false: by recovery, which knows no sign
  double total() const { return std::abs(cells + increments) + scatter + solver; }
  double limit() const { return of.value - cells - increments; }
  double in_percent(double part) const { return 100 * part / std::max(std::abs(of.value), 1e-300); }  // of the value
};

// Of any mesh, by what its stress lacks to be smooth (post/recovery.hpp): force and greatest von Mises stress, no limit. The error of
// sticking on coarse cells and that of increments are not among them.
std::vector<ErrorEstimate> recovered_errors(const Scene& scene, const Mesh& mesh, const StepRecord& state,
                                            const std::vector<Valued>& found);

// who goes along with the n-th of the scenes that an estimate solves
using EstimateListener = std::function<RunListener(const Run& run, int n, int of)>;

// Of the state that `config` led to. Throws Failure(not_converged) where a coarser scene has no equilibrium,
// Failure(config) for another kind of mesh.
std::vector<ErrorEstimate> estimate_errors(const SolveConfig& config, const std::optional<Material>& material,
                                           const std::function<Place(const std::string&)>& where, const std::vector<Valued>& found,
                                           double residual, const EstimateListener& listener = {});

// as config.estimate says, of the last state of its run
std::vector<ErrorEstimate> estimated(const SolveConfig& config, const std::optional<Material>& material,
                                     const std::function<Place(const std::string&)>& where, const Run& run, const StepRecord& last,
                                     const EstimateListener& listener);

// "force 10.7 N +- 0.9 % (cells +0.8, increments -0.1, scatter 0.2, solver 1e-7 %); limit 10.6"
std::string in_words(const ErrorEstimate& estimate);
std::vector<Summary> summary_of(const std::vector<ErrorEstimate>& estimates);  // what gather can collect

// CPU seconds that it will take, about (solve/forecast.hpp); 0 where the scene is not solved again
double estimate_seconds(const SolveConfig& config, const std::optional<Material>& material,
                        const std::function<Place(const std::string&)>& where);

}  // namespace langer
