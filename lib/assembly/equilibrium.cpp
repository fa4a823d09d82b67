#include "assembly/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace langer {

Equilibrium::Equilibrium(const Mesh& mesh, std::vector<Material> materials, Formulation formulation, Dofs dofs, int threads)
    : mesh_(mesh),
      materials_(std::move(materials)),
      formulation_(formulation),
      dofs_(std::move(dofs)),
      pattern_(make_pattern(mesh, dofs_)),
      threads_(threads) {
  const int n = mesh.n_cells(), per_element = n_pressures(formulation);
  geometry_.reserve(n);
  for (int e = 0; e < n; ++e) {
    geometry_.push_back(element_geometry(element_nodes(mesh, e)));
    fibres_.push_back(fibre_directions(material(e), mesh.frames.empty() ? Mat3::Identity() : mesh.frames[e]));
  }
  p_.assign(static_cast<std::size_t>(n) * per_element, 0);
  J_minus_1_ = p_;
  dJ_du_.resize(p_.size());
  f_ = K_du_ = VecX::Zero(dofs_.n);
  K_.assign(pattern_.nnz(), 0);
}

ElementNodes Equilibrium::element_displacements(const VecX& u, int e) const {
  ElementNodes q;
  const auto nodes = mesh_.cell(e);
  for (int a = 0; a < 8; ++a) q.row(a) = u.segment<3>(3 * nodes[a]).transpose();
  return q;
}

bool Equilibrium::assemble(const VecX& u, bool with_tangent, const VecX* du_prescribed) {
  constexpr int block = 64;  // elements computed in parallel, then added in order
  const int n = mesh_.n_cells(), per_element = n_pressures(formulation_);
  std::vector<SolidElement> out(block);
  f_.setZero(), K_du_.setZero();
  if (with_tangent) std::fill(K_.begin(), K_.end(), 0.0);
  W_ = 0, J_min_ = std::numeric_limits<double>::infinity(), floor_ = 0;
  bool admissible = true;
  for (int first = 0; first < n && admissible; first += block) {
    const int last = std::min(n, first + block);
#pragma omp parallel for schedule(static) num_threads(threads_) reduction(&& : admissible) if (threads_ > 1)
    for (int e = first; e < last; ++e) {
      const ElementNodes q = element_displacements(u, e);
      admissible = solid(formulation_, material(e), geometry_[e], fibres_[e], q,
                         with_tangent ? &p_[static_cast<std::size_t>(e) * per_element] : nullptr, with_tangent, out[e - first]) &&
                   admissible;
    }
    if (!admissible) break;
    for (int e = first; e < last; ++e) {
      const SolidElement& element = out[e - first];
      const auto nodes = mesh_.cell(e);
      for (int a = 0; a < 8; ++a) f_.segment<3>(3 * nodes[a]) += element.f.segment<3>(3 * a);
      W_ += element.W;
      J_min_ = std::min(J_min_, element.J_min);
      double strain = 0;
      for (int k = 0; k < per_element; ++k) {
        J_minus_1_[e * per_element + k] = element.J_minus_1[k];
        dJ_du_[e * per_element + k] = element.dJ_du[k];
        strain = std::max(strain, element.dJ_du[k].lpNorm<Eigen::Infinity>());
      }
      // |grad u| is bounded by the displacements through the same gradients
      const double size = strain * element_displacements(u, e).cwiseAbs().maxCoeff();
      const double kappa = material(e).volume.quadratic.bulk_modulus();
      floor_ += std::pow(std::numeric_limits<double>::epsilon() * kappa * size * geometry_[e].V * strain, 2);
      if (!with_tangent) continue;
      const int* slot = pattern_.slots(e);
      for (int i = 0; i < 24; ++i)
        for (int j = 0; j <= i; ++j, ++slot)
          if (*slot >= 0) K_[*slot] += element.K(i, j);
      if (du_prescribed) {
        Vec24 du;
        for (int a = 0; a < 8; ++a) du.segment<3>(3 * a) = du_prescribed->segment<3>(3 * nodes[a]);
        if (du.isZero(0)) continue;
        const Vec24 K_du = element.K * du;
        for (int a = 0; a < 8; ++a) K_du_.segment<3>(3 * nodes[a]) += K_du.segment<3>(3 * a);
      }
    }
  }
  floor_ = std::sqrt(floor_);
  return admissible && std::isfinite(W_) && f_.allFinite();
}

void Equilibrium::predict_pressures(const VecX& du, double step) {
  const int n = mesh_.n_cells(), per_element = n_pressures(formulation_);
  for (int e = 0; e < n; ++e) {
    const double kappa = material(e).volume.quadratic.bulk_modulus();
    const ElementNodes q = element_displacements(du, e);
    for (int k = 0; k < per_element; ++k) {
      const std::size_t i = static_cast<std::size_t>(e) * per_element + k;
      double change = 0;
      for (int a = 0; a < 8; ++a) change += q.row(a).dot(dJ_du_[i].segment<3>(3 * a).transpose());
      p_[i] += step * (kappa * (J_minus_1_[i] + change) - p_[i]);
    }
  }
}

void Equilibrium::pressures_from(const VecX& u) {
  if (!assemble(u, false)) return;
  const int per_element = n_pressures(formulation_);
  for (std::size_t i = 0; i < p_.size(); ++i)
    p_[i] = material(static_cast<int>(i) / per_element).volume.quadratic.bulk_modulus() * J_minus_1_[i];
}

}  // namespace langer
