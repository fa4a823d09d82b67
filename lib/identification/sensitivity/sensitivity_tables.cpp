#include "identification/sensitivity/sensitivity_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "results/store/curves_file.hpp"

namespace langer {

// mu_star (upper - lower)
MatX over_range(const SensitivityRecord& r, MatX mu_star) {
  for (std::size_t j = 0; j < r.parameters.size(); ++j)
    mu_star.row(static_cast<Eigen::Index>(j)) *= r.parameters[j].upper - r.parameters[j].lower;
  return mu_star;
}

std::vector<double> row(const MatX& A, std::size_t j) {
  const VecX x = A.row(static_cast<Eigen::Index>(j));
  return {x.data(), x.data() + x.size()};
}

// One row per strain, three columns per parameter.
std::string effects_csv(const SensitivityRecord& r) {
  std::vector<Column> columns{{"strain", "-", r.strain}, {"stress", "MPa", r.curve}};
  const MatX range = over_range(r, r.effects.mu_star);
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const std::string &name = r.parameters[j].name, unit = effect_unit(r.parameters[j].unit);
    columns.push_back({"mu_star_" + name, unit, row(r.effects.mu_star, j)});
    columns.push_back({"s_" + name, unit, row(r.effects.s, j)});
    columns.push_back({"spread_" + name, unit, row(r.effects.spread, j)});
    columns.push_back({"mu_star_range_" + name, "MPa", row(range, j)});
  }
  return csv(columns);
}

// One row per zone and parameter, all methods next to each other.
std::string zones_csv(const SensitivityRecord& r) {
  const auto of = [&](const MatX& A) {
    return zone_means(A, r.strain, r.zones);
  };
  const MatX mu_star = of(r.effects.mu_star);
  const MatX s = of(r.effects.s);
  const MatX spread = of(r.effects.spread);
  const MatX range = over_range(r, mu_star);
  const MatX spread_range = over_range(r, spread);
  std::vector<std::pair<std::string, MatX>> more;
  const auto add = [&](const std::string& name, const std::string& unit, const Estimate& e) {
    more.push_back({csv_name(name, unit), e.value});
    more.push_back({csv_name(name + "_low", unit), e.low});
    more.push_back({csv_name(name + "_high", unit), e.high});
  };
  more.push_back({"spread_range_MPa", spread_range});
  if (r.morris) {
    add("morris_mu_star", "MPa", r.morris->group_mu_star);
    add("morris_sigma", "MPa", r.morris->group_sigma);
  }
  if (r.sobol) {
    add("sobol_first", "-", r.sobol->group_first);
    add("sobol_total", "-", r.sobol->group_total);
  }
  std::string text = "parameter,zone,strain_from,strain_to,mu_star,s,spread,unit,mu_star_range_MPa";
  for (const auto& [name, A] : more) text += "," + name;
  text += "\n";
  for (std::size_t j = 0; j < r.parameters.size(); ++j)
    for (std::size_t z = 0; z < r.zones.size(); ++z) {
      text += fmt::format("{},{},{},{},{},{},{},{},{}", csv_cell(r.parameters[j].name), z + 1,
                          r.zones[z].from, r.zones[z].to, row(mu_star, j)[z], row(s, j)[z],
                          row(spread, j)[z], csv_cell(effect_unit(r.parameters[j].unit)),
                          row(range, j)[z]);
      for (const auto& [name, A] : more) text += fmt::format(",{}", row(A, j)[z]);
      text += "\n";
    }
  return text;
}

namespace {

// An estimate and both ends of its interval, for each parameter.
void add_columns(std::vector<Column>& columns, const std::string& what, const std::string& unit,
                 const SensitivityRecord& r, const Estimate& e) {
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const std::string name = what + "_" + r.parameters[j].name;
    columns.push_back({name, unit, row(e.value, j)});
    columns.push_back({name + "_low", unit, row(e.low, j)});
    columns.push_back({name + "_high", unit, row(e.high, j)});
  }
}

