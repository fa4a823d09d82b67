// How the scenes of a fit come from its config.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "accuracy/refinement/accuracy.hpp"
#include "identification/inverse/refuse.hpp"
#include "identification/inverse/scene_fit.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {

// The solve config of an item of `data` with its mesh.
Loaded<SolveConfig> scene_config(const FitData& data, std::size_t item,
                                 const SceneTests::Where& where) {
  const std::string at = fmt::format("data[{}].", item);
  Tree tree = load_yaml(data.solve.path);
  if (!data.mesh.path.empty()) {
    if (tree.find("mesh"))
      throw Failure(Exit::config, Error{where(at + "mesh"), at + "mesh",
                                        "found together with the mesh in " + data.solve.path,
                                        "one of the two", ""});
    set_value(tree, "mesh", load_yaml(data.mesh.path));
  }
  Loaded<SolveConfig> loaded = read_config<SolveConfig>(std::move(tree));
  refuse_several_bodies(loaded.config, where, at + "solve", data.solve.path);
  if (!loaded.config.mesh)
    throw Failure(Exit::config,
                  Error{where(at + "solve"), at + "solve", data.solve.path + " has no mesh",
                        "the key mesh there, or here", "mesh: ../mesh/indentation.yaml"});
  return loaded;
}

// Where increments end: at measured values that are at least half the largest increment apart. A
// force-controlled indenter begins with an infinite slope of travel over force, which no polynomial
// follows: there all measured values are used.
std::vector<double> stops_of(const std::vector<const SceneTest*>& tests, const FitConfig& config,
                             double largest) {
  constexpr double apart = 0.499;
  std::map<double, double> places;  // with the room that they need
  std::set<double> kept;
  for (const SceneTest* test : tests) {
    for (std::size_t row = 0; row < test->s.size(); ++row) {
      const double s = test->s[row];
      std::size_t piece = test->stretch[row];
      double offset = 0;
      if (test->over.key == "u_ind") offset = config.data[test->data].touch_offset;
      const auto t = test->over.find(s - offset, piece, SceneTests::beyond_path);
      if (!t || *t <= 0 || *t >= 1) continue;
      double room = apart * largest;
      if (test->over.key == "force" && *t < 2 * largest) room = 1e-3 * largest;
      places.insert({*t, room});
    }
    kept.insert(test->kinks.begin(), test->kinks.end());
  }
  std::vector<double> stops;
  for (const auto& [t, needed] : places) {
    const auto behind = kept.lower_bound(t);
    double room = 1;
    if (behind != kept.end()) room = *behind - t;
    double before = t;
    if (behind != kept.begin()) before = t - *std::prev(behind);
    room = std::min(room, before);
    if (room < needed) continue;
    stops.push_back(t);
    kept.insert(t);
  }
  return stops;
}

// What is observed of a run, and where, as a part of the key of its cache.
std::string looks_of(const std::vector<Observation>& observations,
                     const std::vector<double>& stops) {
  std::string text;
  for (const Observation& one : observations)
    text += fmt::format("{} {} {} {} {}\n", static_cast<int>(one.of), one.axis, one.contact,
                        fmt::join(one.nodes, ","), fmt::join(one.weights, ","));
  return text + fmt::format("{}\n", fmt::join(stops, ","));
}

}  // namespace

SceneTests::SceneTests(const FitConfig& config, const Where& where, const FitProblem& problem,
                       const std::vector<std::string>& files, std::shared_ptr<RunCache> cache,
                       SceneFitOptions options, double longer)
    : config_(config),
      where_(where),
      files_(files),
      law_(problem),
      cache_(std::move(cache)),
      options_(std::move(options)) {
  law_.tests.clear();
  law_.further.reset();
  std::map<std::string, std::size_t> known;
  run_of_.assign(config_.data.size(), 0);
  for (std::size_t i = 0; i < config_.data.size(); ++i)
    if (config_.data[i].is_scene()) add_run(i, longer, known);
  for (const Scene& scene : scenes_)
    if (!scene.run->differentiates_itself(law_.law)) options_.quotients = true;
  add_tests();
  add_numbers();
}

std::shared_ptr<SceneTests> SceneTests::on_longer_cells(double factor) const {
  auto longer =
      std::make_shared<SceneTests>(config_, where_, law_, files_, cache_, options_, factor);
  return longer->any_longer_ ? longer : nullptr;
}

