#include "identification/inverse/uncertainty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/quantile.hpp"
#include "core/base/random.hpp"
#include "core/base/text.hpp"
#include "core/tensor/dense.hpp"
#include "identification/population/untested_specimen.hpp"
#include "mechanics/material/parameters.hpp"

namespace langer {

namespace {

// The place of each fitted parameter in a population; -1 where it is none of it.
std::vector<Eigen::Index> places_in(const PopulationRecord& population, const FitRecord& fit) {
  std::vector<Eigen::Index> places;
  for (const FittedParameter& parameter : fit.parameters) {
    const auto found = std::ranges::find(population.names, parameter.name);
    places.push_back(found == population.names.end() ? -1 : found - population.names.begin());
  }
  return places;
}

// The covariance of a specimen that was not tested: scatter of the population and error of its
// median, to first order on the scale of the numbers themselves.
MatX scatter_of(const PopulationRecord& population, const FitRecord& fit) {
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  MatX covariance = MatX::Constant(n, n, std::nan(""));
  const MatX of_phi = covariance_of_untested(population);
  VecX slope(of_phi.rows());
  for (Eigen::Index j = 0; j < slope.size(); ++j)
    slope[j] = link_of(population, static_cast<std::size_t>(j)).slope(population.median[j]);
  const std::vector<Eigen::Index> places = places_in(population, fit);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const Eigen::Index i = places[static_cast<std::size_t>(a)];
      const Eigen::Index j = places[static_cast<std::size_t>(b)];
      if (i < 0 || j < 0) continue;
      covariance(a, b) = slope[i] * of_phi(i, j) * slope[j];
    }
  return covariance;
}

// Specimens that are drawn from the same distribution, without the linearisation: one row each, its
// numbers less those of the median, for the parameters `kept`.
MatX draw_specimens(const PopulationRecord& population, const FitRecord& fit,
                    const std::vector<Eigen::Index>& kept) {
  constexpr Eigen::Index n = 4000;
  const UntestedSpecimens specimens(population);
  const VecX median = specimens.median();
  const std::vector<Eigen::Index> places = places_in(population, fit);
  MatX drawn(n, static_cast<Eigen::Index>(kept.size()));
  for (Eigen::Index k = 0; k < n; ++k) {
    Random random(2, static_cast<std::uint64_t>(k));
    const VecX numbers = specimens.draw(random);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Eigen::Index j = places[static_cast<std::size_t>(kept[i])];
      drawn(k, static_cast<Eigen::Index>(i)) = numbers[j] - median[j];
    }
  }
  return drawn;
}

}  // namespace

// What a fitted material file says about its parameters: covariance of those with a variance, and
// the keys of the numbers that follow each of them, ties included.
ParameterKnowledge knowledge_of(const MaterialFile& file) {
  ParameterKnowledge known;
  if (!file.fit) return known;
  const MatX uncertain =
      file.fit->population ? scatter_of(*file.fit->population, *file.fit) : file.fit->covariance;
  Material material = file.material;
  const std::vector<MaterialParameter> numbers = parameters(material);
  const std::vector<FittedParameter>& fitted = file.fit->parameters;
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double variance = uncertain(at, at);
    if (std::isfinite(variance) && variance > 0) {
      kept.push_back(at);
      known.names.push_back(fitted[i].name);
    } else
      known.left_out.push_back(fitted[i].name);
  }
  const auto n = static_cast<Eigen::Index>(kept.size());
  known.covariance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      known.covariance(i, j) =
          uncertain(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]);
  if (file.fit->population && n > 0)
    known.specimens = draw_specimens(*file.fit->population, *file.fit, kept);
  const std::vector<Tie> ties = resolved(file.fit->ties).ties;
  std::vector<VecX> rows;
  for (const MaterialParameter& p : numbers) {
    VecX row = VecX::Zero(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::string& name = known.names[static_cast<std::size_t>(j)];
      if (p.name == name) row[j] = 1;
      for (const Tie& tie : ties)
        for (const MaterialParameter& of : numbers)
          if (tie.key == p.key && tie.of == of.key && of.name == name) row[j] = tie.factor;
    }
    if (!row.isZero(0)) {
      known.keys.push_back(p.key);
      rows.push_back(row);
    }
  }
  known.follow.resize(static_cast<Eigen::Index>(rows.size()), n);
  for (std::size_t i = 0; i < rows.size(); ++i)
    known.follow.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  return known;
}

