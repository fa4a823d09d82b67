#include <algorithm>
#include <map>

#include "report/body_view.hpp"
#include "report/labels.hpp"
#include "report/sources.hpp"
#include "store/h5.hpp"
#include "store/solution_file.hpp"

namespace langer::report {

namespace {

using History = std::map<std::string, std::vector<double>>;

double largest(const History& history, const std::string& name) {
  const auto found = history.find(name);
  if (found == history.end() || found->second.empty()) return std::numeric_limits<double>::quiet_NaN();
  return *std::max_element(found->second.begin(), found->second.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
}

double when(const History& history, const std::string& name, auto&& is) {
  const auto& values = history.at(name);
  const auto found = std::find_if(values.begin(), values.end(), is);
  return found == values.end() ? -1 : history.at("t")[static_cast<std::size_t>(found - values.begin())];
}

void judge(ReportPage& page, const Source& source, const History& history, bool contact) {
  const auto say = [&](Level level, std::string text) { page.verdicts.push_back({level, source.label, std::move(text)}); };
  const double residual = std::abs(largest(history, "residual")), iterations = largest(history, "iterations");
  say(Level::good, fmt::format("equilibrium in all {} steps: largest relative residual {:.1e}, at most {:g} iterations",
                               history.at("t").size(), residual, iterations));
  const auto positive = [](double v) { return v > 0; };
  if (history.count("negative_eigenvalues") == 0)
    say(Level::note, "the stability of the steps was not looked at (stability: last or off)");
  else if (largest(history, "negative_eigenvalues") != 0)
    say(Level::warning, fmt::format("unstable equilibria from t = {:.4g}: the constrained tangent has up to {:g} negative eigenvalues",
                                    when(history, "negative_eigenvalues", [](double v) { return v != 0; }),
                                    std::abs(largest(history, "negative_eigenvalues"))));
  else
    say(Level::good, "every equilibrium is stable: the constrained tangent is positive definite");
  if (history.count("unstable_volume")) {
    if (largest(history, "unstable_volume") > 0)
      say(Level::warning, fmt::format("strong ellipticity is lost from t = {:.4g}, at most in {:.3g} % of the volume: the solution "
                                      "depends on the mesh there",
                                      when(history, "unstable_volume", positive), 100 * largest(history, "unstable_volume")));
    else
      say(Level::good, "the material is strongly elliptic everywhere");
  }
  if (history.count("outside_fit")) {
    if (largest(history, "outside_fit") > 0)
      say(Level::warning, fmt::format("from t = {:.4g} the body is deformed beyond the fitted tests, at most in {:.3g} % of the volume",
                                      when(history, "outside_fit", positive), 100 * largest(history, "outside_fit")));
    else
      say(Level::good, "nowhere deformed beyond the fitted tests");
  }
  if (history.count("volume_change") && largest(history, "volume_change") > 0.02)
    say(Level::warning, fmt::format("a cell changes its volume by {:.3g} %, though the material is nearly incompressible",
                                    100 * largest(history, "volume_change")));
  if (contact && history.count("penetration"))
    say(Level::note, fmt::format("contact: largest penetration {:.1e} mm", std::abs(largest(history, "penetration"))));
  for (const auto& [name, values] : history)
    if (name.find("error") != std::string::npos && !values.empty())
      say(Level::note, fmt::format("{}: {:.3g} at the end, at most {:.3g}", name, values.back(), largest(history, name)));
}

}  // namespace

void add_solutions(ReportPage& page, const std::vector<Source>& sources, const ReportConfig& config) {
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
    judge(page, source, history, !solution.header().contact_nodes.empty());
    for (const auto& [name, values] : history) {
      if (name == "t" || name == "next_increment" || name.starts_with("weakest")) continue;
      if (std::all_of(values.begin(), values.end(), [](double v) { return v == 0; })) continue;  // nothing to see
      Chart& chart = charts.try_emplace(name, Chart{"path", in_words(name), "path parameter t", "-", in_words(name), units[name], {}, true}).first->second;
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
