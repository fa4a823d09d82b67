#include "identification/inverse/scene_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/base/in_order.hpp"
#include "core/base/stopwatch.hpp"
#include "results/store/identity.hpp"
#include "scene/model/config_number.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {

// The key of a cached run: everything that decides its result, hashed.
std::string key_of(const ForwardRun& run, const ForwardInput& input, const std::string& looks) {
  std::string text = to_yaml(run.config_at(input)) + looks;
  for (const std::string& key : input.slopes) text += key + "\n";
  // a thickness moves the mesh, of which the config says nothing
  for (const auto& [path, value] : input.numbers) text += fmt::format("{} {}\n", path, value);
  return fnv1a(text);
}

}  // namespace

// Material, friction and requested derivatives at the parameters p.
ForwardInput SceneTests::input_at(const VecX& p, std::size_t scene) const {
  ForwardInput input{with_parameters(law_, p), {}, {}};
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const double value = p[static_cast<Eigen::Index>(i)];
    const std::string& path = numbers_[i].path;
    if (!numbers_[i].contact.empty()) input.friction[numbers_[i].contact] = value;
    if (!path.empty() && scenes_[scene].run->number(path)) input.numbers[path] = value;
  }
  if (const auto angle = scenes_[scene].angle)
    input.fibre_angle = p[static_cast<Eigen::Index>(*angle)];
  if (options_.quotients) return input;
  for (const Slope& slope : slopes_) input.slopes.push_back(slope.key);
  return input;
}

// Returns the runs of all wanted inputs. Cached runs are reused, missing ones are made in parallel.
// A run that fails counts as a path without an end if its scene had an end before: then the trial
// parameters are the cause.
std::vector<SceneTests::Path> SceneTests::solved(const std::vector<Wanted>& wanted) {
  std::vector<Path> paths(wanted.size());
  std::vector<std::string> keys;
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Wanted& one = wanted[i];
    keys.push_back(key_of(*scenes_[one.scene].run, one.input, scenes_[one.scene].observed));
    paths[i] = cache_->find(keys[i]);
    if (!paths[i]) missing.push_back(i);
  }
  const double begun = cpu_seconds();
  in_order(
      std::min(options_.jobs, static_cast<int>(missing.size())), static_cast<int>(missing.size()),
      [&](int, int k) {
        const std::size_t i = missing[static_cast<std::size_t>(k)];
        const Wanted& one = wanted[i];
        ForwardPath path;
        try {
          path = scenes_[one.scene].run->solve(one.input);
        } catch (const Failure& failure) {
          const bool of_trial =
              failure.code() == Exit::config || failure.code() == Exit::not_converged;
          if (!of_trial || !scenes_[one.scene].solvable)
            throw;  // a scene that never was, or a signal
          path.why = failure.what();
        }
        paths[i] = cache_->keep(keys[i], std::move(path));
      },
      [](int, int) {});
  effort_.runs += static_cast<int>(missing.size());
  effort_.seconds += cpu_seconds() - begun;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (paths[i]->complete) scenes_[wanted[i].scene].solvable = true;
  return paths;
}

// The runs of all scenes at p. Returns false, and keeps the reason, if one does not reach its end.
bool SceneTests::paths_at(const VecX& p, std::vector<Path>& paths) {
  std::vector<Wanted> wanted;
  for (std::size_t scene = 0; scene < scenes_.size(); ++scene)
    wanted.push_back({scene, input_at(p, scene)});
  paths = solved(wanted);
  for (const Path& path : paths)
    if (!path->complete) {
      effort_.failure = path->why;
      return false;
    }
  return true;
}

void SceneTests::run_ahead(const std::vector<VecX>& p) {
  std::vector<Wanted> wanted;
  for (const VecX& one : p)
    for (std::size_t scene = 0; scene < scenes_.size(); ++scene)
      wanted.push_back({scene, input_at(one, scene)});
  solved(wanted);
}

// A quantity of the instrument: the free parameter if there is one, else the value of the config.
double SceneTests::measured_by(const SceneTest& test, SceneNumber::Of of, const VecX& p) const {
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    if (const auto& number = numbers_[i].measured;
        number && number->data == test.data && number->of == of)
      return p[static_cast<Eigen::Index>(i)];
  const FitData& data = config_.data[test.data];
  if (of == SceneNumber::Of::touch_offset) return data.touch_offset;
  if (of == SceneNumber::Of::force_offset) return data.force_offset;
  return data.compliance;
}