// Reads the covariance and asks the run for the derivative by each number it needs.
ParameterKnowledge prepare_uncertainty(SolveConfig& config, const std::string& material_file,
                                       const Run::Where& where) {
  if (config.uncertainty.value_or(UncertaintyBy::none) == UncertaintyBy::none) return {};
  const bool holds_a_fit = std::filesystem::path(material_file).extension() == ".h5";
  ParameterKnowledge known;
  if (holds_a_fit) known = knowledge_of(read_material(material_file));
  if (known.names.empty())
    throw Failure(
        Exit::config,
        Error{where("uncertainty"), "uncertainty", "linear, without a fit that has standard errors",
              "--material with a material.h5 of langer-fit that holds a covariance", ""});
  for (const std::string& key : known.keys)
    if (auto& list = config.sensitivity; std::find(list.begin(), list.end(), key) == list.end())
      list.push_back(key);
  return known;
}

namespace {

// What 95 % of the specimens of a population have, by forces that are linear in their numbers.
std::array<double, 2> specimen_interval(const MatX& specimens, double value, const VecX& g) {
  const VecX forces = specimens * g;
  std::vector<double> sorted(forces.begin(), forces.end());
  std::ranges::sort(sorted);
  return {value + quantile(sorted, 0.025), value + quantile(sorted, 0.975)};
}

}  // namespace

// The standard deviation by linear propagation, sqrt(g^T C g). If parameter j were known exactly
// the variance would be lower by (C g)_j^2 / C_jj (conditional normal distribution).
ForceUncertainty uncertainty_of(const ParameterKnowledge& known, double value, const VecX& by_key) {
  const VecX g = known.follow.transpose() * by_key;
  const VecX Cg = known.covariance * g;
  const double variance = std::max(0.0, g.dot(Cg));
  ForceUncertainty out;
  out.value = value;
  out.deviation = std::sqrt(variance);
  if (known.specimens.rows() > 0) out.specimens = specimen_interval(known.specimens, value, g);
  for (std::size_t i = 0; i < known.names.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    out.parts.push_back(
        {known.names[i],
         std::sqrt(std::max(0.0, variance - Cg[j] * Cg[j] / known.covariance(j, j)))});
  }
  std::stable_sort(out.parts.begin(), out.parts.end(),
                   [](const auto& a, const auto& b) { return a.without < b.without; });
  return out;
}

namespace {

// The gradient of a force at a state by the keys of the material.
VecX derivatives(const std::vector<SceneParameter>& numbers, const ParameterKnowledge& known,
                 const std::function<double(const SceneParameter&)>& of) {
  VecX g = VecX::Zero(static_cast<Eigen::Index>(known.keys.size()));
  for (const SceneParameter& p : numbers)
    for (std::size_t i = 0; i < known.keys.size(); ++i)
      if (p.key == known.keys[i]) g[static_cast<Eigen::Index>(i)] = of(p);
  return g;
}

}  // namespace

std::vector<ForceUncertainty> Uncertainty::of(const StepRecord& whole) const {
  std::vector<ForceUncertainty> out;
  if (known_.names.empty()) return out;
  const auto add = [&](const std::string& name, double value,
                       const std::function<double(const SceneParameter&)>& derivative) {
    ForceUncertainty& force = out.emplace_back(
        uncertainty_of(known_, value, derivatives(sensitivity_.parameters(), known_, derivative)));
    force.name = name;
  };
  const auto scalar = [&](const std::string& quantity) {
    return [&whole, quantity](const SceneParameter& p) {
      return whole.scalars.at(derivative_name(quantity, p));
    };
  };
  const auto& contacts = run_.scene.contacts;
  if (!contacts.empty())
    add("force", whole.force_ind.norm(),
        [&](const SceneParameter& p) { return length_derivative(whole, p); });
  for (const RigidContact& contact : contacts)
    if (contacts.size() > 1)
      add("force_" + contact.name, force_on(whole, contact.name).norm(),
          scalar("force_" + contact.name + "_N"));
  for (const SurfaceContact& surface : run_.scene.surfaces)
    add("force_" + surface.name, force_on(whole, surface.name).norm(),
        scalar("force_" + surface.name + "_N"));
  for (const std::string& set : sensitivity_.moved()) {
    Vec3 sum = Vec3::Zero();
    for (int node : run_.mesh.node_sets.at(set))
      sum += whole.reaction[static_cast<std::size_t>(node)];
    const double size = sum.norm();
    if (size == 0) continue;
    add("reaction_" + set, size, [&](const SceneParameter& p) {
      double along = 0;
      for (int k = 0; k < 3; ++k)
        along += sum[k] / size *
                 whole.scalars.at(derivative_name("reaction_" + set + "_" + "xyz"[k] + "_N", p));
      return along;
    });
  }
  return out;
}

