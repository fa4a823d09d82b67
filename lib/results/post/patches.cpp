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

constexpr double equal_distance = 1.01;  // ratio up to which distances count as equal
constexpr int most_rings = 3;            // of elements in which a corner inside is searched

// The exponents of all monomials up to a degree, in x, y and z or in x and y.
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

// The mean of the corners of an element.
Vec3 middle(const Mesh& mesh, int e) {
  Vec3 X = Vec3::Zero();
  const int n = mesh.cell().n_corners;
  for (int a = 0; a < n; ++a)
    X += mesh.X[static_cast<std::size_t>(mesh.cell(e)[static_cast<std::size_t>(a)])] / n;
  return X;
}

// Least squares. If the values do not determine the polynomial, the smallest one is taken.
MatX fit(const MatX& A, const MatX& values) {
  const PivotedQr qr(A);
  if (qr.rank() == A.cols()) return qr.solve_columns(values);
  return LeastNorm(A, 1e-6).solve_columns(values);
}

// Adds a multiple of a matrix to a sum, which is empty at first.
void add_scaled(MatX& sum, double factor, const MatX& term) {
  if (sum.size() == 0) {
    sum = factor * term;
  } else {
    sum += factor * term;
  }
}

}  // namespace

Patches::Patches(const Body& body) : body_(body) {
  const ReferenceCell& cell = body.mesh().cell();
  dim_ = 3;
  if (body.mesh().section) dim_ = 2;
  degree_ = 2;
  if (cell.second_order()) degree_ = 3;
  n_corners_ = cell.n_corners;
  in_corners_ = !cell.second_order();
  powers_of_nodes_ = powers_up_to(degree_, dim_);
  powers_of_points_ = powers_up_to(degree_ - 1, dim_);
  find_patches();
  find_inside();
  find_used_patches();
}

// The number of nodes with values of their own. In a section the nodes behind z = 0 repeat those in
// front: node n has the values of node n % n_front_nodes().
int Patches::n_front_nodes() const {
  if (body_.mesh().section) return n_front(body_.mesh());
  return body_.mesh().n_nodes();
}

// One patch for each corner and region: the elements around it, and its size.
void Patches::find_patches() {
  const Mesh& mesh = body_.mesh();
  const int front = n_front_nodes();
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
  // The size scales the coordinates of the polynomial to about 1.
  for (Patch& patch : patches_)
    for (int e : patch.cells)
      for (int n : mesh.cell(e))
        patch.size = std::max(patch.size, (mesh.X[n % front] - patch.centre).norm());
}

// A corner is inside if no facet of its region's surface has it. In a section the surface is the
// outline, without the facets in the planes of the section. A facet of the surface belongs to one
// element of the region only.
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

// A corner inside uses its own polynomial. Another corner uses those of the closest corners inside,
// which are searched in growing rings of elements around it; several may be equally close. Without
// any it uses its own.
void Patches::find_used_patches() {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    Patch& patch = patches_[p];
    if (patch.inside) {
      patch.used = {static_cast<int>(p)};
      continue;
    }
    const auto distance = [&](int q) {
      return (patches_[q].centre - patch.centre).norm();
    };
    std::set<int> cells(patch.cells.begin(), patch.cells.end());
    for (int ring = 0; ring < most_rings && patch.used.empty(); ++ring) {
      std::set<int> corners;
      for (int e : cells)
        for (int a = 0; a < n_corners_; ++a) corners.insert(patch_at(e, a));
      double least = 1e300;
      for (int q : corners)
        if (patches_[q].inside) least = std::min(least, distance(q));
      for (int q : corners)
        if (patches_[q].inside && distance(q) <= equal_distance * least) patch.used.push_back(q);
      for (int q : corners) cells.insert(patches_[q].cells.begin(), patches_[q].cells.end());
    }
    if (patch.used.empty()) patch.used = {static_cast<int>(p)};
  }
  for (const Patch& patch : patches_)
    for (int q : patch.used) patches_[static_cast<std::size_t>(q)].is_used = true;
}

double Patches::share_without_interior() const {
  double whole = 0;
  double without = 0;
  for (int e = 0; e < body_.mesh().n_cells(); ++e)
    for (int a = 0; a < n_corners_; ++a) {
      const double V = body_.geometry(e).V;
      whole += V;
      const Patch& patch = patches_[patch_at(e, a)];
      if (!patches_[patch.used[0]].inside) without += V;
    }
  return without / whole;
}

