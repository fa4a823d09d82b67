// Pressures and dilatations of the elements: unknowns of the mixed formulations that are condensed
// within each element, so that no factor sees them.
//
// Near incompressibility the pressure kappa (J - 1) at a state that is not yet in equilibrium means
// little. The tangent therefore uses pressures p that are iterated together with the displacements:
// after each correction du they follow the linearised dilatation,
//   p <- p + step (kappa (t + dt/du du) - p)
// and only at the beginning of an increment, or at a converged state, are they those of u.
//
// An element with four dilatation modes leaves a part of J - 1 to a modulus of its own, the bubble
// modulus. It is the largest compressive pressure of the modes within the element, and at most
// kappa (docs/theory.md, Bubble modulus). Less, and a compressed element folds within itself; more,
// and it locks. It follows the pressures p, not kappa t at the assembled u, which are meaningless
// until the increment is nearly solved. Residual and tangent have the same bubble modulus, one
// correction behind. At every converged state it is a function of u alone.
#pragma once

#include <vector>

#include "mechanics/assembly/body_model.hpp"
#include "mechanics/element/packet_solid.hpp"

namespace langer {

class PressureField {
 public:
  explicit PressureField(const BodyModel& body);  // refers to the body

  // Pressure of mode (or Gauss point) k of element e in the tangent, without the share of the
  // bubble modulus [MPa].
  double modal_pressure(int e, int k) const;
  double bubble_modulus(int e) const { return bubble_modulus_[e]; }  // [MPa]

  // Takes the dilatations of element e and their gradients from lane l of an evaluated packet.
  void store_dilatations(int e, const PacketElement& element, int lane);
  // Gradient of dilatation k of element e with respect to its unknowns, (n_dofs) [1/mm].
  const double* gradient(int e, int k) const { return &dJ_du_[index(e, k) * n_dofs_]; }
  // The stored dilatations are those of u; an empty vector: of no displacements.
  void set_evaluated_at(const VecX& u) { evaluated_at_ = u; }
  bool evaluated_at(const VecX& u) const {
    return evaluated_at_.size() == u.size() && evaluated_at_ == u;
  }

  // p = kappa (J - 1) of the stored dilatations.
  void follow_dilatations();
  // Linearised step: fraction `step` of the way to the pressures of u + du. kept: with the
  // gradients of keep_gradients(), as a tangent of that time has them.
  void predict(const VecX& du, double step, bool kept);
  void keep_gradients() { dJ_du_kept_ = dJ_du_; }
  // p + step dp, of elements with one dilatation; dp by element [MPa].
  void move(const VecX& dp, double step);
  // p_now + s (p_now - p), with p those of this field at present.
  void extrapolate(const std::vector<double>& p_now, double s);

  // The residual of the dilatation equations that a solution with kept gradients b0 needs,
  //   sum V (kappa t - p) (b - b0),   (3 n) [N]
  // Without it a tangent that is a little old is of no use near incompressibility, since
  // kappa (b - b0) is large. For dilatation modes, not for pressures of Gauss points.
  VecX dilatation_residual() const;

  // What the tangent, as assembled last, contains of the volume,  sum V kappa b b^T, for elements
  // with one dilatation.
  struct VolumetricPart {
    std::vector<double> b;  // by element, (n_dofs) in the order of element_dofs() [1/mm]
    VecX V, kappa;          // by element [mm^3], [MPa]
    VecX missing;           // by element: U'(J_bar) less the pressure of the tangent [MPa]
  };
  VolumetricPart volumetric_part() const;

  // Change of the bubble moduli with displacements v, by element [MPa]; empty if none changes.
  std::vector<double> bubble_modulus_change(const VecX& v) const;

  // Pressures and bubble moduli, to be kept and put back.
  struct State {
    std::vector<double> p;               // [MPa]
    std::vector<double> bubble_modulus;  // [MPa]
  };
  State state() const { return {p_, bubble_modulus_}; }
  void restore(const State& state);
  void add_to_bubble_moduli(double factor, const std::vector<double>& change);

 private:
  std::size_t index(int e, int k) const { return static_cast<std::size_t>(e) * n_p_ + k; }
  void update_bubble_moduli();
  // kappa (J - 1), or U'(J) of another volumetric term, of the stored dilatations of element e.
  void evaluate(int e, double* p) const;
  // Change of dilatation k of element e with the displacements q of its nodes.
  double dilatation_change(const std::vector<double>& dJ_du, int e, int k,
                           const ElementNodes& q) const;

  const BodyModel& body_;
  int n_p_;                        // dilatations of an element
  int n_dofs_;                     // unknowns of an element
  std::vector<double> p_;          // n_p_ for each element [MPa]
  std::vector<double> J_minus_1_;  // same shape
  std::vector<double> dJ_du_;      // n_dofs_ for each of them [1/mm]
  std::vector<double> dJ_du_kept_;
  std::vector<double> bubble_modulus_;  // by element [MPa]
  VecX evaluated_at_;
};

}  // namespace langer
