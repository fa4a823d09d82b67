// Natural vibrations of a body about an accepted state, such as pressed skin:
//   (K - omega^2 M) u = 0
// K is the tangent of the state, M the mass matrix, contact is frozen (vibration/frozen_body.hpp).
// The eigenvalue omega^2 is negative in a direction in which the state is unstable: a movement
// grows by exp(growth t) instead of oscillating.
//
// A body that symmetry reduces also vibrates in ways that break the symmetry. They are solved on
// the same mesh with other conditions on the mirror planes, one eigenvalue problem for each kind,
// and merged. The eigenvalues are found and counted by vibration/eigenpairs.hpp.
#pragma once

#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/solve/increment.hpp"

namespace langer {

struct Mode {
  double eigenvalue = 0;  // omega^2 [1/s^2]; negative: the state is unstable in this direction
  // 0: of the constraints of the body that is solved; k > 0: of the k-th kind of movements that
  // break its symmetry
  int kind = 0;
  VecX shape;  // (3 n) of the body that is solved, largest movement of a node 1 mm

  double frequency() const;  // [Hz]; 0 where unstable
  double growth() const;     // [1/s] of a movement that grows by exp(growth t); 0 where stable
};

struct Modes {
  std::vector<Mode> modes;  // ascending eigenvalues
  bool counted = false;     // shown complete by counting (mechanics/vibration/eigenpairs.hpp)
};

// Branches of viscous materials answer as after all has relaxed.
// breaking: constraints of movements that break the symmetry of a reduced body (ReducedScene).
// density: by body [t/mm3]. Right after accept() or restore().
Modes modes_of(Assembler& body, const Increment& increment, const std::vector<double>& density,
               const std::vector<Dofs>& breaking, int count, int threads = 1);

// omega^2 of the shapes of modes of another state, about the accepted one. Next to a mode it is
// stationary, so its change with the state or a number of the material is that of the mode.
std::vector<double> rayleigh_quotients(Assembler& body, const Increment& increment,
                                       const std::vector<double>& density,
                                       const std::vector<Dofs>& breaking,
                                       const std::vector<Mode>& modes);

}  // namespace langer
