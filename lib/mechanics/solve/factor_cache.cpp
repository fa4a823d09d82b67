#include "mechanics/solve/factor_cache.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// Nodes on both sides of all contacts of deformable surfaces from which on laws in the tangent cost
// less than condensed ones: two blocks of 100 and 81 nodes in contact cost the same.
constexpr std::size_t many_nodes = 200;

TangentFactor timed_factor(IncrementState& state) {
  const Stopwatch watch(state.cost.analysis);
  const IncrementOptions& options = state.options;
  if (!state.surfaces.empty())
    return {state.body, state.contacts, state.surfaces.nodes(), options.threads};
  return {state.body, state.contacts, options.threads, options.contact_by, options.linear_by};
}

// Contact of deformable surfaces in the tangent, where it serves and is cheaper.
std::unique_ptr<BodiesInTangent> timed_bodies(IncrementState& state, const TangentFactor& factor) {
  const IncrementOptions& options = state.options;
  if (options.contact_by == ContactBy::compliance) return nullptr;
  if (options.contact_by == ContactBy::by_cost && state.surfaces.nodes().size() < many_nodes)
    return nullptr;
  if (factor.held_by_contact() ||
      !BodiesInTangent::serves(state.body, state.contacts, state.surfaces))
    return nullptr;
  const Stopwatch watch(state.cost.analysis);
  return std::make_unique<BodiesInTangent>(state.body, state.surfaces, options.threads);
}

}  // namespace

FactorCache::FactorCache(IncrementState& state, const Border& border)
    : factor(timed_factor(state)), state_(state), border_(border) {
  bodies_ = timed_bodies(state, factor);
}

void FactorCache::begin_increment() {
  K_is_current = false;
  serves = std::exchange(of_accepted, false);
  where_unstable(WhereUnstable::springs);
  stopped_ = false;
  factor.begin_increment();
  bodies_condensed_ = false;
  if (bodies_) bodies_->begin_increment();
}

long FactorCache::factorizations() const {
  return factor.counts().factorizations + (bodies_ ? bodies_->factorizations() : 0);
}

void FactorCache::forget() { K_is_current = serves = of_accepted = false; }

void FactorCache::take_level(int level) {
  factor.take_level(state_.body, level);
  serves = false;
}

bool FactorCache::factorize() {
  const Stopwatch watch(state_.cost.factor);
  factored_at = state_.trial.u;
  of_accepted = false;
  return factor.factorize(state_.body);
}

bool FactorCache::may_go_into_tangent() const {
  return !contact_in_tangent() && state_.options.contact_by == ContactBy::by_cost &&
         state_.surfaces.empty() && !state_.contacts.empty() && !factor.held_by_contact() &&
         ContactInTangent::serves(state_.contacts);
}

void FactorCache::where_unstable(WhereUnstable what) {
  using enum WhereUnstable;
  if ((where_unstable_ == contact_in_tangent) != (what == contact_in_tangent)) {
    if (!waiting_) {
      const Stopwatch watch(state_.cost.analysis);
      waiting_ = std::make_unique<TangentFactor>(state_.body, state_.contacts,
                                                 state_.options.threads, ContactBy::tangent);
    }
    waiting_->begin_increment();
    waiting_->go_on_counting(factor.counts());
    std::swap(factor, *waiting_);
    serves = of_accepted = false;
  }
  where_unstable_ = what;
  unsettled_ = 0;
}

bool FactorCache::gives_up(bool settled) {
  if (!settled) ++unsettled_;
  return where_unstable_ == WhereUnstable::contact_in_tangent && unsettled_ == 2;
}

bool FactorCache::factorize_or_stop() {
  if (where_unstable_ != WhereUnstable::stop) return factorize();
  const Stopwatch watch(state_.cost.factor);
  factored_at = state_.trial.u;
  of_accepted = false;
  stopped_ = !factor.factorize_whole(state_.body);
  return !stopped_;
}

TangentFactor& FactorCache::condensed_factor() {
  if (!contact_in_tangent()) return factor;
  if (!second_factor_)
    second_factor_ = std::make_unique<TangentFactor>(state_.body, state_.contacts,
                                                     state_.options.threads, ContactBy::compliance);
  return *second_factor_;
}

