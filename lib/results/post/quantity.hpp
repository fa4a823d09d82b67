// A column of a curve is a row: its word, unit and label, its meaning with its sign, the function
// that gives its value, and what it needs. Where it is measured is what its function takes; `langer
// describe columns` prints the rows.
//   StepState            one number of the whole state, or of the indenter: nothing to name
//   displacement         mean over the nodes of a named set (an observation point is a set of one node)
//   row of values        the same, of a row of post/fields.hpp at each node
//   ContactNode          the same, of what the indenters do to each node
//   SetState             reaction summed, or movement averaged, over a named set
//   Extremes             over all Gauss points of the body; their place is the reference position [mm]
// Signs: stress and pressure positive in tension; force positive where the body resists the
// indenter's travel.
#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct StepState;
struct SetState {
  Vec3 u = Vec3::Zero();         // mean [mm]
  Vec3 reaction = Vec3::Zero();  // sum [N]
  double length = 1;             // that belongs to a strain of 1 [mm]
  double swept = 0;              // by its facets [mm^3]
};
struct Extremes {
  double von_mises = -1, J = std::numeric_limits<double>::infinity(), fibre_stretch = -1;
  double pressure_min = std::numeric_limits<double>::infinity(), pressure_max = -pressure_min;
  Vec3 place = Vec3::Zero();  // of the greatest von Mises stress
};

// What all indenters together do to a node; of several that touch it the one with the greatest
// pressure.
struct ContactNode {
  double pressure = 0,
         friction = 0;  // along the normal and across it, over the deformed area [MPa]
  double slip = 0;      // way against the indenter while it touches [mm]
  int status = -1;      // -1: not a candidate, else as in ContactRecord
};

using OfState = double (*)(const StepState& state);
using OfNodes = double (*)(const Vec3& u);
using OfPoint = double (*)(const VecX& row, int family);
using OfContact = double (*)(const ContactNode& node);
using OfSet = double (*)(const SetState& set);
using OfBody = double (*)(const Extremes& all);

struct Needs {
  bool contact = false;           // an indenter
  bool shapes = false;            // the shapes of all indenters
  bool fibres = false;            // a material with fibres
  const char* history = nullptr;  // that the solver wrote
  bool facets = false;            // a set that covers facets
  int extent = -1;                // of the mesh along this axis, unless the user gives a length
};

struct QuantityLine {
  const char *word, *unit;
  const char* label;    // on the axis of a figure
  const char* meaning;  // with its sign
  std::variant<OfState, OfNodes, OfPoint, OfContact, OfSet, OfBody> value;
  Needs needs = {};
};

std::span<const QuantityLine> quantity_lines();

// One of the lines; configs name it by its word.
enum class Quantity : int {};
Quantity quantity(std::string_view word);  // throws std::logic_error where none has it
std::vector<const char*> names(Quantity);

inline const QuantityLine& line_of(Quantity quantity) {
  return quantity_lines()[static_cast<std::size_t>(quantity)];
}

template <class Of>
bool is(const QuantityLine& line) {
  return std::holds_alternative<Of>(line.value);
}
// has a value at every node
inline bool is_field(const QuantityLine& line) {
  return is<OfNodes>(line) || is<OfPoint>(line) || is<OfContact>(line);
}
inline bool needs_place(const QuantityLine& line) { return is_field(line) || is<OfSet>(line); }

}  // namespace langer
