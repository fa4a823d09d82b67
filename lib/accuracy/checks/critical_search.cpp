#include "accuracy/checks/critical_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "accuracy/checks/turning_points.hpp"

namespace langer {

// An increment may pass a limit point: Newton's method then finds a distant state, which may well
// be stable. It shows in a movement much faster than before. Where all tangents of its iterations
// were positive definite it takes more to suspect a jump, as most bodies soften or stiffen on their
// way. Contact that opens or closes and a kink of a given history change the rate by themselves.
void CriticalSearch::take_jump(const StateOnPath& state, bool doubtful) {
  constexpr std::size_t most = 4;  // suspects kept: those whose movement grew most
  if (!run_.scene.contacts.empty() || run_.path.arc_length) return;
  const bool first_increment = !(before_->t < last_->t);
  double faster = INFINITY;
  if (first_increment) {
    if (!doubtful) return;
  } else {
    const auto rate = [](const StateOnPath& a, const StateOnPath& b) {
      return (b.state.u - a.state.u).norm() / (b.t - a.t);
    };
    faster = rate(*last_, state) / rate(*before_, *last_);
    const bool kink = kink_between(run_.scene.stops, before_->t, state.t);
    const double suspect = doubtful ? 1.5 : 3.0;
    if (!(faster > suspect) || (kink && !doubtful)) return;
  }
  suspects_.push_back({Crossing{*before_, *last_, state}, faster});
  if (suspects_.size() <= most) return;
  const auto slower = [](const Suspect& a, const Suspect& b) {
    return a.faster < b.faster;
  };
  suspects_.erase(std::min_element(suspects_.begin(), suspects_.end(), slower));
}

void CriticalSearch::take(StateOnPath state, bool doubtful) {
  if (crossing_) return;
  if (!last_) {
    last_ = StateOnPath{0, at_rest(state.state), 0};
    before_ = last_;
  }
  take_jump(state, doubtful);
  if (state.negative > last_->negative) {
    crossing_ = Crossing{*before_, *last_, std::move(state)};
    return;
  }
  before_ = std::move(last_);
  last_ = std::move(state);
}

void CriticalSearch::search_jump() {
  for (const auto& [states, faster] : suspects_) {
    if (found_ && found_->t <= states.first.t) break;
    const auto point = locate_jump(run_, states.before, states.first, states.last);
    if (!point) continue;
    found_ = point;
    jump_ = states;
    break;
  }
  suspects_.clear();
}

void CriticalSearch::search_bifurcation(const RunEnd& end, bool breaking) {
  if (crossing_) {
    found_ =
        locate_critical_point(run_, crossing_->before, crossing_->first, crossing_->last, breaking);
  } else if (end.at == RunEnd::At::no_equilibrium && run_.increment.n_unstable() > 0 && last_) {
    found_ = critical_point_at_end(run_, *before_, *last_, run_.path.smallest);
  }
}

std::string CriticalSearch::jump_in_words() const {
  return fmt::format(
      "between t = {:.4g} and {:.4g} the run jumped to a distant state, past a limit point; path.arc_length follows the path between them",
      jump_->first.t, jump_->last.t);
}

}  // namespace langer
