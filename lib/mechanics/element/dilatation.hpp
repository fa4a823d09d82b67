// Volumetric energy of a cell as a function of its dilatation modes t_k (solid.hpp), for any number
// type. With theta = sum t_k m_k and < > the mean over the reference volume:
//   W = V (<U(1 + theta)> - local/2 sum t_k^2),  p_k = dW/dt_k / V = <m_k U'> - local t_k,  kappa_kl = <m_k m_l U''> - local (k = l)
// Where U is quadratic the modes are independent: p_k = (kappa - local) t_k. One mode is constant
// in the cell: no sum is needed.
#pragma once

#include "mechanics/element/geometry.hpp"
#include "mechanics/material/volume.hpp"

namespace langer {

template <class T>
struct ModalVolume {
  T W{};                        // [N mm]
  T p[n_modes]{};               // [MPa]
  T kappa[n_modes][n_modes]{};  // [MPa]
  bool independent = true;      // kappa is diagonal
};

// w[g] and modes m_k at the Gauss points, volume V
template <class T>
ModalVolume<T> modal_volume(const Volume& law, int n, const T* t, const T& local, const T& V,
                            int n_gauss, auto&& w, auto&& mode) {
  ModalVolume<T> out;
  if (linear_pressure(law)) {
    const T kappa = bulk_modulus(law) - local;
    for (int k = 0; k < n; ++k) {
      out.p[k] = kappa * t[k];
      out.kappa[k][k] = kappa;
      out.W += 0.5 * V * out.p[k] * t[k];
    }
    return out;
  }
  const T inverse_V = 1.0 / V;
  for (int g = 0; g < (n == 1 ? 1 : n_gauss); ++g) {
    const T share = n == 1 ? T(1.0) : T(w(g) * inverse_V);
    T m[n_modes] = {T(1.0)};
    T theta = t[0];
    for (int k = 1; k < n; ++k) {
      m[k] = mode(g, k);
      theta += m[k] * t[k];
    }
    const Energy<T> U = volume_energy(law, theta);
    out.W += share * U.W;
    for (int k = 0; k < n; ++k) {
      const T weight = share * m[k];
      out.p[k] += weight * U.dW;
      for (int l = 0; l < n; ++l) out.kappa[k][l] += weight * m[l] * U.ddW;
    }
  }
  for (int k = 0; k < n; ++k) {
    out.W -= 0.5 * local * t[k] * t[k];
    out.p[k] -= local * t[k];
    out.kappa[k][k] -= local;
  }
  out.W = V * out.W;
  out.independent = n == 1;
  return out;
}

inline ModalVolume<double> modal_volume(const Volume& law, int n, const double* t, double local,
                                        const ElementGeometry& geometry) {
  return modal_volume(
      law, n, t, local, geometry.V, geometry.n_gauss(), [&](int g) { return geometry.w[g]; },
      [&](int g, int k) { return geometry.mode[g][k]; });
}

// the pressures of all dilatations x (t_k of the modes, or J - 1 of the Gauss points) [MPa]
void pressures(const Volume& law, bool modal, const ElementGeometry& geometry, int n,
               const double* x, double* p);

// linearised about x, as the tangent of x has them after a change dx
void predicted_pressures(const Volume& law, bool modal, const ElementGeometry& geometry, int n,
                         const double* x, const double* dx, double* p);

}  // namespace langer
