// The tangent of the body and its factorization: which state they belong to, and which corrections
// the factor serves.
//
// Modified Newton reuses the factor of an earlier state of the increment. The factor of an accepted
// state also begins the next increment. Stability and derivatives need the factor of the accepted
// state, and take the last one where it was made close to there.
#pragma once

#include <memory>

#include "mechanics/solve/bodies_in_tangent.hpp"
#include "mechanics/solve/border.hpp"
#include "mechanics/solve/increment_state.hpp"

namespace langer {

class FactorCache {
 public:
  FactorCache(IncrementState& state, const Border& border);

  void begin_increment();  // the factor of the accepted state may serve
  void forget();           // neither tangent nor factor serves
  void take_level(int level);
  void update_tangent();  // assembles K at the trial, if it is of another state
  bool factorize();       // K of the trial; false where it is singular
  // What to do where K is not positive definite without contact, as in what an indenter presses
  // hard. Springs make condensed contact ill-conditioned; contact in the tangent holds the body.
  // Each increment begins with springs, so that an interrupted path goes on with the same digits.
  enum class WhereUnstable { springs, stop, contact_in_tangent };
  bool may_go_into_tangent() const;
  void where_unstable(WhereUnstable what);
  bool stopped() const { return stopped_; }  // K was not positive definite
  // Whether contact in the tangent of an unstable body had best be left to the springs: two of its
  // corrections did not settle what the candidates do.
  bool gives_up(bool settled);
  bool factorize_or_stop();  // K of the trial; false where it is not usable
  // Factorizes the tangent of the accepted state, right after accept() or restore(); false where it
  // is singular. The next increment begins with it where it is positive definite and contact is
  // condensed.
  bool factorize_accepted();
  // The last factor serves for the accepted state where it was made within a share of the last
  // increment's movement from there. Otherwise K is factorized once more.
  void update_of_accepted(double within);
  // The factor of the body, or where contact stands in its tangent a second one without it.
  TangentFactor& condensed_factor();
  bool contact_in_tangent() const { return factor.in_tangent() != nullptr; }
  // Contact of deformable surfaces in the tangent; nullptr: condensed.
  BodiesInTangent* bodies_in_tangent() const {
    if (bodies_condensed_) return nullptr;
    return bodies_.get();
  }
  // In the rest of this increment.
  void condense_bodies() { bodies_condensed_ = true; }
  long factorizations() const;
  LinearSolver::Size size() const { return bodies_ ? bodies_->size() : factor.size(); }
  double cost_ratio() const;  // of a correction with a new tangent in units of one with the last
  // candidates that an increment from a state to t begins with (solve/candidate_levels.hpp)
  int level_of_increment(const BodyState& from, double t, double last_travel) const;

  TangentFactor factor;
  VecX factored_at;           // u of the tangent that was factorized last
  bool K_is_current = false;  // K is that of the trial
  bool serves = false;        // the factor, also for other corrections of this increment
  bool of_accepted = false;   // the factor is that of the accepted state

 private:
  IncrementState& state_;
  const Border& border_;
  std::unique_ptr<TangentFactor> second_factor_;
  std::unique_ptr<BodiesInTangent> bodies_;
  bool bodies_condensed_ = false;
  WhereUnstable where_unstable_ = WhereUnstable::springs;
  bool stopped_ = false;
  int unsettled_ = 0;                       // corrections since where_unstable()
  std::unique_ptr<TangentFactor> waiting_;  // of contact in the tangent, or condensed, in its place
};

}  // namespace langer
