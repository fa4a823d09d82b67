#include "accuracy/estimate/energy_error.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/element/dilatation.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/section.hpp"
#include "mechanics/mesh/select.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

constexpr double small_strain = 1e-4;  // of the change along a dual solution

// J F^-T, also where F is singular: its columns are cross products of the columns of F.
Mat3 cofactor(const Mat3& F) {
  Mat3 cof;
  cof.col(0) = F.col(1).cross(F.col(2));
  cof.col(1) = F.col(2).cross(F.col(0));
  cof.col(2) = F.col(0).cross(F.col(1));
  return cof;
}

// A Gauss point of a state, or what changes there along a dual solution.
struct PointFields {
  Mat3 H, smooth_H;
  double p = 0, smooth_p = 0;
  double theta = 0;  // J - 1 of the modes
};

// Energies of the error at a point: in change of shape, and in change of volume [MPa].
struct PointError {
  double shape = 0, volume = 0;
};

// Compares the computed fields with smooth ones, which patches of elements give (Zienkiewicz and
// Zhu 1992). The energy of the difference is a function of the state. Its derivative along a dual
// solution is the error of the quantity that belongs to this dual solution; it is computed by
// central differences with a step of `small_strain`.
class ErrorOfCells {
 public:
  ErrorOfCells(const Body& body, const StepRecord& state, const std::vector<DualSolution>& duals)
      : body_(body),
        mesh_(body.mesh()),
        n_modes_(n_pressures(body.formulation(), body.mesh().cell().n_nodes)),
        patches_(body),
        state_(state),
        duals_(duals) {
    const auto n = static_cast<Eigen::Index>(mesh_.X.size());
    const auto fields = static_cast<Eigen::Index>(1 + duals.size());
    MatX u(n, 3 * fields);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < fields; ++k)
        u.block<1, 3>(i, 3 * k) = nodal(k)[static_cast<std::size_t>(i)].transpose();
    // Field 0 is the state, field k + 1 the change along dual solution k. All are fitted at once.
    u_ = patches_.fit_nodal_fields(u);
    std::vector<MatX> p;
    for (int e = 0; e < mesh_.n_cells(); ++e) {
      modes_.push_back(modes(e));
      p.push_back(pressures_of(e));
    }
    p_ = patches_.fit_gauss_fields(p);
    scale_.assign(duals.size(), 0);
    for (int e = 0; e < mesh_.n_cells(); ++e)
      for (std::size_t k = 0; k < duals.size(); ++k)
        for (int g = 0; g < mesh_.cell().n_gauss; ++g)
          scale_[k] =
              std::max(scale_[k], displacement_gradient(element_displacements(mesh_, duals[k].u, e),
                                                        body_.geometry(e).dN_dX[g])
                                      .norm());
  }

  double step(std::size_t dual) const { return small_strain / std::max(scale_[dual], 1e-300); }
  double alone() const { return patches_.share_without_interior(); }

  // of each dual solution, at each Gauss point: derivative of the error's energy
  std::vector<PointError> at(int e, int g, double share) const {
    const MatX gradients = u_.gradients(e, g);
    const MatX p = p_.values(e, g);
    const auto fields = [&](std::size_t k) {
      PointFields f;
      f.H = displacement_gradient(
          element_displacements(mesh_, nodal(static_cast<Eigen::Index>(k)), e),
          body_.geometry(e).dN_dX[g]);
      f.smooth_H = f.H;
      const Mat3 smooth = gradients.middleRows<3>(3 * static_cast<Eigen::Index>(k));
      // In a section only the in-plane part comes from the patches.
      if (mesh_.section)
        f.smooth_H.topLeftCorner<2, 2>() = smooth.topLeftCorner<2, 2>();
      else
        f.smooth_H = smooth;
      f.smooth_p = p(static_cast<Eigen::Index>(k), 0);
      for (int m = 0; m < n_modes_; ++m) {
        double shape = 0;
        if (m == 0) {
          shape = 1;
        } else {
          shape = body_.geometry(e).mode[g][m];
        }
        f.p += shape * modes_[e](m, 2 * static_cast<Eigen::Index>(k));
        f.theta += shape * modes_[e](m, 2 * static_cast<Eigen::Index>(k) + 1);
      }
      return f;
    };
    const PointFields state = fields(0);
    std::vector<PointError> out;
    for (std::size_t k = 0; k < duals_.size(); ++k) {
      const double eps = step(k);
      const double w = share * body_.geometry(e).w[g] / (2 * eps);
      const PointFields change = fields(k + 1);
      const PointError plus = error(e, state, change, eps);
      const PointError minus = error(e, state, change, -eps);
      out.push_back({w * (plus.shape - minus.shape), w * (plus.volume - minus.volume)});
    }
    return out;
  }

 private:
  const std::vector<Vec3>& nodal(Eigen::Index field) const {
    if (field == 0) return state_.u;
    return duals_[static_cast<std::size_t>(field - 1)].u;
  }
  // (modes, 2 fields): pressure and dilatation of each
  MatX modes(int e) const {
    const ElementGeometry& geometry = body_.geometry(e);
    const int n = n_modes_;
    const auto fields = static_cast<Eigen::Index>(1 + duals_.size());
    MatX out = MatX::Zero(n, 2 * fields);
    const ElementNodes u = element_displacements(mesh_, state_.u, e);
    std::array<double, n_modes> t{}, p{}, dt{}, dp{};
    for (Eigen::Index k = 0; k < fields; ++k) {
      dt = {};
      const ElementNodes z = element_displacements(mesh_, nodal(k), e);
      for (int g = 0; g < geometry.n_gauss(); ++g) {
        const Mat3 H = displacement_gradient(u, geometry.dN_dX[g]);
        double J = 0;
        if (k == 0) {
          J = volume_change(H);
        } else {
          J = cofactor(Mat3::Identity() + H)
                  .cwiseProduct(displacement_gradient(z, geometry.dN_dX[g]))
                  .sum();
        }
        // The dilatation is averaged over the element, weighted with each pressure mode.
        for (int m = 0; m < n; ++m)
          dt[m] += geometry.w[g] * (m == 0 ? 1 : geometry.mode[g][m]) * J / geometry.V;
      }
      if (k == 0) {
        t = dt;
        pressures(body_.material(e).volume, true, geometry, n, t.data(), p.data());
        dp = p;
      } else {
        predicted_pressures(body_.material(e).volume, true, geometry, n, t.data(), dt.data(),
                            dp.data());
        for (int m = 0; m < n; ++m) dp[m] -= p[m];
      }
      for (int m = 0; m < n; ++m) {
        out(m, 2 * k) = dp[m];
        out(m, 2 * k + 1) = dt[m];
      }
    }
    return out;
  }

  // (points, fields): the pressure at Gauss points, or one value where it is constant in an element
  MatX pressures_of(int e) const {
    const bool one = n_modes_ == 1;
    const auto fields = static_cast<Eigen::Index>(1 + duals_.size());
    MatX out = MatX::Zero(one ? 1 : mesh_.cell().n_gauss, fields);
    for (Eigen::Index g = 0; g < out.rows(); ++g)
      for (Eigen::Index k = 0; k < fields; ++k)
        for (int m = 0; m < n_modes_; ++m)
          out(g, k) +=
              (m == 0 ? 1
                      : body_.geometry(e)
                            .mode[static_cast<std::size_t>(g)][static_cast<std::size_t>(m)]) *
              modes_[e](m, 2 * k);
    return out;
  }

  Mat3 isochoric_stress(int e, const Mat3& F) const {
    return F * tensor(isochoric(body_.material(e), F.transpose() * F, body_.fibres(e), false).S);
  }

  // The energy of the difference between the smooth and the computed fields, at the state that is
  // eps further along the dual solution. The smooth deformation gets the volume that belongs to the
  // smooth pressure: a fit of gradients alone would change volumes by more than the material
  // allows.
  PointError error(int e, const PointFields& s, const PointFields& d, double eps) const {
    const Mat3 H = s.H + eps * d.H;
    const Mat3 smooth_H = s.smooth_H + eps * d.smooth_H;
    const double p = s.p + eps * d.p;
    const double smooth_p = s.smooth_p + eps * d.smooth_p;
    const double theta = s.theta + eps * d.theta;
    const double J = 1 + volume_change(H);
    const double smooth_theta = theta + (smooth_p - p) / bulk_modulus(body_.material(e));
    const Mat3 F = Mat3::Identity() + H;
    Mat3 smooth_F = Mat3::Identity() + smooth_H;
    smooth_F *= std::cbrt((1 + smooth_theta) / (1 + volume_change(smooth_H)));
    const Mat3 P = isochoric_stress(e, F) + p * cofactor(F);
    const Mat3 smooth_P = isochoric_stress(e, smooth_F) + smooth_p * cofactor(smooth_F);
    return {0.5 * (smooth_F - F).cwiseProduct(smooth_P - P).sum(),
            0.5 * (smooth_p - p) * (1 + theta - J)};
  }

  const Body& body_;
  const Mesh& mesh_;
  int n_modes_;
  Patches patches_;
  const StepRecord& state_;
  const std::vector<DualSolution>& duals_;
  Patches::Smooth u_, p_;
  std::vector<MatX> modes_;
  std::vector<double> scale_;
};

