#include "mechanics/element/solid.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/element/dilatation.hpp"

namespace langer {

namespace {

template <int n>
struct Sizes {
  using Gradient = Eigen::Matrix<double, n, 3>;
  using Vec = Eigen::Matrix<double, 3 * n, 1>;
  using Mat = Eigen::Matrix<double, 3 * n, 3 * n>;
  using Strain = Eigen::Matrix<double, 6, 3 * n>;
};

// dE = B du, engineering shear: row p = ij of node a, direction k is F_ki dN_j + F_kj dN_i
template <int n>
typename Sizes<n>::Strain strain_operator(const Mat3& F, const typename Sizes<n>::Gradient& dN) {
  typename Sizes<n>::Strain B;
  for (int a = 0; a < n; ++a)
    for (int k = 0; k < 3; ++k)
      for (int p = 0; p < 6; ++p) {
        const int i = voigt_i[p];
        const int j = voigt_j[p];
        if (p < 3) {
          B(p, 3 * a + k) = F(k, i) * dN(a, i);
        } else {
          B(p, 3 * a + k) = F(k, i) * dN(a, j) + F(k, j) * dN(a, i);
        }
      }
  return B;
}

// dJ/du of one point: cofactor of F contracted with grad(du)
template <int n>
typename Sizes<n>::Vec dilatation_gradient(const Mat3& F, const typename Sizes<n>::Gradient& dN) {
  Mat3 cof;
  cof.col(0) = F.col(1).cross(F.col(2));
  cof.col(1) = F.col(2).cross(F.col(0));
  cof.col(2) = F.col(0).cross(F.col(1));
  const typename Sizes<n>::Gradient g = dN * cof.transpose();
  typename Sizes<n>::Vec v;
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < 3; ++i) v[3 * a + i] = g(a, i);
  return v;
}

template <int n, class Mat>
void add_geometric(const typename Sizes<n>::Gradient& dN, const Vec6& S, double w, Mat& K) {
  const Eigen::Matrix<double, n, n> G = w * (dN * tensor(S) * dN.transpose());
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += G(a, b);
}

double mode(const ElementGeometry& geometry, int g, int k) {
  if (k == 0) return 1;
  return geometry.mode[g][k];
}

// n nodes; sizes known to the compiler
template <int n>
struct GaussPoints {
  std::vector<Mat3> F;
  std::vector<double> J_minus_1;
  std::vector<typename Sizes<n>::Vec> dJ;
  std::vector<typename Sizes<n>::Gradient> dN;
  double J_min = 1e300;

  GaussPoints(const ElementGeometry& geometry, const ElementNodes& u) {
    for (int g = 0; g < geometry.n_gauss(); ++g) {
      const Mat3 H = displacement_gradient(u, geometry.dN_dX[g]);
      F.push_back(Mat3::Identity() + H);
      J_minus_1.push_back(volume_change(H));
      J_min = std::min(J_min, 1 + J_minus_1[g]);
      dN.push_back(geometry.dN_dX[g]);
      dJ.push_back(dilatation_gradient<n>(F[g], dN[g]));
    }
  }
};

// dilatations and pressures of the whole cell: their energy, force and tangent
template <int n>
ModalVolume<double> add_modal(const Material& material, double local,
                              const ElementGeometry& geometry, const GaussPoints<n>& at, int n_p,
                              typename Sizes<n>::Vec& f, typename Sizes<n>::Mat* K,
                              SolidElement& out) {
  out.J_minus_1.assign(n_p, 0);
  out.dJ_du.assign(n_p, VecX::Zero(3 * n));
  for (int k = 0; k < n_p; ++k) {
    double& t = out.J_minus_1[k];
    VecX& b = out.dJ_du[k];
    for (int g = 0; g < geometry.n_gauss(); ++g) {
      const double w = geometry.w[g] * mode(geometry, g, k);
      t += w * at.J_minus_1[g];
      b += w * at.dJ[g];
    }
    t /= geometry.V;
    b /= geometry.V;
  }
  const ModalVolume<double> volume =
      modal_volume(material.volume, n_p, out.J_minus_1.data(), local, geometry);
  out.W += volume.W;
  for (int k = 0; k < n_p; ++k) {
    f += (geometry.V * volume.p[k]) * out.dJ_du[k];
    for (int l = 0; l < n_p && K; ++l)
      if (l == k || !volume.independent)
        *K += (geometry.V * volume.kappa[k][l]) * out.dJ_du[k] * out.dJ_du[l].transpose();
  }
  return volume;
}

template <int n>
bool solid_of(Formulation formulation, const Material& material, double local,
              const ElementGeometry& geometry, std::span<const Vec3> a, const ElementNodes& u,
              const double* p_tangent, bool with_tangent, SolidElement& out,
              const CellMemory* memory) {
  const bool modal = formulation != Formulation::displacement;
  const int n_gauss = geometry.n_gauss();
  const int n_p = n_pressures(formulation, n);
  typename Sizes<n>::Vec f = Sizes<n>::Vec::Zero();
  thread_local typename Sizes<n>::Mat K;  // 52 kB for 27 nodes
  if (with_tangent) K.setZero();
  out.W = 0;
  const GaussPoints<n> at(geometry, u);
  out.J_min = at.J_min;
  if (!(out.J_min > 0)) return false;

  ModalVolume<double> volume;
  if (modal)
    volume = add_modal<n>(material, local, geometry, at, n_p, f, with_tangent ? &K : nullptr, out);
  else {
    out.J_minus_1 = at.J_minus_1;
    out.dJ_du.assign(at.dJ.begin(), at.dJ.end());
  }

  for (int g = 0; g < n_gauss; ++g) {
    const double w = geometry.w[g];
    const double J = 1 + at.J_minus_1[g];
    const Mat3 C = at.F[g].transpose() * at.F[g];
    Response iso =
        memory ? isochoric(material, C, a, memory->amplified) : isochoric(material, C, a);
    if (memory) iso.S += memory->H[static_cast<std::size_t>(g)];
    out.W += w * iso.W;
    const Mat3 C_inverse = C.inverse();
    const Vec6 Ci = voigt(C_inverse);
    Vec6 S = iso.S;
    const double x = at.J_minus_1[g];
    const Energy<double> U = modal ? Energy<double>{0.5 * local * x * x, local * x, local}
                                   : volume_energy(material.volume, x);
    double p_K = U.dW;
    out.W += w * U.W;
    S += U.dW * J * Ci;
    for (int k = 0; k < n_p && modal; ++k)
      p_K += mode(geometry, g, k) * (p_tangent ? p_tangent[k] : volume.p[k]);
    if (!modal && p_tangent) p_K = p_tangent[g];
    const typename Sizes<n>::Strain B = strain_operator<n>(at.F[g], at.dN[g]);
    f.noalias() += w * (B.transpose() * S);
    if (!with_tangent) continue;
    // dJ/dE = J C^-1,  d2J/dE2 = J (C^-1 x C^-1 - 2 C^-1 o C^-1)
    Mat6 D = iso.D + p_K * J * (Ci * Ci.transpose() - 2 * symmetric_product(C_inverse));
    if (U.ddW != 0) D += U.ddW * J * J * Ci * Ci.transpose();
    const typename Sizes<n>::Strain DB = w * D * B;
    K.noalias() += B.transpose() * DB;
    add_geometric<n>(at.dN[g], iso.S + p_K * J * Ci, w, K);
  }
  out.f = f;
  if (with_tangent) out.K = K;
  return true;
}

}  // namespace

