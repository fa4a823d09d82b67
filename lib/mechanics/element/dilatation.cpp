#include "mechanics/element/dilatation.hpp"

#include <algorithm>
#include <array>

namespace langer {

void pressures(const Volume& law, bool modal, const ElementGeometry& geometry, int n,
               const double* x, double* p) {
  if (modal) {
    const ModalVolume<double> v = modal_volume(law, n, x, 0, geometry);
    std::copy(v.p, v.p + n, p);
  } else {
    for (int g = 0; g < n; ++g) p[g] = volume_energy(law, x[g]).dW;
  }
}

void predicted_pressures(const Volume& law, bool modal, const ElementGeometry& geometry, int n,
                         const double* x, const double* dx, double* p) {
  if (linear_pressure(law)) {
    std::array<double, most_gauss> sum;
    for (int k = 0; k < n; ++k) sum[k] = x[k] + dx[k];
    return pressures(law, modal, geometry, n, sum.data(), p);
  }
  if (!modal) {
    for (int g = 0; g < n; ++g) {
      const Energy<double> U = volume_energy(law, x[g]);
      p[g] = U.dW + U.ddW * dx[g];
    }
    return;
  }
  const ModalVolume<double> v = modal_volume(law, n, x, 0, geometry);
  for (int k = 0; k < n; ++k) {
    p[k] = v.p[k];
    for (int l = 0; l < n; ++l) p[k] += v.kappa[k][l] * dx[l];
  }
}

}  // namespace langer
