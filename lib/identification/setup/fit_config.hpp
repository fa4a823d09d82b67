// The config of langer-fit.
//   data:       [{file: ../../data/curve.csv, strain_to: 0.6}]       one test, or several of any kind, fitted together;
//               what the file says of itself (setup/specimen.hpp) need not stand here, what stands here wins
//   law:        a material; its numbers are the start values, those not named under `parameters` stay as they are
//   bounds:     admissible
//   parameters: [{key: matrix.yeoh.a1}, {key: "fibres[0].alpha", lower: 0, upper: 90}, ...]
//   ties:       [{key: "fibres[1].alpha", follows: "-fibres[0].alpha"}, ...]
// A test may be a whole scene, {kind: scene, solve: ../solve/indentation.yaml, file: ..., columns:
// {u_ind: ..., force: ...}}: then further numbers may be found, contacts.<name>.friction,
// data[i].touch_offset, data[i].force_offset, data[i].compliance, data[i].fibre_angle, and any
// number of the solve configs by its path, such as mesh.bodies[0].thickness.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/former.hpp"
#include "core/base/input_path.hpp"
#include "core/config/tree.hpp"
#include "identification/fit/fit.hpp"
#include "identification/setup/comparison_config.hpp"
#include "identification/setup/prior_config.hpp"
#include "identification/statistics/study_config.hpp"
#include "layers/prestretch_config.hpp"
#include "results/plot/figure_style.hpp"