double local_modulus(const ElementGeometry& geometry, const double* p) {
  double most = 0;
  for (int g = 0; g < geometry.n_gauss(); ++g) {
    double here = 0;
    for (int k = 0; k < n_modes; ++k) here += geometry.mode[g][k] * p[k];
    most = std::max(most, -here);
  }
  return most;
}

double local_modulus_change(const ElementGeometry& geometry, const double* p, const double* dp) {
  double most = 0, change = 0;
  for (int g = 0; g < geometry.n_gauss(); ++g) {
    double here = 0, d_here = 0;
    for (int k = 0; k < n_modes; ++k) {
      here += geometry.mode[g][k] * p[k];
      d_here += geometry.mode[g][k] * dp[k];
    }
    if (-here > most) {
      most = -here;
      change = -d_here;
    }
  }
  return change;
}

int n_pressures(Formulation f, int n_nodes) {
  if (f == Formulation::mean_dilatation) return 1;
  if (f == Formulation::linear_dilatation) return n_modes;
  return reference(n_nodes).n_gauss;
}

Formulation usual_formulation(CellType type) {
  return reference(type).second_order() ? Formulation::linear_dilatation
                                        : Formulation::mean_dilatation;
}

bool solid(Formulation formulation, const Material& material, double local,
           const ElementGeometry& geometry, std::span<const Vec3> a, const ElementNodes& u,
           const double* p_tangent, bool with_tangent, SolidElement& out,
           const CellMemory* memory) {
  bool done = false;
  with_cell(static_cast<int>(u.rows()), [&](auto cell) {
    done = solid_of<decltype(cell)::n_nodes>(formulation, material, local, geometry, a, u,
                                             p_tangent, with_tangent, out, memory);
  });
  return done;
}

std::vector<GaussState> gauss_states(Formulation formulation, const Material& material,
                                     const ElementGeometry& geometry, std::span<const Vec3> a,
                                     const ElementNodes& u, std::span<const Vec6> branches) {
  const int n_gauss = geometry.n_gauss();
  const int n_p = n_pressures(formulation, geometry.n_nodes());
  const bool modal = formulation != Formulation::displacement;
  std::vector<GaussState> states(n_gauss);
  std::array<double, n_modes> t{};
  for (int g = 0; g < n_gauss; ++g) {
    const Mat3 H = displacement_gradient(u, geometry.dN_dX[g]);
    states[g].F = Mat3::Identity() + H;
    const double J_minus_1 = volume_change(H);
    states[g].J = 1 + J_minus_1;
    if (!modal) states[g].pressure = volume_energy(material.volume, J_minus_1).dW;
    for (int k = 0; k < n_p && modal; ++k)
      t[k] += geometry.w[g] * mode(geometry, g, k) * J_minus_1 / geometry.V;
  }
  std::array<double, n_modes> p{};
  if (modal) pressures(material.volume, true, geometry, n_p, t.data(), p.data());
  for (int g = 0; g < n_gauss; ++g) {
    GaussState& s = states[g];
    for (int k = 0; k < n_p && modal; ++k) s.pressure += mode(geometry, g, k) * p[k];
    Vec6 S = isochoric(material, s.F.transpose() * s.F, a).S;
    if (!branches.empty()) S += branches[static_cast<std::size_t>(g)];
    s.sigma = s.F * tensor(S) * s.F.transpose() / s.J + s.pressure * Mat3::Identity();
  }
  return states;
}

double mean_I4_bar(std::span<const GaussState> states, const Vec3& a) {
  double sum = 0;
  for (const GaussState& g : states) sum += (g.F * a).squaredNorm() / std::cbrt(g.J * g.J);
  return sum / static_cast<double>(states.size());
}

}  // namespace langer