// The integral of pressure times gap over the facets of one contact, in the undeformed state. It is
// 0 where contact is exact. Between nodes a body enters the indenter, and the integral is the
// energy of this error. Pressures are nodal forces over the areas that belong to the nodes.
class ContactFacets {
 public:
  ContactFacets(const RigidContact& contact, const Mesh& mesh, const StepRecord& state,
                const ContactRecord& reactions)
      : contact_(contact), mesh_(mesh), state_(state), c_(indenter_at(contact, state)) {
    if (mesh.section) {
      front_ = n_front(mesh);
    } else {
      front_ = mesh.n_nodes();
    }
    if (mesh.section) {
      share_ = cell_share(*mesh.section);
    } else {
      share_ = 1;
    }
    facets_ = facets_within(
        mesh, boundary(mesh),
        with_hanging(mesh, mesh.section ? through_layers(mesh, contact.nodes) : contact.nodes));
    area_ = VecX::Zero(mesh.n_nodes());
    each([&](const Facet&, const std::vector<int>& nodes, const VecX& N, double dA) {
      for (std::size_t a = 0; a < nodes.size(); ++a)
        area_[nodes[a] % front_] += N[static_cast<Eigen::Index>(a)] * dA;
    });
    fold_hanging(mesh, area_);
    normal_.assign(static_cast<std::size_t>(mesh.n_nodes()), Vec3::Zero());
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const int n = contact.nodes[i];
      normal_[n] = shape_at(contact.shape, mesh.X[n] + state.u[n] - c_).normal;
    }
    pressure_ = pressure_of(reactions.r);
  }

  VecX pressure_of(const std::vector<Vec3>& r) const {
    VecX out = VecX::Zero(mesh_.n_nodes());
    for (std::size_t i = 0; i < r.size(); ++i)
      if (const int n = contact_.nodes[i]; area_[n] > 0) out[n] = r[i].dot(normal_[n]) / area_[n];
    spread_to_hanging(mesh_, out);
    return out;
  }

  // on(facet, change of it) along a dual solution
  template <class On>
  void change(const DualSolution& dual, std::size_t k, double eps, const On& on) const {
    const VecX pressure = pressure_of(dual.r[k]);
    each([&](const Facet& facet, const std::vector<int>& nodes, const VecX& N, double dA) {
      Vec3 x = Vec3::Zero();
      Vec3 dx = Vec3::Zero();
      double lambda = 0, d_lambda = 0;
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const double N_a = N[static_cast<Eigen::Index>(a)];
        x += N_a * (mesh_.X[nodes[a]] + state_.u[nodes[a]]);
        dx += N_a * dual.u[nodes[a]];
        lambda += N_a * pressure_[nodes[a] % front_];
        d_lambda += N_a * pressure[nodes[a] % front_];
      }
      if (lambda == 0 && d_lambda == 0) return;
      const auto energy = [&](double s) {
        const double gap = shape_at(contact_.shape, x + s * dx - c_ - s * dual.indenters[k]).gap;
        return (lambda + s * d_lambda) * std::min(gap, 0.0);
      };
      on(facet, dA * (energy(eps) - energy(-eps)) / (2 * eps));
    });
  }

 private:
  // on(facet, nodes, shape functions, area) at each quadrature point of the facets.
  template <class On>
  void each(const On& on) const {
    const ReferenceCell& cell = mesh_.cell();
    for (const Facet& facet : facets_) {
      const auto all = mesh_.cell(facet.cell);
      const std::vector<int> nodes(all.begin(), all.end());
      const ElementNodes X = element_nodes(mesh_, facet.cell);
      for (const FacetPoint& point : cell.facet_points[facet.local]) {
        const MatX tangents = X.transpose() * cell.gradient(point.xi);
        const Vec3 one = tangents * point.along_1;
        const Vec3 two = tangents * point.along_2;
        on(facet, nodes, cell.shape(point.xi), share_ * point.weight * one.cross(two).norm());
      }
    }
  }

  const RigidContact& contact_;
  const Mesh& mesh_;
  const StepRecord& state_;
  Vec3 c_;
  int front_;
  double share_;
  std::vector<Facet> facets_;
  VecX area_, pressure_;
  std::vector<Vec3> normal_;
};

}  // namespace

