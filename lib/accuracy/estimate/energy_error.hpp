// How much more energy a state of finite elements has than that of the body itself, by fields
// recovered from it (post/patches.hpp). With x = (u, p, lambda): displacements, pressures of the
// modes, contact pressures, and L their Lagrangian,
//   L = integral W_iso(F) + p (J - 1) - p^2 / (2 kappa) dV0 - integral lambda gap dA0
//   L(x_h) - L(x) = 1/2 L''(e, e),  e = x* - x_h,  written with the differences of stresses:
//     1/2 integral (F* - F_h) : (P* - P_h) + (p* - p_h) (J of p_h - J_h) dV0  +  integral lambda* gap_h dA0
// F* = I + grad u* with the volume that p* gives it. The second term is what a cell's pressure
// lacks where its volume changes within it, the last one the gap between nodes that touch. The
// force that moves something is dL/ds, and its error that of the energy's change with s: the
// derivative along the body's answer to a movement of it, the dual solution. [BR01],
// docs/work_precision.md
#pragma once

#include <vector>

#include "results/post/patches.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

// of the whole body
struct DualSolution {
  std::vector<Vec3> u;               // by node
  std::vector<Vec3> indenters;       // movement of each
  std::vector<std::vector<Vec3>> r;  // change of the reactions, by contact and candidate
};

struct EnergyErrors {
  // of each dual solution: derivative of the energy's error, signed, and the sum of what cells and
  // facets have of it, without sign
  struct Derivative {
    double shape = 0, volume = 0, contact = 0;
    double size = 0;
    std::vector<double> of_cell;
    double sum() const { return shape + volume + contact; }
  };
  std::vector<Derivative> along;
  double alone = 0;  // Patches::alone()
};

// `state` of the scene's mesh, an elastic body of cells with dilatation modes
EnergyErrors energy_errors(const Scene& scene, const Mesh& mesh, const StepRecord& state,
                           const std::vector<DualSolution>& duals);

}  // namespace langer
