// A fit with scenes (finite element runs) among its tests. The search begins on coarse elements and
// ends on those of the configs. The difference of the two estimates the discretisation error of the
// parameters. The model of a scene: scene_fit.hpp.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/voice.hpp"
#include "identification/fit/prior.hpp"
#include "identification/inverse/scene_fit.hpp"
#include "identification/posterior/costly_posterior.hpp"

namespace langer {

class InverseFit {
 public:
  // quotients: derivatives by differences of whole runs, as scenes with adhesion have them anyway.
  // problem: gets the scenes as further tests. journal: keeps the runs (inverse/run_cache.hpp).
  // files: of items without one.
  InverseFit(const Voice& voice, const FitConfig& config, const SceneTests::Where& where,
             FitProblem& problem, const std::vector<std::string>& files, const std::string& journal,
             bool quotients = false);

  // What was known of parameters before; behind the values of the scenes.
  void set_priors(const std::vector<Prior>& priors) {
    priors_ = priors;
    problem_.further = with_priors(priors_, scenes_);
  }

  // The scenes as tests whose model takes runs, for a posterior.
  CostlyTests costly() const;

  // Throws Failure(not_converged) where no start leads to an optimum, one with the signal's code
  // where one has come.
  FitResult search();
  // The best parameters of a search without an optimum, if there is a model at them.
  const std::optional<FitResult>& reached() const { return reached_; }
  // the measured and found curves with the errors that their cells make, and what these do to the
  // parameters, in words
  std::vector<std::string> add_curves(const FitResult& fit, FitRecord& record);
  std::vector<FittedCurve> curves(const FitResult& fit) const;  // with their errors
  // What the scenes hold fixed and would widen an interval by half or more, the most first. Without
  // runs where there is nothing to hold.
  struct Widening {
    HeldNumber held;
    std::string parameter;
    double factor = 1;  // of the standard error, if the number were a parameter; infinite: unknown
  };
  std::vector<Widening> widenings(const FitResult& fit);
  std::vector<std::string> cost() const;  // of what was solved, in words
  int runs() const {
    if (!draft_) return scenes_->runs();
    return scenes_->runs() + draft_->runs();
  }
  void done() { cache_->remove(); }

 private:
  FitResult level(const std::shared_ptr<SceneTests>& scenes, const FitOptions& options);

  Voice voice_;
  const FitConfig& config_;
  SceneTests::Where where_;
  FitProblem& problem_;
  std::shared_ptr<RunCache> cache_;
  std::shared_ptr<SceneTests> scenes_, draft_;
  std::optional<FitResult> reached_;
  std::vector<Prior> priors_;
};

std::string in_words(const InverseFit::Widening& widening);

// parameter,true,found,standard_error,lower_95,upper_95; empty cells where there is nothing
std::string parameters_csv(const FitRecord& record);
// one table of each curve: what it was measured over, places, measured, model, error
struct NamedTable {
  std::string name, text;
};
std::vector<NamedTable> curve_tables(const FitRecord& record);

}  // namespace langer
