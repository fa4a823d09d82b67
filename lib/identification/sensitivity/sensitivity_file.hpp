// sensitivity.h5: effects of parameters on a curve. docs/schema.md
//   /strain (m)   /curve (m) the stress at the identified values [MPa]
//   /parameters/<name>/{value, lower, upper}     attribute `order` of /parameters: the rows of what follows
//   /mu_star, /s, /spread (k, m)                 stress over parameter; units differ by row: attribute `units`
//   /mu_star_range (k, m)                        mu_star (upper - lower) [MPa], which compares
//   /zones/{from, to} (z)   /zones/{mu_star, s, spread, mu_star_range} (k, z)
//   /morris/{mu, mu_star, sigma}[_low, _high] (k, m) [MPa], over the range   /morris/zones/{mu_star, sigma}[_low, _high] (k, z)
//   /sobol/{first, total}[_low, _high] (k, m) [-]   /sobol/zones/... (k, z)   /sobol/{mean, deviation} (m) [MPa]
//   /summary/<mu_star | s>_<name>_zone<1..z>
//   /summary/<morris_mu_star | morris_sigma | sobol_first | sobol_total>_<name>_zone<1..z>
// and sensitivity.csv, sensitivity_zones.csv, sensitivity_morris.csv, sensitivity_sobol.csv beside
// it (sensitivity_tables.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identification/sensitivity/morris.hpp"
#include "identification/sensitivity/sobol.hpp"
#include "results/store/identity.hpp"
#include "results/store/provenance.hpp"

namespace langer {

struct RankedNumber {
  std::string name, unit;
  double value = 0, lower = 0, upper = 0;
};

struct SensitivityRecord {
  std::vector<RankedNumber> parameters;  // k
  std::vector<double> strain, curve;     // m
  OneAtATime effects;
  std::vector<Zone> zones;
  std::optional<Morris> morris;
  std::optional<Sobol> sobol;
};

std::string effect_unit(const std::string& parameter_unit);  // of a stress over a parameter
std::vector<Summary> summary_of(const SensitivityRecord& record);
void write_sensitivity(const std::string& path, const SensitivityRecord& record,
                       const Identity& identity);

}  // namespace langer
