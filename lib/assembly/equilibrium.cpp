#include "assembly/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/in_order.hpp"

namespace langer {

Equilibrium::Equilibrium(const Mesh& mesh, std::vector<Material> materials, Formulation formulation, Dofs dofs, int threads,
                         Kernel kernel, std::vector<std::vector<Vec3>> fibres, std::vector<double> cell_share)
    : mesh_(mesh),
      materials_(std::move(materials)),
      formulation_(formulation),
      dofs_(std::move(dofs)),
      pattern_(make_pattern(mesh, dofs_)),
      threads_(threads),
      kernel_(kernel),
      fibres_(std::move(fibres)) {
  const int n = mesh.n_cells(), per_element = n_pressures(formulation);
  geometry_.reserve(n);
  const bool from_frames = fibres_.empty();
  for (int e = 0; e < n; ++e) {
    geometry_.push_back(element_geometry(element_nodes(mesh, e)));
    if (!cell_share.empty()) {
      for (double& w : geometry_[e].w) w *= cell_share[e];
      geometry_[e].V *= cell_share[e];
    }
    if (from_frames) fibres_.push_back(fibre_directions(material(e), mesh.frames.empty() ? Mat3::Identity() : mesh.frames[e]));
  }
  for (const Material& m : materials_)
    if (!packet_form(m)) kernel_ = Kernel::one_by_one;
  if (!dofs_.tie.empty()) {
    tied_.assign(n, 0);
    for (int e = 0; e < n; ++e)
      for (int a : mesh.cell(e))
        if (dofs_.tie[a].of != a) tied_[e] = 1;
  }
  make_blocks();
  p_.assign(static_cast<std::size_t>(n) * per_element, 0);
  J_minus_1_ = p_;
  dJ_du_.resize(p_.size());
  f_ = K_du_ = VecX::Zero(dofs_.n);
  K_.assign(pattern_.nnz(), 0);
}

void Equilibrium::make_blocks() {
  std::vector<std::vector<int>> of_body(std::max<std::size_t>(1, mesh_.bodies.size()));
  for (int e = 0; e < mesh_.n_cells(); ++e) of_body[mesh_.body.empty() ? 0 : mesh_.body[e]].push_back(e);
  for (const auto& cells : of_body)
    for (std::size_t first = 0; first < cells.size(); first += Packet::lanes) {
      Block block;
      block.n = static_cast<int>(std::min<std::size_t>(Packet::lanes, cells.size() - first));
      const ElementGeometry* geometry[Packet::lanes];
      std::vector<PacketFibre> fibres(fibres_[cells[first]].size());
      for (int l = 0; l < Packet::lanes; ++l) {
        const int e = block.cells[l] = cells[first + std::min(l, block.n - 1)];
        geometry[l] = &geometry_[e];
        for (std::size_t k = 0; k < fibres.size(); ++k)
          for (int i = 0; i < 3; ++i) fibres[k].a[i].set(l, fibres_[e][k][i]);
      }
      blocks_.push_back(block);
      packet_geometry_.push_back(packed(geometry));
      packet_fibres_.push_back(std::move(fibres));
    }
}

ElementNodes Equilibrium::element_displacements(const VecX& u, int e) const {
  ElementNodes q;
  const auto nodes = mesh_.cell(e);
  for (int a = 0; a < 8; ++a) q.row(a) = u.segment<3>(3 * dofs_.node(nodes[a])).transpose();
  if (!tied_.empty() && tied_[e])
    for (int a = 0; a < 8; ++a) q.row(a) = q.row(a).cwiseProduct(dofs_.tie[nodes[a]].signs.transpose());
  return q;
}

void Equilibrium::load(const Block& block, const VecX& u, Packet* q) const {
  for (int l = 0; l < Packet::lanes; ++l) {
    const int e = block.cells[l];
    const auto nodes = mesh_.cell(e);
    if (!tied_.empty() && tied_[e]) {
      const ElementNodes q_e = element_displacements(u, e);
      for (int a = 0; a < 8; ++a)
        for (int k = 0; k < 3; ++k) q[3 * a + k].set(l, q_e(a, k));
      continue;
    }
    for (int a = 0; a < 8; ++a)
      for (int k = 0; k < 3; ++k) q[3 * a + k].set(l, u[3 * nodes[a] + k]);
  }
}

void Equilibrium::compute(const Block& block, const VecX& u, bool with_tangent, PacketElement& out) const {
  const int per_element = n_pressures(formulation_);
  const Material& law = material(block.cells[0]);
  if (kernel_ == Kernel::packets) {
    const std::size_t b = &block - blocks_.data();
    Packet q[24], p[8];
    load(block, u, q);
    for (int l = 0; l < Packet::lanes; ++l)
      for (int k = 0; k < per_element; ++k) p[k].set(l, p_[static_cast<std::size_t>(block.cells[l]) * per_element + k]);
    packet_solid(formulation_, law, packet_geometry_[b], packet_fibres_[b].data(), q, p, with_tangent, out);
    return;
  }
  SolidElement one;
  for (int l = 0; l < block.n; ++l) {
    const int e = block.cells[l];
    solid(formulation_, law, geometry_[e], fibres_[e], element_displacements(u, e),
          &p_[static_cast<std::size_t>(e) * per_element], with_tangent, one);
    out.W.set(l, one.W), out.J_min.set(l, one.J_min);
    for (int k = 0; k < per_element; ++k) {
      out.J_minus_1[k].set(l, one.J_minus_1[k]);
      for (int i = 0; i < 24; ++i) out.dJ_du[k][i].set(l, one.dJ_du[k][i]);
    }
    for (int i = 0; i < 24; ++i) out.f[i].set(l, one.f[i]);
    for (int i = 0, k = 0; i < 24 && with_tangent; ++i)
      for (int j = 0; j <= i; ++j) out.K[k++].set(l, one.K(i, j));
  }
  for (int l = block.n; l < Packet::lanes; ++l) out.J_min.set(l, out.J_min[0]);
}

// Forces and tangent of a cell with tied nodes, folded onto the nodes that move.
void Equilibrium::add_tied(int e, const PacketElement& out, int lane, bool with_tangent) {
  const auto nodes = mesh_.cell(e);
  double sign[24];
  int dof[24];
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i) {
      sign[3 * a + i] = dofs_.tie[nodes[a]].signs[i], dof[3 * a + i] = 3 * dofs_.node(nodes[a]) + i;
      f_[dof[3 * a + i]] += sign[3 * a + i] * out.f[3 * a + i][lane];
    }
  if (!with_tangent) return;
  const int* slot = pattern_.slots(e);
  for (int i = 0, k = 0; i < 24; ++i)
    for (int j = 0; j <= i; ++j, ++k)  // two tied entries of one cell meet on the diagonal: both halves of the matrix count there
      if (slot[k] >= 0) K_[slot[k]] += (i != j && dof[i] == dof[j] ? 2 : 1) * sign[i] * sign[j] * out.K[k][lane];
}

