#include "material/viscous.hpp"

namespace langer {

std::vector<ViscousBranch> branches_of(const Spectrum& spectrum) {
  const double decades = std::log10(spectrum.tau2 / spectrum.tau1);
  const int n = static_cast<int>(std::ceil(decades - 1e-9));
  const double width = std::log(spectrum.tau2 / spectrum.tau1) / n;
  std::vector<ViscousBranch> branches;
  for (int i = 0; i < n; ++i) branches.push_back({spectrum.tau1 * std::exp((i + 0.5) * width), spectrum.c * width, spectrum.of});
  return branches;
}

void amplify(Amplified& amplified, BranchOf of, double follow) {
  const Amplified share = only(of);
  amplified.matrix += share.matrix * follow, amplified.fibres += share.fibres * follow;
}

}  // namespace langer
