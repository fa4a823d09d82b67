#include "mechanics/vibration/harmonic.hpp"

#include <numbers>
#include <stdexcept>

namespace langer {

namespace {

Complex branch_modulus(const ViscousBranch& branch, double omega) {
  const Complex x(0, omega * branch.tau);
  return branch.gamma * x / (1.0 + x);
}

}  // namespace

Harmonic::Harmonic(Assembler& body, const Increment& increment, const std::vector<double>& density,
                   const Driver& driver)
    : body_(body),
      frozen_(body, increment, density, body.dofs(), true, driver),
      viscous_(body.viscous()) {
  K_ = stiffness_with([](const ViscousBranch&) { return 0.0; });
}

SparseX Harmonic::stiffness_with(const std::function<double(const ViscousBranch&)>& follow) {
  body_.begin_small_movements(follow);
  return frozen_.stiffness();
}

// The stiffness is linear in what the branches answer with, so its real and its imaginary part are
// stiffnesses of two real materials.
Complex Harmonic::stiffness(double frequency) {
  const double omega = 2 * std::numbers::pi * frequency;
  SparseX real = K_;
  SparseXc A;
  if (viscous_) {
    real = stiffness_with([&](const ViscousBranch& b) { return branch_modulus(b, omega).real(); });
    const SparseX imaginary =
        stiffness_with([&](const ViscousBranch& b) { return branch_modulus(b, omega).imag(); }) -
        K_;
    A = Complex(0, 1) * imaginary.cast<Complex>();
    A = (A + (real - omega * omega * frozen_.mass()).cast<Complex>()).eval();
  } else {
    A = (real - omega * omega * frozen_.mass()).cast<Complex>();
  }
  const Eigen::Index n = A.rows() - 1;
  const SparseXc inner = A.topLeftCorner(n, n);
  const VecXc beside = VecXc(A.col(n)).head(n);
  if (!solver_.factorize(inner))
    throw std::runtime_error("the body resonates without damping at this frequency");
  return A.coeff(n, n) - (beside.transpose() * solver_.solve(beside))(0, 0);
}

}  // namespace langer
