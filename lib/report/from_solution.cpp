#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/hdf5/h5.hpp"
#include "report/answer.hpp"
#include "report/body_view.hpp"
#include "report/labels.hpp"
#include "report/sources.hpp"
#include "results/store/solution_file.hpp"

namespace langer::report {

namespace {

using History = std::map<std::string, std::vector<double>>;

double largest(const History& history, const std::string& name) {
  const auto found = history.find(name);
  if (found == history.end() || found->second.empty())
    return std::numeric_limits<double>::quiet_NaN();
  return *std::max_element(found->second.begin(), found->second.end(),
                           [](double a, double b) { return std::abs(a) < std::abs(b); });
}

double when(const History& history, const std::string& name, auto&& is) {
  const auto& values = history.at(name);
  const auto found = std::find_if(values.begin(), values.end(), is);
  return found == values.end() ? -1
                               : history.at("t")[static_cast<std::size_t>(found - values.begin())];
}

using Say = std::function<void(Level, std::string)>;

struct IndenterForce {
  double largest = 0, last = 0;  // [N]
};
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
      for (int k = 0; k < 3; ++k)
        if (const auto found = history.find("force_" + name + "_" + "xyz"[k]);
            found != history.end())
          for (std::size_t i = 0; i < n; ++i) rows[i][k] = found->second[i];
    }
    IndenterForce& force = forces[name];
    for (const Vec3& f : rows)
      force.largest = std::max(force.largest, f.norm()), force.last = f.norm();
  }
  return forces;
}

void judge_contact(const Say& say, const std::map<std::string, IndenterForce>& forces,
                   const History& history) {
  const double penetration =
      history.count("penetration") ? std::abs(largest(history, "penetration")) : 0;
  for (const auto& [name, force] : forces) {
    if (force.largest > 0)
      say(Level::good,
          fmt::format(
              "{} touches the body: largest force {:.4g} N, largest penetration {:.1e} mm at the nodes",
              name, force.largest, penetration));
    else
      say(Level::warning,
          fmt::format(
              "{} never touches the body: its force is 0 in every step; look at its place and motion, and at the "
              "nodes that may touch",
              name));
  }
}

// "force 0.51 N +- 1.2 %": only a force whose estimated error is within the wanted one is called
// good
void judge_errors(const Say& say, const std::vector<Summary>& summary, double force,
                  double wanted) {
  bool any = false;
  for (const Summary& s : summary) {
    if (!s.name.ends_with("_error")) continue;
    const std::string name = s.name.substr(0, s.name.size() - 6);
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto [of, percent] = known_error(summary, name, name == "force" ? force : unknown);
    if (!std::isfinite(of) || of == 0) continue;
    any = true;
    const std::string text =
        fmt::format("{} {:.4g} {} ± {:.2g} % by cells and increments", name, of, s.unit, percent);
    if (name != "force")
      say(Level::note, text);
    else if (percent <= wanted)
      say(Level::good, fmt::format("{}: within the {:g} % wanted", text, wanted));
    else
      say(Level::warning,
          fmt::format(
              "{}: more than the {:g} % wanted; smaller cells, or `accuracy` in the solve config",
              text, wanted));
  }
  if (!any)
    say(Level::note,
        "how much cells and increments change the result is not known: `estimate` or `accuracy` in the solve config tells it");
}

void judge_resolution(const Say& say, const std::vector<Summary>& summary) {
  const auto value = [&](const char* name) {
    const auto found = std::find_if(summary.begin(), summary.end(),
                                    [&](const Summary& s) { return s.name == name; });
    return found == summary.end() ? 0 : found->value;
  };
  if (value("contact_warnings") > 0)
    say(Level::warning,
        fmt::format(
            "contact is not resolved by the cells, or an indenter missed the body (langer-solve said where, {:g} "
            "warnings): between nodes an indenter is up to {:.3g} mm inside the body, {:.0f} % of what it is "
            "pressed in",
            value("contact_warnings"), value("penetration_between_nodes"),
            100 * value("penetration_share")));
}

double smallest(const std::vector<double>& values) {
  return values.empty() ? 1 : *std::min_element(values.begin(), values.end());
}

