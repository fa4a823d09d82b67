#include "results/post/patches.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "core/tensor/dense.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/section.hpp"

namespace langer {

namespace {

constexpr double equally_near = 1.01;
constexpr int far = 3;  // rings of cells in which a corner inside is looked for

std::vector<std::array<int, 3>> powers_up_to(int degree, int dim) {
  std::vector<std::array<int, 3>> out;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int k = 0; i + j + k <= degree && (dim == 3 || k == 0); ++k) out.push_back({i, j, k});
  return out;
}

double monomial(const Vec3& x, const std::array<int, 3>& powers) {
  double value = 1;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < powers[static_cast<std::size_t>(k)]; ++i) value *= x[k];
  return value;
}

Vec3 middle(const Mesh& mesh, int e) {
  Vec3 X = Vec3::Zero();
  const int n = mesh.cell().n_corners;
  for (int a = 0; a < n; ++a)
    X += mesh.X[static_cast<std::size_t>(mesh.cell(e)[static_cast<std::size_t>(a)])] / n;
  return X;
}

// least squares; of a patch that does not decide its polynomial the smallest one
MatX fit(const MatX& A, const MatX& values) {
  const PivotedQr qr(A);
  if (qr.rank() == A.cols()) return qr.solve_columns(values);
  return LeastNorm(A, 1e-6).solve_columns(values);
}

}  // namespace

Patches::Patches(const Body& body) : body_(body) {
  const ReferenceCell& cell = body.mesh().cell();
  dim_ = body.mesh().section ? 2 : 3;
  degree_ = cell.second_order() ? 3 : 2;
  n_corners_ = cell.n_corners;
  in_corners_ = !cell.second_order();
  powers_of_nodes_ = powers_up_to(degree_, dim_);
  powers_of_points_ = powers_up_to(degree_ - 1, dim_);
  find_patches();
  find_inside();
  find_deputies();
}

void Patches::find_patches() {
  const Mesh& mesh = body_.mesh();
  int front = 0;
  if (mesh.section) {
    front = n_front(mesh);
  } else {
    front = mesh.n_nodes();
  }
  std::map<std::pair<int, int>, int> known;  // region, node
  patch_of_.resize(static_cast<std::size_t>(mesh.n_cells() * n_corners_));
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int a = 0; a < n_corners_; ++a) {
      const int node = mesh.cell(e)[a] % front;
      const auto [entry, is_new] =
          known.try_emplace({body_.region(e), node}, static_cast<int>(patches_.size()));
      if (is_new) patches_.push_back({mesh.X[node], 0, {}, true, false, {}});
      const int p = patch_of_[static_cast<std::size_t>(e * n_corners_ + a)] = entry->second;
      if (patches_[p].cells.empty() || patches_[p].cells.back() != e)
        patches_[p].cells.push_back(e);
    }
  for (Patch& patch : patches_)
    for (int e : patch.cells)
      for (int n : mesh.cell(e))
        patch.size = std::max(patch.size, (mesh.X[n % front] - patch.centre).norm());
}

// not on the surface of the region, of a section of its outline
void Patches::find_inside() {
  const Mesh& mesh = body_.mesh();
  std::map<std::pair<int, std::array<int, 4>>, std::vector<Facet>> met;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int f = 0; f < mesh.cell().n_facets(); ++f)
      if (!mesh.section || f < 4) met[{body_.region(e), facet_key(mesh, {e, f})}].push_back({e, f});
  for (const auto& [key, facets] : met)
    if (facets.size() == 1)
      for (int a : mesh.cell().facet[facets[0].local])
        if (a < n_corners_) patches_[patch_at(facets[0].cell, a)].inside = false;
}

void Patches::find_deputies() {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    Patch& patch = patches_[p];
    if (patch.inside) {
      patch.deputies = {static_cast<int>(p)};
      continue;
    }
    std::set<int> cells(patch.cells.begin(), patch.cells.end());
    for (int ring = 0; ring < far && patch.deputies.empty(); ++ring) {
      std::set<int> corners;
      for (int e : cells)
        for (int a = 0; a < n_corners_; ++a) corners.insert(patch_at(e, a));
      double least = 1e300;
      for (int q : corners)
        if (patches_[q].inside) least = std::min(least, (patches_[q].centre - patch.centre).norm());
      for (int q : corners)
        if (patches_[q].inside &&
            (patches_[q].centre - patch.centre).norm() <= equally_near * least)
          patch.deputies.push_back(q);
      for (int q : corners) cells.insert(patches_[q].cells.begin(), patches_[q].cells.end());
    }
    if (patch.deputies.empty()) patch.deputies = {static_cast<int>(p)};
  }
  for (const Patch& patch : patches_)
    for (int q : patch.deputies) patches_[static_cast<std::size_t>(q)].serves = true;
}

