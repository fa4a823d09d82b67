// A body that oscillates about an accepted state, driven by an indenter or a face.
//   (K + sum_i g_i(w) K_i - w^2 M) u = f,     g_i = gamma_i i w tau_i / (1 + i w tau_i)
// K_i is the part of the stiffness that the isochoric moduli of branch i make, so the matrix is
// complex symmetric. Its stress part is that of the state. With the driver's own movement s
// separated from the others,
//   k(w) = A_ss - A_s' A^-1 A_s          force for a movement of 1 mm: storage + i loss [N/mm]
//                                                              docs/vibration.md
#pragma once

#include <vector>

#include "mechanics/linear/complex_solver.hpp"
#include "mechanics/vibration/frozen_body.hpp"

namespace langer {

class Harmonic {
 public:
  // Right after accept() or restore(). density: by body [t/mm3]. Throws std::invalid_argument as
  // FrozenBody does.
  Harmonic(Assembler& body, const Increment& increment, const std::vector<double>& density,
           const Driver& driver);

  // At a frequency [Hz] above 0: of the whole body [N/mm]. Throws std::runtime_error at the
  // resonance of a body without damping.
  Complex stiffness(double frequency);

 private:
  SparseX stiffness_with(const std::function<double(const ViscousBranch&)>& follow);

  Assembler& body_;
  FrozenBody frozen_;
  bool viscous_;
  SparseX K_;  // after all branches have relaxed
  ComplexSolver solver_;
};

}  // namespace langer
