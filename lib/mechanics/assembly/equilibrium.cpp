#include "mechanics/assembly/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/in_order.hpp"
#include "mechanics/element/dilatation.hpp"

namespace langer {

namespace {

std::vector<int> cells_of_rank(const std::optional<Division>& division, int n) {
  if (division) return division->cells();
  std::vector<int> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

Equilibrium::Equilibrium(const Mesh& mesh, std::vector<Material> materials, Directions directions,
                         Formulation formulation, Dofs dofs, int threads, Kernel kernel,
                         std::vector<double> cell_share, std::optional<Division> division)
    : mesh_(mesh),
      materials_(std::move(materials)),
      directions_(std::move(directions)),
      formulation_(formulation),
      n_nodes_(nodes_per_cell(mesh.type)),
      n_dofs_(3 * n_nodes_),
      n_p_(n_pressures(formulation, n_nodes_)),
      dofs_(std::move(dofs)),
      division_(std::move(division)),
      own_(cells_of_rank(division_, mesh.n_cells())),
      moving_(mesh),
      pattern_(make_pattern(mesh, moving_, dofs_, own_)),
      threads_(threads),
      asked_(kernel),
      kernel_(kernel) {
  const int n = mesh.n_cells();
  geometry_.reserve(n);
  for (int e = 0; e < n; ++e) {
    if (division_ && !division_->ranks->first() && !division_->own(e)) {
      geometry_.emplace_back();
      continue;
    }
    geometry_.push_back(element_geometry(element_nodes(mesh, e)));
    if (const MatX* C = moving_.weights(e))
      for (Gradients& dN : geometry_[e].dN_dX) dN = C->transpose() * dN;
    if (!cell_share.empty()) {
      for (double& w : geometry_[e].w) w *= cell_share[e];
      geometry_[e].V *= cell_share[e];
    }
  }
  for (const Material& m : materials_)
    if (!packet_form(m)) kernel_ = Kernel::one_by_one;
  if (!dofs_.tie.empty()) {
    tied_.assign(n, 0);
    for (int e = 0; e < n; ++e)
      for (int a : moving_.of(e))
        if (dofs_.tie[a].of != a || !dofs_.tie[a].T.isDiagonal(0)) tied_[e] = 1;
  }
  make_blocks();
  find_beginnings();
  p_.assign(static_cast<std::size_t>(n) * n_p_, 0);
  local_.assign(n, 0);
  J_minus_1_ = p_;
  dJ_du_.resize(p_.size() * n_dofs_);
  if (ViscousPoints::needed(materials_))
    viscous_.emplace(materials_, mesh.body, n, mesh.cell().n_gauss);
  f_ = K_du_ = VecX::Zero(dofs_.n);
  K_.assign(pattern_.nnz(), 0);
  begin_increment(0);
}

void Equilibrium::make_blocks() {
  std::vector<std::vector<int>> of_body(std::max<std::size_t>(1, mesh_.bodies.size()));
  for (int e : own_) of_body[mesh_.body.empty() ? 0 : mesh_.body[e]].push_back(e);
  for (const auto& cells : of_body)
    for (std::size_t first = 0; first < cells.size(); first += Packet::lanes) {
      Block block;
      block.n = static_cast<int>(std::min<std::size_t>(Packet::lanes, cells.size() - first));
      const ElementGeometry* geometry[Packet::lanes];
      for (int l = 0; l < Packet::lanes; ++l) {
        const int e = block.cells[l] = cells[first + std::min(l, block.n - 1)];
        geometry[l] = &geometry_[e];
      }
      blocks_.push_back(block);
      packet_geometry_.push_back(packed(geometry));
    }
  pack_fibres();
}

void Equilibrium::pack_fibres() {
  packet_fibres_.resize(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    packet_fibres_[b].resize(fibres(blocks_[b].cells[0]).size());
    for (int l = 0; l < Packet::lanes; ++l)
      for (std::size_t k = 0; k < packet_fibres_[b].size(); ++k)
        for (int i = 0; i < 3; ++i)
          packet_fibres_[b][k].a[i].set(l, fibres(blocks_[b].cells[l])[k][i]);
  }
}

void Equilibrium::find_beginnings() {
  const int per_element = pattern_.blocks_per_element;
  begins_.assign(own_.size() * per_element, 0);
  std::vector<char> met(pattern_.nnz(), 0);
  for (const Block& block : blocks_)
    for (int l = 0; l < block.n; ++l) {
      const int e = block.cells[l];
      if (pattern_.scattered(e)) {
        for (int k = 0; k < pattern_.slots_per_element; ++k)
          if (const int at = pattern_.slots(e)[k]; at >= 0 && !met[at])
            met[at] = 1, cleared_.push_back(at);
        continue;
      }
      for (int k = 0; k < per_element; ++k) {
        const int at = pattern_.blocks(e)[3 * k];
        if (at == Pattern::none) continue;
        char& first_entry =
            met[at >= 0 ? at : Pattern::turned(at)];  // no cell meets a part of a block
        begins_[pattern_.number(e) * per_element + k] = !first_entry;
        first_entry = 1;
      }
    }
}

ElementNodes Equilibrium::element_displacements(const VecX& u, int e) const {
  if ((tied_.empty() || !tied_[e]) && !moving_.weights(e)) return element_values(mesh_, e, u);
  const auto nodes = moving_.of(e);
  ElementNodes q(n_nodes_, 3);
  for (int a = 0; a < n_nodes_; ++a) q.row(a) = displacement(dofs_, u, nodes[a]).transpose();
  return q;
}

void Equilibrium::load(const Block& block, const VecX& u, Packet* q) const {
  for (int l = 0; l < Packet::lanes; ++l) {
    const int e = block.cells[l];
    const auto nodes = moving_.of(e);
    if (!tied_.empty() && tied_[e]) {
      const ElementNodes q_e = element_displacements(u, e);
      for (int a = 0; a < n_nodes_; ++a)
        for (int k = 0; k < 3; ++k) q[3 * a + k].set(l, q_e(a, k));
      continue;
    }
    for (int a = 0; a < n_nodes_; ++a)
      for (int k = 0; k < 3; ++k) q[3 * a + k].set(l, u[3 * nodes[a] + k]);
  }
}

void Equilibrium::compute(const Block& block, const VecX& u, bool with_tangent,
                          PacketElement& out) const {
  const Material& law = material(block.cells[0]);
  if (kernel_ == Kernel::packets) {
    const std::size_t b = &block - blocks_.data();
    Packet q[most_dofs], p[most_gauss], local;
    load(block, u, q);
    for (int l = 0; l < Packet::lanes; ++l) {
      const int e = block.cells[l];
      local.set(l, local_[e]);
      for (int k = 0; k < n_p_; ++k) p[k].set(l, modal_pressure(e, k));
    }
    const bool remembers = viscous_ && viscous_->has(block.cells[0]);
    const PacketMemory memory =
        remembers ? PacketMemory{viscous_->amplified(block.cells[0]), packet_H_[b].data()}
                  : PacketMemory{};
    packet_solid(formulation_, law, local, packet_geometry_[b], packet_fibres_[b].data(), q, p,
                 with_tangent, out, remembers ? &memory : nullptr);
    return;
  }
  SolidElement one;
  std::vector<double> p(n_p_);
  for (int l = 0; l < block.n; ++l) {
    const int e = block.cells[l];
    for (int k = 0; k < n_p_; ++k) p[k] = modal_pressure(e, k);
    const auto memory =
        viscous_ && viscous_->has(e) ? std::optional(viscous_->memory(e)) : std::nullopt;
    const bool whole =
        solid(formulation_, law, local_[e], geometry_[e], fibres(e), element_displacements(u, e),
              p.data(), with_tangent, one, memory ? &*memory : nullptr);
    out.W.set(l, one.W), out.J_min.set(l, one.J_min);
    if (!whole) continue;
    for (int k = 0; k < n_p_; ++k) {
      out.J_minus_1[k].set(l, one.J_minus_1[k]);
      for (int i = 0; i < n_dofs_; ++i) out.dJ_du(k)[i].set(l, one.dJ_du[k][i]);
    }
    for (int i = 0; i < n_dofs_; ++i) out.f[i].set(l, one.f[i]);
    for (int i = 0, k = 0; i < n_dofs_ && with_tangent; ++i)
      for (int j = 0; j <= i; ++j) out.K[k++].set(l, one.K(i, j));
  }
  for (int l = block.n; l < Packet::lanes; ++l) out.J_min.set(l, out.J_min[0]);
}

void Equilibrium::add_force(VecX& forces, int node, bool tied, const Vec3& force) const {
  forces.segment<3>(3 * dofs_.node(node)) +=
      tied ? Vec3(dofs_.tie[node].T.transpose() * force) : force;
}

// Forces and tangent of a cell with tied nodes, folded onto the nodes that move.
void Equilibrium::add_tied(int e, const PacketElement& out, int lane, bool with_tangent) {
  const auto nodes = moving_.of(e);
  const auto entry = [](int i, int j) {
    return i < j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j;
  };  // lower triangle, row by row
  for (int a = 0; a < n_nodes_; ++a)
    add_force(f_, nodes[a], true,
              Vec3(out.f[3 * a][lane], out.f[3 * a + 1][lane], out.f[3 * a + 2][lane]));
  if (!with_tangent) return;
  const int* slot = pattern_.slots(e);
  for (int a = 0; a < n_nodes_; ++a)
    for (int b = 0; b <= a; ++b) {
      const Image &row = dofs_.tie[nodes[a]], &column = dofs_.tie[nodes[b]];
      Mat3 K;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) K(i, j) = out.K[entry(3 * a + i, 3 * b + j)][lane];
      K = row.T.transpose() * K * column.T;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < (a == b ? i + 1 : 3); ++j) {
          const int at = slot[entry(3 * a + i, 3 * b + j)];
          // two nodes that move with one: both halves of the matrix meet on its diagonal
          if (at >= 0) K_[at] += (a != b && i == j && row.of == column.of ? 2 : 1) * K(i, j);
        }
    }
}

void Equilibrium::set_loads(Loads loads) {
  loads_ = std::move(loads);
  f_ext_ = VecX::Zero(dofs_.n);
}

int Equilibrium::position(int e, int row, int column) const {
  if (pattern_.scattered(e)) return pattern_.slots(e)[row * (row + 1) / 2 + column];
  const int a = row / 3, b = column / 3, i = row % 3, j = column % 3;
  const int* at = pattern_.blocks(e) + 3 * (a * (a + 1) / 2 + b);
  if (at[0] == Pattern::none) return Pattern::none;
  if (a == b) return at[j] + i - j;
  return at[0] >= 0 ? at[j] + i : Pattern::turned(at[i]) + j;
}

void Equilibrium::add_loads(const VecX& u, bool with_tangent, const VecX* du_prescribed) {
  f_ext_.setZero();
  const auto displacements = [&](int e) {
    return element_displacements(u, e);
  };
  loads_.each(t_loads_, displacements, with_tangent,
              [&](int e, const ElementNodes& force, const MatX* stiffness) {
                const auto nodes = moving_.of(e);
                const bool tied = !tied_.empty() && tied_[e];
                for (int a = 0; a < n_nodes_; ++a)
                  add_force(f_ext_, nodes[a], tied, force.row(a).transpose());
                if (!stiffness) return;
                for (int a = 0; a < n_nodes_; ++a)
                  for (int b = 0; b <= a; ++b) {
                    Mat3 K = stiffness->block<3, 3>(3 * a, 3 * b);
                    if (K.isZero(0)) continue;
                    const bool twice =
                        tied && a != b &&
                        dofs_.tie[nodes[a]].of == dofs_.tie[nodes[b]].of;  // as in add_tied
                    if (tied) K = dofs_.tie[nodes[a]].T.transpose() * K * dofs_.tie[nodes[b]].T;
                    for (int i = 0; i < 3; ++i)
                      for (int j = 0; j < (a == b ? i + 1 : 3); ++j)
                        if (const int at = position(e, 3 * a + i, 3 * b + j); at >= 0)
                          K_[at] += (twice && i == j ? 2 : 1) * K(i, j);
                  }
                if (!du_prescribed) return;
                const ElementNodes du = element_displacements(*du_prescribed, e);
                if (du.isZero(0)) return;
                for (int a = 0; a < n_nodes_; ++a) {
                  Vec3 K_du = Vec3::Zero();
                  for (int b = 0; b < n_nodes_; ++b)
                    K_du += stiffness->block<3, 3>(3 * a, 3 * b) * du.row(b).transpose();
                  add_force(K_du_, nodes[a], tied, K_du);
                }
              });
}

VecX Equilibrium::skew_pressures(const VecX& u, const VecX& du) const {
  VecX out = VecX::Zero(dofs_.n);
  const auto at = [this](const VecX& values) {
    return [this, &values](int e) {
      return element_displacements(values, e);
    };
  };
  loads_.each_skew(t_loads_, at(u), at(du), [&](int e, const ElementNodes& change) {
    const auto nodes = moving_.of(e);
    for (int a = 0; a < n_nodes_; ++a)
      add_force(out, nodes[a], !tied_.empty() && tied_[e], change.row(a).transpose());
  });
  return out;
}

void Equilibrium::add_stiffness(int e, const PacketElement& out, int lane) {
  if (pattern_.scattered(e)) {
    const int* slot = pattern_.slots(e);
    for (int k = 0; k < pattern_.slots_per_element; ++k)
      if (slot[k] >= 0) K_[slot[k]] += out.K[k][lane];
    return;
  }
  const int* at = pattern_.blocks(e);
  const char* begins = &begins_[pattern_.number(e) * pattern_.blocks_per_element];
  const auto column = [this](int position, bool first, int n, const auto& value) {
    static constexpr double nothing[3] = {};
    double* to = &K_[position];
    const double* before = first ? nothing : to;
    for (int i = 0; i < n; ++i) to[i] = before[i] + value(i);
  };
  for (int a = 0; a < n_nodes_; ++a) {
    const Packet* row[3];
    for (int i = 0; i < 3; ++i) row[i] = &out.K[(3 * a + i) * (3 * a + i + 1) / 2];
    for (int b = 0; b <= a; ++b, at += 3, ++begins) {
      if (at[0] == Pattern::none) continue;
      if (a == b)
        for (int j = 0; j < 3; ++j)
          column(at[j], *begins, 3 - j, [&](int i) { return row[i + j][3 * b + j][lane]; });
      else if (at[0] >= 0)
        for (int j = 0; j < 3; ++j)
          column(at[j], *begins, 3, [&](int i) { return row[i][3 * b + j][lane]; });
      else
        for (int i = 0; i < 3; ++i)
          column(Pattern::turned(at[i]), *begins, 3,
                 [&](int j) { return row[i][3 * b + j][lane]; });
    }
  }
}

void Equilibrium::add(const Block& block, const PacketElement& out, const VecX& u,
                      bool with_tangent, const VecX* du_prescribed) {
  const double kappa = bulk_modulus(block.cells[0]);
  for (int l = 0; l < block.n; ++l) {
    const int e = block.cells[l];
    const auto nodes = moving_.of(e);
    const bool tied = !tied_.empty() && tied_[e];
    if (tied) add_tied(e, out, l, with_tangent);
    for (int a = 0; a < n_nodes_ && !tied; ++a)
      for (int i = 0; i < 3; ++i) f_[3 * nodes[a] + i] += out.f[3 * a + i][l];
    W_ += out.W[l];
    double slope = 0, moved = 0;
    for (int k = 0; k < n_p_; ++k) {
      const std::size_t at = static_cast<std::size_t>(e) * n_p_ + k;
      J_minus_1_[at] = out.J_minus_1[k][l];
      double* dJ = &dJ_du_[at * n_dofs_];
      for (int i = 0; i < n_dofs_; ++i) dJ[i] = out.dJ_du(k)[i][l];
      for (int i = 0; i < n_dofs_ && !tied; ++i) slope = std::max(slope, std::abs(dJ[i]));
      for (int a = 0; a < n_nodes_ && tied; ++a) {
        Vec3 sum = Vec3::Zero();  // over the nodes before it that move with the same dofs
        for (int b = 0; b <= a; ++b)
          if (dofs_.node(nodes[b]) == dofs_.node(nodes[a]))
            sum += dofs_.tie[nodes[b]].T.transpose() * Vec3(dJ + 3 * b);
        slope = std::max(slope, sum.lpNorm<Eigen::Infinity>());
      }
    }
    for (int a : nodes)
      moved = std::max(moved, u.segment<3>(3 * dofs_.node(a)).lpNorm<Eigen::Infinity>());
    // rounding of u reaches the pressure through the dilatation's gradient, and the force through
    // it once more
    const double floor =
        std::numeric_limits<double>::epsilon() * kappa * moved * slope * slope * geometry_[e].V;
    floor_ += floor * floor;
    if (!with_tangent) continue;
    if (!tied) add_stiffness(e, out, l);
    if (!du_prescribed) continue;
    const ElementNodes du_nodes = element_displacements(*du_prescribed, e);
    if (du_nodes.isZero(0)) continue;
    std::array<double, most_dofs> du, K_du{};
    for (int i = 0; i < n_dofs_; ++i) du[i] = du_nodes(i / 3, i % 3);
    for (int i = 0, k = 0; i < n_dofs_; ++i)
      for (int j = 0; j <= i; ++j, ++k) {
        K_du[i] += out.K[k][l] * du[j];
        if (j < i) K_du[j] += out.K[k][l] * du[i];
      }
    for (int a = 0; a < n_nodes_; ++a) add_force(K_du_, nodes[a], tied, Vec3(&K_du[3 * a]));
  }
}

void Equilibrium::sum_over_ranks(bool with_tangent) {
  J_min_ = division_->ranks->smallest(J_min_);
  if (!(J_min_ > 0)) return;
  VecX all(f_.size() + 2 + (with_tangent ? K_du_.size() : 0));
  all << f_, W_, floor_, K_du_.head(all.size() - f_.size() - 2);
  division_->ranks->sum(all.data(), static_cast<std::size_t>(all.size()));
  f_ = all.head(f_.size()), W_ = all[f_.size()], floor_ = all[f_.size() + 1];
  if (with_tangent) K_du_ = all.tail(K_du_.size());
}

bool Equilibrium::assemble(const VecX& u, bool with_tangent, const VecX* du_prescribed) {
  // blocks computed by one thread before it waits for its turn to add them; they stay in its cache
  const int chunk = threads_ == 1 ? 1 : mesh_.cell().second_order() ? 2 : 8;
  const int n = static_cast<int>(blocks_.size()), n_chunks = (n + chunk - 1) / chunk;
  f_.setZero(), K_du_.setZero();
  if (with_tangent)
    for (int position : cleared_) K_[position] = 0;
  W_ = 0, J_min_ = std::numeric_limits<double>::infinity(), floor_ = 0;
  std::vector<PacketElement> out(static_cast<std::size_t>(chunk) * threads_,
                                 PacketElement(n_nodes_, n_p_));
  const auto first = [chunk](int c) {
    return c * chunk;
  };
  const auto last = [n, chunk](int c) {
    return std::min(n, (c + 1) * chunk);
  };
  in_order(
      threads_, n_chunks,
      [&](int worker, int c) {
        for (int b = first(c); b < last(c); ++b)
          compute(blocks_[b], u, with_tangent, out[worker * chunk + b - first(c)]);
      },
      [&](int worker, int c) {
        for (int b = first(c); b < last(c); ++b) {
          const PacketElement& element = out[worker * chunk + b - first(c)];
          J_min_ = std::min(J_min_, smallest(element.J_min));
          if (J_min_ > 0) add(blocks_[b], element, u, with_tangent, du_prescribed);
        }
      });
  if (division_) sum_over_ranks(with_tangent);
  floor_ = std::sqrt(floor_);
  if (!loads_.empty() && J_min_ > 0) add_loads(u, with_tangent, du_prescribed);
  const bool whole = J_min_ > 0 && std::isfinite(W_) && f_.allFinite();
  J_at_ = whole ? u : VecX();
  return whole;
}

double Equilibrium::smallest_J(const VecX& u) const {
  double J_min = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Packet q[most_dofs], J_minus_1[most_gauss];
    load(blocks_[b], u, q);
    packet_dilatations(packet_geometry_[b], q, J_minus_1);
    for (int g = 0; g < packet_geometry_[b].n_gauss; ++g)
      J_min = std::min(J_min, 1 + smallest(J_minus_1[g]));
  }
  return division_ ? division_->ranks->smallest(J_min) : J_min;
}

}  // namespace langer
