#include "identification/setup/fit_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "identification/setup/comparison_complaints.hpp"
#include "identification/setup/law_catalogue.hpp"
#include "identification/setup/specimen.hpp"
#include "identification/setup/specimen_table.hpp"

namespace langer {

// Checks an item of `data`: keys that exclude each other, columns that the kind of test needs, and
// parts of a history that cannot be left out.
std::vector<Complaint> FitData::complaints() const {
  std::vector<Complaint> all;
  if (strain_from && strain_to && *strain_from >= *strain_to)
    all.push_back({"strain_to", "found " + number_text(*strain_to),
                   "more than strain_from, " + number_text(*strain_from), ""});
  if (time_from && time_to && *time_from >= *time_to)
    all.push_back({"time_to", "found " + number_text(*time_to),
                   "more than time_from, " + number_text(*time_from), ""});
  if (weight && standard_deviation)
    all.push_back({"weight", "found together with standard_deviation", "one of the two",
                   "the weight is 1/standard_deviation"});
  if (is_scene()) {
    complain_of_scene(all);
    return all;
  }
  if (is_wave()) {
    complain_of_wave(all);
    return all;
  }
  complain_of_wave_keys(all);
  if (file.path.empty())
    all.push_back(
        {"file", "missing", "the path of a file, relative to this one (measured test, CSV)", ""});
  if (!solve.path.empty())
    all.push_back({"solve", "found in a test that is no scene", "kind: scene", ""});
  if (columns)
    for (const auto& [key, text, says] :
         {std::tuple("strain_x", &columns->strain_x,
                     "text (deformation along x; in simple shear its amount)"),
          {"stress_x", &columns->stress_x,
           "text (stress along x; in simple shear the shear stress)"}})
      if (text->empty()) all.push_back({std::string("columns.") + key, "missing", says, ""});
  complain_of_laboratory_keys(all);
  const bool biaxial = kind == DataKind::biaxial;
  if (!columns && (biaxial || kind == DataKind::simple_shear))
    all.push_back(
        {"kind",
         std::string("found ") + (biaxial ? "biaxial" : "simple_shear") + " without `columns`",
         "the columns of deformation and stress",
         "which column is which, by the names in the file: columns: {strain_x: lambda_x, strain_z: lambda_z, stress_x: P_x_MPa, "
         "stress_z: P_z_MPa}"});
  if (!columns && (!split.empty() || !where.empty()))
    all.push_back({split.empty() ? "where" : "split", "found without `columns`",
                   "the columns of deformation and stress", ""});
  if (columns && biaxial && columns->strain_z.empty() && !ratio)
    all.push_back(
        {"columns.strain_z", "missing", "the deformation along z, which a biaxial test imposes",
         "both axes at the same instants in one file; of an equibiaxial or pure shear test, or with ratio:, each axis may be an item "
         "of its own, the second with fibre_angle: 90"});
  const bool own_grids = columns && (!biaxial || ratio) && !columns->strain_z.empty();
  if (own_grids && !biaxial && kind != DataKind::equibiaxial && kind != DataKind::pure_shear)
    all.push_back({"columns.strain_z", "found in a test without stress along z",
                   "kind: biaxial, equibiaxial or pure_shear, or no strain_z", ""});
  else if (own_grids && columns->stress_z.empty())
    all.push_back({"columns.stress_z", "missing, with strain_z given",
                   "the stress along z, at the deformations of strain_z", ""});
  if (columns && !columns->time.empty()) {
    const std::string whole = "a history, of which no part can be left out";
    if (toe) all.push_back({"toe", "found together with columns.time", "none: " + whole, ""});
    if (strain_from)
      all.push_back({"strain_from", "found together with columns.time", "none: " + whole,
                     "time_from begins it later"});
    if (strain_to)
      all.push_back({"strain_to", "found together with columns.time", "none: " + whole,
                     "time_to ends it earlier"});
    if (own_grids)
      all.push_back({"columns.time", "found with a grid of its own for each axis",
                     "both axes at the same instants", ""});
  } else {
    for (const auto& [key, given] :
         {std::pair("time_from", time_from), {"time_to", time_to}, {"compare_from", compare_from}})
      if (given)
        all.push_back({key, "found without a column of times", "columns: {time: ...}", ""});
  }
  if (toe && zero_at == ZeroAt::start)
    all.push_back({"toe", "found together with zero_at: start", "one of the two",
                   "both define the undeformed state"});
  if (toe && kind == DataKind::simple_shear)
    all.push_back({"toe", "found in simple shear", "a test that stretches", ""});
  if (toe && own_grids)
    all.push_back({"toe", "found with a grid of its own for each axis",
                   "no toe: data that start at rest", ""});
  if (columns && !columns->stress_z.empty() &&
      (kind == DataKind::uniaxial || kind == DataKind::simple_shear))
    all.push_back({"columns.stress_z", "found in a test without stress along z",
                   "equibiaxial, biaxial or pure_shear", ""});
  return all;
}

void FitConfig::complete(Tree& tree) {
  if (tree.kind != Tree::Kind::map) return;
  complete_laws(tree);
  expand_specimens(tree);
  for (auto& entry : tree.map)
    if (entry.key == "data")
      for (Tree& item : entry.value.list) add_keys_of_measured_file(item);
}

// The bounds of a number whose listing names none. A shear modulus or coefficient of an energy may
// be negative unless the config asks for admissible numbers.
Range bounds_of_unit(const std::string& unit, Bounds bounds, double start) {
  if (unit == unit::MPa && bounds == Bounds::admissible) return {0, 10};
  if (unit == unit::deg) return {-90, 90};
  if (unit == unit::s) return {start / 100, 100 * start};  // a relaxation time
  if (unit == unit::per_MPa) return {1e-8, 10};            // a compressibility
  return {-10, 10};
}

Range default_bounds(const MaterialParameter& parameter, Bounds bounds, double start) {
  Range box = bounds_of_unit(parameter.unit, bounds, start);
  if (const auto& search = parameter.search) {
    box = {search->low, search->high};
    if (bounds == Bounds::admissible && search->least_size > 0) {
      if (start < 0) {
        box.high = -search->least_size;
      } else {
        box.low = search->least_size;
      }
    }
  }
  box.low = std::max(box.low, parameter.range.low);
  box.high = std::min(box.high, parameter.range.high);
  return box;
}

namespace {

// A parameter that is not a number of the material: friction, or a quantity of the instrument.
FreeParameter free_number(const FitConfig& config, const FitParameter& p,
                          const SceneNumber& number) {
  if (number.of == SceneNumber::Of::of_config) return scene_config_parameter(p);
  FreeParameter one{p.key, 0, 0, 0, false, "friction", unit::none};
  Range box{0, 2};
  const FitData* data = nullptr;  // none for friction
  if (number.of != SceneNumber::Of::friction) data = &config.data[number.data];
  if (!data) {
    one.start = 0.3;
    one.name = "friction_" + number.contact;
  } else {
    std::string behind;
    if (config.data.size() > 1) behind = "_" + std::to_string(number.data + 1);
    if (number.of == SceneNumber::Of::touch_offset) {
      one.name = "touch_offset" + behind;
      one.unit = unit::mm;
      one.start = data->touch_offset;
      box = {-0.5, 0.5};
    } else if (number.of == SceneNumber::Of::force_offset) {
      one.name = "force_offset" + behind;
      one.unit = unit::N;
      one.start = data->force_offset;
      box = {-1, 1};
    } else if (number.of == SceneNumber::Of::stretch_along) {
      one.name = "prestretch_along" + behind;
      one.start = data->prestretch.value_or(PrestretchConfig{}).along;
      box = {0.7, 1.5};
    } else if (number.of == SceneNumber::Of::stretch_across) {
      one.name = "prestretch_across" + behind;
      one.start = data->prestretch.value_or(PrestretchConfig{}).across;
      box = {0.7, 1.5};
    } else if (number.of == SceneNumber::Of::fibre_angle) {
      one.name = "fibre_angle" + behind;
      one.unit = unit::deg;
      one.start = data->fibre_angle;
      box = {one.start - 90, one.start + 90};
    } else {
      one.name = "compliance" + behind;
      one.unit = "mm/N";
      one.start = data->compliance;
      box = {0, 1};
    }
  }
  one.start = p.start.value_or(one.start);
  if (config.bounds == Bounds::custom) box = {0, 0};
  one.lower = p.lower.value_or(box.low);
  one.upper = p.upper.value_or(box.high);
  return one;
}

}  // namespace

// Bounds and start of each parameter: given ones first, then those of the preset.
std::vector<FreeParameter> free_parameters(const FitConfig& config) {
  Material law = config.law;
  const std::vector<MaterialParameter> known = parameters(law);
  std::vector<FreeParameter> free;
  for (const FitParameter& p : config.parameters) {
    FreeParameter one{p.key, p.start.value_or(0), p.lower.value_or(0), p.upper.value_or(0)};
    const auto found = std::ranges::find(known, p.key, &MaterialParameter::key);
    if (const auto number = scene_number(config, p.key)) one = free_number(config, p, *number);
    if (found != known.end()) {
      if (!p.start) one.start = *found->value;
      Range box = default_bounds(*found, config.bounds, one.start);
      // mu_p alpha_p >= 0 of an Ogden term: its modulus has the sign of its power
      if (config.bounds == Bounds::admissible && !found->sign_of.empty()) {
        const auto other = std::ranges::find(known, found->sign_of, &MaterialParameter::key);
        if (other != known.end() && *other->value < 0) box = {-10, 0};
      }
      one.preset = config.bounds == Bounds::admissible && !(box.high <= 0 ? p.upper : p.lower);
      if (config.bounds != Bounds::custom) {
        one.lower = p.lower.value_or(box.low);
        one.upper = p.upper.value_or(box.high);
      }
    }
    free.push_back(one);
  }
  return free;
}

namespace {

// The ties whose text is understood.
std::vector<Tie> written_ties(const FitConfig& config) {
  std::vector<Tie> all;
  for (const FitTie& written : config.ties)
    if (const auto tie = parse_tie(written.key, written.follows)) all.push_back(*tie);
  return all;
}

// A key that the material does not have, with the closest one.
Complaint unknown(const std::string& at, const std::string& key,
                  const std::vector<MaterialParameter>& known) {
  std::vector<std::string> keys;
  std::string list;
  for (const MaterialParameter& k : known) {
    keys.push_back(k.key);
    append(list, ", ", k.key);
  }
  const std::string near = nearest(key, keys);
  return {at, "the material has no number \"" + key + "\"", "one of " + list, did_you_mean(near)};
}

// Checks one tie whose text is understood. `whole` is the same tie followed to the end of its
// chain.
void complain(const std::string& at, const Tie& tie, const Tie& whole, const FitConfig& config,
              const std::vector<MaterialParameter>& known, std::vector<Complaint>& all) {
  const auto number = [&](const std::string& key) {
    return std::ranges::find(known, key, &MaterialParameter::key);
  };
  const auto tied = number(tie.key);
  const auto of = number(tie.of);
  if (tied == known.end()) all.push_back(unknown(at + "key", tie.key, known));
  if (of == known.end()) all.push_back(unknown(at + "follows", tie.of, known));
  if (tied == known.end() || of == known.end()) return;
  if (tie.key == tie.of)
    return all.push_back({at + "follows", "\"" + tie.key + "\" tied to itself",
                          "another number of the material", ""});
  const std::vector<FreeParameter> free = free_parameters(config);
  if (std::any_of(free.begin(), free.end(),
                  [&](const FreeParameter& p) { return p.key == tie.key; }))
    return all.push_back({at + "key",
                          "\"" + tie.key + "\" is tied and also among the parameters to find",
                          "one of the two", "bounds belong to " + tie.of + ", which it follows"});
  if (tied->unit != of->unit)
    return all.push_back(
        {at + "follows",
         fmt::format("{} in {} tied to {} in {}", tie.key, tied->unit, tie.of, of->unit),
         "numbers of one unit", ""});
  const auto root = std::ranges::find(free, whole.of, &FreeParameter::key);
  const auto source = number(whole.of);
  if (source == known.end()) return;
  double from = *source->value;
  double to = from;
  if (root != free.end()) {
    from = root->lower;
    to = root->upper;
  }
  for (const double end : {whole.factor * from + whole.offset, whole.factor * to + whole.offset})
    if (end < tied->range.low || end > tied->range.high ||
        (end == tied->range.low && !tied->range.low_included))
      return all.push_back(
          {at + "follows",
           fmt::format("{} would be {} where {} is {}", tie.key, number_text(end), whole.of,
                       number_text(whole.factor != 0 ? (end - whole.offset) / whole.factor : from)),
           fmt::format("between {} and {}, as the material model requires",
                       number_text(tied->range.low), number_text(tied->range.high)),
           "other bounds of " + whole.of + ", or another factor"});
}

// Viscous materials need times and incompressible tests.
void complain_about_time(const FitConfig& config, std::vector<Complaint>& all) {
  if (config.dilatation == Dilatation::compressible)
    all.push_back({"dilatation", "compressible, and a viscous material", "incompressible", ""});
  for (std::size_t i = 0; i < config.data.size(); ++i)
    if (const auto& columns = config.data[i].columns; !config.data[i].is_scene() &&
                                                      !config.data[i].is_wave() &&
                                                      (!columns || columns->time.empty()))
      all.push_back({fmt::format("data[{}].columns.time", i),
                     "missing, and the material is viscous", "the column of times in s",
                     "columns: {time: t_s, strain_x: ..., stress_x: ...}"});
}

// Options that a fit with scenes or waves does not have.
void complain_about_scenes(const FitConfig& config, std::vector<Complaint>& all) {
  const std::string what = config.has_scenes() ? "scenes" : "waves";
  if (config.cross_check != SecondAnswer::none)
    all.push_back(
        {"cross_check", "found in a fit with " + what, "none", "it takes thousands of runs"});
  if (config.dilatation == Dilatation::compressible)
    all.push_back({"dilatation", "compressible, in a fit with " + what, "incompressible",
                   config.has_scenes() ? "scenes count the volume term anyway" : ""});
  if (config.noise_model != NoiseKind::automatic && config.noise_model != NoiseKind::white)
    all.push_back({"noise",
                   std::string("found ") +
                       names(config.noise_model)[static_cast<int>(config.noise_model)] +
                       " in a fit with " + what,
                   "auto or white", "the noise of " + what + " is their standard_deviation"});
  if (config.leave_one_out)
    all.push_back({"leave_one_out", "true, in a fit with " + what, "false",
                   "a fit to some of the tests alone needs a config of its own"});
  for (std::size_t i = 0; i < config.data.size(); ++i) {
    const FitData& data = config.data[i];
    if (!data.is_scene() && !data.is_wave() && data.weight)
      all.push_back({fmt::format("data[{}].weight", i), "found in a fit with " + what,
                     "standard_deviation, which makes different units comparable", ""});
  }
}

// A fit has further tests of one kind.
void complain_about_waves_with_scenes(const FitConfig& config, std::vector<Complaint>& all) {
  for (std::size_t i = 0; i < config.data.size(); ++i) {
    if (!config.data[i].is_wave()) continue;
    all.push_back({fmt::format("data[{}].kind", i), "wave, in a fit with scenes",
                   "waves and homogeneous tests, or scenes and homogeneous tests", ""});
  }
}

// Checks all ties: text, duplicates, circles, then each one alone.
void complain_about_ties(const FitConfig& config, const std::vector<MaterialParameter>& known,
                         std::vector<Complaint>& all) {
  const std::vector<Tie> written = written_ties(config);
  const ResolvedTies whole = resolved(written);
  const auto itself = [](const Tie& t) {
    return t.key == t.of;
  };
  const bool circle = !whole.circle.empty() && std::none_of(written.begin(), written.end(), itself);
  std::set<std::string> seen;
  for (std::size_t i = 0, understood = 0; i < config.ties.size(); ++i) {
    const FitTie& one = config.ties[i];
    const std::string at = fmt::format("ties[{}].", i);
    if (!seen.insert(one.key).second)
      all.push_back({at + "key", "\"" + one.key + "\" a second time", "each number once", ""});
    if (!parse_tie(one.key, one.follows)) {
      all.push_back(
          {at + "follows", "found \"" + one.follows + "\"",
           "a number of the material, with a sign, a factor or an offset",
           "such as fibres[0].alpha, -fibres[0].alpha, 0.5 * fibres[0].hgo.c1 or fibres[0].alpha + 90"});
      continue;
    }
    if (!circle)
      complain(at, written[understood], whole.ties[understood], config, known, all);
    else if (one.key == whole.circle)
      all.push_back({at + "follows", "\"" + one.key + "\" follows itself through the other ties",
                     "ties that end at a number without one", ""});
    ++understood;
  }
}

}  // namespace

std::vector<Tie> ties_of(const FitConfig& config) {
  const ResolvedTies whole = resolved(written_ties(config));
  if (whole.circle.empty()) return whole.ties;
  return std::vector<Tie>();
}

// Checks the parameters: known keys, bounds within the range of the model, a start within the
// bounds.
std::vector<Complaint> FitConfig::complaints() const {
  std::vector<Complaint> all = comparison_complaints(*this);
  if (data.empty()) all.push_back({"data", "missing", "one test at least", ""});
  if (law.matrix.empty() && all.empty())
    all.push_back({"law", "missing",
                   "a map (energy terms, fibre angles and the numbers that are not "
                   "fitted)",
                   "or laws: [yeoh, hgo_yeoh, goh]"});
  if (parameters.empty() && all.empty())
    all.push_back({"parameters", "an empty list", "one number to find at least", ""});
  if (dilatation == Dilatation::compressible)
    for (std::size_t i = 0; i < data.size(); ++i)
      if (!data[i].is_scene() && !data[i].is_wave() &&
          (data[i].kind != DataKind::uniaxial || data[i].shear == OffAxisShear::free ||
           data[i].fibre_angle != 0))
        all.push_back(
            {"data[" + std::to_string(i) + "].kind",
             "a test whose state is solved without change of volume",
             "uniaxial tests with held shear and no fibre_angle, or dilatation: incompressible",
             ""});
  if (is_viscous(law)) complain_about_time(*this, all);
  Material copy = law;
  const std::vector<MaterialParameter> known = langer::parameters(copy);
  std::vector<std::string> keys;
  for (const MaterialParameter& k : known) keys.push_back(k.key);
  const std::vector<FreeParameter> free = free_parameters(*this);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FitParameter& p = parameters[i];
    const std::string at = "parameters[" + std::to_string(i) + "].";
    const auto found = std::find(keys.begin(), keys.end(), p.key);
    const auto number = scene_number(*this, p.key);
    if (found == keys.end() && !number) {
      all.push_back(unknown(at + "key", p.key, known));
      if (has_waves())
        all.back().expected +=
            ", data[i].prestretch.along, data[i].prestretch.across of a wave test";
      if (has_scenes())
        all.back().expected +=
            ", contacts.<name>.friction, data[i].touch_offset, data[i].force_offset, data[i].compliance, data[i].fibre_angle of a scene, or a number of its config such as "
            "mesh.bodies[0].thickness";
      continue;
    }
    if (!seen.insert(p.key).second)
      all.push_back({at + "key", "\"" + p.key + "\" a second time", "each number once", ""});
    if (bounds == Bounds::custom && !(p.lower && p.upper)) {
      all.push_back({at + (p.lower ? "upper" : "lower"), "missing", "a bound",
                     "or bounds: paper, bounds: admissible"});
      continue;
    }
    const double lower = free[i].lower;
    const double upper = free[i].upper;
    // what the scene gives is checked where the scene has been read
    if (std::isnan(lower) || std::isnan(upper)) continue;
    const bool stretches = number && (number->of == SceneNumber::Of::stretch_along ||
                                      number->of == SceneNumber::Of::stretch_across);
    const bool from_zero = number && (number->of == SceneNumber::Of::friction ||
                                      number->of == SceneNumber::Of::compliance);
    Range range;
    if (!number) {
      range = known[static_cast<std::size_t>(found - keys.begin())].range;
    } else if (from_zero) {
      range = at_least(0);
    } else if (stretches) {
      range = positive;
    }
    if (!(lower < upper)) {
      all.push_back({at + (p.upper ? "upper" : "key"), "found " + number_text(upper),
                     "more than lower, " + number_text(lower), ""});
      continue;
    }
    if (lower < range.low || (lower == range.low && !range.low_included))
      all.push_back({at + "lower", "found " + number_text(lower),
                     std::string("a number ") + (range.low_included ? ">= " : "> ") +
                         number_text(range.low) + ", as the material model requires",
                     ""});
    if (upper > range.high)
      all.push_back({at + "upper", "found " + number_text(upper),
                     "a number <= " + number_text(range.high) + ", as the material model requires",
                     ""});
    if (free[i].start < lower || free[i].start > upper)
      all.push_back(
          {at + (p.start ? "start" : "key"), "starts at " + number_text(free[i].start),
           "a value between " + number_text(lower) + " and " + number_text(upper),
           p.start ? "" : "the start is the material's own value unless `start` is given"});
  }
  complain_about_ties(*this, known, all);
  if (has_scenes() || has_waves()) complain_about_scenes(*this, all);
  if (has_scenes() && has_waves()) complain_about_waves_with_scenes(*this, all);
  return all;
}

