#include "results/post/nodal_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/tensor/invariants.hpp"

namespace langer {

Body::Body(const Mesh& mesh, std::vector<Material> materials, Directions directions,
           Formulation formulation)
    : mesh_(mesh),
      materials_(std::move(materials)),
      directions_(std::move(directions)),
      formulation_(formulation),
      n_families_(directions_.n_families()) {
  const int n = mesh.n_cells();
  // The region that each node shows: the lowest number of all elements at it.
  std::vector<int> shown(mesh.X.size(), std::numeric_limits<int>::max());
  for (int e = 0; e < n; ++e) {
    geometry_.push_back(element_geometry(element_nodes(mesh, e)));
    for (int node : mesh.cell(e)) shown[node] = std::min(shown[node], region(e));
  }
  // The elements at each node, in compressed rows: count, sum up, fill.
  first_.assign(mesh.X.size() + 1, 0);
  for (int e = 0; e < n; ++e)
    for (int node : mesh.cell(e)) first_[node + 1] += region(e) == shown[node];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  corners_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (int e = 0; e < n; ++e)
    for (int a = 0; a < nodes_per_cell(mesh.type); ++a) {
      const int node = mesh.cell(e)[a];
      if (region(e) == shown[node]) corners_[next[node]++] = {e, a};
    }
}

ElementNodes element_displacements(const Mesh& mesh, const std::vector<Vec3>& u, int e) {
  const auto nodes = mesh.cell(e);
  ElementNodes q(nodes.size(), 3);
  for (std::size_t a = 0; a < nodes.size(); ++a) q.row(a) = u[nodes[a]].transpose();
  return q;
}

// The states of the Gauss points from the formulation of the elements, as rows: stress, J,
// stretches of the fibres.
ElementValues gauss_values(const Body& body, const std::vector<Vec3>& u, int e) {
  const auto a = body.fibres(e);
  const auto states = gauss_states(body.formulation(), body.material(e), body.geometry(e), a,
                                   element_displacements(body.mesh(), u, e), body.branches(e));
  ElementValues values =
      ElementValues::Ones(static_cast<Eigen::Index>(states.size()), body.n_values());
  for (std::size_t g = 0; g < states.size(); ++g) {
    values.row(g).head<6>() = voigt(states[g].sigma).transpose();
    values(g, 6) = states[g].J;
    // sqrt(I4_bar) = J^(-1/3) |F a|
    for (std::size_t k = 0; k < a.size(); ++k)
      values(g, 7 + k) = (states[g].F * a[k]).norm() / std::cbrt(states[g].J);
  }
  return values;
}

VecX element_mean(const Body& body, int e, const ElementValues& gauss) {
  const ElementGeometry& geometry = body.geometry(e);
  VecX mean = VecX::Zero(gauss.cols());
  for (int g = 0; g < geometry.n_gauss(); ++g)
    mean += geometry.w[g] / geometry.V * gauss.row(g).transpose();
  return mean;
}

// F of the element's mean gradients of the shape functions, weighted with the reference volume.
Mat3 mean_deformation_gradient(const Body& body, const std::vector<Vec3>& u, int e) {
  const ElementGeometry& geometry = body.geometry(e);
  Gradients dN = Gradients::Zero(geometry.n_nodes(), 3);
  for (int g = 0; g < geometry.n_gauss(); ++g) dN += geometry.w[g] / geometry.V * geometry.dN_dX[g];
  return Mat3::Identity() + displacement_gradient(element_displacements(body.mesh(), u, e), dN);
}

Vec3 gauss_position(const Mesh& mesh, int e, int g) {
  return element_nodes(mesh, e).transpose() * mesh.cell().N[g];
}

void add_gauss_values(const Body& body, const std::vector<Vec3>& u, int e, GaussValues& gauss) {
  gauss.resize(static_cast<std::size_t>(body.mesh().n_cells()));
  if (gauss[e].size() == 0) gauss[e] = gauss_values(body, u, e);
}

GaussValues gauss_values(const Body& body, const std::vector<Vec3>& u) {
  GaussValues gauss;
  for (int e = 0; e < body.mesh().n_cells(); ++e) add_gauss_values(body, u, e, gauss);
  return gauss;
}

// The mean over the elements at the node, weighted with their reference volume.
VecX node_values(const Body& body, int node, const GaussValues& gauss, StressAt at) {
  VecX sum = VecX::Zero(body.n_values());
  double V = 0;
  const ReferenceCell& cell = body.mesh().cell();
  for (const auto [e, a] : body.corners(node)) {
    const double w = body.geometry(e).V;
    const ElementValues& values = gauss[e];
    if (at == StressAt::nodal_average) {
      // J stays within the values at the Gauss points of the element.
      VecX row = (cell.at_nodes.row(a) * values).transpose();
      row[6] = std::clamp(row[6], values.col(6).minCoeff(), values.col(6).maxCoeff());
      sum += w * row;
    } else {
      sum += w * values.row(cell.nearest_gauss[a]).transpose();
    }
    V += w;
  }
  // A node without elements has zeros.
  if (V > 0) return VecX(sum / V);
  return sum;
}

}  // namespace langer
