// Samples of a density by its gradient: the no-U-turn sampler.
//
// A point is pushed with a random momentum and follows the hills of ln p like a ball without
// friction; the path is doubled until it begins to turn back, and one of its points is drawn. Steps
// are as long as the accuracy of the path allows, so that neighbouring samples are almost
// independent even where parameters are correlated.
// Multinomial variant [B17] of the sampler of Hoffman and Gelman (2014), step size by dual
// averaging, dense metric. Chain and seed alone decide the samples, not the number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

// ln p but for a constant, and its gradient (n); -infinity where p is 0
using LogDensity = std::function<double(const VecX& x, VecX& gradient)>;

struct NutsOptions {
  int samples = 500;
  int warmup = 300;
  std::uint64_t seed = 1;
  std::uint64_t chain = 0;
  double acceptance = 0.85;
  int deepest = 10;  // paths of at most 2^deepest steps
  // (n) walls between which x moves, infinite where there is none; empty: none at all. Paths are
  // reflected at walls [AD15], so the density may end there without falling to 0.
  VecX lower = {}, upper = {};
};

struct NutsChain {
  MatX draws;           // (samples, n)
  VecX log_density;     // (samples)
  int divergences = 0;  // paths whose energy went astray: p is steeper there than the steps resolve
  int longest = 0;      // paths that were cut at the deepest level
  double step = 0, acceptance = 0;
  long evaluations = 0;
};

// scale (n, n): a first idea of the covariance
NutsChain sample_chain(const LogDensity& density, const VecX& start, const MatX& scale,
                       const NutsOptions& options);

// How well several chains agree and how many independent samples they are worth, of one parameter.
// chains: samples of each, of equal number. Split-R-hat, and the effective number by Geyer's
// initial monotone sequence [GCSR13, 11.4, 11.5].
struct Convergence {
  double r_hat = 0, effective = 0;
};
Convergence convergence(const std::vector<VecX>& chains);

}  // namespace langer
