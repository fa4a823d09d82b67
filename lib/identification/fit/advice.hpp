// Which further test would make the parameters best known. Each candidate adds its information to
// what is known:
//   (J^T J)/noise^2 + (J_c^T J_c)/noise_c^2         per size of the parameters
// worst     the largest relative standard error afterwards: what the advice is ordered by
// gain      growth of ln det of the information per parameter (D-optimal design) [AD92]: in nats
#pragma once

#include <string>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct Candidate {
  std::string name;
  MatX J;  // (m, p) of its residuals
  double noise = 1;
};

struct Advice {
  std::string name;
  double worst = 0;              // largest relative standard error with this test added
  std::vector<double> relative;  // (p) all of them
  double gain = 0;
};

// information (p, p) so far per size; the best first
std::vector<Advice> advise(const MatX& information, const VecX& size,
                           const std::vector<Candidate>& candidates);
MatX information(const MatX& J, const VecX& size, double noise);

}  // namespace langer
