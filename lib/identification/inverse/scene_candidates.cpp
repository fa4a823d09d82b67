#include "identification/inverse/scene_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "accuracy/refinement/accuracy.hpp"
#include "core/base/in_order.hpp"
#include "core/base/interrupt.hpp"
#include "core/base/text.hpp"
#include "identification/inverse/forward_run.hpp"
#include "identification/inverse/refuse.hpp"
#include "mechanics/material/ties.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {

// One variant of a candidate scene: values of the keys that `vary` names.
struct Setting {
  std::vector<std::pair<std::string, double>> values;
  std::string words;  // "radius 2.5, fibre_angle 90"
};

// All combinations of the values of `vary`.
std::vector<Setting> settings_of(const CandidateChoice& choice) {
  std::vector<Setting> all{{}};
  for (const CandidateValues& one : choice.vary) {
    std::string name;
    if (one.key.find("to[") != std::string::npos) {
      name = one.key;
    } else {
      name = one.key.substr(one.key.find_last_of('.') + 1);
    }
    std::vector<Setting> longer;
    for (const Setting& before : all)
      for (const double value : one.values) {
        Setting next = before;
        next.values.push_back({one.key, value});
        append(next.words, ", ", fmt::format("{} {:g}", name, value));
        longer.push_back(std::move(next));
      }
    all = std::move(longer);
  }
  return all;
}

// The numbers by which a scene is differentiated, and for each the parameter that moves it.
struct Slopes {
  std::vector<std::string> keys;
  std::vector<std::pair<Eigen::Index, double>> of;  // parameter, factor
};

// A candidate scene: it is solved at the fitted parameters, and its Jacobian tells what it would
// add to the information of the data.
class SceneOf {
 public:
  SceneOf(const FitConfig& config, const FitProblem& problem, const FitResult& fit,
          const FindPlace& where, std::size_t candidate)
      : config_(config),
        problem_(problem),
        fit_(fit),
        where_(where),
        choice_(config.study->candidates[candidate]),
        at_(fmt::format("study.candidates[{}].", candidate)) {}

  // (values, parameters), each row over its standard deviation; nothing where the scene has no end
  std::optional<MatX> slopes(const Setting& setting, std::string& why) const {
    double angle = choice_.fibre_angle;
    const Loaded<SolveConfig> loaded = scene(setting, angle);
    SolveConfig scene = loaded.config;
    choose_accuracy(scene, fit_.material);
    ForwardRun run(scene, loaded.where, angle);
    run.observe(observed(run), {});
    const Slopes by = slopes_of(scene);
    ForwardInput input{fit_.material, {}, by.keys};
    for (std::size_t i = 0; i < problem_.free.size(); ++i)
      if (const auto friction = friction_of(i))
        input.friction[*friction] = fit_.best.p[static_cast<Eigen::Index>(i)];
    const ForwardPath path = run.solve(input);
    why = path.why;
    if (!path.complete) return {};
    return weighted(path, by);
  }

 private:
  // The contact whose friction a free parameter is, if it is one.
  std::optional<std::string> friction_of(std::size_t i) const {
    const auto number = scene_number(config_, problem_.free[i]);
    if (number && number->of == SceneNumber::Of::friction) {
      return std::optional(number->contact);
    }
    return std::nullopt;
  }

  // The solve config of a variant. A varied fibre_angle turns the specimen.
  Loaded<SolveConfig> scene(const Setting& setting, double& angle) const {
    Tree tree = load_yaml(choice_.solve.path);
    for (std::size_t k = 0; k < setting.values.size(); ++k) {
      const auto& [key, value] = setting.values[k];
      if (key == "fibre_angle") {
        angle += value;
        continue;
      }
      Tree number = plain_tree(fmt::format("{}", value));
      number.place = where_(at_ + fmt::format("vary[{}].key", k));
      set_value(tree, key, number);
    }
    Loaded<SolveConfig> loaded = read_config<SolveConfig>(std::move(tree));
    refuse_several_bodies(loaded.config, where_, at_ + "solve", choice_.solve.path);
    if (!loaded.config.mesh)
      refuse_scene(where_, at_ + "solve", choice_.solve.path + " has no mesh",
                   "the key mesh there");
    if (!loaded.config.fibre_angles.empty())
      refuse_scene(
          where_, at_ + "solve",
          choice_.solve.path + " has fibre_angles, which would stand for those of the fit's law",
          "the law's own angle, and fibre_angle");
    return loaded;
  }

  // What the candidate measures: forces, or reactions and displacements of a set or at places.
  std::vector<Observation> observed(const ForwardRun& run) const {
    std::vector<Observation> all;
    const auto set = [&]() -> const std::vector<int>& {
      const auto found = run.mesh().node_sets.find(choice_.on);
      std::vector<std::string> known;
      for (const auto& [name, nodes] : run.mesh().node_sets) known.push_back(name);
      if (found == run.mesh().node_sets.end())
        refuse_scene(where_, at_ + "on", "the scene has no set \"" + choice_.on + "\"",
                     "one of " + list_words(known));
      return found->second;
    };
    for (const SceneQuantity quantity : choice_.measured) {
      Observation one;
      if (quantity == SceneQuantity::force) {
        if (run.config().contacts.empty())
          refuse_scene(where_, at_ + "measured", "force, of a scene without indenters",
                       "a reaction");
        if (run.config().contacts.size() > 1) {
          if (!run.config().contacts.count(choice_.on))
            refuse_scene(where_, at_ + "on", "a scene with several indenters", "the name of one");
          one.contact = choice_.on;
        }
        all.push_back(one);
        continue;
      }
      const std::string word = names(quantity)[static_cast<std::size_t>(quantity)];
      one.of = Observation::Of::reaction;
      if (quantity >= SceneQuantity::u_x) one.of = Observation::Of::displacement;
      one.axis = word.back() - 'x';
      for (std::size_t i = 0; i < choice_.places.size(); ++i) {
        const auto& [x, z] = choice_.places[i];
        if (!find_place(run.mesh(), {x, std::nan(""), z}, one))
          refuse_scene(where_, at_ + fmt::format("places[{}]", i),
                       fmt::format("no top of the scene at ({:g}, {:g})", x, z), "a place on it");
        all.push_back(one);
      }
      if (!choice_.places.empty()) continue;
      one.nodes = set();
      // reactions are summed over the set, displacements are averaged
      double weight = 1;
      if (one.of == Observation::Of::displacement)
        weight = 1 / static_cast<double>(one.nodes.size());
      one.weights.assign(one.nodes.size(), weight);
      all.push_back(one);
    }
    return all;
  }