// Reads a run as the instrument would: s_path = s_read - touch_offset - compliance (F_read -
// force_offset) is the travel of the scene at each row, and the observations are interpolated
// there. Rows before the beginning of the path are at rest. Returns false if a row is too far
// beyond the end.
bool SceneTests::read(const SceneTest& test, const ForwardPath& path, const MatX& of, const VecX& p,
                      Read what, VecX& out) const {
  const double touch = measured_by(test, SceneNumber::Of::touch_offset, p);
  const double force = measured_by(test, SceneNumber::Of::force_offset, p);
  const double compliance = measured_by(test, SceneNumber::Of::compliance, p);
  const auto rows = static_cast<Eigen::Index>(test.s.size());
  out = VecX::Zero(test.measured.size());
  for (Eigen::Index row = 0; row < rows; ++row) {
    std::size_t piece = test.stretch[static_cast<std::size_t>(row)];
    double read = 0;
    if (compliance != 0) read = test.measured[test.force + row] - force;
    const double s = test.s[static_cast<std::size_t>(row)] - touch - compliance * read;
    const auto t = test.over.find(s, piece, beyond_path);
    const bool before = piece == 0 && (s - test.over.s[0]) * (test.over.s[1] - test.over.s[0]) <= 0;
    if (!t && !before) return false;
    if (before) continue;  // at rest
    const PathPlace place = place_on(path.t, test.kinks, *t);
    if (!place.exists) return false;
    for (const SceneCurve& curve : test.curves) {
      // a curve has one observation, or one for each place that was measured
      std::size_t which = 0;
      if (curve.observation.size() > 1) which = static_cast<std::size_t>(row);
      const auto column = static_cast<Eigen::Index>(curve.observation[which]);
      const auto& states = what == Read::rate ? place.rate : place.value;
      double sum = 0;
      for (const auto& [state, weight] : states) sum += weight * of(state, column);
      if (what == Read::rate) {
        out[curve.first + row] = sum * test.over.rate(piece);
      } else {
        out[curve.first + row] = sum;
      }
    }
  }
  return true;
}

// All values of all scenes at p. The force offset is added to forces.
bool SceneTests::model(const VecX& p, VecX& values) {
  std::vector<Path> paths;
  if (!paths_at(p, paths)) return false;
  values.resize(observed_.measured.size());
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    const SceneTest& test = tests_[i];
    VecX of_test;
    const ForwardPath& path = *paths[test.run];
    if (!read(test, path, path.values, p, Read::values, of_test)) {
      effort_.failure = fmt::format("the path of {} ends before what {} measured, at these offsets",
                                    config_.data[test.data].solve.path, test.name);
      return false;
    }
    const double offset = measured_by(test, SceneNumber::Of::force_offset, p);
    for (const SceneCurve& curve : test.curves)
      if (curve.unit == "N")
        of_test.segment(curve.first, static_cast<Eigen::Index>(test.s.size())).array() += offset;
    values.segment(observed_.first[i], of_test.size()) = of_test;
  }
  if (options_.say)
    options_.say(
        fmt::format("run {}: chi-square {:.6g}", effort_.runs,
                    observed_.weight.cwiseProduct(values - observed_.measured).squaredNorm()));
  return true;
}

// The Jacobian: columns of material numbers and friction from the runs, those of the instrument
// from the rate of the observations along the path.
bool SceneTests::slope(const VecX& p, MatX& J) {
  std::vector<Path> paths;
  if (!paths_at(p, paths)) return false;
  J = MatX::Zero(observed_.measured.size(), p.size());
  bool exists = false;
  if (options_.quotients) {
    exists = add_difference_quotients(p, paths, true, J);
  } else {
    exists = add_path_sensitivities(p, paths, J) && add_difference_quotients(p, paths, false, J);
  }
  if (!exists) return false;
  add_instrument_columns(p, paths, J);
  return true;
}

// Columns from the derivatives that the runs computed themselves. A number that follows a parameter
// by a tie adds its factor times its own derivative.
bool SceneTests::add_path_sensitivities(const VecX& p, const std::vector<Path>& paths,
                                        MatX& J) const {
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    const ForwardPath& path = *paths[tests_[i].run];
    for (std::size_t k = 0; k < slopes_.size(); ++k) {
      VecX column;
      if (!read(tests_[i], path, path.slopes[k], p, Read::values, column)) return false;
      for (const SlopeOf& of : slopes_[k].of)
        if (!of.scene || *of.scene == tests_[i].run)
          J.block(observed_.first[i], static_cast<Eigen::Index>(of.number), column.size(), 1) +=
              of.factor * column;
    }
  }
  return true;
}