namespace langer {

struct FitColumns {
  std::string strain_x, strain_z, stress_x, stress_z, time;
  std::string t, u_ind, displacement, pressure;  // of a scene: over what
  std::string force, reaction_x, reaction_y, reaction_z, u_x, u_y,
      u_z;                              // of a scene: what was measured
  std::string x, y, z;                  // of a scene: where
  std::string angle, speed, frequency;  // of a wave
  static void fields(auto& v) {
    v(&FitColumns::strain_x, "strain_x", unit::none,
      "deformation along x; in simple shear its amount");
    v(&FitColumns::strain_z, "strain_z", unit::none,
      "deformation along z, of a biaxial test; of an equibiaxial or pure shear test where stress_z has a grid of its own");
    v(&FitColumns::stress_x, "stress_x", unit::none,
      "stress along x; in simple shear the shear stress");
    v(&FitColumns::stress_z, "stress_z", unit::none, "stress along z, where it was measured");
    v(&FitColumns::time, "time", unit::s,
      "of each point, where the law is viscous: relaxation, ramp and hold, cycles. The specimen is at rest until the first point, see step_at; its name or time_unit gives another unit than s; of a scene with path.seconds: over which it was measured");
    v(&FitColumns::u_ind, "u_ind", unit::none,
      "of a scene: travel of the indenter, over which it was measured");
    v(&FitColumns::displacement, "displacement", unit::none,
      "of a scene: imposed displacement of the set `moved`, over which it was measured");
    v(&FitColumns::pressure, "pressure", unit::none,
      "of a scene: pressure on the set `moved`, over which it was measured");
    v(&FitColumns::t, "t", unit::none,
      "of a scene: place on its path, 0 to 1; without any of these all was measured at its end");
    v(&FitColumns::force, "force", unit::none,
      "of a scene: force that resists the indenter, or the one that `on` names");
    v(&FitColumns::reaction_x, "reaction_x", unit::none,
      "of a scene: force that holds or moves the set `on`, along x");
    v(&FitColumns::reaction_y, "reaction_y", unit::none, "the same along y");
    v(&FitColumns::reaction_z, "reaction_z", unit::none, "the same along z");
    v(&FitColumns::u_x, "u_x", unit::none,
      "of a scene: displacement along x of the point or set `on` (mean over its nodes), or at the places of x, y, z");
    v(&FitColumns::u_y, "u_y", unit::none, "the same along y, such as the height of an apex");
    v(&FitColumns::u_z, "u_z", unit::none, "the same along z");
    v(&FitColumns::x, "x", unit::none,
      "of a scene: x at rest of each measured place on the surface");
    v(&FitColumns::y, "y", unit::none, "of a scene: y at rest; none: the top");
    v(&FitColumns::z, "z", unit::none, "of a scene: z at rest; none: 0");
    v(&FitColumns::angle, "angle", unit::none,
      "of a wave: direction of travel in degrees from x towards z; without `columns`, angle_deg");
    v(&FitColumns::speed, "speed", unit::none,
      "of a wave: measured phase speed in m/s; without `columns`, speed_m_s");
    v(&FitColumns::frequency, "frequency", unit::none,
      "of a wave: frequency in Hz, where speeds depend on it; without `columns`, frequency_Hz");
  }
};

// Where the deformation and the stress of a test count from.
enum class ZeroAt { reading, start };
constexpr auto names(ZeroAt) { return std::array{"reading", "start"}; }

struct FitData {
  InputPath file;
  std::string name, specimen;
  DataKind kind = DataKind::uniaxial;
  InputPath solve, mesh;
  std::string on, moved;
  double touch_offset = 0, force_offset = 0, compliance = 0;
  std::optional<FitColumns> columns;
  std::optional<StressMeasure> stress;
  std::optional<StrainMeasure> strain;
  std::optional<StressUnit> stress_unit;
  std::optional<StrainUnit> strain_unit;
  std::optional<TimeUnit> time_unit;
  OffAxisShear shear = OffAxisShear::held;
  double fibre_angle = 0;
  std::optional<DecimalSign> decimal;
  std::optional<double> width, thickness, gauge_length, width_z, gauge_length_z, toe;
  std::optional<double> density_kg_m3;
  std::optional<PrestretchConfig> prestretch;
  ZeroAt zero_at = ZeroAt::reading;
  bool normalised = false;
  std::optional<double> weight, standard_deviation, strain_from, strain_to, time_from, time_to,
      compare_from;
  std::map<std::string, std::string> where;
  std::string split, block, name_pattern;
  std::optional<double> sign, strain_sign, stress_sign, step_at, ramp, ratio;
  KeptUntil until = KeptUntil::end;
  KeptBranch branch = KeptBranch::all;
  KeptCycle cycle = KeptCycle::all;
  int skip_cycles = 0;
  static void fields(auto& v) {
    v(&FitData::file, "file", unit::none,
      "measured test, CSV; keys of this list may stand in its header between lines `# ---`, or in a YAML file of its name; none: the "
      "next of the files that --curves gives");
    v(&FitData::name, "name", unit::none, "of the test; by default that of the file");
    v(&FitData::specimen, "specimen", unit::none,
      "id of the specimen that was tested, in a fit with `specimens`; written there by the program");
    v(&FitData::kind, "kind", unit::none,
      "what the test imposes; scene: what the config `solve` does");
    v(&FitData::solve, "solve", unit::none,
      "config of langer-solve that simulates the test; its material is replaced by that of the fit, bodies under `materials` keep theirs");
    v(&FitData::mesh, "mesh", unit::none, "config of langer-mesh for it, where `solve` has none");
    v(&FitData::on, "on", unit::none,
      "set or point of the scene that was measured; of a force the contact's name, if there are several");
    v(&FitData::moved, "moved", unit::none,
      "set of the scene whose imposed displacement or pressure it was measured over");
    v(&FitData::touch_offset, "touch_offset", unit::mm,
      "of a scene: measured travel at first contact; may be a parameter, data[i].touch_offset");
    v(&FitData::force_offset, "force_offset", unit::N,
      "of a scene: measured force without contact; may be a parameter");
    v(&FitData::compliance, "compliance", unit::none,
      "of the machine, in mm/N: this times the measured force is subtracted from the measured travel; may be a parameter",
      at_least(0));
    v(&FitData::columns, "columns", unit::none,
      "which columns to read; without it the file says by its columns' names: strain, strain_percent or stretch, and "
      "cauchy_stress_MPa or nominal_stress_MPa (kPa, Pa), or Force (N) and Extension (mm), for uniaxial, equibiaxial and pure shear "
      "tests");
    v(&FitData::stress, "stress", unit::none,
      "measure of the stress, if the name of its column does not give it; without either, a column of `columns` is taken as cauchy, with a notice");
    v(&FitData::strain, "strain", unit::none,
      "measure of the deformation, if the name of its column does not give it; without either, a column that starts at 1 is taken as "
      "stretch and one that starts at 0 as engineering, with a notice");
    v(&FitData::stress_unit, "stress_unit", unit::none,
      "if the name of the column does not give it; a force (N, mN, kN, gf, kgf, lbf), width and thickness give a nominal stress");
    v(&FitData::strain_unit, "strain_unit", unit::none,
      "if the name of the column does not give it, fraction by default; an elongation (mm, um, cm, m, in) and gauge_length give a strain");
    v(&FitData::decimal, "decimal", unit::none,
      "sign of decimals where the file leaves it open, as 1,234 does");
    v(&FitData::width, "width", unit::mm, "of the specimen at rest, across a force along x",
      positive);
    v(&FitData::thickness, "thickness", unit::mm,
      "of the specimen at rest, for forces; of a wave: of the skin, held below; none: a half-space",
      positive);
    v(&FitData::density_kg_m3, "density_kg_m3", unit::none,
      "of a wave: density at rest in kg/m3, such as 1100", positive);
    v(&FitData::prestretch, "prestretch", unit::none,
      "of a wave: stretch of the skin that it travels in; may be parameters, "
      "data[i].prestretch.along and data[i].prestretch.across");
    v(&FitData::gauge_length, "gauge_length", unit::mm,
      "length at rest between grips or marks, for elongations along x", positive);
    v(&FitData::width_z, "width_z", unit::mm, "of the specimen at rest, across a force along z",
      positive);
    v(&FitData::gauge_length_z, "gauge_length_z", unit::mm,
      "length at rest, for elongations along z", positive);
    v(&FitData::toe, "toe", unit::MPa,
      "the state in which the stress along x first reaches this is taken as the one at rest: stretches and nominal stresses are "
      "referred to it, points before it left out",
      positive);
    v(&FitData::shear, "shear", unit::none,
      "shear that fibres off the axes cause: held by the grips, or free");
    v(&FitData::fibre_angle, "fibre_angle", unit::deg,
      "how the specimen was cut: added to the law's fibre angles");
    counted_fields(v);
    v(&FitData::where, "where", unit::none, "column: text; rows with other texts are left out");
    v(&FitData::split, "split", unit::none,
      "a column: one test for each text in it, such as a protocol");
    laboratory_fields(v);
  }
  // how the machine and its operator wrote the file
  static void laboratory_fields(auto& v) {
    v(&FitData::time_unit, "time_unit", unit::none,
      "of the column of times, if its name does not give it; seconds by default");
    v(&FitData::sign, "sign", unit::none,
      "-1: strains, elongations, stresses and forces change their sign, where the file counts compression or pushing positive; a "
      "stretch stays what it is. 1: they do not, which confirms the file");
    v(&FitData::strain_sign, "strain_sign", unit::none,
      "1 or -1: the same for strains and elongations alone");
    v(&FitData::stress_sign, "stress_sign", unit::none,
      "1 or -1: the same for stresses and forces alone");
    v(&FitData::block, "block", unit::none,
      "of a file that repeats its line of names: what stands above the one to read, such as Specimen 2; none: one test for each");
    v(&FitData::name_pattern, "name_pattern", unit::none,
      "how the file's name holds sizes, such as *_w{width}_t{thickness}_L{gauge_length}; * is any text, a number may have p for its "
      "point; {fibre_angle}, {width_z} and {gauge_length_z} are read too");
    v(&FitData::ratio, "ratio", unit::none,
      "of a biaxial test whose axes have grids of their own: (lambda_z - 1) / (lambda_x - 1), held throughout the test",
      positive);
    v(&FitData::step_at, "step_at", unit::s,
      "time at which the specimen leaves rest for the deformation of the first reading; for relaxation tables without t = 0");
    v(&FitData::ramp, "ramp", unit::s,
      "duration of that step; without step_at the ramp ends at the first reading", at_least(0));
    v(&FitData::until, "until", unit::none,
      "peak: points behind the largest stress along x are left out");
    v(&FitData::branch, "branch", unit::none,
      "loading or unloading: points where the strain moves away from 0, or back; turns by less than 3 % of its range are noise");
    v(&FitData::cycle, "cycle", unit::none,
      "last: earlier cycles are left out; with a column of times they are history, as before compare_from");
    v(&FitData::skip_cycles, "skip_cycles", unit::none,
      "number of cycles at the beginning that are left out, or are history, such as preconditioning",
      at_least(0));
  }
  // Keys about which points count, with which weight.
  static void counted_fields(auto& v) {
    v(&FitData::weight, "weight", unit::none,
      "of the residuals relative to those of other tests; 1 by default", positive);
    v(&FitData::standard_deviation, "standard_deviation", unit::none,
      "of the measured stress in MPa: the weight is its inverse; in a fit with scenes every test needs it, a scene in N or mm; none: study.noise "
      "times its largest value",
      positive);
    v(&FitData::strain_from, "strain_from", unit::none,
      "points below this engineering strain along x are left out");
    v(&FitData::strain_to, "strain_to", unit::none,
      "points above this engineering strain along x are left out");
    v(&FitData::time_from, "time_from", unit::s,
      "points before this time are left out; the specimen is at rest at the first one kept");
    v(&FitData::time_to, "time_to", unit::s, "points after this time are left out");
    v(&FitData::compare_from, "compare_from", unit::s,
      "points before this time are history: viscous branches remember them, residuals do not count them; such as a cycle of "
      "preconditioning");
    v(&FitData::zero_at, "zero_at", unit::none,
      "start: the specimen is undeformed until it is first moved, whatever was read: stretches are divided by the mean stretch read "
      "until then, the mean stress, an offset of the device, is taken from all");
    v(&FitData::normalised, "normalised", unit::none,
      "stresses or forces over the largest of the test, where sizes are not known: moduli then are shares of it, strengths and times "
      "of viscous branches stay what they are");
  }
  bool is_scene() const { return kind == DataKind::scene; }
  bool is_wave() const { return kind == DataKind::wave; }
  std::vector<Complaint> complaints() const;

