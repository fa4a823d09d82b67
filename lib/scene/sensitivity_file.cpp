#include "scene/sensitivity_file.hpp"

#include <fmt/format.h>

#include "store/curves_file.hpp"
#include "store/h5.hpp"

namespace langer {

namespace {

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

void write_matrix(const h5::Group& group, const char* name, const MatX& A, const std::string& unit, const std::string& units) {
  const Eigen::Matrix<double, -1, -1, Eigen::RowMajor> rows = A;
  group.write<double>(name, {static_cast<std::size_t>(A.rows()), static_cast<std::size_t>(A.cols())},
                      std::span(rows.data(), static_cast<std::size_t>(rows.size())), unit);
  if (!units.empty()) group.annotate(name, "units", units);
}

}  // namespace

std::string effect_unit(const std::string& parameter_unit) {
  if (parameter_unit == "MPa") return "-";
  if (parameter_unit == "-") return "MPa";
  if (parameter_unit == "1/MPa") return "MPa2";
  return "MPa_per_" + parameter_unit;
}

std::vector<Summary> summary_of(const SensitivityRecord& r) {
  const MatX mu_star = zone_means(r.effects.mu_star, r.strain, r.zones), s = zone_means(r.effects.s, r.strain, r.zones);
  std::vector<Summary> all;
  for (std::size_t j = 0; j < r.parameters.size(); ++j)
    for (std::size_t z = 0; z < r.zones.size(); ++z) {
      const auto& [name, unit, value, lower, upper] = r.parameters[j];
      all.push_back({fmt::format("mu_star_{}_zone{}", name, z + 1), row(mu_star, j)[z], effect_unit(unit)});
      all.push_back({fmt::format("s_{}_zone{}", name, z + 1), row(s, j)[z], effect_unit(unit)});
    }
  return all;
}

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

std::string zones_csv(const SensitivityRecord& r) {
  const auto of = [&](const MatX& A) { return zone_means(A, r.strain, r.zones); };
  const MatX mu_star = of(r.effects.mu_star), s = of(r.effects.s), spread = of(r.effects.spread);
  const MatX range = over_range(r, mu_star);
  std::string text = "parameter,zone,strain_from,strain_to,mu_star,s,spread,unit,mu_star_range_MPa\n";
  for (std::size_t j = 0; j < r.parameters.size(); ++j)
    for (std::size_t z = 0; z < r.zones.size(); ++z)
      text +=
          fmt::format("{},{},{},{},{},{},{},{},{}\n", r.parameters[j].name, z + 1, r.zones[z].from, r.zones[z].to,
                      row(mu_star, j)[z], row(s, j)[z], row(spread, j)[z], effect_unit(r.parameters[j].unit), row(range, j)[z]);
  return text;
}

void write_sensitivity(const std::string& path, const SensitivityRecord& r, const Identity& identity) {
  h5::File file = h5::File::create(path);
  const h5::Group root = file.root();
  write_identity(root, sensitivity_schema, identity);
  root.write<double>("strain", {r.strain.size()}, r.strain, "-");
  root.write<double>("curve", {r.curve.size()}, r.curve, "MPa");
  std::string order, units;
  const h5::Group parameters = root.make_group("parameters");
  for (const RankedNumber& p : r.parameters) {
    const h5::Group one = parameters.make_group(p.name);
    one.write_scalar("value", p.value, p.unit);
    one.write_scalar("lower", p.lower, p.unit);
    one.write_scalar("upper", p.upper, p.unit);
    order += (order.empty() ? "" : " ") + p.name;
    units += (units.empty() ? "" : " ") + effect_unit(p.unit);
  }
  parameters.attribute("order", order);
  const auto write_effects = [&](const h5::Group& group, auto&& part) {
    write_matrix(group, "mu_star", part(r.effects.mu_star), "", units);
    write_matrix(group, "s", part(r.effects.s), "", units);
    write_matrix(group, "spread", part(r.effects.spread), "", units);
    write_matrix(group, "mu_star_range", over_range(r, part(r.effects.mu_star)), "MPa", "");
  };
  write_effects(root, [](const MatX& A) { return A; });
  const h5::Group zones = root.make_group("zones");
  std::vector<double> from, to;
  for (const Zone& z : r.zones) from.push_back(z.from), to.push_back(z.to);
  zones.write<double>("from", {from.size()}, from, "-");
  zones.write<double>("to", {to.size()}, to, "-");
  write_effects(zones, [&](const MatX& A) { return zone_means(A, r.strain, r.zones); });
  write_summary(root, summary_of(r));
  file.commit();
}

}  // namespace langer
