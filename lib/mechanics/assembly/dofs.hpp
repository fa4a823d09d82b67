// Which degrees of freedom are free. Dof 3 i + k is displacement component k of node i.
// A prescribed component moves as  value * factor(t),  held components have value 0; of a node that
// is turned about an axis as well
//   (R(angle(t)) - 1) q = sin(angle) a x q - (1 - cos(angle)) q_across,   q its place from the axis, a the axis
// Tied nodes, those of symmetry or of a section, have no dofs of their own: whoever needs their
// displacement asks their image.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/history.hpp"
#include "core/tensor/turn.hpp"
#include "core/tensor/types.hpp"
#include "mechanics/mesh/symmetry.hpp"

namespace langer {

struct Turn {
  History angle;                 // [rad]
  double along = 0, across = 0;  // this component of a x q and of q_across [mm]
  double at(double t) const {
    const double half = std::sin(0.5 * angle.at(t));
    return std::sin(angle.at(t)) * along - 2 * half * half * across;
  }
  double rate(double t) const {
    return angle.rate(t) * (std::cos(angle.at(t)) * along - std::sin(angle.at(t)) * across);
  }
  double radius() const { return std::hypot(along, across); }  // at most that of the node
  friend bool operator==(const Turn&, const Turn&) = default;
};

struct Prescribed {
  int dof = 0;
  double value = 0;             // [mm] its largest value
  LoadFactor factor = nullptr;  // of it; none: in proportion to t
  std::optional<Turn> turn = {};
  double at(double t) const { return value * factor_at(factor, t) + (turn ? turn->at(t) : 0); }
  double rate(double t) const {
    return value * factor_rate(factor, t) + (turn ? turn->rate(t) : 0);
  }
  bool in_proportion() const { return !factor && !turn; }  // to t
  bool keeps_rate(double before, double now,
                  double next) const;  // at the rate that it had, or turning at that rate
  bool moves_as(const Prescribed& other) const {
    return value == other.value && same_factor(factor, other.factor) && turn == other.turn;
  }
};

// A set that is turned as a rigid body, and moved as a whole.
struct TurnedSet {
  std::string name;
  std::vector<int> nodes;
  Line axis;                  // at rest
  History angle;              // [rad]
  std::array<History, 3> to;  // of the axis [mm]
  Vec3 axis_at(double t) const {
    return axis.point + Vec3(to[0].at(t), to[1].at(t), to[2].at(t));
  }  // a point of it
};

struct Dofs {
  int n = 0;  // 3 * nodes
  std::vector<int>
      equation;  // (n) row of a free dof, -1 where prescribed, tied or forbidden by symmetry
  std::vector<int> free;               // dof of each row
  std::vector<Prescribed> prescribed;  // ascending dof
  std::vector<Image> tie;              // by node; empty without symmetry

  int n_free() const { return static_cast<int>(free.size()); }
  int node(int i) const {
    if (tie.empty()) return i;
    return tie[i].of;
  }  // where node i has its dofs
};

// Later entries for the same dof must agree in value; `conflict` is the dof where they do not, or
// -1.
struct DofsResult {
  Dofs dofs;
  int conflict = -1;
};
// Hanging nodes have no dofs: what is prescribed for them is left out, and has to be what the nodes
// that they hang on ask for.
DofsResult number_dofs(int n_nodes, std::vector<Prescribed> prescribed, std::vector<Image> tie = {},
                       const std::vector<HangingNode>& hanging = {});

// Whether any node moves with another one. Nodes on a mirror plane move alone, along the plane.
bool ties_nodes(const Dofs& dofs);

// of a node, whatever it moves with; u (n)
Vec3 displacement(const Dofs& dofs, const VecX& u, int node);

}  // namespace langer