namespace {

// The greatest secant modulus of the tests, over points of at least a tenth of the largest strain
// [MPa].
double greatest_secant(const std::vector<Test>& tests) {
  double greatest = 0;
  for (const Test& test : tests) {
    const auto strain = [&](std::size_t i) {
      return std::abs(strain_of(test.kind, test.first[i]));
    };
    double most = 0;
    for (std::size_t i = 0; i < test.points(); ++i) most = std::max(most, strain(i));
    for (std::size_t i = 0; i < test.points(); ++i)
      if (strain(i) > 0 && strain(i) >= 0.1 * most)
        greatest = std::max(greatest, std::abs(test.stress_x[i]) / strain(i));
  }
  return greatest;
}

}  // namespace

// The numerical problem of a config. Upper bounds of moduli grow for stiff tests.
FitProblem fit_problem(const FitConfig& config) {
  FitProblem problem{config.law, free_parameters(config), measured_tests(config), config.dilatation,
                     ties_of(config)};
  problem.noise = config.noise_model;
  if (config.has_scenes() || config.has_waves()) problem.noise = NoiseKind::white;
  if (config.bounds == Bounds::custom) return problem;
  const double secant = 3 * greatest_secant(problem.tests);
  Material law = config.law;
  const std::vector<MaterialParameter> known = parameters(law);
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    FreeParameter& free = problem.free[i];
    const auto found = std::ranges::find(known, free.key, &MaterialParameter::key);
    if (found != known.end() && found->unit == std::string(unit::MPa) &&
        !config.parameters[i].upper && free.upper > 0)
      free.upper = std::max(free.upper, std::min(secant, found->range.high));
  }
  return problem;
}

}  // namespace langer
