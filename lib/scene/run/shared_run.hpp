// A run that several ranks share (base/ranks.hpp): whether it can be, and what rank 0 tells the
// others.
#pragma once

#include <optional>
#include <string>

#include "mechanics/assembly/division.hpp"
#include "scene/run/reduction.hpp"

namespace langer {

// Why one rank has to solve such a config, whatever its body; "" where several may.
std::string single_rank_reason(const SolveConfig& config, bool may_be_an_image);

// The cells of each rank, where there are several and the body can be solved so; else why one has
// all, empty where there is but one.
std::optional<Division> divided(const Reduction& reduction, const SolveConfig& config,
                                std::string& why);

// A signal that one of the ranks has got, on all of them; 0: none has.
int signal_of(const Ranks* ranks);

// What rank 0 goes on from, on all: the accepted state, the one before, and the increment to begin
// with. False where it is at rest.
struct Resumed {
  BodyState now, before;
  double increment = 0;
};
bool share(const Ranks& ranks, std::optional<Resumed>& resumed, const BodyState& shape);

}  // namespace langer