// The monomials at a place, or their gradients. Coordinates are relative to the centre and the size
// of the patch, so that the least squares problem is well conditioned.
MatX Patches::terms(const Patch& patch, const Vec3& X, bool gradient) const {
  const Vec3 x = (X - patch.centre) / patch.size;
  if (!gradient) {
    MatX values(static_cast<Eigen::Index>(powers_of_points_.size()), 1);
    for (std::size_t i = 0; i < powers_of_points_.size(); ++i)
      values(static_cast<Eigen::Index>(i), 0) = monomial(x, powers_of_points_[i]);
    return values;
  }
  const auto& powers = powers_of_nodes_;
  MatX gradients = MatX::Zero(static_cast<Eigen::Index>(powers.size()), 3);
  for (std::size_t i = 0; i < powers.size(); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(dim_); ++k) {
      if (powers[i][k] == 0) continue;
      std::array<int, 3> lower = powers[i];
      --lower[k];
      gradients(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          powers[i][k] / patch.size * monomial(x, lower);
    }
  return gradients;
}

// The mean of the polynomials that a patch uses, at a place.
MatX Patches::at(const std::vector<MatX>& fitted, const Patch& patch, const Vec3& X,
                 bool gradient) const {
  MatX out;
  for (int q : patch.used) {
    const auto p = static_cast<std::size_t>(q);
    const MatX here = fitted[p].transpose() * terms(patches_[p], X, gradient) /
                      static_cast<double>(patch.used.size());
    if (out.size() == 0) {
      out = here;
    } else {
      out = MatX(out + here);
    }
  }
  return out;
}

// A smooth field from the fitted coefficients; for hex8 from its values at the corners.
Patches::Smooth Patches::smooth_field(std::vector<MatX> fitted, bool gradient) const {
  Smooth out;
  out.patches_ = this;
  if (!in_corners_) {
    out.fitted_ = std::move(fitted);
    return out;
  }
  for (const Patch& patch : patches_)
    out.fitted_.push_back(at(fitted, patch, patch.centre, gradient));
  return out;
}

// The sum of the fields of the corners times the trilinear shape functions L of the corners.
MatX Patches::blended(const std::vector<MatX>& fitted, int e, int g, bool gradient) const {
  const ReferenceCell& cell = body_.mesh().cell();
  const VecX L = cell.corner_shape(cell.gauss[static_cast<std::size_t>(g)]);
  Vec3 X = Vec3::Zero();
  if (!in_corners_) X = gauss_position(body_.mesh(), e, g);
  MatX out;
  for (int a = 0; a < n_corners_; ++a) {
    const auto p = static_cast<std::size_t>(patch_at(e, a));
    if (in_corners_) {
      add_scaled(out, L[a], fitted[p]);
    } else {
      add_scaled(out, L[a], at(fitted, patches_[p], X, gradient));
    }
  }
  return out;
}

// A least squares fit of the nodal values on each patch whose polynomial is used. All fields of a
// patch share one factorization.
Patches::Smooth Patches::fit_nodal_fields(const MatX& values) const {
  const Mesh& mesh = body_.mesh();
  const int front = n_front_nodes();
  std::vector<MatX> fitted;
  for (const Patch& patch : patches_) {
    // The nodes of all elements of the patch, each once.
    std::set<int> nodes;
    for (int e : patch.cells)
      for (int n : mesh.cell(e)) nodes.insert(n % front);
    MatX A(static_cast<Eigen::Index>(nodes.size()),
           static_cast<Eigen::Index>(powers_of_nodes_.size()));
    MatX b(A.rows(), values.cols());
    Eigen::Index row = 0;
    for (int n : nodes) {
      const Vec3 x = (mesh.X[static_cast<std::size_t>(n)] - patch.centre) / patch.size;
      for (std::size_t i = 0; i < powers_of_nodes_.size(); ++i)
        A(row, static_cast<Eigen::Index>(i)) = monomial(x, powers_of_nodes_[i]);
      b.row(row) = values.row(n);
      ++row;
    }
    MatX& coefficients = fitted.emplace_back();
    if (patch.is_used) coefficients = fit(A, b);
  }
  return smooth_field(std::move(fitted), true);
}

// The same for values at Gauss points. hex8 have one value per element, in its middle.
Patches::Smooth Patches::fit_gauss_fields(const std::vector<MatX>& values) const {
  const Mesh& mesh = body_.mesh();
  std::vector<MatX> fitted;
  for (const Patch& patch : patches_) {
    const Eigen::Index points = values[0].rows();
    // One row for each Gauss point of the elements of the patch.
    const auto n = static_cast<Eigen::Index>(patch.cells.size()) * points;
    MatX A(n, static_cast<Eigen::Index>(powers_of_points_.size()));
    MatX b(n, values[0].cols());
    Eigen::Index row = 0;
    for (int e : patch.cells)
      for (Eigen::Index g = 0; g < points; ++g) {
        Vec3 X;
        if (points > 1) {
          X = gauss_position(mesh, e, static_cast<int>(g));
        } else {
          X = middle(mesh, e);
        }
        A.row(row) = terms(patch, X, false).transpose();
        b.row(row) = values[static_cast<std::size_t>(e)].row(g);
        ++row;
      }
    MatX& coefficients = fitted.emplace_back();
    if (patch.is_used) coefficients = fit(A, b);
  }
  return smooth_field(std::move(fitted), false);
}

}  // namespace langer
