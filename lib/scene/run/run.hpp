// A scene on its way along the load path: solved on the part of the body that decides the rest,
// told of the whole body. The one place where a scene becomes equations: langer-solve, the estimate
// of its errors and the tests follow a Run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "mechanics/nonlinear/load_path.hpp"
#include "scene/run/reduction.hpp"
#include "scene/run/shared_run.hpp"

namespace langer {

constexpr bool at_end_of_path(double t) { return t >= 1 - 1e-10; }  // t is a sum of increments

// Somebody who goes along; each may be empty.
struct RunListener {
  std::function<Problem(Problem problem, double t)> watched;  // what the solver is given instead
  std::function<void(double t, const SolveReport& report)>
      failed;  // no equilibrium at t: a shorter increment follows
  std::function<void(double t, int equilibria)>
      jumping;  // bonds let go at t: equilibria of it that were looked for
  std::function<bool(StepRecord& of_part)> of_part;  // an accepted state; false ends the path there
  std::function<void(StepRecord& whole, const SolveReport& report)> of_whole;  // the same, balanced
};

struct RunEnd {
  enum class At { the_end, signal, no_equilibrium, listener, not_homogeneous };
  At at = At::the_end;
  PathReport path;
  StepRecord last;  // of the whole body at the end of the path
};

class Run {
 public:
  using Where = std::function<Place(const std::string&)>;

  // at_a_point: one hexahedron may stand for a body that deforms alike everywhere; by_ranks: cells
  // may be divided among those there are
  Run(Mesh mesh, const SolveConfig& config, const std::optional<Material>& material,
      const Where& where, bool at_a_point = false, bool by_ranks = false);
  // of a scene that is there, or what is left of it
  Run(Mesh mesh, Scene scene, const std::optional<ReducedScene>& part, const LoadPathOptions& path,
      Solver solver, const IncrementOptions& options = {});
  Run(const Run&) = delete;  // its parts refer to each other
  Run& operator=(const Run&) = delete;

  const Mesh mesh;
  const Scene scene;  // of the whole body
  const Reduction reduction;
  std::string serial_reason;         // where it is not divided among ranks that are there
  Assembler body;                    // balance of the part
  std::unique_ptr<Inertia> inertia;  // of a body in motion, else none
  Increment increment;
  LoadPathOptions path;
  Solver solver;

  // To go on after `last`; before: the step before it, none where that was the body at rest.
  void resume(const StepRecord& last, const std::optional<StepRecord>& before);
  // Divided among ranks: puts the others where rank 0 goes on from.
  void resume_all();
  // Before that, of a viscous body: every step so far, in order. Its branches follow from them to
  // the last digit.
  void replay(const StepRecord& step);
  const Ranks* shared_by() const {
    if (body.division()) return body.division()->ranks;
    return nullptr;
  }
  // One equilibrium at t from where it stands, not accepted yet: increments of a search.
  SolveReport solve_at(double t);
  // Puts it at a state that was found before, and the one before that.
  void put_at(double t, const BodyState& state, const BodyState& before);
  double share_of_cells() const { return 1.0 * body.mesh().n_cells() / mesh.n_cells(); }  // solved
  double t() const { return t_; }                      // of the accepted state, on the path
  BodyState state_from(const StepRecord& step) const;  // of the model that is solved

  // The path leaves at t along a mode: (3 n) of the model, its largest movement 1.
  struct Switch {
    double t = 0;
    VecX mode;
    double amplitude = 0;  // [mm]
    double sign = 1;       // recorded
  };
  void switch_branch(Switch at) { switch_ = std::move(at); }

  // From where it stands to t = 1; of several ranks rank 0 alone has a listener and the last
  // record. A signal (base/interrupt.hpp) ends it after the increment in which it comes.
  RunEnd follow(const RunListener& listener = {});

 private:
  void begin(double t);
  SolveReport solved_from_begin(double t, const std::function<SolveReport()>& solve);
  void begin_branch(double t);
  double t_ = 0;
  std::optional<Switch> switch_;
  RunEnd::At record_step(const RunListener& listener, double t, double taken, double next,
                         const SolveReport& report, RunEnd& end);
  std::optional<double> increment_;  // to begin with
  std::optional<Resumed> resumed_;
};

}  // namespace langer
