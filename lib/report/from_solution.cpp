// Solutions in a report: what a reader must know before the numbers can be used. The verdicts come
// from columns of /history, which langer-solve records at every step, and from its summary:
//   equilibrium   relative residual and number of iterations
//   stability     negative eigenvalues of the constrained tangent, loss of strong ellipticity
//   deformation   elements outside of the range of the fitted tests, changes of volume
//   contact       whether the indenter touches, and its penetration between nodes
//   errors        estimated errors, compared with the wanted accuracy
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/base/text.hpp"
#include "core/hdf5/h5.hpp"
#include "report/answer.hpp"
#include "report/body_view.hpp"
#include "report/labels.hpp"
#include "report/sources.hpp"
#include "results/store/solution_file.hpp"
#include "results/store/solution_layout.hpp"

namespace langer::report {

namespace {

// The columns of /history: one value for each step.
using History = std::map<std::string, std::vector<double>>;

bool larger_size(double a, double b) { return std::abs(a) < std::abs(b); }
bool is_positive(double v) { return v > 0; }
bool is_nonzero(double v) { return v != 0; }

// The value of the largest size in a column, with its sign; NaN without the column.
double largest(const History& history, const std::string& name) {
  const auto found = history.find(name);
  if (found == history.end() || found->second.empty())
    return std::numeric_limits<double>::quiet_NaN();
  return *std::ranges::max_element(found->second, larger_size);
}

// The path parameter of the first step whose value fulfils a condition; -1 if none does.
double first_time(const History& history, const std::string& name, bool (*condition)(double)) {
  const auto& values = history.at(name);
  const auto found = std::ranges::find_if(values, condition);
  if (found == values.end()) return -1;
  return history.at("t")[static_cast<std::size_t>(found - values.begin())];
}

// Adds a verdict on the solution at hand.
using AddVerdict = std::function<void(Level, std::string)>;

struct IndenterForce {
  double largest = 0, last = 0;  // [N]
};
// Forces of all indenters. A file with one indenter has the column force_ind (three components);
// with several indenters each has columns of its own name.
std::map<std::string, IndenterForce> indenter_forces(const SolutionReader& solution,
                                                     const h5::Group& group,
                                                     const History& history) {
  const auto n = static_cast<std::size_t>(solution.n_steps());
  std::map<std::string, IndenterForce> forces;
  const auto& nodes = solution.header().contact_nodes;
  for (const auto& [name, unused] : nodes) {
    std::vector<Vec3> rows(n, Vec3::Zero());
    if (nodes.size() == 1) {
      const std::vector<double> all = group.read_rows<double>("force_ind", 0, n, {3}).values;
      for (std::size_t i = 0; i < n; ++i) rows[i] = {all[3 * i], all[3 * i + 1], all[3 * i + 2]};
    } else {
      for (int k = 0; k < 3; ++k) {
        const auto found = history.find("force_" + name + "_" + "xyz"[k]);
        if (found == history.end()) continue;
        for (std::size_t i = 0; i < n; ++i) rows[i][k] = found->second[i];
      }
    }
    IndenterForce& force = forces[name];
    for (const Vec3& f : rows) {
      force.largest = std::max(force.largest, f.norm());
      force.last = f.norm();
    }
  }
  return forces;
}

// Whether each indenter touches the body, and how deep the nodes are inside it.
void judge_contact(const AddVerdict& add, const std::map<std::string, IndenterForce>& forces,
                   const History& history) {
  double penetration = 0;
  if (history.count("penetration")) penetration = std::abs(largest(history, "penetration"));
  for (const auto& [name, force] : forces) {
    if (force.largest > 0)
      add(Level::good, fmt::format("{} touches the body: largest force {:.4g} N, largest "
                                   "penetration {:.1e} mm at the nodes",
                                   name, force.largest, penetration));
    else
      add(Level::warning,
          fmt::format("{} never touches the body: its force is 0 in every step; check its place "
                      "and motion, and the nodes that may touch",
                      name));
  }
}

// "force 0.51 N ± 1.2 %". A force is called good only if its estimated error is within the wanted
// one. Other results are notes: the wanted accuracy is that of the force.
void judge_errors(const AddVerdict& add, const std::vector<Summary>& summary, double force,
                  double wanted) {
  bool any = false;
  for (const Summary& s : summary) {
    if (!s.name.ends_with("_error")) continue;
    const std::string name = s.name.substr(0, s.name.size() - 6);
    double fallback = std::numeric_limits<double>::quiet_NaN();
    if (name == "force") fallback = force;
    const KnownError known = known_error(summary, name, fallback);
    const double value = known.value;
    const double percent = known.percent;
    if (!std::isfinite(value) || value == 0) continue;
    any = true;
    std::string number = rounded(value, percent);
    if (s.unit != "-") number += " " + s.unit;
    const std::string text =
        fmt::format("{} {} ± {:.2g} % by mesh and increments", name, number, percent);
    if (name != "force")
      add(Level::note, text);
    else if (percent <= wanted)
      add(Level::good, fmt::format("{}: within the {:g} % wanted", text, wanted));
    else
      add(Level::warning, fmt::format("{}: more than the {:g} % wanted; use a finer mesh, or "
                                      "`accuracy` in the solve config",
                                      text, wanted));
  }
  if (!any)
    add(Level::note,
        "the discretisation error is not known: set `estimate` or `accuracy` in the solve config");
}

// A quantity of the summary; 0 if the solution does not have it.
double value_or_zero(const std::vector<Summary>& summary, const std::string& name) {
  const auto found = std::ranges::find(summary, name, &Summary::name);
  if (found == summary.end()) return 0;
  return found->value;
}

// Warnings of langer-solve about contact: an indenter between nodes, or one that misses the body.
void judge_resolution(const AddVerdict& add, const std::vector<Summary>& summary) {
  const double warnings = value_or_zero(summary, "contact_warnings");
  if (!(warnings > 0)) return;
  add(Level::warning,
      fmt::format("contact is not resolved by the mesh, or an indenter missed the body (see the "
                  "{:g} warnings of langer-solve): between nodes an indenter is up to {:.3g} mm "
                  "inside the body, {:.0f} % of its indentation depth",
                  warnings, value_or_zero(summary, "penetration_between_nodes"),
                  100 * value_or_zero(summary, "penetration_share")));
}

// Equilibrium of all steps. A residual is relative to the forces on the body: where none acts, it
// is one rounding over another.
void judge_equilibrium(const AddVerdict& add, const History& history) {
  constexpr double of_no_force = 0.01;
  double residual = 0;
  int at_rest = 0;
  for (const double r : history.at("residual")) {
    if (r > of_no_force) {
      ++at_rest;
    } else {
      residual = std::max(residual, r);
    }
  }
  std::string words = "equilibrium";
  if (history.count("kinetic_energy")) words = "balance of momentum";
  words +=
      fmt::format(" in all {} steps: largest relative residual {:.1e}, at most {:g} iterations",
                  history.at("t").size(), residual, largest(history, "iterations"));
  if (at_rest > 0) words += fmt::format("; no force acts in {} of them", at_rest);
  add(Level::good, std::move(words));
}

// The movements in which the equilibria were found to be stable. The column signs_of_whole_body is
// 0 at a step whose tangent was that of a section or of a part by symmetry: movements out of it
// were not checked.
std::string stability_words(const History& history) {
  const auto whole = history.find("signs_of_whole_body");
  if (whole == history.end() || std::ranges::all_of(whole->second, is_positive))
    return "every equilibrium is stable: the constrained tangent is positive definite";
  if (whole->second.back() > 0)
    return "every equilibrium is stable in movements that keep its symmetry, and the last one in "
           "all movements (stability: each_step checks all of them at each step)";
  return "every equilibrium is stable in the movements that were solved for; those out of the plane "
         "of a section, or out of a symmetry, were not checked";
}

// Stability of the structure (negative eigenvalues of the constrained tangent) and of the material
// (strong ellipticity).
void judge_stability(const AddVerdict& add, const History& history) {
  if (history.count("kinetic_energy"))
    add(Level::note, "no step is judged as stable or not: a body in motion has no equilibrium");
  else if (history.count("negative_eigenvalues") == 0)
    add(Level::note,
        "the stability of the steps was not checked (stability: last or off, or an "
        "iterative solver)");
  else if (largest(history, "negative_eigenvalues") != 0)
    add(Level::warning, fmt::format("unstable equilibria from t = {:.4g}: the constrained tangent "
                                    "has up to {:g} negative eigenvalues",
                                    first_time(history, "negative_eigenvalues", is_nonzero),
                                    std::abs(largest(history, "negative_eigenvalues"))));
  else
    add(Level::good, stability_words(history));
  if (history.count("unstable_volume") == 0) return;
  if (largest(history, "unstable_volume") > 0)
    add(Level::warning,
        fmt::format("strong ellipticity is lost from t = {:.4g}, at most in "
                    "{:.3g} % of the volume: the solution depends on the mesh there",
                    first_time(history, "unstable_volume", is_positive),
                    100 * largest(history, "unstable_volume")));
  else
    add(Level::good, "the material is strongly elliptic everywhere");
}

// Whether the deformation stays inside the range of the fitted tests, and nearly isochoric.
void judge_deformation(const AddVerdict& add, const History& history) {
  if (history.count("outside_fit")) {
    if (largest(history, "outside_fit") > 0)
      add(Level::warning, fmt::format("from t = {:.4g} the body is deformed beyond the fitted "
                                      "tests, at most in {:.3g} % of the volume",
                                      first_time(history, "outside_fit", is_positive),
                                      100 * largest(history, "outside_fit")));
    else
      add(Level::good, "nowhere deformed beyond the fitted tests");
  }
  if (history.count("volume_change") && largest(history, "volume_change") > 0.02)
    add(Level::warning,
        fmt::format("an element changes its volume by {:.3g} %: soft tissue keeps its volume",
                    100 * largest(history, "volume_change")));
}

// Columns of error estimates along the path. Those that the summary judges at the end are left out.
void add_estimates(const AddVerdict& add, const History& history,
                   const std::vector<Summary>& summary) {
  for (const auto& [name, values] : history)
    if (name.find("error") != std::string::npos && !values.empty() &&
        std::ranges::find(summary, name, &Summary::name) == summary.end())
      add(Level::note, fmt::format("{}: {:.3g} at the end, at most {:.3g}", name, values.back(),
                                   largest(history, name)));
}

// Natural frequencies in words, and curves of the complex stiffness over frequency.
void add_vibration(const AddVerdict& add, std::map<std::string, Chart>& charts,
                   const Source& source, const VibrationRecord& vibration) {
  if (vibration.modes) {
    std::vector<std::string> words;
    for (double frequency : vibration.modes->frequency) {
      if (words.size() < 6) words.push_back(fmt::format("{:.4g}", frequency));
    }
    add(Level::note,
        fmt::format("natural frequencies about the last state: {} Hz{}", fmt::join(words, ", "),
                    words.size() < vibration.modes->frequency.size() ? ", ..." : ""));
    const bool grows = std::ranges::any_of(vibration.modes->growth, is_positive);
    if (grows) add(Level::warning, "the last state is unstable: movements about it grow");
  }
  if (!vibration.harmonic) return;
  const HarmonicRecord& harmonic = *vibration.harmonic;
  const auto add_curve = [&](const std::string& name, const std::vector<double>& values) {
    const Chart empty{"path", name, "frequency", "Hz", name, "N/mm", {}, true};
    Chart& chart = charts.try_emplace(name, empty).first->second;
    chart.ordered = chart.ordered && source.numbered;
    chart.series.push_back({source.label, harmonic.frequency, values, false});
  };
  add_curve("storage stiffness of " + harmonic.driver, harmonic.storage);
  add_curve("loss stiffness of " + harmonic.driver, harmonic.loss);
}

// Whether a column of the history deserves a chart.
bool is_charted(const std::string& name, const std::vector<double>& values) {
  if (name == "t" || name == "next_increment" || name.starts_with("weakest")) return false;
  return std::ranges::any_of(values, is_nonzero);
}

}  // namespace

// For each solution: the answer, verdicts, and a view of the deformed body. Columns of the history
// are charts in which all solutions are compared.
void add_solutions(ReportPage& page, const std::vector<Source>& sources,
                   const ReportConfig& config) {
  const double budget = 1e6 * config.megabytes - static_cast<double>(bytes_without_data());
  std::map<std::string, Chart> charts;
  std::vector<Json> modes;
  for (const Source& source : sources) {
    const SolutionReader solution(source.path);
    const h5::File file = h5::File::open(source.path);
    const h5::Group group = file.root().group("history");
    History history;
    std::map<std::string, std::string> units;
    const std::size_t n = static_cast<std::size_t>(solution.n_steps());
    for (const std::string& name : group.datasets()) {
      if (group.shape(name).size() != 1) continue;
      if (solution::is_count(name)) {
        const auto whole = group.read_rows<std::int64_t>(name, 0, n, {}).values;
        history[name].assign(whole.begin(), whole.end());
      } else {
        history[name] = group.read_rows<double>(name, 0, n, {}).values;
      }
      units[name] = text_or(group.unit(name), "-");
    }
    if (n == 0) continue;
    page.answers.push_back(answer_of(solution, sources.size() > 1 ? source.label : ""));
    const AddVerdict add = [&](Level level, std::string text) {
      page.verdicts.push_back({level, source.label, std::move(text)});
    };
    judge_equilibrium(add, history);
    judge_stability(add, history);
    judge_deformation(add, history);
    add_estimates(add, history, solution.summary());
    const auto forces = indenter_forces(solution, group, history);
    judge_contact(add, forces, history);
    judge_resolution(add, solution.summary());
    double force = 0;
    if (!forces.empty()) force = forces.begin()->second.last;
    judge_errors(add, solution.summary(), force, *percent_of(config.accuracy));
    for (const auto& [name, values] : history) {
      if (!is_charted(name, values)) continue;
      const Chart empty{
          "path", in_words(name), "path parameter t", "-", in_words(name), units[name], {}, true};
      Chart& chart = charts.try_emplace(name, empty).first->second;
      chart.ordered = chart.ordered && source.numbered;
      chart.series.push_back({source.label, history.at("t"), values, false});
    }
    const VibrationRecord vibration = solution.vibration();
    add_vibration(add, charts, source, vibration);
    if (!has_three()) continue;
    const double share = budget / static_cast<double>(sources.size());
    page.bodies.push_back(body_view(source.label, solution, source.path, config, 0.9 * share));
    for (Json& mode : mode_views(source.label, solution, vibration, 0.08 * share))
      modes.push_back(std::move(mode));
  }
  // behind the bodies, of which the page shows the first
  for (Json& mode : modes) page.bodies.push_back(std::move(mode));
  for (auto& [name, chart] : charts) page.charts.push_back(std::move(chart));
}

}  // namespace langer::report