EnergyErrors energy_errors(const Scene& scene, const Mesh& mesh, const StepRecord& state,
                           const std::vector<DualSolution>& duals) {
  const Body body(mesh, scene.materials, scene.directions, scene.formulation);
  const ErrorOfCells cells(body, state, duals);
  EnergyErrors out;
  out.alone = cells.alone();
  out.along.resize(duals.size());
  for (auto& d : out.along) d.of_cell.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  double share = 1;
  if (mesh.section) share = cell_share(*mesh.section);
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int g = 0; g < mesh.cell().n_gauss; ++g) {
      const std::vector<PointError> here = cells.at(e, g, share);
      for (std::size_t k = 0; k < duals.size(); ++k) {
        out.along[k].shape += here[k].shape;
        out.along[k].volume += here[k].volume;
        out.along[k].of_cell[static_cast<std::size_t>(e)] += here[k].shape + here[k].volume;
      }
    }
  for (std::size_t c = 0; c < scene.contacts.size(); ++c) {
    const ContactFacets facets(scene.contacts[c], mesh, state,
                               state.contacts.at(scene.contacts[c].name));
    for (std::size_t k = 0; k < duals.size(); ++k)
      facets.change(duals[k], c, cells.step(k), [&](const Facet& facet, double change) {
        out.along[k].contact += change;
        out.along[k].of_cell[static_cast<std::size_t>(facet.cell)] += change;
      });
  }
  for (auto& d : out.along)
    for (double of_cell : d.of_cell) d.size += std::abs(of_cell);
  return out;
}

}  // namespace langer
