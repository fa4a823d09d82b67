// What a number of the scene changes directly, where the state stands still: the right-hand side of
// derivatives (solve/state_tangent.hpp).
#pragma once

#include <optional>
#include <vector>

#include "mechanics/contact/adhesion.hpp"
#include "mechanics/contact/rigid.hpp"

namespace langer {

// An indenter whose number is a little less, or more, by `width` in all.
struct ShapeChange {
  Indenter less, more;
  double width = 1;
};

// What a number changes where the state stands still; empty: nothing.
struct ParameterChange {
  VecX f = {};                  // (3 n) of f_int less the forces
  std::vector<double> mu = {};  // by contact: of its friction
  VecX prescribed = {};         // (3 n) of prescribed dofs [mm], 0 elsewhere
  std::vector<Vec3> indenters =
      {};  // by contact: of its place [mm], whose orientation stands still
  std::vector<std::optional<ShapeChange>> shapes = {};  // by contact: of its shape
  double control = 0;                                   // of the given force on an indenter [N]
  std::vector<Adhesion> adhesion = {};                  // by contact: of the numbers of its law
};

// Of gap, normal and curvature of an indenter at a place x less its own; none: of a number that is
// not one of its shape.
ShapePoint shape_change(const ParameterChange& change, std::size_t contact, const Vec3& x);

}  // namespace langer
