// What may be asked about a fit: the `study` of the fit stage's YAML.
//   study: {noise: 0.01, bootstrap: 200, candidates: [{kind: uniaxial, fibre_angle: 90}]}
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/input_path.hpp"
#include "identification/statistics/posterior_config.hpp"
#include "mechanics/material/states.hpp"

namespace langer {

// What a test imposes: TestKind, in its order, or a whole scene.
enum class DataKind { uniaxial, equibiaxial, biaxial, pure_shear, simple_shear, scene, wave };
constexpr auto names(DataKind) {
  return std::array{"uniaxial",     "equibiaxial", "biaxial", "pure_shear",
                    "simple_shear", "scene",       "wave"};
}

enum class SceneQuantity { force, reaction_x, reaction_y, reaction_z, u_x, u_y, u_z };
constexpr auto names(SceneQuantity) {
  return std::array{"force", "reaction_x", "reaction_y", "reaction_z", "u_x", "u_y", "u_z"};
}

struct CandidateValues {
  std::string key;
  std::vector<double> values;
  static void fields(auto& v) {
    v(&CandidateValues::key, "key", unit::none,
      "path in the solve config, such as contacts.sphere.rigid.sphere.radius or contacts.sphere.motion[0].to[1]; or fibre_angle",
      required);
    v(&CandidateValues::values, "values", unit::none,
      "a candidate for each, and for each combination with those of other keys", required);
  }
};

struct CandidateChoice {
  DataKind kind = DataKind::uniaxial;
  double fibre_angle = 0;
  std::string name = "";
  InputPath solve = {};
  std::vector<CandidateValues> vary = {};
  bool together = false;
  std::vector<SceneQuantity> measured = {SceneQuantity::force};
  std::string on = "";
  std::vector<std::array<double, 2>> places = {};
  int points = 20;
  std::optional<double> standard_deviation = {};
  static void fields(auto& v) {
    v(&CandidateChoice::kind, "kind", unit::none, "of a test that could be made", required);
    v(&CandidateChoice::fibre_angle, "fibre_angle", unit::deg,
      "of its specimen, added to the law's");
    v(&CandidateChoice::name, "name", unit::none,
      "of a scene, in the advice; by default that of its config");
    v(&CandidateChoice::solve, "solve", unit::none,
      "config of langer-solve, with its mesh, that a scene is");
    v(&CandidateChoice::vary, "vary", unit::none,
      "of a scene: values of its keys, such as radius, depth or fibre_angle");
    v(&CandidateChoice::together, "together", unit::none,
      "of a scene: all its values make one candidate, of tests that are made together");
    v(&CandidateChoice::measured, "measured", unit::none, "of a scene: what would be measured");
    v(&CandidateChoice::on, "on", unit::none,
      "of a scene: set or point whose reaction or displacement; of a force the contact's name, if there are several");
    v(&CandidateChoice::places, "places", unit::mm,
      "of a scene: x and z of places on the top whose displacements are observed");
    v(&CandidateChoice::points, "points", unit::none,
      "of a scene: values of each quantity along the path", between(1, 100000));
    v(&CandidateChoice::standard_deviation, "standard_deviation", unit::none,
      "of a scene: of each value, in N or mm; none: study.noise times the largest", positive);
  }
  std::vector<Complaint> complaints() const;
};

struct StudyConfig {
  double noise = 0.01;
  std::optional<bool> profiles;
  int bootstrap = 200;
  int seed = 1;
  std::vector<CandidateChoice> candidates{
      {DataKind::uniaxial, 0},     {DataKind::uniaxial, 45},     {DataKind::uniaxial, 90},
      {DataKind::equibiaxial, 0},  {DataKind::pure_shear, 0},    {DataKind::pure_shear, 90},
      {DataKind::simple_shear, 0}, {DataKind::simple_shear, 45}, {DataKind::simple_shear, 90}};
  bool stability = true;
  double stability_to = 1;
  int threads = 1;
  bool figures = false;
  std::optional<PosteriorConfig> posterior = {};
  std::optional<bool> held = {};
  static void fields(auto& v) {
    v(&StudyConfig::noise, "noise", unit::none,
      "least standard deviation of a measured value, as part of the largest stress; more where the fit misses by more",
      positive);
    v(&StudyConfig::profiles, "profiles", unit::none,
      "intervals by holding each parameter while the others follow; none: of tests only, as with scenes they take many runs");
    v(&StudyConfig::bootstrap, "bootstrap", unit::none,
      "fits to fresh noise, with scenes of the model linearised where it was found; 0 for none",
      between(0, 1000000));
    v(&StudyConfig::seed, "seed", unit::none, "of that noise", at_least(0));
    v(&StudyConfig::candidates, "candidates", unit::none,
      "tests that could be made next, scenes among them; the advice ranks them");
    v(&StudyConfig::stability, "stability", unit::none, "map where the law is stable");
    v(&StudyConfig::stability_to, "stability_to", unit::none, "largest strain or shear of that map",
      positive);
    v(&StudyConfig::threads, "threads", unit::none,
      "processor cores; the results do not depend on it", between(1, 1024));
    v(&StudyConfig::figures, "figures", unit::none, "draw correlations, profiles and stability");
    v(&StudyConfig::posterior, "posterior", unit::none,
      "samples of the parameters by their probability, priors included; {} for 2000 of four chains");
    v(&StudyConfig::held, "held", unit::none,
      "name the numbers of scenes that are held fixed and would widen an interval as parameters; none: in fits with scenes");
  }
};

}  // namespace langer