void judge(const Say& say, const History& history) {
  const double residual = std::abs(largest(history, "residual")),
               iterations = largest(history, "iterations");
  say(Level::good,
      fmt::format(
          "equilibrium in all {} steps: largest relative residual {:.1e}, at most {:g} iterations",
          history.at("t").size(), residual, iterations));
  const auto positive = [](double v) {
    return v > 0;
  };
  if (history.count("negative_eigenvalues") == 0)
    say(Level::note,
        "the stability of the steps was not looked at (stability: last or off, or a tangent that is solved iteratively)");
  else if (largest(history, "negative_eigenvalues") != 0)
    say(Level::warning,
        fmt::format(
            "unstable equilibria from t = {:.4g}: the constrained tangent has up to {:g} negative eigenvalues",
            when(history, "negative_eigenvalues", [](double v) { return v != 0; }),
            std::abs(largest(history, "negative_eigenvalues"))));
  else if (const auto whole = history.find("signs_of_whole_body");
           whole == history.end() || smallest(whole->second) > 0)
    say(Level::good, "every equilibrium is stable: the constrained tangent is positive definite");
  else if (whole->second.back() > 0)
    say(Level::good,
        "every equilibrium is stable in movements that keep its symmetry, and the last one in all movements "
        "(stability: each_step checks all of them at each step)");
  else
    say(Level::good,
        "every equilibrium is stable in the movements that were solved for; those out of the plane of a section, or "
        "out of a symmetry, were not checked");
  if (history.count("unstable_volume")) {
    if (largest(history, "unstable_volume") > 0)
      say(Level::warning,
          fmt::format(
              "strong ellipticity is lost from t = {:.4g}, at most in {:.3g} % of the volume: the solution "
              "depends on the mesh there",
              when(history, "unstable_volume", positive),
              100 * largest(history, "unstable_volume")));
    else
      say(Level::good, "the material is strongly elliptic everywhere");
  }
  if (history.count("outside_fit")) {
    if (largest(history, "outside_fit") > 0)
      say(Level::warning,
          fmt::format(
              "from t = {:.4g} the body is deformed beyond the fitted tests, at most in {:.3g} % of the volume",
              when(history, "outside_fit", positive), 100 * largest(history, "outside_fit")));
    else
      say(Level::good, "nowhere deformed beyond the fitted tests");
  }
  if (history.count("volume_change") && largest(history, "volume_change") > 0.02)
    say(Level::warning,
        fmt::format("an element changes its volume by {:.3g} %: soft tissue keeps its volume",
                    100 * largest(history, "volume_change")));
  for (const auto& [name, values] : history)
    if (name.find("error") != std::string::npos && !values.empty())
      say(Level::note, fmt::format("{}: {:.3g} at the end, at most {:.3g}", name, values.back(),
                                   largest(history, name)));
}

}  // namespace

void add_solutions(ReportPage& page, const std::vector<Source>& sources,
                   const ReportConfig& config) {
  const double budget = 1e6 * config.megabytes - static_cast<double>(bytes_without_data());
  std::map<std::string, Chart> charts;
  for (const Source& source : sources) {
    const SolutionReader solution(source.path);
    const h5::File file = h5::File::open(source.path);
    const h5::Group group = file.root().group("history");
    History history;
    std::map<std::string, std::string> units;
    const std::size_t n = static_cast<std::size_t>(solution.n_steps());
    for (const std::string& name : group.datasets()) {
      if (group.shape(name).size() != 1) continue;
      if (name == "iterations" || name.starts_with("contact_")) {
        const auto whole = group.read_rows<std::int64_t>(name, 0, n, {}).values;
        history[name].assign(whole.begin(), whole.end());
      } else
        history[name] = group.read_rows<double>(name, 0, n, {}).values;
      units[name] = group.unit(name).empty() ? "-" : group.unit(name);
    }
    if (n == 0) continue;
    page.answers.push_back(answer_of(solution, sources.size() > 1 ? source.label : ""));
    const Say say = [&](Level level, std::string text) {
      page.verdicts.push_back({level, source.label, std::move(text)});
    };
    judge(say, history);
    const auto forces = indenter_forces(solution, group, history);
    judge_contact(say, forces, history);
    judge_resolution(say, solution.summary());
    judge_errors(say, solution.summary(), forces.empty() ? 0 : forces.begin()->second.last,
                 *percent_of(config.accuracy));
    for (const auto& [name, values] : history) {
      if (name == "t" || name == "next_increment" || name.starts_with("weakest")) continue;
      if (std::all_of(values.begin(), values.end(), [](double v) { return v == 0; }))
        continue;  // nothing to see
      Chart& chart = charts
                         .try_emplace(name, Chart{"path",
                                                  in_words(name),
                                                  "path parameter t",
                                                  "-",
                                                  in_words(name),
                                                  units[name],
                                                  {},
                                                  true})
                         .first->second;
      chart.ordered = chart.ordered && source.numbered;
      chart.series.push_back({source.label, history.at("t"), values, false});
    }
    if (has_three())
      page.bodies.push_back(body_view(source.label, solution, source.path, config,
                                      0.9 * budget / static_cast<double>(sources.size())));
  }
  for (auto& [name, chart] : charts) page.charts.push_back(std::move(chart));
}

}  // namespace langer::report
