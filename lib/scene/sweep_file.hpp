// sweep.h5: the table of a sweep.                                                       docs/schema.md
//   /members           text, one path per line
//   /axis/<name>       (members) f64 with `unit`; for words their index (i64) with the attribute `words`, separated by spaces
//   /values/<name>     (members) f64 with `unit`; NaN where a member does not have it
#pragma once

#include "post/gather.hpp"
#include "store/identity.hpp"

namespace langer {

// the CSV first, so that whoever sees `path` finds the table beside it
void write_sweep(const std::string& path, const std::string& csv_path, const Sweep& sweep, const Identity& identity);

}  // namespace langer
