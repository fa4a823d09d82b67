#include "mechanics/material/viscous.hpp"

namespace langer {

std::vector<ViscousBranch> branches_of(const Spectrum& spectrum) {
  const double decades =
      std::log10(spectrum.tau2) - std::log10(spectrum.tau1);  // their quotient may overflow
  const int n = static_cast<int>(std::ceil(decades - 1e-9));
  const double width = (std::log(spectrum.tau2) - std::log(spectrum.tau1)) / n;
  std::vector<ViscousBranch> branches;
  for (int i = 0; i < n; ++i)
    branches.push_back(
        {std::exp(std::log(spectrum.tau1) + (i + 0.5) * width), spectrum.c * width, spectrum.of});
  return branches;
}

void amplify(Amplified& amplified, BranchOf of, double follow) {
  const Amplified share = only(of);
  amplified.matrix += share.matrix * follow;
  amplified.fibres += share.fibres * follow;
}

}  // namespace langer
