// Where on its path a body becomes unstable, what kind of point that is, and how the body moves
// there.
//
// The number of negative eigenvalues of the tangent of the whole body (its inertia) changes between
// two accepted states. Equilibria between them are solved until the place is known to 1e-4 of the
// path. The eigenvector phi that belongs to the eigenvalue near 0 is the mode:
//   limit point   the path itself runs along phi: the load (or the imposed travel) has an extremum
//   bifurcation   the path runs across phi, and another path leaves it along phi
// Told apart by the angle between phi and the last movement of the path. A mode that breaks a
// symmetry by which the body was reduced is always a bifurcation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/solve/increment.hpp"
#include "scene/run/run.hpp"

namespace langer {

struct CriticalPoint {
  double t = 0;            // middle of the bracket
  double within = 0;       // half of its length
  double load_factor = 0;  // t itself but on paths with arc lengths
  // "limit point of load", "limit point of travel", "bifurcation", "jump to another path"; and
  // without a mode "loss of strong ellipticity", "crease", "loss of support", "loss of stability"
  std::string kind;
  std::string symmetry;         // of the mode: "antisymmetric in x, symmetric in z"; may be empty
  int before = 0, after = 0;    // negative eigenvalues
  std::vector<Vec3> mode;       // (n) of the whole body, the largest movement 1
  std::optional<double> angle;  // of the waves of the mode on the top face, from x towards z [deg]
  VecX of_model;      // (3 n) of the model that was solved; empty where it breaks its symmetry
  BodyState state;    // the last one before, of the model
  BodyState earlier;  // the one that it was found from
  double t_state = 0;
  std::optional<Vec3> place;  // in the reference state, of what happens in a point [mm]
  std::string words() const;  // "bifurcation at t = 0.4321 (...)"
};

// Of a verdict that needs no mode, met between two steps. place: of what happens in a point
CriticalPoint point_between(const std::string& kind, double t_before, const StepRecord& record,
                            const std::optional<Vec3>& place = {});

// A table of one row: place on the path, load factor, kind, symmetry, direction of the waves.
std::string table_of(const CriticalPoint& point);

// A state of a run and its place on the path.
struct StateOnPath {
  double t = 0;
  BodyState state;
  int negative = 0;
};

// Between two accepted states of an elastic body without bonds, of which `last` has more negative
// eigenvalues; before: the one before `first`. breaking: movements that break the symmetry of a
// reduced body are counted. The run is left where it was. Nothing where the change is not found
// again.
std::optional<CriticalPoint> locate_critical_point(Run& run, const StateOnPath& before,
                                                   const StateOnPath& first,
                                                   const StateOnPath& last, bool breaking);
// The point at which a path under given loads ended, of which the last state is known only: within
// `left` of the path after it there is no equilibrium.
std::optional<CriticalPoint> critical_point_at_end(Run& run, const StateOnPath& before,
                                                   const StateOnPath& last, double left);

// The limit point between two accepted states from the first of which the run jumped to a distant
// one: smaller increments from the first leave a gap that does not close. Nothing where it closes,
// as the path is only steep there. The run is left where it was.
std::optional<CriticalPoint> locate_jump(Run& run, const StateOnPath& before,
                                         const StateOnPath& first, const StateOnPath& last);

// The modes of the body at the accepted state of a run without contact, as node movements of the
// model (3 n), the largest component 1.
std::vector<VecX> modes_of(Run& run, int n);

// By the path of the body up to its first critical point: nothing where it is stable to the end.
std::optional<CriticalPoint> first_critical_point(Run& run);

}  // namespace langer