// Columns from forward differences: one more run of each scene for each number. The step goes to
// the other side if it would leave the box.
bool SceneTests::add_difference_quotients(const VecX& p, const std::vector<Path>& paths, bool all,
                                          MatX& J) {
  std::vector<Wanted> wanted;
  std::vector<std::pair<std::size_t, double>> steps;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    if (numbers_[i].measured || !(all || numbers_[i].quotient)) continue;
    const FreeParameter& free = law_.free[i];
    const auto k = static_cast<Eigen::Index>(i);
    double width = free.upper - free.lower;
    if (free.unit == unit::deg || width == 0) width = 1;
    const double size = std::max(std::abs(p[k]), 1e-3 * width);
    // the active set of friction needs longer steps
    double h = 1e-4 * size;
    if (with_friction_) h = 1e-3 * size;
    if (p[k] + 1e-3 * size > free.upper) h = -h;
    VecX moved = p;
    moved[k] += h;
    steps.push_back({i, moved[k] - p[k]});
    for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
      wanted.push_back({scene, input_at(moved, scene)});
      if (!all) wanted.back().input.slopes.clear();
    }
  }
  if (wanted.empty()) return true;
  const std::vector<Path> moved = solved(wanted);
  for (std::size_t step = 0; step < steps.size(); ++step)
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      const SceneTest& test = tests_[i];
      const ForwardPath& path = *paths[test.run];
      const ForwardPath& other = *moved[step * scenes_.size() + test.run];
      VecX here, there;
      if (!other.complete || !read(test, path, path.values, p, Read::values, here) ||
          !read(test, other, other.values, p, Read::values, there))
        return false;
      J.block(observed_.first[i], static_cast<Eigen::Index>(steps[step].first), here.size(), 1) =
          (there - here) / steps[step].second;
    }
  return true;
}

// Columns of touch offset, force offset and compliance by the chain rule, with the rate dF/ds of
// each observation at the row.
void SceneTests::add_instrument_columns(const VecX& p, const std::vector<Path>& paths,
                                        MatX& J) const {
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    for (std::size_t k = 0; k < tests_.size(); ++k) {
      const SceneTest& test = tests_[k];
      if (!numbers_[i].measured || numbers_[i].measured->data != test.data) continue;
      VecX column;
      // where it is not, the model is not there either
      if (instrument_column(test, numbers_[i].measured->of, p, *paths[test.run], column))
        J.block(observed_.first[k], static_cast<Eigen::Index>(i), column.size(), 1) = column;
    }
}

// What touch offset, force offset or compliance of one test changes of its values.
bool SceneTests::instrument_column(const SceneTest& test, SceneNumber::Of of, const VecX& p,
                                   const ForwardPath& path, VecX& column) const {
  VecX rate;
  if (!read(test, path, path.values, p, Read::rate, rate)) return false;
  column = VecX::Zero(rate.size());
  const auto rows = static_cast<Eigen::Index>(test.s.size());
  const double compliance = measured_by(test, SceneNumber::Of::compliance, p);
  const double force = measured_by(test, SceneNumber::Of::force_offset, p);
  switch (of) {
    case SceneNumber::Of::touch_offset:
      column = -rate;
      break;
    case SceneNumber::Of::force_offset:
      column = compliance * rate;
      for (const SceneCurve& curve : test.curves)
        if (curve.unit == "N") column.segment(curve.first, rows).array() += 1;
      break;
    default:
      for (const SceneCurve& curve : test.curves)
        column.segment(curve.first, rows) =
            -rate.segment(curve.first, rows)
                 .cwiseProduct((test.measured.segment(test.force, rows).array() - force).matrix());
  }
  return true;
}

// Offsets and compliances of tests of a force over the travel of its indenter.
void SceneTests::add_held_of_instruments(const VecX& p, const std::vector<Path>& paths,
                                         std::vector<HeldNumber>& held) const {
  const auto is_free = [&](const SceneTest& test, SceneNumber::Of of) {
    return std::any_of(numbers_.begin(), numbers_.end(), [&](const Number& number) {
      return number.measured && number.measured->data == test.data && number.measured->of == of;
    });
  };
  for (std::size_t k = 0; k < tests_.size(); ++k) {
    const SceneTest& test = tests_[k];
    const bool force = std::any_of(test.curves.begin(), test.curves.end(),
                                   [](const SceneCurve& c) { return c.unit == "N"; });
    if (!force || test.over.key != "u_ind") continue;
    for (const auto& [word, unit, of] :
         {std::tuple("touch_offset", "mm", SceneNumber::Of::touch_offset),
          std::tuple("force_offset", "N", SceneNumber::Of::force_offset),
          std::tuple("compliance", "mm/N", SceneNumber::Of::compliance)}) {
      VecX column;
      if (is_free(test, of) || !instrument_column(test, of, p, *paths[test.run], column)) continue;
      HeldNumber one{fmt::format("data[{}].{}", test.data, word), unit, measured_by(test, of, p),
                     VecX::Zero(observed_.measured.size())};
      one.slope.segment(observed_.first[k], column.size()) = column;
      held.push_back(std::move(one));
    }
  }
}

