// The posterior of a fit: `study: {posterior: {samples: 2000}}`.
#pragma once

#include "core/base/fields.hpp"

namespace langer {

struct PosteriorConfig {
  int samples = 2000;
  int chains = 4;
  int warmup = 300;
  int seed = 1;
  double acceptance = 0.85;
  int runs = 1000;
  double shift = 0.05;
  static void fields(auto& v) {
    v(&PosteriorConfig::samples, "samples", unit::none, "of all chains together",
      between(100, 1000000));
    v(&PosteriorConfig::chains, "chains", unit::none,
      "that begin at different places; where they disagree, they have not found the posterior",
      between(2, 64));
    v(&PosteriorConfig::warmup, "warmup", unit::none,
      "steps of each chain that choose the step size and are not counted", between(50, 100000));
    v(&PosteriorConfig::seed, "seed", unit::none, "of the chains", at_least(0));
    v(&PosteriorConfig::acceptance, "acceptance", unit::none,
      "that the step size aims at; closer to 1: smaller steps, fewer divergences",
      between(0.5, 0.99));
    v(&PosteriorConfig::runs, "runs", unit::none,
      "of a fit with scenes: sets of parameters at which scenes are solved, at most",
      between(60, 100000));
    v(&PosteriorConfig::shift, "shift", unit::none,
      "of a fit with scenes: standard deviations by which a mean may be off, because polynomials "
      "are sampled instead of scenes",
      between(1e-3, 1));
  }
};

}  // namespace langer
