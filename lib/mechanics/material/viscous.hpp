// Finite linear viscoelasticity of the isochoric stress: branches in parallel with the elastic
// terms, which describe the material after all branches have relaxed.
//                                                                            [S87], [H00] section 6.10
//   S = S_vol + S_iso + sum Q_i,   Q_i' + Q_i / tau_i = gamma_i S_i',   S_i: S_iso of the terms that the branch belongs to
// Over an increment, exact where S_i is linear in time, else of second order [TPG70]:
//   Q_i(n+1) = keep Q_i(n) + follow (S_i(n+1) - S_i(n)),   keep = exp(-x),  follow = gamma_i (1 - exp(-x)) / x,  x = seconds / tau_i
// Short increments give 1 + sum gamma_i times the stress, long ones the elastic terms alone. Q_i
// are second Piola-Kirchhoff stresses, which rotations do not change. With H = sum keep Q_i(n) -
// follow S_i(n), known when the increment begins,
//   S_iso + sum Q_i = (1 + sum follow) S_iso + H        and the tangent is (1 + sum follow) D_iso, term by term
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/base/fields.hpp"
#include "core/tensor/types.hpp"

namespace langer {

enum class BranchOf { all, matrix, fibres };
constexpr auto names(BranchOf) { return std::array{"all", "matrix", "fibres"}; }

struct ViscousBranch {
  double tau = 0, gamma = 0;
  BranchOf of = BranchOf::all;
  static void fields(auto& v) {
    v(&ViscousBranch::tau, "tau", unit::s, "relaxation time", required, positive);
    v(&ViscousBranch::gamma, "gamma", unit::none,
      "stress of the branch at once after a step, over that of the terms it belongs to after all has relaxed",
      required, at_least(0));
    v(&ViscousBranch::of, "of", unit::none, "energy terms that it belongs to");
  }
};

// A continuous spectrum [F93]: relaxation 1 + c integral over tau from tau1 to tau2 of exp(-t/tau)
// / tau
struct Spectrum {
  double c = 0, tau1 = 0, tau2 = 0;
  BranchOf of = BranchOf::all;
  static void fields(auto& v) {
    v(&Spectrum::c, "c", unit::none,
      "density: gamma of the branches of a decade together, over ln 10", required, at_least(0));
    v(&Spectrum::tau1, "tau1", unit::s, "shortest relaxation time", required, positive);
    v(&Spectrum::tau2, "tau2", unit::s, "longest relaxation time", required, positive);
    v(&Spectrum::of, "of", unit::none, "energy terms that it belongs to");
  }
  std::vector<Complaint> complaints() const {
    if (tau2 > tau1) return {};
    return {{"tau2", "not above tau1", "tau2 > tau1", ""}};
  }
};

// one branch for each decade or part of one, in the middle of its logarithms
std::vector<ViscousBranch> branches_of(const Spectrum& spectrum);

// of one increment
struct BranchStep {
  double keep = 1, follow = 0;
};
inline BranchStep branch_step(const ViscousBranch& branch, double seconds) {
  const double x = seconds / branch.tau;
  return {std::exp(-x), branch.gamma * (x > 0 ? -std::expm1(-x) / x : 1)};
}
// The difference to another rule of second order, the midpoint rule with exp(-x/2) instead of
// (1 - exp(-x))/x, for the same change of stress. It estimates the error of the increment; if the
// stress changes at a constant rate, the error is smaller.
inline double branch_step_error(const ViscousBranch& branch, double seconds) {
  const double x = seconds / branch.tau;
  return branch.gamma * (x > 0 ? std::abs(-std::expm1(-x) / x - std::exp(-x / 2)) : 0);
}

// 1 + sum follow of the branches of each kind of terms
struct Amplified {
  double matrix = 1, fibres = 1;
};
void amplify(Amplified& amplified, BranchOf of, double follow);
inline Amplified only(BranchOf of) {
  Amplified result{1, 1};
  if (of == BranchOf::fibres) result.matrix = 0;
  if (of == BranchOf::matrix) result.fibres = 0;
  return result;
}

}  // namespace langer
