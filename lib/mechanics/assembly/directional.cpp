// Derivatives of the balance in a direction, and other numbers in its laws: what direct
// differentiation asks of a body.
#include <algorithm>
#include <cmath>

#include "mechanics/assembly/equilibrium.hpp"
#include "mechanics/element/dilatation.hpp"

namespace langer {

void Equilibrium::set_laws(std::vector<Material> materials, Directions directions) {
  materials_ = std::move(materials), directions_ = std::move(directions);
  kernel_ = asked_;
  for (const Material& m : materials_)
    if (!packet_form(m)) kernel_ = Kernel::one_by_one;
  pack_fibres();
}

Equilibrium::Forces Equilibrium::with_laws(std::vector<Material> materials, Directions directions,
                                           const VecX& u) {
  const std::vector<Material> own = materials_;
  const Directions own_directions = directions_;
  const std::vector<double> p = p_, local = local_;
  const VecX f = f_, f_ext = f_ext_;
  const double W = W_, floor = floor_;
  set_laws(std::move(materials), std::move(directions));
  pressures_from(u);
  assemble(u, false);
  Forces out{f_, W_};
  set_laws(own, own_directions);
  p_ = p, local_ = local, f_ = f, f_ext_ = f_ext, W_ = W, floor_ = floor;
  return out;
}

VecX Equilibrium::K_times(const VecX& v) const {
  VecX out = VecX::Zero(v.size());
  for (int column = 0; column < pattern_.n; ++column) {
    int at = pattern_.column_start[column];
    double sum = K_[at] * v[column];  // a column starts with its diagonal
    for (++at; at < pattern_.column_start[column + 1]; ++at) {
      out[pattern_.row[at]] += K_[at] * v[column];
      sum += K_[at] * v[pattern_.row[at]];
    }
    out[column] += sum;
  }
  return out;
}

VecX Equilibrium::beside_K(const VecX& u, const VecX& v, double* W) {
  VecX out;
  if (W) *W = 0;
  if (formulation_ == Formulation::linear_dilatation) out = local_beside_K(u, v, W);
  if (!loads_.follow()) return out;
  return out.size() == 0 ? VecX(-skew_pressures(u, v)) : VecX(out - skew_pressures(u, v));
}

// S v, S what K() has of the loads.
VecX Equilibrium::loads_times(const VecX& u, const VecX& v) const {
  VecX out = VecX::Zero(dofs_.n);
  const auto displacements = [&](int e) {
    return element_displacements(u, e);
  };
  loads_.each(t_loads_, displacements, true,
              [&](int e, const ElementNodes&, const MatX* stiffness) {
                if (!stiffness) return;
                const ElementNodes q = element_displacements(v, e);
                const auto nodes = moving_.of(e);
                for (int a = 0; a < n_nodes_; ++a) {
                  Vec3 f = Vec3::Zero();
                  for (int b = 0; b < n_nodes_; ++b)
                    f += stiffness->block<3, 3>(3 * a, 3 * b) * q.row(b).transpose();
                  add_force(out, nodes[a], !tied_.empty() && tied_[e], f);
                }
              });
  return out;
}

// Forces and energy are linear in the moduli.
VecX Equilibrium::local_beside_K(const VecX& u, const VecX& v, double* in_W) {
  std::vector<double> change(local_.size()), dt(n_p_), dp(n_p_);
  double largest = 0;
  for (int e = 0; e < mesh_.n_cells(); ++e) {
    const std::size_t first = static_cast<std::size_t>(e) * n_p_;
    if (local_[e] <= 0 || local_[e] >= bulk_modulus(e)) continue;
    const ElementNodes q = element_displacements(v, e);
    for (int k = 0; k < n_p_; ++k) {
      dt[k] = 0;
      for (int a = 0; a < n_nodes_; ++a)
        dt[k] += q.row(a).dot(
            Eigen::Map<const Eigen::RowVector3d>(&dJ_du_[(first + k) * n_dofs_ + 3 * a]));
    }
    const ModalVolume<double> volume =
        modal_volume(material(e).volume, n_p_, &J_minus_1_[first], 0, geometry_[e]);
    for (int k = 0; k < n_p_; ++k) {
      dp[k] = 0;
      for (int l = 0; l < n_p_; ++l) dp[k] += volume.kappa[k][l] * dt[l];
    }
    change[e] = local_modulus_change(geometry_[e], &p_[first], dp.data());
    largest = std::max(largest, std::abs(change[e]));
  }
  if (largest == 0) return VecX::Zero(dofs_.n);
  const std::vector<double> local = local_;
  double size = 0;
  for (double modulus : local) size = std::max(size, modulus);
  const double W = W_;
  const VecX f = f_, f_ext = f_ext_;
  for (std::size_t e = 0; e < local_.size(); ++e) local_[e] += size / largest * change[e];
  assemble(u, false);
  const VecX out = largest / size * (f_ - f);
  if (in_W) *in_W = largest / size * (W_ - W);
  local_ = local, f_ = f, f_ext_ = f_ext, W_ = W;
  return out;
}

std::vector<VecX> Equilibrium::on_prescribed(const VecX& u, const std::vector<VecX>& v) const {
  std::vector<VecX> out(v.size(), VecX::Zero(dofs_.n));
  std::vector<char> prescribed(static_cast<std::size_t>(dofs_.n), 0);
  for (const Prescribed& p : dofs_.prescribed) prescribed[static_cast<std::size_t>(p.dof)] = 1;
  const auto concerned = [&](const Block& block) {
    for (int l = 0; l < block.n; ++l)
      for (int node : moving_.of(block.cells[l]))
        for (int k = 0; k < 3; ++k)
          if (prescribed[static_cast<std::size_t>(3 * dofs_.node(node) + k)]) return true;
    return false;
  };
  PacketElement element(n_nodes_, n_p_);
  for (const Block& block : blocks_) {
    if (!concerned(block)) continue;
    compute(block, u, true, element);
    for (int l = 0; l < block.n; ++l) {
      const int e = block.cells[l];
      const auto nodes = moving_.of(e);
      const bool tied = !tied_.empty() && tied_[e];
      for (std::size_t j = 0; j < v.size(); ++j) {
        const ElementNodes q = element_displacements(v[j], e);
        VecX f = VecX::Zero(n_dofs_);
        for (int i = 0, k = 0; i < n_dofs_; ++i)
          for (int m = 0; m <= i; ++m, ++k) {
            f[i] += element.K[k][l] * q(m / 3, m % 3);
            if (m < i) f[m] += element.K[k][l] * q(i / 3, i % 3);
          }
        for (int a = 0; a < n_nodes_; ++a) add_force(out[j], nodes[a], tied, f.segment<3>(3 * a));
      }
    }
  }
  if (loads_.follow())
    for (std::size_t j = 0; j < v.size(); ++j) out[j] += loads_times(u, v[j]);
  for (VecX& f : out)
    for (int dof = 0; dof < dofs_.n; ++dof)
      if (!prescribed[static_cast<std::size_t>(dof)]) f[dof] = 0;
  return out;
}

}  // namespace langer