std::string percent(double part) { return fmt::format("{:.0f} %", 100 * part); }

}  // namespace

std::string morris_csv(const SensitivityRecord& r) {
  std::vector<Column> columns{{"strain", "-", r.strain}};
  add_columns(columns, "mu", "MPa", r, r.morris->mu);
  add_columns(columns, "mu_star", "MPa", r, r.morris->mu_star);
  add_columns(columns, "sigma", "MPa", r, r.morris->sigma);
  return csv(columns);
}

std::string sobol_csv(const SensitivityRecord& r) {
  std::vector<Column> columns{
      {"strain", "-", r.strain},
      {"mean", "MPa", {r.sobol->mean.data(), r.sobol->mean.data() + r.sobol->mean.size()}},
      {"deviation",
       "MPa",
       {r.sobol->deviation.data(), r.sobol->deviation.data() + r.sobol->deviation.size()}}};
  add_columns(columns, "first", "-", r, r.sobol->first);
  add_columns(columns, "total", "-", r, r.sobol->total);
  return csv(columns);
}

// Ranks the parameters in each zone, and names interactions that one-at-a-time effects miss.
std::vector<std::string> sensitivity_lines(const SensitivityRecord& r) {
  std::vector<std::string> lines;
  const MatX range = over_range(r, zone_means(r.effects.mu_star, r.strain, r.zones));
  const MatX spread = over_range(r, zone_means(r.effects.spread, r.strain, r.zones));
  const auto ranked = [&](const MatX& A, std::size_t z, auto&& text) {
    std::vector<std::size_t> order(r.parameters.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return row(A, a)[z] > row(A, b)[z]; });
    std::vector<std::string> words;
    for (std::size_t j : order) words.push_back(r.parameters[j].name + " " + text(j));
    return fmt::format("{}", fmt::join(words, ", "));
  };
  std::optional<std::size_t> last_zone;  // with strains: that of the largest stress
  for (std::size_t z = 0; z < r.zones.size(); ++z) {
    const std::string zone = fmt::format("{} to {}", r.zones[z].from, r.zones[z].to);
    if (r.parameters.empty() || std::isnan(row(range, 0)[z])) {
      lines.push_back(zone + ": none of the strains of this study is in this zone");
      continue;
    }
    last_zone = z;
    lines.push_back(zone + ": one at a time, MPa over the range: " + ranked(range, z, [&](auto j) {
                      return fmt::format("{:.3g}", row(range, j)[z]);
                    }));
    if (r.morris)
      lines.push_back(zone + ": Morris mu* (sigma), MPa:             " +
                      ranked(r.morris->group_mu_star.value, z, [&](auto j) {
                        return fmt::format("{:.3g} ({:.2g})",
                                           row(r.morris->group_mu_star.value, j)[z],
                                           row(r.morris->group_sigma.value, j)[z]);
                      }));
    if (r.sobol)
      lines.push_back(zone + ": Sobol total (alone):                 " +
                      ranked(r.sobol->group_total.value, z, [&](auto j) {
                        return percent(row(r.sobol->group_total.value, j)[z]) + " (" +
                               percent(row(r.sobol->group_first.value, j)[z]) + ")";
                      }));
  }
  if (r.morris && last_zone) {
    const std::size_t z = *last_zone;
    std::vector<std::string> words;
    for (std::size_t j = 0; j < r.parameters.size(); ++j) {
      const double sigma = row(r.morris->group_sigma.low, j)[z];
      const double seen = row(spread, j)[z];
      if (sigma > 2 * seen &&
          sigma > 0.05 * r.morris->group_mu_star.value.col(static_cast<Eigen::Index>(z)).maxCoeff())
        words.push_back(fmt::format("{} (spread {:.2g} MPa one at a time, sigma at least {:.2g})",
                                    r.parameters[j].name, seen, sigma));
    }
    if (!words.empty())
      lines.push_back(fmt::format("interactions that one-at-a-time effects do not see: {}",
                                  fmt::join(words, ", ")));
  }
  return lines;
}

}  // namespace langer
