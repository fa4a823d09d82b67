// The columns of curves. A column is a row of a table: its word, unit and label, its meaning with
// its sign, the function that gives its value, and what it needs. The argument of the function says
// where the column is measured; `langer describe columns` prints the rows.
//   StepState        one number of the whole state or of the indenter, without a place
//   displacement     mean over the nodes of a named set; an observation point is a set of one node
//   row of values    the same for a row of post/nodal_fields.hpp at each node
//   ContactNode      the same for the contact of each node
//   SetState         sum of the reactions of a named set, or mean of its movement
//   Extremes         over all Gauss points of the body; their place is the reference position [mm]
// Signs: stress and pressure are positive in tension; force is positive where the body resists the
// travel of the indenter.
#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct StepState;
// The state of a node set.
struct SetState {
  Vec3 u = Vec3::Zero();             // mean [mm]
  Vec3 reaction = Vec3::Zero();      // sum [N]
  Vec3 velocity = Vec3::Zero();      // mean [mm/s]
  Vec3 acceleration = Vec3::Zero();  // mean [mm/s^2]
  double length = 1;                 // reference length of a strain [mm]
  double swept = 0;                  // volume swept by its facets [mm^3]
};
// The extremes of the body; the von Mises stress is that of the nodal averages.
struct Extremes {
  double von_mises = -1, J = std::numeric_limits<double>::infinity(), fibre_stretch = -1;
  double pressure_min = std::numeric_limits<double>::infinity(), pressure_max = -pressure_min;
  Vec3 place = Vec3::Zero();  // of the greatest von Mises stress
};

// The contact of a node with all indenters. If several touch it, the one with the greatest
// pressure counts.
struct ContactNode {
  double pressure = 0;  // force along the normal over the deformed area [MPa]
  double friction = 0;  // force across the normal over the deformed area [MPa]
  double slip = 0;      // distance along the indenter during contact [mm]
  int status = -1;      // -1: not a candidate, otherwise as in ContactRecord
};

using OfState = double (*)(const StepState& state);
using OfNodes = double (*)(const Vec3& u);
using OfPoint = double (*)(const VecX& row, int family);
using OfContact = double (*)(const ContactNode& node);
using OfSet = double (*)(const SetState& set);
using OfBody = double (*)(const Extremes& all);

// What a solution must have, so that a quantity can be computed.
struct Needs {
  bool contact = false;           // an indenter, or surfaces that touch
  bool indenter = false;          // an indenter alone
  bool shapes = false;            // the shapes of all indenters
  bool fibres = false;            // a material with fibres
  const char* history = nullptr;  // a history that the solver wrote
  bool facets = false;            // a set that covers facets
  int extent = -1;                // extent of the mesh along this axis, unless a length is given
};

// A row of the table of quantities.
struct QuantityLine {
  const char *word, *unit;
  const char* label;    // on the axis of a figure
  const char* meaning;  // with its sign
  std::variant<OfState, OfNodes, OfPoint, OfContact, OfSet, OfBody> value;
  Needs needs = {};
};

std::span<const QuantityLine> quantity_lines();

// A quantity is the index of its line. Configs name it by its word.
enum class Quantity : int {};
Quantity quantity(std::string_view word);  // throws std::logic_error if there is none
std::vector<const char*> names(Quantity);

inline const QuantityLine& line_of(Quantity quantity) {
  return quantity_lines()[static_cast<std::size_t>(quantity)];
}

template <class Of>
bool is(const QuantityLine& line) {
  return std::holds_alternative<Of>(line.value);
}
// Whether the quantity has a value at every node.
inline bool is_field(const QuantityLine& line) {
  return is<OfNodes>(line) || is<OfPoint>(line) || is<OfContact>(line);
}
inline bool needs_place(const QuantityLine& line) { return is_field(line) || is<OfSet>(line); }

}  // namespace langer