// items of one scene share its runs
void SceneTests::add_run(std::size_t item, double longer,
                         std::map<std::string, std::size_t>& known) {
  const FitData& data = config_.data[item];
  std::string scene_name =
      fmt::format("{}\n{}\n{}", data.solve.path, data.mesh.path, data.fibre_angle);
  if (free_angle(item)) scene_name += fmt::format("\nof item {}", item);
  const auto [at, is_new] = known.insert({scene_name, scenes_.size()});
  run_of_[item] = at->second;
  if (!is_new) return;
  Loaded<SolveConfig> loaded = scene_config(data, item, where_);
  SolveConfig& scene = loaded.config;
  Material law = law_.law;
  const auto is_free_angle = [this](const MaterialParameter& number) {
    return number.unit == unit::deg &&
           std::ranges::find(law_.free, number.key, &FreeParameter::key) != law_.free.end();
  };
  const bool angle_free = free_angle(item) || std::ranges::any_of(parameters(law), is_free_angle);
  if (!scene.fibre_angles.empty() && (angle_free || data.fibre_angle != 0))
    throw Failure(Exit::config,
                  Error{loaded.where("fibre_angles"), "fibre_angles",
                        "found, and would stand for the angles of the fit's law",
                        "none: the law's own angle, and fibre_angle of the item of data", ""});
  choose_accuracy(scene, law_.law);
  // an angle that is a parameter is not the one of the config
  const double angle = free_angle(item) ? 0 : data.fibre_angle;
  auto run = std::make_shared<ForwardRun>(scene, loaded.where, angle);
  if (longer != 1)
    if (const auto other = run->on_longer_cells(longer)) {
      run = std::make_shared<ForwardRun>(*other, loaded.where, angle);
      any_longer_ = true;
    }
  double top = 0;
  for (const Vec3& x : run->mesh().X) top = std::max(top, x[1]);
  with_friction_ = with_friction_ || has_friction(scene);
  scenes_.push_back({std::move(run), "", top, false, {}});
}

// Whether an offset or the compliance of an item of `data` is a free parameter.
bool SceneTests::offset_free(std::size_t item) const {
  return std::any_of(law_.free.begin(), law_.free.end(), [&](const FreeParameter& p) {
    const auto number = scene_number(config_, p);
    return number && number->data == item &&
           (number->of == SceneNumber::Of::touch_offset ||
            number->of == SceneNumber::Of::force_offset ||
            number->of == SceneNumber::Of::compliance);
  });
}

// Reads all files, defines their observations and stops, and collects measured values and weights.
void SceneTests::add_tests() {
  std::vector<std::vector<Observation>> observations(scenes_.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < config_.data.size(); ++i) {
    const FitData& data = config_.data[i];
    if (!data.is_scene()) continue;
    const std::string key = fmt::format("data[{}].file", i);
    if (data.file.path.empty() && next >= files_.size())
      throw Failure(Exit::config, Error{where_(key), key, "missing",
                                        "a measured file, or one given by --curves", ""});
    std::string file = data.file.path;
    if (data.file.path.empty()) file = files_[next++];
    const std::size_t run = run_of_[i];
    SceneData read = read_scene_data(data, file);
    if (data.file.path.empty() && data.name.empty()) read.name = fmt::format("scene_{}", i + 1);
    for (int n = 2; std::any_of(tests_.begin(), tests_.end(),
                                [&](const SceneTest& t) { return t.name == read.name; });
         ++n)
      read.name = fmt::format(
          "{}_{}", read.name.substr(0, read.name.find_last_not_of("_0123456789") + 1), n);
    double slack = 1e-6;  // part of the path by which values may lie beyond its end
    if (offset_free(i)) slack = beyond_path;
    tests_.push_back(scene_test(data, i, read, *scenes_[run].run, config_.noise(), slack, where_,
                                observations[run]));
    tests_.back().run = run;
  }
  // Each file of --curves must have an item of `data` that takes it.
  if (next < files_.size())
    throw Failure(Exit::config,
                  Error{where_("data"), "data", fmt::format("{} files by --curves", files_.size()),
                        fmt::format("{}, one for each scene without a file", next), ""});
  for (std::size_t run = 0; run < scenes_.size(); ++run) {
    std::vector<const SceneTest*> of_run;
    for (const SceneTest& test : tests_)
      if (test.run == run) of_run.push_back(&test);
    const std::vector<double> stops =
        stops_of(of_run, config_, scenes_[run].run->config().path.largest_increment());
    // cells that were lengthened do not stand in the config
    scenes_[run].observed = fmt::format("{} nodes\n", scenes_[run].run->mesh().n_nodes()) +
                            looks_of(observations[run], stops);
    scenes_[run].run->observe(observations[run], stops);
  }
  std::vector<double> measured, weight;
  for (const SceneTest& test : tests_) {
    observed_.first.push_back(static_cast<Eigen::Index>(measured.size()));
    measured.insert(measured.end(), test.measured.data(),
                    test.measured.data() + test.measured.size());
    weight.insert(weight.end(), static_cast<std::size_t>(test.measured.size()), 1 / test.deviation);
    for (std::size_t k = 0; k < test.curves.size(); ++k)
      observed_.curves.push_back(static_cast<Eigen::Index>(test.s.size()));
  }
  observed_.measured =
      Eigen::Map<const VecX>(measured.data(), static_cast<Eigen::Index>(measured.size()));
  observed_.weight =
      Eigen::Map<const VecX>(weight.data(), static_cast<Eigen::Index>(weight.size()));
}