double Patches::alone() const {
  double whole = 0, alone = 0;
  for (int e = 0; e < body_.mesh().n_cells(); ++e)
    for (int a = 0; a < n_corners_; ++a) {
      const double V = body_.geometry(e).V;
      whole += V;
      if (const int p = patch_at(e, a); !patches_[patches_[p].deputies[0]].inside) alone += V;
    }
  return alone / whole;
}

MatX Patches::terms(const Patch& patch, const Vec3& X, bool gradient) const {
  const Vec3 x = (X - patch.centre) / patch.size;
  const auto& powers = gradient ? powers_of_nodes_ : powers_of_points_;
  MatX out = MatX::Zero(static_cast<Eigen::Index>(powers.size()), gradient ? 3 : 1);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!gradient) out(row, 0) = monomial(x, powers[i]);
    for (std::size_t k = 0; gradient && k < static_cast<std::size_t>(dim_); ++k) {
      if (powers[i][k] == 0) continue;
      std::array<int, 3> lower = powers[i];
      --lower[k];
      out(row, static_cast<Eigen::Index>(k)) = powers[i][k] / patch.size * monomial(x, lower);
    }
  }
  return out;
}

MatX Patches::at(const std::vector<MatX>& fitted, const Patch& patch, const Vec3& X,
                 bool gradient) const {
  MatX out;
  for (int q : patch.deputies) {
    const auto p = static_cast<std::size_t>(q);
    const MatX here = fitted[p].transpose() * terms(patches_[p], X, gradient) /
                      static_cast<double>(patch.deputies.size());
    if (out.size() == 0) {
      out = here;
    } else {
      out = MatX(out + here);
    }
  }
  return out;
}

Patches::Smooth Patches::told_in_corners(std::vector<MatX> fitted, bool gradient) const {
  Smooth out;
  out.patches_ = this;
  if (!in_corners_)
    out.of_ = std::move(fitted);
  else
    for (const Patch& patch : patches_)
      out.of_.push_back(at(fitted, patch, patch.centre, gradient));
  return out;
}

MatX Patches::blended(const std::vector<MatX>& of, int e, int g, bool gradient) const {
  const ReferenceCell& cell = body_.mesh().cell();
  const VecX L = cell.corner_shape(cell.gauss[static_cast<std::size_t>(g)]);
  const Vec3 X = in_corners_ ? Vec3(Vec3::Zero()) : gauss_position(body_.mesh(), e, g);
  MatX out;
  for (int a = 0; a < n_corners_; ++a) {
    const auto p = static_cast<std::size_t>(patch_at(e, a));
    if (a == 0)
      out = L[a] * (in_corners_ ? of[p] : at(of, patches_[p], X, gradient));
    else if (in_corners_)
      out += L[a] * of[p];
    else
      out += L[a] * at(of, patches_[p], X, gradient);
  }
  return out;
}

Patches::Smooth Patches::of_nodes(const MatX& values) const {
  const Mesh& mesh = body_.mesh();
  int front = 0;
  if (mesh.section) {
    front = n_front(mesh);
  } else {
    front = mesh.n_nodes();
  }
  std::vector<MatX> fitted;
  for (const Patch& patch : patches_) {
    std::set<int> nodes;
    for (int e : patch.cells)
      for (int n : mesh.cell(e)) nodes.insert(n % front);
    MatX A(static_cast<Eigen::Index>(nodes.size()),
           static_cast<Eigen::Index>(powers_of_nodes_.size())),
        b(A.rows(), values.cols());
    Eigen::Index row = 0;
    for (int n : nodes) {
      const Vec3 x = (mesh.X[static_cast<std::size_t>(n)] - patch.centre) / patch.size;
      for (std::size_t i = 0; i < powers_of_nodes_.size(); ++i)
        A(row, static_cast<Eigen::Index>(i)) = monomial(x, powers_of_nodes_[i]);
      b.row(row++) = values.row(n);
    }
    fitted.push_back(patch.serves ? fit(A, b) : MatX());
  }
  return told_in_corners(std::move(fitted), true);
}

Patches::Smooth Patches::of_points(const std::vector<MatX>& values) const {
  const Mesh& mesh = body_.mesh();
  std::vector<MatX> fitted;
  for (const Patch& patch : patches_) {
    const Eigen::Index points = values[0].rows();
    const auto n = static_cast<Eigen::Index>(patch.cells.size()) * points;
    MatX A(n, static_cast<Eigen::Index>(powers_of_points_.size())), b(n, values[0].cols());
    Eigen::Index row = 0;
    for (int e : patch.cells)
      for (Eigen::Index g = 0; g < points; ++g) {
        const Vec3 X = points > 1 ? gauss_position(mesh, e, static_cast<int>(g)) : middle(mesh, e);
        A.row(row) = terms(patch, X, false).transpose();
        b.row(row++) = values[static_cast<std::size_t>(e)].row(g);
      }
    fitted.push_back(patch.serves ? fit(A, b) : MatX());
  }
  return told_in_corners(std::move(fitted), false);
}

}  // namespace langer
