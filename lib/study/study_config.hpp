// What may be asked about a fit: the `study` of the fit stage's YAML.
//   study: {noise: 0.01, bootstrap: 200, candidates: [{kind: uniaxial, fibre_angle: 90}]}
#pragma once

#include <optional>
#include <vector>

#include "base/fields.hpp"
#include "material/states.hpp"

namespace langer {

struct CandidateChoice {
  TestKind kind = TestKind::uniaxial;
  double fibre_angle = 0;
  static void fields(auto& v) {
    v(&CandidateChoice::kind, "kind", unit::none, "of a test that could be made", required);
    v(&CandidateChoice::fibre_angle, "fibre_angle", unit::deg, "of its specimen, added to the law's");
  }
};

struct StudyConfig {
  double noise = 0.01;
  std::optional<bool> profiles;
  int bootstrap = 200;
  int seed = 1;
  std::vector<CandidateChoice> candidates{{TestKind::uniaxial, 0},     {TestKind::uniaxial, 45},     {TestKind::uniaxial, 90},
                                          {TestKind::equibiaxial, 0},  {TestKind::pure_shear, 0},    {TestKind::pure_shear, 90},
                                          {TestKind::simple_shear, 0}, {TestKind::simple_shear, 45}, {TestKind::simple_shear, 90}};
  bool stability = true;
  double stability_to = 1;
  int threads = 1;
  bool figures = false;
  static void fields(auto& v) {
    v(&StudyConfig::noise, "noise", unit::none,
      "least standard deviation of a measured value, as part of the largest stress; more where the fit misses by more", positive);
    v(&StudyConfig::profiles, "profiles", unit::none,
      "intervals by holding each parameter while the others follow; none: of tests only, as with scenes they take many runs");
    v(&StudyConfig::bootstrap, "bootstrap", unit::none,
      "fits to fresh noise, with scenes of the model linearised where it was found; 0 for none", between(0, 1000000));
    v(&StudyConfig::seed, "seed", unit::none, "of that noise", at_least(0));
    v(&StudyConfig::candidates, "candidates", unit::none, "tests that could be made next; the advice ranks them");
    v(&StudyConfig::stability, "stability", unit::none, "map where the law is stable");
    v(&StudyConfig::stability_to, "stability_to", unit::none, "largest strain or shear of that map", positive);
    v(&StudyConfig::threads, "threads", unit::none, "processor cores; the results do not depend on it", between(1, 1024));
    v(&StudyConfig::figures, "figures", unit::none, "draw correlations, profiles and stability");
  }
};

}  // namespace langer
