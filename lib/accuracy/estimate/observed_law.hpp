#pragma once

#include <optional>
#include <vector>

namespace langer {

// What three meshes show by themselves, the finest first: q = f + A length^p with the p that they
// have, p at most `theory`. Differences of opposite signs follow no such law: then the larger one
// is taken for the scatter.
struct ObservedLaw {
  double limit;
  double order;
  double scatter;
  bool grows;  // p is so small that nothing shows a limit
};
// length: of the elements, in any unit. Nothing for another number of meshes.
std::optional<ObservedLaw> observed_law(const std::vector<double>& length,
                                        const std::vector<double>& values, double theory);

}  // namespace langer
