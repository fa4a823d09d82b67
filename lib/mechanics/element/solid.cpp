#include "mechanics/element/solid.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/element/dilatation.hpp"
#include "mechanics/element/packet_solid.hpp"
#include "mechanics/element/point_kinematics.hpp"

namespace langer {

namespace {

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
      const double w = geometry.w[g] * dilatation_mode(geometry, g, k);
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
    Response iso = memory ? isochoric(material, C, a, memory->amplified, with_tangent)
                          : isochoric(material, C, a, with_tangent);
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
      p_K += dilatation_mode(geometry, g, k) * (p_tangent ? p_tangent[k] : volume.p[k]);
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

namespace {

// Cauchy stress without pressure; eight points at once where the material has such a form.
void add_isochoric_stress(const Material& material, std::span<const Vec3> a,
                          std::vector<GaussState>& states) {
  if (!packet_form(material)) {
    for (GaussState& s : states) {
      const Vec6 S = isochoric(material, s.F.transpose() * s.F, a, false).S;
      s.sigma = s.F * tensor(S) * s.F.transpose() / s.J;
    }
    return;
  }
  for (std::size_t first = 0; first < states.size(); first += Packet::lanes) {
    Packet F[9], J, tau[6];
    for (std::size_t l = 0; l < Packet::lanes; ++l) {
      const GaussState& s = states[std::min(first + l, states.size() - 1)];
      J.set(static_cast<int>(l), s.J);
      for (int i = 0; i < 9; ++i) F[i].set(static_cast<int>(l), s.F(i / 3, i % 3));
    }
    packet_stress(material, F, J, a, tau);
    for (std::size_t l = 0; l < Packet::lanes && first + l < states.size(); ++l) {
      GaussState& s = states[first + l];
      Vec6 stress;
      for (int p = 0; p < 6; ++p) stress[p] = tau[p][static_cast<int>(l)] / s.J;
      s.sigma = tensor(stress);
    }
  }
}

}  // namespace

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
      t[k] += geometry.w[g] * dilatation_mode(geometry, g, k) * J_minus_1 / geometry.V;
  }
  std::array<double, n_modes> p{};
  if (modal) pressures(material.volume, true, geometry, n_p, t.data(), p.data());
  add_isochoric_stress(material, a, states);
  for (int g = 0; g < n_gauss; ++g) {
    GaussState& s = states[g];
    for (int k = 0; k < n_p && modal; ++k) s.pressure += dilatation_mode(geometry, g, k) * p[k];
    if (!branches.empty())
      s.sigma += s.F * tensor(branches[static_cast<std::size_t>(g)]) * s.F.transpose() / s.J;
    s.sigma += s.pressure * Mat3::Identity();
  }
  return states;
}

double mean_I4_bar(std::span<const GaussState> states, const Vec3& a) {
  double sum = 0;
  for (const GaussState& g : states) sum += (g.F * a).squaredNorm() / std::cbrt(g.J * g.J);
  return sum / static_cast<double>(states.size());
}

}  // namespace langer
