// Pressures and dilatations of the cells, unknowns of the mixed formulations that no factor sees.
#include <cmath>

#include "mechanics/assembly/equilibrium.hpp"
#include "mechanics/element/dilatation.hpp"

namespace langer {

double Equilibrium::modal_pressure(int e, int k) const {
  const std::size_t at = static_cast<std::size_t>(e) * n_p_ + k;
  if (linear_pressure(material(e).volume)) return (1 - local_[e] / bulk_modulus(e)) * p_[at];
  return p_[at] - local_[e] * J_minus_1_[at];
}

void Equilibrium::pressures_of(int e, const double* J_minus_1, double* p) const {
  pressures(material(e).volume, formulation_ != Formulation::displacement, geometry_[e], n_p_,
            J_minus_1, p);
}

VecX Equilibrium::turned_dilatations() const {
  VecX out = VecX::Zero(dofs_.n);
  std::vector<double> now(n_p_);
  for (int e = 0; e < mesh_.n_cells(); ++e) {
    // what a linear pressure leaves to `local` follows the predicted dilatation, else it is the
    // same in both
    const double share = linear_pressure(material(e).volume) ? 1 - local_[e] / bulk_modulus(e) : 1;
    pressures_of(e, &J_minus_1_[static_cast<std::size_t>(e) * n_p_], now.data());
    const auto nodes = moving_.of(e);
    const bool tied = !tied_.empty() && tied_[e];
    for (int k = 0; k < n_p_; ++k) {
      const std::size_t at = static_cast<std::size_t>(e) * n_p_ + k;
      const double *b = &dJ_du_[at * n_dofs_], *b0 = &dJ_du_kept_[at * n_dofs_];
      const double w = geometry_[e].V * share * (now[k] - p_[at]);
      for (int a = 0; a < n_nodes_; ++a)
        add_force(out, nodes[a], tied, w * (Vec3(b + 3 * a) - Vec3(b0 + 3 * a)));
    }
  }
  return out;
}

void Equilibrium::predict_pressures(const VecX& du, double step, bool kept) {
  const std::vector<double>& dJ_du = kept ? dJ_du_kept_ : dJ_du_;
  std::vector<double> change(n_p_), p(n_p_);
  for (int e : own_) {
    const ElementNodes q = element_displacements(du, e);
    const std::size_t first = static_cast<std::size_t>(e) * n_p_;
    for (int k = 0; k < n_p_; ++k) {
      change[k] = 0;
      for (int a = 0; a < n_nodes_; ++a)
        change[k] += q.row(a).dot(
            Eigen::Map<const Eigen::RowVector3d>(&dJ_du[(first + k) * n_dofs_ + 3 * a]));
    }
    predicted_pressures(material(e).volume, formulation_ != Formulation::displacement, geometry_[e],
                        n_p_, &J_minus_1_[first], change.data(), p.data());
    for (int k = 0; k < n_p_; ++k) p_[first + k] += step * (p[k] - p_[first + k]);
  }
  follow_pressures();
}

void Equilibrium::pressures_from(const VecX& u) {
  const bool known = J_at_.size() == u.size() && J_at_ == u;
  if (!known && !assemble(u, false)) return;
  for (int e : own_) {
    const std::size_t first = static_cast<std::size_t>(e) * n_p_;
    pressures_of(e, &J_minus_1_[first], &p_[first]);
  }
  follow_pressures();
}

void Equilibrium::extrapolate_pressures(const VecX& u_before, double s) {
  const std::vector<double> p = p_;
  pressures_from(u_before);
  for (std::size_t i = 0; i < p_.size(); ++i) p_[i] = p[i] + s * (p[i] - p_[i]);
  follow_pressures();
}

void Equilibrium::move_pressures(const VecX& dp, double step) {
  for (int e : own_) p_[static_cast<std::size_t>(e)] += step * dp[e];
}

Equilibrium::VolumetricPart Equilibrium::volumetric_part() const {
  const int n = mesh_.n_cells();
  VolumetricPart part{dJ_du_, VecX::Zero(n), VecX::Zero(n), VecX::Zero(n)};
  for (int e : own_) {
    const ModalVolume<double> volume =
        modal_volume(material(e).volume, n_p_, &J_minus_1_[static_cast<std::size_t>(e)], local_[e],
                     geometry_[e]);
    part.V[e] = geometry_[e].V, part.kappa[e] = volume.kappa[0][0];
    part.missing[e] = volume.p[0] - p_[static_cast<std::size_t>(e)];
    if (tied_.empty() || !tied_[e]) continue;
    const auto nodes = moving_.of(e);
    for (int a = 0; a < n_nodes_; ++a) {
      Eigen::Map<Vec3> b(&part.b[static_cast<std::size_t>(e) * n_dofs_ + 3 * a]);
      b = (dofs_.tie[nodes[a]].T.transpose() * b).eval();
    }
  }
  if (!division_) return part;
  division_->ranks->sum(part.b.data(), part.b.size());  // 0 in the cells of others
  for (VecX* of_cells : {&part.V, &part.kappa, &part.missing})
    division_->ranks->sum(of_cells->data(), of_cells->size());
  return part;
}

std::vector<int> Equilibrium::cell_dofs() const {
  std::vector<int> dofs;
  dofs.reserve(static_cast<std::size_t>(mesh_.n_cells()) * n_dofs_);
  for (int e = 0; e < mesh_.n_cells(); ++e)
    for (int node : moving_.of(e))
      for (int i = 0; i < 3; ++i) dofs.push_back(3 * dofs_.node(node) + i);
  return dofs;
}

// What four dilatation modes leave of J - 1 within a cell is opposed by a modulus of its own,
// kappa_l: the largest compressive pressure of the modes in the cell, kappa at most
// (docs/theory.md, Volume). Less, and a compressed cell folds within itself; more, and it locks. It
// follows the pressures p that the tangent uses, not kappa t at the u assembled: near
// incompressibility those are meaningless until the increment is nearly solved. Residual and
// tangent thus have the same kappa_l, which lags one correction behind; where p = kappa t, at every
// converged state, it is a function of u alone, and the body has no memory.
void Equilibrium::follow_pressures() {
  if (formulation_ != Formulation::linear_dilatation) return;
  for (int e = 0; e < mesh_.n_cells(); ++e)
    local_[e] = std::min(local_modulus(geometry_[e], &p_[static_cast<std::size_t>(e) * n_p_]),
                         bulk_modulus(e));
}

}  // namespace langer
