#include "mechanics/assembly/body_model.hpp"

#include <numeric>
#include <utility>

#include "mechanics/element/solid.hpp"

namespace langer {

namespace {

std::vector<int> elements_of_this_rank(const std::optional<Division>& division, int n) {
  if (division) return division->cells();
  std::vector<int> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

BodyModel::BodyModel(const Mesh& mesh, std::vector<Material> materials, Directions directions,
                     Formulation formulation, Dofs dofs, const std::vector<double>& cell_share,
                     std::optional<Division> division)
    : mesh_(mesh),
      materials_(std::move(materials)),
      directions_(std::move(directions)),
      formulation_(formulation),
      dofs_(std::move(dofs)),
      division_(std::move(division)),
      own_(elements_of_this_rank(division_, mesh.n_cells())),
      moving_(mesh),
      n_nodes_(nodes_per_cell(mesh.type)),
      n_pressures_(langer::n_pressures(formulation, n_nodes_)) {
  make_geometry(cell_share);
  find_tied_elements();
}

void BodyModel::make_geometry(const std::vector<double>& cell_share) {
  const int n = mesh_.n_cells();
  geometry_.reserve(n);
  for (int e = 0; e < n; ++e) {
    // Rank 0 writes fields of all elements; the others need their own elements only.
    if (division_ && !division_->ranks->first() && !division_->own(e)) {
      geometry_.emplace_back();
      continue;
    }
    geometry_.push_back(element_geometry(element_nodes(mesh_, e)));

    // An element with hanging nodes is moved by other nodes: N'_b = sum_a C_ab N_a.
    if (const MatX* C = moving_.weights(e)) {
      for (Gradients& dN : geometry_[e].dN_dX) dN = C->transpose() * dN;
    }
    if (!cell_share.empty()) {
      for (double& w : geometry_[e].w) w *= cell_share[e];
      geometry_[e].V *= cell_share[e];
    }
  }
}

void BodyModel::find_tied_elements() {
  if (dofs_.tie.empty()) return;
  tied_.assign(mesh_.n_cells(), 0);
  for (int e = 0; e < mesh_.n_cells(); ++e) {
    for (int a : moving_.of(e)) {
      if (dofs_.tie[a].of != a || !dofs_.tie[a].T.isDiagonal(0)) tied_[e] = 1;
    }
  }
}

void BodyModel::set_materials(std::vector<Material> materials, Directions directions) {
  materials_ = std::move(materials);
  directions_ = std::move(directions);
}

ElementNodes BodyModel::displacements(const VecX& u, int e) const {
  if (!tied(e) && !moving_.weights(e)) return element_values(mesh_, e, u);
  const auto nodes = moving_.of(e);
  ElementNodes q(n_nodes_, 3);
  for (int a = 0; a < n_nodes_; ++a) q.row(a) = displacement(dofs_, u, nodes[a]).transpose();
  return q;
}

void BodyModel::add_force(VecX& forces, int node, int e, const Vec3& force) const {
  if (tied(e)) {
    forces.segment<3>(3 * dofs_.node(node)) += Vec3(dofs_.tie[node].T.transpose() * force);
  } else {
    forces.segment<3>(3 * dofs_.node(node)) += force;
  }
}

std::vector<int> BodyModel::element_dofs() const {
  std::vector<int> dofs;
  dofs.reserve(static_cast<std::size_t>(mesh_.n_cells()) * n_dofs());
  for (int e = 0; e < mesh_.n_cells(); ++e) {
    for (int node : moving_.of(e)) {
      for (int i = 0; i < 3; ++i) dofs.push_back(3 * dofs_.node(node) + i);
    }
  }
  return dofs;
}

}  // namespace langer
