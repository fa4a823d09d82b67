// sweep.h5: the table of a sweep. docs/schema.md
//   /members           text, one path per line
//   /axis/<name>       (members) f64 with `unit`; for words their index (i64) with the attribute `words`, separated by spaces
//   /values/<name>     (members) f64 with `unit`; NaN where a member does not have it
//   /effects/<quantity>/{one_at_a_time, one_at_a_time_spread, morris_mu_star, morris_sigma, sobol_first, sobol_total} (k)
//                      of a design, as far as asked for, in the quantity's unit over each parameter's range; shares without;
//                      with [_low, _high] all but the first two; attribute `order` of /effects: the parameters
//   /spread, /bands    of samples of what a fit leaves open (sweep/spread.hpp)
#pragma once

#include "pipeline/sweep/design.hpp"
#include "pipeline/sweep/gather.hpp"
#include "pipeline/sweep/spread.hpp"
#include "results/store/identity.hpp"

namespace langer {

// the CSV first, so that whoever sees `path` finds the table beside it
void write_sweep(const std::string& path, const std::string& csv_path, const Sweep& sweep,
                 const Design* design, const std::vector<QuantityEffects>& effects,
                 const Identity& identity, const std::vector<Spread>& spreads = {},
                 const std::vector<Band>& bands = {});

}  // namespace langer