void Equilibrium::add(const Block& block, const PacketElement& out, const VecX& u, bool with_tangent,
                      const VecX* du_prescribed) {
  const int per_element = n_pressures(formulation_);
  const double kappa = material(block.cells[0]).volume.quadratic.bulk_modulus();
  for (int l = 0; l < block.n; ++l) {
    const int e = block.cells[l];
    const auto nodes = mesh_.cell(e);
    const bool tied = !tied_.empty() && tied_[e];
    if (tied) add_tied(e, out, l, with_tangent);
    for (int a = 0; a < 8 && !tied; ++a)
      for (int i = 0; i < 3; ++i) f_[3 * nodes[a] + i] += out.f[3 * a + i][l];
    W_ += out.W[l];
    double slope = 0, moved = 0;
    for (int k = 0; k < per_element; ++k) {
      J_minus_1_[e * per_element + k] = out.J_minus_1[k][l];
      Vec24& dJ = dJ_du_[e * per_element + k];
      for (int i = 0; i < 24; ++i) dJ[i] = out.dJ_du[k][i][l];
      slope = std::max(slope, dJ.lpNorm<Eigen::Infinity>());
    }
    for (int a = 0; a < 8; ++a) moved = std::max(moved, u.segment<3>(3 * dofs_.node(nodes[a])).lpNorm<Eigen::Infinity>());
    // rounding of u reaches the pressure through the dilatation's gradient, and the force through it once more
    const double floor = std::numeric_limits<double>::epsilon() * kappa * moved * slope * slope * geometry_[e].V;
    floor_ += floor * floor;
    if (!with_tangent) continue;
    const int* slot = pattern_.slots(e);
    for (int k = 0; k < Pattern::slots_per_element && !tied; ++k)
      if (slot[k] >= 0) K_[slot[k]] += out.K[k][l];
    if (!du_prescribed) continue;
    Vec24 du;
    const ElementNodes du_nodes = element_displacements(*du_prescribed, e);
    for (int a = 0; a < 8; ++a) du.segment<3>(3 * a) = du_nodes.row(a).transpose();
    if (du.isZero(0)) continue;
    Vec24 K_du = Vec24::Zero();
    for (int i = 0, k = 0; i < 24; ++i)
      for (int j = 0; j <= i; ++j, ++k) {
        K_du[i] += out.K[k][l] * du[j];
        if (j < i) K_du[j] += out.K[k][l] * du[i];
      }
    for (int a = 0; a < 8; ++a) {
      const Vec3 signs = tied ? dofs_.tie[nodes[a]].signs : Vec3::Ones();
      K_du_.segment<3>(3 * dofs_.node(nodes[a])) += signs.cwiseProduct(K_du.segment<3>(3 * a));
    }
  }
}

bool Equilibrium::assemble(const VecX& u, bool with_tangent, const VecX* du_prescribed) {
  constexpr int chunk = 8;  // blocks computed by one thread before it waits for its turn to add them
  const int n = static_cast<int>(blocks_.size()), n_chunks = (n + chunk - 1) / chunk;
  f_.setZero(), K_du_.setZero();
  if (with_tangent) std::fill(K_.begin(), K_.end(), 0.0);
  W_ = 0, J_min_ = std::numeric_limits<double>::infinity(), floor_ = 0;
  std::vector<PacketElement> out(static_cast<std::size_t>(chunk) * threads_);
  const auto first = [](int c) { return c * chunk; };
  const auto last = [n](int c) { return std::min(n, (c + 1) * chunk); };
  in_order(
      threads_, n_chunks,
      [&](int worker, int c) {
        for (int b = first(c); b < last(c); ++b) compute(blocks_[b], u, with_tangent, out[worker * chunk + b - first(c)]);
      },
      [&](int worker, int c) {
        for (int b = first(c); b < last(c); ++b) {
          const PacketElement& element = out[worker * chunk + b - first(c)];
          J_min_ = std::min(J_min_, smallest(element.J_min));
          if (J_min_ > 0) add(blocks_[b], element, u, with_tangent, du_prescribed);
        }
      });
  floor_ = std::sqrt(floor_);
  return J_min_ > 0 && std::isfinite(W_) && f_.allFinite();
}

double Equilibrium::smallest_J(const VecX& u) const {
  double J_min = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Packet q[24], J_minus_1[8];
    load(blocks_[b], u, q);
    packet_dilatations(packet_geometry_[b], q, J_minus_1);
    for (const Packet& J : J_minus_1) J_min = std::min(J_min, 1 + smallest(J));
  }
  return J_min;
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
