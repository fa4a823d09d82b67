// Which rank has which cells of a body.
#pragma once

#include <vector>

#include "core/base/ranks.hpp"

namespace langer {

struct Division {
  const Ranks* ranks = nullptr;
  std::vector<int> rank_of;  // by cell

  bool own(int e) const { return rank_of[static_cast<std::size_t>(e)] == ranks->rank(); }
  std::vector<int> cells() const {  // of this rank, ascending
    std::vector<int> out;
    for (std::size_t e = 0; e < rank_of.size(); ++e)
      if (own(static_cast<int>(e))) out.push_back(static_cast<int>(e));
    return out;
  }
};

}  // namespace langer
