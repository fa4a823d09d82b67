#include "element/dilatation.hpp"

#include <algorithm>

namespace langer {

void pressures(const Volume& law, bool modal, const ElementGeometry& geometry, int n, const double* x, double* p) {
  if (modal) {
    const ModalVolume<double> v = modal_volume(law, n, x, 0, geometry);
    std::copy(v.p, v.p + n, p);
  } else {
    for (int g = 0; g < n; ++g) p[g] = volume_energy(law, x[g]).dW;
  }
}

}  // namespace langer