// Finds out what each free parameter is for the scenes: a number of the material, friction of a
// contact, or a quantity of the instrument that the test can determine.
void SceneTests::add_numbers() {
  for (std::size_t i = 0; i < law_.free.size(); ++i) {
    const FreeParameter& p = law_.free[i];
    const std::string key = fmt::format("parameters[{}].key", i);
    Number one;
    const auto refuse = [&](std::string found, std::string expected) {
      throw Failure(Exit::config,
                    Error{where_(key), key, std::move(found), std::move(expected), ""});
    };
    if (const auto number = scene_number(config_, p)) {
      if (number->of == SceneNumber::Of::friction) {
        one.contact = number->contact;
        std::set<std::string> contacts;
        for (const Scene& scene : scenes_)
          for (const auto& [name, contact] : scene.run->config().contacts) contacts.insert(name);
        std::string expected = "none: no scene has an indenter";
        if (!contacts.empty()) expected = fmt::format("one of {}", fmt::join(contacts, ", "));
        if (!contacts.count(one.contact))
          refuse("no scene has a contact \"" + one.contact + "\"", expected);
        with_friction_ = true;
      } else if (number->of == SceneNumber::Of::of_config) {
        one.path = number->contact;
        numbers_.push_back(one);
        add_config_number(one.path, i, refuse);
        continue;
      } else if (number->of == SceneNumber::Of::fibre_angle) {
        const std::size_t run = run_of_[number->data];
        scenes_[run].angle = i;
        const auto& field = scenes_[run].run->config().fibre_field;
        if (field && !std::holds_alternative<FormulaField>(*field))
          refuse(p.key + " of a scene whose directions are read at points",
                 "directions by a formula: fibre_field: {formula: {alpha: ...}}");
        one.quotient = field.has_value();
        for (std::size_t family = 0; !field && family < law_.law.fibres.size(); ++family)
          add_slope(fmt::format("fibres[{}].alpha", family), i, 1, run);
      } else {
        one.measured = number;
        const auto test = std::ranges::find(tests_, number->data, &SceneTest::data);
        const bool force = std::any_of(test->curves.begin(), test->curves.end(),
                                       [](const SceneCurve& c) { return c.unit == "N"; });
        if (number->of != SceneNumber::Of::force_offset && test->over.key != "u_ind")
          refuse(p.key + " of a test that was not measured over u_ind",
                 "a test over the travel of its indenter");
        if (number->of != SceneNumber::Of::touch_offset && !force)
          refuse(p.key + " of a test without force", "a test of a force");
      }
    } else {
      add_slope(p.key, i, 1);
      for (const Tie& tie : law_.ties)
        if (tie.of == p.key) add_slope(tie.key, i, tie.factor);
    }
    if (!one.contact.empty()) add_slope(p.key, i, 1);
    numbers_.push_back(std::move(one));
  }
}

// Registers a number of the scene by which runs are differentiated, and the parameter that moves
// it.
void SceneTests::add_slope(const std::string& key, std::size_t number, double factor,
                           std::optional<std::size_t> scene) {
  auto known = std::ranges::find(slopes_, key, &Slope::key);
  if (known == slopes_.end()) known = slopes_.insert(slopes_.end(), Slope{key, {}});
  known->of.push_back({number, factor, scene});
}