bool FactorCache::factorize_accepted() {
  {
    const Stopwatch watch(state_.cost.assembly);
    state_.body.pressures_from(state_.now.u);
    state_.body.assemble(state_.now.u, true);
    K_is_current = true;
  }
  TangentFactor& condensed = condensed_factor();
  int level =
      level_of_increment(state_.before, state_.now.t, state_.now.travel - state_.before.travel);
  level = std::max(level, level_of_increment(state_.now, state_.now.t, 0));
  condensed.take_level(state_.body, level);
  const TangentFactor::Counts needed = condensed.counts();
  serves = false;
  bool solvable = false;
  if (&condensed == &factor) {
    solvable = factorize();
    of_accepted = solvable && condensed.kind() == TangentFactor::Kind::whole &&
                  state_.body.formulation() != Formulation::displacement;
    if (of_accepted) state_.body.keep_dilatations();
  } else {
    const Stopwatch watch(state_.cost.factor);
    condensed.begin_increment();
    solvable = condensed.factorize(state_.body);
  }
  condensed.uncount(needed);  // the counts show what the solution itself needed
  return solvable;
}

void FactorCache::update_tangent() {
  if (K_is_current) return;
  const Stopwatch watch(state_.cost.assembly);
  const VecX du = border_.imposed_direction(state_.trial.u);
  state_.body.assemble(state_.trial.u, true, &du);
  K_is_current = true;
}

// The cost of a correction with a new tangent, in corrections with the last one. It is computed
// from operation counts and not measured with a clock: the same scene takes the same steps on every
// machine. The rates are those of one thread of a machine of 2020 (`langer-bench indentation`);
// only their ratio matters.
double FactorCache::cost_ratio() const {
  const LinearSolver::Size size = this->size();
  const ReferenceCell& cell = state_.body.mesh().cell();
  const double points = static_cast<double>(state_.body.mesh().n_cells()) * cell.n_gauss;
  const double n = cell.n_nodes;
  const double factorization = size.flops / 20e9;
  const double through_factor = 16 * size.factor_nonzeros / 10e9;
  const double tangents = 4e-9 * points * n * n;
  const double forces = 15e-9 * points * n;
  return (factorization + tangents + through_factor + forces) / (through_factor + forces);
}

// The level of candidates with which an increment to t begins, from the state before it: those that
// the indenter can reach. A linear step that finds others within reach takes a higher one.
int FactorCache::level_of_increment(const BodyState& from, double t, double last_travel) const {
  if (!factor.may_leave_out()) return factor.level();
  const std::vector<Vec3> begin = state_.indenters(from.t, from.travel);
  const std::vector<Vec3> end = state_.indenters(t, from.travel);
  int level = 0;
  for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
    double reach = 3 * (end[k] - begin[k]).norm() + 0.05;
    if (static_cast<int>(k) == state_.controlled_index) reach += 0.1 + 2 * std::abs(last_travel);
    for (std::size_t i = 0; i < state_.contacts[k].nodes.size(); ++i) {
      if (factor.levels().of(k, i) <= level) continue;
      const int node = state_.contacts[k].nodes[i];
      const Vec3 x = state_.body.mesh().X[node] + from.u.segment<3>(3 * node);
      const bool bonded = !state_.bonds.none() && state_.bonds.holds(k, i);
      if (bonded || !from.r[k][i].isZero(0) ||
          shape_at(state_.contacts[k].shape, x - end[k]).gap <= reach)
        level = factor.levels().of(k, i);
    }
  }
  return level;
}

void FactorCache::update_of_accepted(double within) {
  const double moved = (state_.now.u - state_.before.u).lpNorm<Eigen::Infinity>();
  if (factor.kind() != TangentFactor::Kind::none &&
      (state_.now.u - factored_at).lpNorm<Eigen::Infinity>() <= within * moved)
    return;
  const TangentFactor::Counts needed = factor.counts();
  update_tangent();
  factorize();
  factor.uncount(needed);  // the counts show what the solution itself needed
}

}  // namespace langer