std::vector<HeldNumber> SceneTests::held_numbers(const VecX& p) {
  std::vector<HeldNumber> held;
  std::vector<Path> paths;
  if (options_.quotients || !paths_at(p, paths)) return held;
  add_held_of_instruments(p, paths, held);
  constexpr double trial_friction = 0.05;
  std::map<std::string, std::size_t> known;
  for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
    ForwardInput input = input_at(p, scene);
    input.slopes.clear();
    std::vector<std::pair<std::string, ForwardInput>> frictionless;
    for (const std::string& path : scenes_[scene].run->uncertain_numbers()) {
      if (std::ranges::find(law_.free, path, &FreeParameter::key) != law_.free.end()) continue;
      const double value = *scenes_[scene].run->number(path);
      if (path.ends_with(".friction") && value == 0) {
        ForwardInput rough = input;
        rough.friction[path.substr(9, path.rfind('.') - 9)] = trial_friction;
        frictionless.emplace_back(path, rough);
      } else if (scenes_[scene].run->differentiates(path, input.law)) {
        input.slopes.push_back(path);
      }
    }
    std::vector<Wanted> wanted;
    if (!input.slopes.empty()) wanted.push_back({scene, input});
    for (const auto& [path, rough] : frictionless) wanted.push_back({scene, rough});
    const std::vector<Path> runs = solved(wanted);
    // the values of all tests of this scene, read from a run as those of the fit are
    const auto add = [&](const std::string& path, const ForwardPath& run, const MatX& of,
                         double factor, const ForwardPath* less) {
      const auto [at, is_new] = known.insert({path, held.size()});
      if (is_new)
        held.push_back({path, unit_of_config_number(path), *scenes_[scene].run->number(path),
                        VecX::Zero(observed_.measured.size())});
      for (std::size_t k = 0; k < tests_.size(); ++k) {
        if (tests_[k].run != scene) continue;
        VecX column, before;
        if (!read(tests_[k], run, of, p, Read::values, column)) continue;
        if (less && !read(tests_[k], *less, less->values, p, Read::values, before)) continue;
        if (less) column -= before;
        held[at->second].slope.segment(observed_.first[k], column.size()) += factor * column;
      }
    };
    std::size_t next = 0;
    if (!input.slopes.empty()) {
      const ForwardPath& run = *runs[next++];
      for (std::size_t k = 0; run.complete && k < input.slopes.size(); ++k)
        add(input.slopes[k], run, run.slopes[k], 1, nullptr);
    }
    for (const auto& [path, rough] : frictionless) {
      const ForwardPath& run = *runs[next++];
      if (run.complete) add(path, run, run.values, 1 / trial_friction, &*paths[scene]);
    }
  }
  return held;
}

// Sentences about tests that were read beyond the end of a path at the fitted offsets.
std::vector<std::string> SceneTests::extrapolations(const VecX& p) const {
  std::vector<std::string> lines;
  for (const SceneTest& test : tests_) {
    const double touch = measured_by(test, SceneNumber::Of::touch_offset, p);
    const double force = measured_by(test, SceneNumber::Of::force_offset, p);
    const double compliance = measured_by(test, SceneNumber::Of::compliance, p);
    double farthest = 1;
    for (std::size_t row = 0; row < test.s.size(); ++row) {
      double s = test.s[row] - touch;
      if (compliance != 0)
        s -= compliance * (test.measured[test.force + static_cast<Eigen::Index>(row)] - force);
      std::size_t piece = test.stretch[row];
      const auto t = test.over.find(s, piece, beyond_path);
      if (t) farthest = std::max(farthest, *t);
    }
    if (farthest > 1 + 1e-6)
      lines.push_back(fmt::format(
          "{} was read up to {:.2g} % beyond the end of the path of {}, which is extrapolated: a longer motion "
          "there is safer",
          test.name, 100 * (farthest - 1), config_.data[test.data].solve.path));
  }
  return lines;
}

// Measured and computed curves of all tests, for the report.
std::vector<FittedCurve> SceneTests::fitted(const VecX& values) const {
  std::vector<FittedCurve> all;
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    const SceneTest& test = tests_[i];
    for (const SceneCurve& curve : test.curves) {
      std::string name = test.name;
      if (test.curves.size() > 1) name += "_" + curve.key;
      FittedCurve one{
          std::move(name), curve.key, curve.unit, test.over.key, test.over.unit, test.deviation,
          test.s,          {},        {},         test.places};
      const auto rows = static_cast<Eigen::Index>(test.s.size());
      const VecX measured = test.measured.segment(curve.first, rows);
      const VecX model = values.segment(observed_.first[i] + curve.first, rows);
      one.measured.assign(measured.data(), measured.data() + rows);
      one.model.assign(model.data(), model.data() + rows);
      for (Vec3& place : one.places)
        if (std::isnan(place[1])) place[1] = scenes_[test.run].top;
      all.push_back(std::move(one));
    }
  }
  return all;
}

}  // namespace langer