 private:
  void complain_of_scene(std::vector<Complaint>& all) const;
  void complain_of_wave(std::vector<Complaint>& all) const;
  void complain_of_wave_keys(std::vector<Complaint>& all) const;  // in other tests
  void complain_of_laboratory_keys(std::vector<Complaint>& all) const;
  void complain_of_homogeneous_keys(
      std::vector<Complaint>& all) const;  // that a scene does not read
};

enum class Bounds { custom, paper, admissible };
constexpr auto names(Bounds) { return std::array{"custom", "paper", "admissible"}; }

struct FitParameter {
  std::string key;
  std::optional<double> lower, upper, start, truth;
  std::optional<PriorConfig> prior = {};
  static void fields(auto& v) {
    v(&FitParameter::key, "key", unit::none,
      "path of a number of the material, such as matrix.yeoh.a1", required);
    v(&FitParameter::lower, "lower", unit::none,
      "lower bound, in the unit of the number; may be left out unless bounds: custom");
    v(&FitParameter::upper, "upper", unit::none,
      "upper bound; may be left out unless bounds: custom");
    v(&FitParameter::start, "start", unit::none,
      "where the first search starts; by default the value in `law`");
    v(&FitParameter::truth, "truth", unit::none,
      "its true value, for synthetic data: reported next to the value found");
    v(&FitParameter::prior, "prior", unit::none,
      "what is known of it beforehand, as {normal: [2.0, 0.1]}: counts like one more measurement");
  }
};

struct FitTie {
  std::string key, follows;
  static void fields(auto& v) {
    v(&FitTie::key, "key", unit::none,
      "path of a number of the material that is not among `parameters`", required);
    v(&FitTie::follows, "follows", unit::none,
      "path of the number that it follows, with a sign, a factor or an offset if need be: -fibres[0].alpha, "
      "0.5 * fibres[0].hgo.c1, fibres[0].alpha + 90",
      required);
  }
};

enum class SecondAnswer { none, nlopt };
constexpr auto names(SecondAnswer) { return std::array{"none", "nlopt"}; }

struct FitConfig {
  std::vector<FitData> data;
  Material law;
  std::vector<FitParameter> parameters;
  std::vector<FitTie> ties;
  Bounds bounds = Bounds::custom;
  Dilatation dilatation = Dilatation::incompressible;
  NoiseKind noise_model = NoiseKind::automatic;
  bool leave_one_out = false;
  std::optional<int> starts;
  int seed = 1;
  int jobs = 1;
  bool draft = true;
  SecondAnswer cross_check = SecondAnswer::none;
  std::optional<StudyConfig> study;
  std::vector<std::string> laws;
  std::optional<DiscoverConfig> discover;
  std::optional<SpecimensConfig> specimens;
  FigureStyle figure_style;
  static void fields(auto& v) {
    v(&FitConfig::data, "data", unit::none,
      "the tests to fit; with `specimens` what their files do not say of themselves");
    v(&FitConfig::law, "law", unit::none,
      "energy terms, fibre angles and the numbers that are not fitted; not with `laws` or `discover`");
    v(&FitConfig::parameters, "parameters", unit::none,
      "the numbers to find; not with `laws` or `discover`");
    v(&FitConfig::laws, "laws", unit::none,
      "instead of law and parameters: laws to compare by how they predict tests that they were not fitted to, such as [yeoh, "
      "hgo_yeoh, goh] (docs/population.md)");
    v(&FitConfig::discover, "discover", unit::none,
      "instead of law and parameters: terms of an energy of which the fewest that describe the tests are chosen");
    v(&FitConfig::specimens, "specimens", unit::none,
      "tests of many specimens: the parameters of a population, and how they scatter");
    v(&FitConfig::ties, "ties", unit::none,
      "numbers of the material that follow others, such as those of a second family of fibres");
    v(&FitConfig::bounds, "bounds", unit::none,
      "of parameters without their own. paper: moduli of either sign; admissible: moduli >= 0, so that the material is stable, and a shear "
      "modulus at rest that the tests can distinguish from 0 (docs/identification.md)");
    v(&FitConfig::dilatation, "dilatation", unit::none,
      "state of the specimen: the volume term left out (incompressible) or counted (uniaxial tests only)");
    v(&FitConfig::noise_model, "noise", unit::none,
      "of the measured stresses, under which the parameters have the largest likelihood: white (least squares), proportional to the "
      "stress, autoregressive along a curve, or both; auto: the one of lowest AICc, with scenes white");
    v(&FitConfig::leave_one_out, "leave_one_out", unit::none,
      "predict each test from a fit to the others, and report the error");
    v(&FitConfig::starts, "starts", unit::none,
      "searches: one from the start values, the others from random places in the box; none: 20, with waves 4, with scenes 1",
      between(1, 100000));
    v(&FitConfig::jobs, "jobs", unit::none,
      "scenes that are solved in parallel; the results do not depend on it", between(1, 256));
    v(&FitConfig::draft, "draft", unit::none,
      "of scenes: search on elements twice as long first, if the mesh follows from numbers of its config, and continue from there");
    v(&FitConfig::seed, "seed", unit::none, "of the random places", at_least(0));
    v(&FitConfig::cross_check, "cross_check", unit::none,
      "a cross-check by another method; disagreement is a warning", Formerly{"check"});
    v(&FitConfig::study, "study", unit::none,
      "how well the data identify the parameters, and where the material is stable; {} for all");
    v(&FitConfig::figure_style, "figure_style", unit::none, "how figures are made");
  }
  bool has_scenes() const;
  bool has_waves() const;
  double noise() const {
    return study.value_or(StudyConfig{}).noise;
  }  // part of the largest value of a test
  int searches() const {
    if (has_scenes()) return starts.value_or(1);
    if (has_waves()) return starts.value_or(4);
    return starts.value_or(20);
  }
  std::vector<Complaint> complaints() const;
  static void complete(Tree& tree);  // what the measured files say of themselves
};

// The bounds of a number of the material where the config names none: those of its listing
// (SearchBounds) or of its unit, within the range that the material model allows.
Range default_bounds(const MaterialParameter& parameter, Bounds bounds, double start);

// the parameters with their bounds and start values; a key that the law lacks stays without
// (complaints() names it)
std::vector<FreeParameter> free_parameters(const FitConfig& config);

// The number of a scene or a wave test that a key names; nothing for keys of the material.
struct SceneNumber {
  enum class Of {
    friction,
    touch_offset,
    force_offset,
    compliance,
    stretch_along,  // of a wave
    stretch_across,
    fibre_angle,  // of a scene: how its specimen was cut
    of_config     // any number of a solve config, in all scenes that have it
  } of = Of::friction;
  std::string contact;   // of friction; of of_config the path of the number
  std::size_t data = 0;  // of the others
};
std::optional<SceneNumber> scene_number(const FitConfig& config, const std::string& key);
// the free parameter that such a number of a solve config is; what is not given is NaN
FreeParameter scene_config_parameter(const FitParameter& p);
std::optional<SceneNumber> wave_number_key(const FitConfig& config, const std::string& key);
inline std::optional<SceneNumber> scene_number(const FitConfig& config, const FreeParameter& p) {
  if (p.is_material_number()) return std::nullopt;
  return scene_number(config, p.key);
}

// the ties of the law, resolved; those that complaints() names are left out
std::vector<Tie> ties_of(const FitConfig& config);

// reads the files; throws Failure(input). Scenes are left out.
std::vector<Test> measured_tests(const FitConfig& config);

// all of it; upper bounds of moduli that the config leaves to a preset are three times the greatest
// secant modulus of the tests, where that is more than 10 MPa
FitProblem fit_problem(const FitConfig& config);

}  // namespace langer