bool SceneTests::free_angle(std::size_t item) const {
  return std::ranges::any_of(law_.free, [&](const FreeParameter& p) {
    const auto number = scene_number(config_, p);
    return number && number->of == SceneNumber::Of::fibre_angle && number->data == item;
  });
}

// A number of the config of one scene or more. It is refused where it decides at which travel or
// displacement a file was measured: then the rows would belong to other states.
void SceneTests::add_config_number(const std::string& path, std::size_t number,
                                   const std::function<void(std::string, std::string)>& refuse) {
  bool any = false;
  bool differentiated = true;
  for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
    const ForwardRun& run = *scenes_[scene].run;
    if (!run.number(path)) continue;
    any = true;
    if (const std::string why = run.reason_fixed(path); !why.empty())
      refuse(path + ": " + why, "a number that a scene can have otherwise");
    differentiated = differentiated && run.differentiates(path, law_.law);
  }
  if (!any) {
    std::string why = "no scene has it";
    for (const Scene& scene : scenes_)
      if (const std::string reason = scene.run->reason_fixed(path); !reason.empty()) why = reason;
    refuse(path + ": " + why,
           "a number of a scene, such as mesh.bodies[0].thickness or "
           "contacts.<name>.rigid.sphere.radius");
  }
  const bool of_motion =
      path.find(".motion[") != std::string::npos || path.find(".control.") != std::string::npos;
  for (const SceneTest& test : tests_) {
    const bool imposed = path.starts_with("loads[") &&
                         (test.over.key == "displacement" || test.over.key == "pressure");
    if (of_motion && (test.over.key == "u_ind" || test.over.key == "force"))
      refuse(path + " of a scene that was measured over " + test.over.key,
             "data[i].touch_offset or data[i].compliance");
    if (imposed)
      refuse(path + " of a scene that was measured over its " + test.over.key,
             "columns: {t: ...}, or another number");
  }
  if (differentiated) {
    add_slope(path, number, 1);
  } else {
    numbers_[number].quotient = true;
  }
}

void complete_scene_numbers(const FitConfig& config,
                            const std::function<Place(const std::string&)>& where,
                            FitProblem& problem) {
  std::vector<ForwardRun> runs;
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    FreeParameter& free = problem.free[i];
    const bool complete =
        std::isfinite(free.start) && std::isfinite(free.lower) && std::isfinite(free.upper);
    const auto number = scene_number(config, free);
    if (complete || !number || number->of != SceneNumber::Of::of_config) continue;
    if (runs.empty())
      for (std::size_t item = 0; item < config.data.size(); ++item)
        if (config.data[item].is_scene()) {
          Loaded<SolveConfig> loaded = scene_config(config.data[item], item, where);
          runs.emplace_back(loaded.config, loaded.where, 0.);
        }
    std::optional<double> value;
    for (const ForwardRun& run : runs)
      if (!value) value = run.number(free.key);
    if (!value) {
      const std::string key = fmt::format("parameters[{}].key", i);
      std::string why = runs.front().reason_fixed(free.key);
      throw Failure(Exit::config, Error{where(key), key, free.key + ": " + why,
                                        "a number of a scene, such as mesh.bodies[0].thickness or "
                                        "contacts.<name>.rigid.sphere.radius",
                                        ""});
    }
    if (!std::isfinite(free.start)) free.start = *value;
    double low = std::min(0.5 * free.start, 2 * free.start);
    double high = std::max(0.5 * free.start, 2 * free.start);
    if (free.start == 0) {
      low = -1;
      high = 1;
    }
    const auto& prior = config.parameters[i].prior;
    if (prior && prior->normal) {
      low = std::min(low, (*prior->normal)[0] - 6 * (*prior->normal)[1]);
      high = std::max(high, (*prior->normal)[0] + 6 * (*prior->normal)[1]);
      if (*value > 0) low = std::max(low, 0.01 * *value);
    }
    if (!std::isfinite(free.lower)) free.lower = low;
    if (!std::isfinite(free.upper)) free.upper = high;
    if (free.start < free.lower || free.start > free.upper) {
      const std::string key = fmt::format("parameters[{}].start", i);
      throw Failure(Exit::config,
                    Error{where(key), key, fmt::format("starts at {:g}", free.start),
                          fmt::format("between {:g} and {:g}", free.lower, free.upper), ""});
    }
  }
}

}  // namespace langer