  // Material numbers and friction, with the numbers that follow them by ties.
  Slopes slopes_of(const SolveConfig& scene) const {
    Slopes by;
    for (std::size_t i = 0; i < problem_.free.size(); ++i) {
      const FreeParameter& p = problem_.free[i];
      const auto k = static_cast<Eigen::Index>(i);
      const auto friction = friction_of(i);
      if (p.is_material_number() || (friction && scene.contacts.count(*friction))) {
        by.keys.push_back(p.key);
        by.of.push_back({k, 1});
      }
      for (const Tie& tie : problem_.ties)
        if (tie.of == p.key) {
          by.keys.push_back(tie.key);
          by.of.push_back({k, tie.factor});
        }
    }
    return by;
  }

  // The Jacobian over the standard deviation of a measurement. The states of the path together have
  // the weight of `points` measured values.
  MatX weighted(const ForwardPath& path, const Slopes& by) const {
    const Eigen::Index states = path.values.rows();
    const Eigen::Index observations = path.values.cols();
    const double count =
        std::sqrt(static_cast<double>(choice_.points) / static_cast<double>(states));
    const auto of_each =
        std::max<Eigen::Index>(1, static_cast<Eigen::Index>(choice_.places.size()));
    MatX J = MatX::Zero(states * observations, fit_.best.p.size());
    for (Eigen::Index o = 0; o < observations; ++o) {
      const Eigen::Index first = o / of_each * of_each;  // of the places of one quantity
      const double largest = path.values.middleCols(first, of_each).cwiseAbs().maxCoeff();
      const double deviation = choice_.standard_deviation.value_or(config_.noise() * largest);
      if (!(deviation > 0)) continue;  // nothing moves there
      for (std::size_t k = 0; k < by.of.size(); ++k)
        J.block(o * states, by.of[k].first, states, 1) +=
            by.of[k].second * count / deviation * path.slopes[k].col(o);
    }
    return J;
  }

  const FitConfig& config_;
  const FitProblem& problem_;
  const FitResult& fit_;
  const FindPlace& where_;
  const CandidateChoice& choice_;
  const std::string at_;
};

// A scene to solve for the advice.
struct Wanted {
  std::size_t candidate;
  Setting setting;
  std::string name;
};

std::vector<Wanted> wanted_of(const FitConfig& config) {
  std::vector<Wanted> all;
  for (std::size_t i = 0; i < config.study->candidates.size(); ++i) {
    const CandidateChoice& choice = config.study->candidates[i];
    if (choice.kind != DataKind::scene) continue;
    std::string name = choice.name;
    if (choice.name.empty()) {
      name = std::filesystem::path(choice.solve.path).stem().string();
    }
    for (const Setting& setting : settings_of(choice)) {
      std::string title = name;
      if (!setting.words.empty()) title += ", " + setting.words;
      all.push_back({i, setting, title});
    }
  }
  return all;
}

}  // namespace

// Solves all variants in parallel. Variants that are measured `together` become one candidate with
// the rows of both.
SceneCandidates scene_candidates(const FitConfig& config, const FitProblem& problem,
                                 const FitResult& fit, const FindPlace& where) {
  SceneCandidates out;
  if (!config.study) return out;
  const std::vector<Wanted> wanted = wanted_of(config);
  std::vector<std::optional<MatX>> J(wanted.size());
  std::vector<std::string> why(wanted.size());
  in_order(
      std::min(config.jobs, static_cast<int>(wanted.size())), static_cast<int>(wanted.size()),
      [&](int, int k) {
        const auto i = static_cast<std::size_t>(k);
        try {
          J[i] = SceneOf(config, problem, fit, where, wanted[i].candidate)
                     .slopes(wanted[i].setting, why[i]);
        } catch (const Failure& failure) {
          if (failure.code() != Exit::not_converged || interrupted()) throw;
          why[i] = failure.what();
        }
      },
      [](int, int) {});
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const CandidateChoice& choice = config.study->candidates[wanted[i].candidate];
    if (!J[i]) {
      out.without.push_back(fmt::format("no advice on {}: {}", wanted[i].name, why[i]));
      continue;
    }
    const bool joins =
        choice.together && i > 0 && wanted[i - 1].candidate == wanted[i].candidate && J[i - 1];
    if (!joins) {
      out.candidates.push_back({wanted[i].name, *J[i], 1});
      continue;
    }
    Candidate& one = out.candidates.back();
    MatX both(one.J.rows() + J[i]->rows(), one.J.cols());
    both << one.J, *J[i];
    one.J = both;
    one.name += " and " + wanted[i].setting.words;
  }
  return out;
}

}  // namespace langer
