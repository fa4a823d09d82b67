// What a solve config may ask for beyond the first instability of a body: its critical points, the
// branch that leaves the path there, and a mesh that is imperfect from the beginning.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"

namespace langer {

// Where an equilibrium becomes unstable.
//   auto  the first such place is found to 1e-4 of the path, its kind is named, its mode written
enum class LocateCritical { automatic, off };
constexpr auto names(LocateCritical) { return std::array{"auto", "off"}; }

enum class BranchTake { follow };
constexpr auto names(BranchTake) { return std::array{"follow"}; }

enum class BranchSign { positive, negative };
constexpr auto names(BranchSign) { return std::array{"positive", "negative"}; }

// The branch at the first bifurcation; "follow" is short for {take: follow}.
struct BranchConfig {
  static constexpr const char* short_key = "take";
  BranchTake take = BranchTake::follow;
  std::optional<double> amplitude;
  BranchSign sign = BranchSign::positive;
  static void fields(auto& v) {
    v(&BranchConfig::take, "take", unit::none,
      "follow: the path leaves the first bifurcation along its mode", required);
    v(&BranchConfig::amplitude, "amplitude", unit::mm,
      "largest movement of a node along the mode with which the branch begins; none: a hundredth of "
      "the largest extent of the body",
      positive);
    v(&BranchConfig::sign, "sign", unit::none,
      "which of the two directions of the mode; positive: the node that moves most goes along +y, or "
      "where it moves across y along +x or +z");
  }
};

// A mesh whose nodes are moved along a mode of the perfect body.
struct ImperfectionConfig {
  int mode = 1;
  double amplitude = 0;
  static void fields(auto& v) {
    v(&ImperfectionConfig::mode, "mode", unit::none,
      "1: the lowest mode at the first critical point of the perfect body, 2: the next",
      between(1, 8));
    v(&ImperfectionConfig::amplitude, "amplitude", unit::mm,
      "of the node that is moved most; the sign chooses the direction of the mode", required);
  }
  std::vector<Complaint> complaints() const {
    if (amplitude != 0 && std::isfinite(amplitude)) return {};
    return {{"amplitude", "found no imperfection", "an amplitude other than 0 mm", ""}};
  }
};

}  // namespace langer
