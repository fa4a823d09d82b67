// sensitivity.h5: effects of parameters on a curve.                                     docs/schema.md
//   /strain (m)   /curve (m) the stress at the identified values [MPa]
//   /parameters/<name>/{value, lower, upper}     attribute `order` of /parameters: the rows of what follows
//   /mu_star, /s, /spread (k, m)                 stress over parameter; units differ by row: attribute `units`
//   /mu_star_range (k, m)                        mu_star (upper - lower) [MPa], which compares
//   /zones/{from, to} (z)   /zones/{mu_star, s, spread, mu_star_range} (k, z)
//   /summary/<mu_star | s>_<name>_zone<1..z>
// and sensitivity.csv, sensitivity_zones.csv beside it.
#pragma once

#include <string>
#include <vector>

#include "sensitivity/one_at_a_time.hpp"
#include "store/identity.hpp"
#include "store/provenance.hpp"

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
};

std::string effect_unit(const std::string& parameter_unit);  // of a stress over a parameter
std::vector<Summary> summary_of(const SensitivityRecord& record);
std::string effects_csv(const SensitivityRecord& record);  // one row per strain
std::string zones_csv(const SensitivityRecord& record);    // one row per parameter and zone
void write_sensitivity(const std::string& path, const SensitivityRecord& record, const Identity& identity);

}  // namespace langer
