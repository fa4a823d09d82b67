#include "mechanics/assembly/pressure_field.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/element/dilatation.hpp"

namespace langer {

PressureField::PressureField(const BodyModel& body)
    : body_(body), n_p_(body.n_pressures()), n_dofs_(body.n_dofs()) {
  const auto n = static_cast<std::size_t>(body.mesh().n_cells());
  p_.assign(n * n_p_, 0);
  bubble_modulus_.assign(n, 0);
  J_minus_1_ = p_;
  dJ_du_.resize(p_.size() * n_dofs_);
}

double PressureField::modal_pressure(int e, int k) const {
  const std::size_t at = index(e, k);
  if (linear_pressure(body_.material(e).volume)) {
    return (1 - bubble_modulus_[e] / body_.bulk_modulus(e)) * p_[at];
  }
  return p_[at] - bubble_modulus_[e] * J_minus_1_[at];
}

void PressureField::store_dilatations(int e, const PacketElement& element, int lane) {
  for (int k = 0; k < n_p_; ++k) {
    const std::size_t at = index(e, k);
    J_minus_1_[at] = element.J_minus_1[k][lane];
    double* dJ = &dJ_du_[at * n_dofs_];
    for (int i = 0; i < n_dofs_; ++i) dJ[i] = element.dJ_du(k)[i][lane];
  }
}

void PressureField::evaluate(int e, double* p) const {
  pressures(body_.material(e).volume, body_.formulation() != Formulation::displacement,
            body_.geometry(e), n_p_, &J_minus_1_[index(e, 0)], p);
}

double PressureField::dilatation_change(const std::vector<double>& dJ_du, int e, int k,
                                        const ElementNodes& q) const {
  double change = 0;
  for (int a = 0; a < body_.n_nodes(); ++a) {
    change +=
        q.row(a).dot(Eigen::Map<const Eigen::RowVector3d>(&dJ_du[index(e, k) * n_dofs_ + 3 * a]));
  }
  return change;
}

void PressureField::follow_dilatations() {
  for (int e : body_.own_cells()) evaluate(e, &p_[index(e, 0)]);
  update_bubble_moduli();
}

void PressureField::predict(const VecX& du, double step, bool kept) {
  const std::vector<double>& dJ_du = kept ? dJ_du_kept_ : dJ_du_;
  std::vector<double> change(n_p_);
  std::vector<double> p(n_p_);
  for (int e : body_.own_cells()) {
    const ElementNodes q = body_.displacements(du, e);
    for (int k = 0; k < n_p_; ++k) change[k] = dilatation_change(dJ_du, e, k, q);

    const std::size_t first = index(e, 0);
    predicted_pressures(body_.material(e).volume, body_.formulation() != Formulation::displacement,
                        body_.geometry(e), n_p_, &J_minus_1_[first], change.data(), p.data());
    for (int k = 0; k < n_p_; ++k) p_[first + k] += step * (p[k] - p_[first + k]);
  }
  update_bubble_moduli();
}

void PressureField::move(const VecX& dp, double step) {
  for (int e : body_.own_cells()) p_[static_cast<std::size_t>(e)] += step * dp[e];
}

void PressureField::extrapolate(const std::vector<double>& p_now, double s) {
  for (std::size_t i = 0; i < p_.size(); ++i) p_[i] = p_now[i] + s * (p_now[i] - p_[i]);
  update_bubble_moduli();
}

VecX PressureField::dilatation_residual() const {
  VecX out = VecX::Zero(body_.dofs().n);
  std::vector<double> now(n_p_);
  for (int e = 0; e < body_.mesh().n_cells(); ++e) {
    // A linear pressure leaves a share to the bubble, which follows the predicted dilatation. Of
    // another volumetric term the bubble's part is the same in both pressures.
    double share = 1;
    if (linear_pressure(body_.material(e).volume)) {
      share = 1 - bubble_modulus_[e] / body_.bulk_modulus(e);
    }
    evaluate(e, now.data());
    const auto nodes = body_.nodes(e);
    for (int k = 0; k < n_p_; ++k) {
      const std::size_t at = index(e, k);
      const double* b = &dJ_du_[at * n_dofs_];
      const double* b0 = &dJ_du_kept_[at * n_dofs_];
      const double w = body_.geometry(e).V * share * (now[k] - p_[at]);
      for (int a = 0; a < body_.n_nodes(); ++a) {
        body_.add_force(out, nodes[a], e, w * (Vec3(b + 3 * a) - Vec3(b0 + 3 * a)));
      }
    }
  }
  return out;
}

PressureField::VolumetricPart PressureField::volumetric_part() const {
  const int n = body_.mesh().n_cells();
  VolumetricPart part{dJ_du_, VecX::Zero(n), VecX::Zero(n), VecX::Zero(n)};
  for (int e : body_.own_cells()) {
    const ModalVolume<double> volume =
        modal_volume(body_.material(e).volume, n_p_, &J_minus_1_[static_cast<std::size_t>(e)],
                     bubble_modulus_[e], body_.geometry(e));
    part.V[e] = body_.geometry(e).V;
    part.kappa[e] = volume.kappa[0][0];
    part.missing[e] = volume.p[0] - p_[static_cast<std::size_t>(e)];
    if (!body_.tied(e)) continue;
    const auto nodes = body_.nodes(e);
    for (int a = 0; a < body_.n_nodes(); ++a) {
      Eigen::Map<Vec3> b(&part.b[static_cast<std::size_t>(e) * n_dofs_ + 3 * a]);
      b = (body_.dofs().tie[nodes[a]].T.transpose() * b).eval();
    }
  }
  const Division* division = body_.division();
  if (!division) return part;
  division->ranks->sum(part.b.data(), part.b.size());  // 0 for elements of other ranks
  for (VecX* by_element : {&part.V, &part.kappa, &part.missing}) {
    division->ranks->sum(by_element->data(), by_element->size());
  }
  return part;
}

std::vector<double> PressureField::bubble_modulus_change(const VecX& v) const {
  std::vector<double> change(bubble_modulus_.size());
  std::vector<double> dt(n_p_);
  std::vector<double> dp(n_p_);
  double largest = 0;
  for (int e = 0; e < body_.mesh().n_cells(); ++e) {
    // At its bounds, 0 and kappa, the bubble modulus does not change.
    if (bubble_modulus_[e] <= 0 || bubble_modulus_[e] >= body_.bulk_modulus(e)) continue;
    const ElementNodes q = body_.displacements(v, e);
    for (int k = 0; k < n_p_; ++k) dt[k] = dilatation_change(dJ_du_, e, k, q);

    const std::size_t first = index(e, 0);
    const ModalVolume<double> volume =
        modal_volume(body_.material(e).volume, n_p_, &J_minus_1_[first], 0, body_.geometry(e));
    for (int k = 0; k < n_p_; ++k) {
      dp[k] = 0;
      for (int l = 0; l < n_p_; ++l) dp[k] += volume.kappa[k][l] * dt[l];
    }
    change[e] = local_modulus_change(body_.geometry(e), &p_[first], dp.data());
    largest = std::max(largest, std::abs(change[e]));
  }
  if (largest == 0) change.clear();
  return change;
}

void PressureField::restore(const State& state) {
  p_ = state.p;
  bubble_modulus_ = state.bubble_modulus;
}

void PressureField::add_to_bubble_moduli(double factor, const std::vector<double>& change) {
  for (std::size_t e = 0; e < bubble_modulus_.size(); ++e) {
    bubble_modulus_[e] += factor * change[e];
  }
}

void PressureField::update_bubble_moduli() {
  if (body_.formulation() != Formulation::linear_dilatation) return;
  for (int e = 0; e < body_.mesh().n_cells(); ++e) {
    bubble_modulus_[e] =
        std::min(local_modulus(body_.geometry(e), &p_[index(e, 0)]), body_.bulk_modulus(e));
  }
}

}  // namespace langer