Observer Uncertainty::beside(Observer sensitivity) const {
  if (known_.names.empty()) return sensitivity;
  return {sensitivity.kept, [this, along = sensitivity.along](RunListener listener) {
            const auto next = listener.of_whole;
            listener.of_whole = [this, next](StepRecord& whole, const SolveReport& report) {
              write(whole);
              if (next) next(whole, report);
            };
            return along(std::move(listener));
          }};
}

void Uncertainty::write(StepRecord& whole) const {
  for (const ForceUncertainty& force : of(whole))
    whole.scalars[force.name + "_deviation"] = force.deviation;
}

// The deviations for the summary of a run.
std::vector<Summary> summary_of(const std::vector<ForceUncertainty>& forces) {
  std::vector<Summary> out;
  for (const ForceUncertainty& force : forces) {
    out.push_back({force.name + "_deviation", force.deviation, "N"});
    if (force.specimens) {
      out.push_back({force.name + "_specimens_lower_95", (*force.specimens)[0], "N"});
      out.push_back({force.name + "_specimens_upper_95", (*force.specimens)[1], "N"});
    }
    for (const auto& part : force.parts)
      out.push_back({force.name + "_deviation_without_" + part.name, part.without, "N"});
  }
  return out;
}

// One sentence: the force, its discretisation error, its deviation, and what knowing a parameter
// would reduce it to.
std::string in_words(const ForceUncertainty& force, std::optional<double> cells) {
  const auto percent = [&](double part) {
    return fmt::format("{:.2g} %", 100 * part / std::max(std::abs(force.value), 1e-300));
  };
  std::string words = fmt::format("{} {:.4g} N", force.name, force.value);
  if (cells) words += fmt::format(" +- {} (cells)", percent(*cells));
  const char* source = "parameters";
  if (force.specimens) source = "between specimens";
  words += fmt::format(" +- {} ({}", percent(force.deviation), source);
  // at most three parameters, and only those that reduce the deviation by a tenth
  std::string reductions;
  int listed = 0;
  for (const auto& part : force.parts)
    if (part.without < 0.9 * force.deviation && listed++ < 3)
      append(reductions, ", ",
             fmt::format("{} if {} were known", percent(part.without), part.name));
  if (!reductions.empty()) words += "; " + reductions;
  words += ")";
  if (force.specimens)
    words += fmt::format(", 95 % of specimens between {:.3g} and {:.3g} N", (*force.specimens)[0],
                         (*force.specimens)[1]);
  return words;
}

void report_forces(const Voice& voice, const ParameterKnowledge& known,
                   const std::vector<ForceUncertainty>& forces,
                   const std::vector<ErrorEstimate>& errors) {
  for (ForceUncertainty force : forces) {
    std::optional<double> cells;
    for (const ErrorEstimate& error : errors) {
      if (error.of.name != force.name || error.t < 1) continue;
      cells = error.total();
      if (!error.limit_answers) continue;
      cells = error.limit_bar();
      force.value = error.limit();
    }
    voice.say("{}", in_words(force, cells));
  }
  if (known.left_out.empty()) return;
  std::string names;
  for (const std::string& name : known.left_out) append(names, ", ", name);
  voice.detail("not included, since the fit gives them no variance: {}", names);
}

}  // namespace langer
