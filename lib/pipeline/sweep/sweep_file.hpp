// sweep.h5: the table of a sweep. docs/schema.md
//   /members           text, one path per line
//   /axis/<name>       (members) f64 with `unit`; for words their index (i64) with the attribute `words`, separated by spaces
//   /values/<name>     (members) f64 with `unit`; NaN for a member without it
//   /effects/<quantity>/{one_at_a_time, one_at_a_time_spread, morris_mu_star, morris_sigma, sobol_first, sobol_total} (k)
//                      of the methods of a design, in the unit of the quantity over the range of each parameter; Sobol' indices
//                      have no unit; all but the first two also with _low and _high; attribute `order` of /effects: the parameters
//   /spread, /bands    of samples of fitted parameters (sweep/spread.hpp)
#pragma once

#include "pipeline/sweep/design.hpp"
#include "pipeline/sweep/gather.hpp"
#include "pipeline/sweep/spread.hpp"
#include "results/store/identity.hpp"

namespace langer {

// Writes the CSV table first, so that it exists when the file at `path` appears.
void write_sweep(const std::string& path, const std::string& csv_path, const Sweep& sweep,
                 const Design* design, const std::vector<QuantityEffects>& effects,
                 const Identity& identity, const std::vector<Spread>& spreads = {},
                 const std::vector<Band>& bands = {});

}  // namespace langer
