#include "identification/sensitivity/sensitivity_file.hpp"

#include <fmt/format.h>

#include "core/base/text.hpp"
#include "identification/sensitivity/sensitivity_tables.hpp"
#include "results/store/matrices.hpp"

namespace langer {

namespace {

void write_rates(const h5::Group& group, const std::string& name, const MatX& A,
                 const std::string& units) {
  write_matrix(group, name, A, "");
  group.annotate(name, "units", units);
}

// Value and interval as three datasets.
void write_estimate(const h5::Group& group, const std::string& name, const Estimate& e,
                    const std::string& unit) {
  write_matrix(group, name, e.value, unit);
  write_matrix(group, name + "_low", e.low, unit);
  write_matrix(group, name + "_high", e.high, unit);
}

void write_morris(const h5::Group& group, const Morris& m) {
  write_estimate(group, "mu", m.mu, "MPa");
  write_estimate(group, "mu_star", m.mu_star, "MPa");
  write_estimate(group, "sigma", m.sigma, "MPa");
  group.write_scalar("trajectories", m.trajectories, "-");
  group.write_scalar("without_curve", m.without_curve, "-");
  write_estimate(group.make_group("zones"), "mu_star", m.group_mu_star, "MPa");
  write_estimate(group.make_group("zones"), "sigma", m.group_sigma, "MPa");
}

void write_sobol(const h5::Group& group, const Sobol& s) {
  write_estimate(group, "first", s.first, "-");
  write_estimate(group, "total", s.total, "-");
  group.write<double>("mean", {static_cast<std::size_t>(s.mean.size())},
                      std::span(s.mean.data(), static_cast<std::size_t>(s.mean.size())), "MPa");
  group.write<double>("deviation", {static_cast<std::size_t>(s.deviation.size())},
                      std::span(s.deviation.data(), static_cast<std::size_t>(s.deviation.size())),
                      "MPa");
  group.write_scalar("rows", static_cast<double>(s.rows), "-");
  group.write_scalar("without_curve", static_cast<double>(s.without_curve), "-");
  write_estimate(group.make_group("zones"), "first", s.group_first, "-");
  write_estimate(group.make_group("zones"), "total", s.group_total, "-");
}

}  // namespace

std::string effect_unit(const std::string& parameter_unit) {
  if (parameter_unit == "MPa") return "-";
  if (parameter_unit == "-") return "MPa";
  if (parameter_unit == "1/MPa") return "MPa2";
  return "MPa_per_" + parameter_unit;
}

// Indices of each zone, for the summary of a pipeline.
std::vector<Summary> summary_of(const SensitivityRecord& r) {
  const MatX mu_star = zone_means(r.effects.mu_star, r.strain, r.zones);
  const MatX s = zone_means(r.effects.s, r.strain, r.zones);
  std::vector<Summary> all;
  for (std::size_t j = 0; j < r.parameters.size(); ++j)
    for (std::size_t z = 0; z < r.zones.size(); ++z) {
      const auto& [name, unit, value, lower, upper] = r.parameters[j];
      all.push_back(
          {fmt::format("mu_star_{}_zone{}", name, z + 1), row(mu_star, j)[z], effect_unit(unit)});
      all.push_back({fmt::format("s_{}_zone{}", name, z + 1), row(s, j)[z], effect_unit(unit)});
    }
  const auto add = [&](const char* what, const MatX& A, const char* unit) {
    for (std::size_t j = 0; j < r.parameters.size(); ++j)
      for (std::size_t z = 0; z < r.zones.size(); ++z)
        all.push_back(
            {fmt::format("{}_{}_zone{}", what, r.parameters[j].name, z + 1), row(A, j)[z], unit});
  };
  if (r.morris) {
    add("morris_mu_star", r.morris->group_mu_star.value, "MPa");
    add("morris_sigma", r.morris->group_sigma.value, "MPa");
  }
  if (r.sobol) {
    add("sobol_first", r.sobol->group_first.value, "-");
    add("sobol_total", r.sobol->group_total.value, "-");
  }
  return all;
}

// Writes the study as docs/schema.md describes it.
void write_sensitivity(const std::string& path, const SensitivityRecord& r,
                       const Identity& identity) {
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
    append(order, " ", p.name);
    append(units, " ", effect_unit(p.unit));
  }
  parameters.attribute("order", order);
  const auto write_effects = [&](const h5::Group& group, auto&& part) {
    write_rates(group, "mu_star", part(r.effects.mu_star), units);
    write_rates(group, "s", part(r.effects.s), units);
    write_rates(group, "spread", part(r.effects.spread), units);
    write_matrix(group, "mu_star_range", over_range(r, part(r.effects.mu_star)), "MPa");
  };
  write_effects(root, [](const MatX& A) { return A; });
  const h5::Group zones = root.make_group("zones");
  std::vector<double> from, to;
  for (const Zone& z : r.zones) {
    from.push_back(z.from);
    to.push_back(z.to);
  }
  zones.write<double>("from", {from.size()}, from, "-");
  zones.write<double>("to", {to.size()}, to, "-");
  write_effects(zones, [&](const MatX& A) { return zone_means(A, r.strain, r.zones); });
  if (r.morris) write_morris(root.make_group("morris"), *r.morris);
  if (r.sobol) write_sobol(root.make_group("sobol"), *r.sobol);
  write_summary(root, summary_of(r));
  file.commit();
}

}  // namespace langer
