// One table over the members of a sweep: a row per member, first its values on the axes, then
// quantities of its summary.
//
// Every file of a stage has a /summary: a few numbers with names and units, such as the force of a
// solution. A quantity that a member does not have is NaN here and an empty cell in CSV. Refused: a
// quantity that no member has, and a quantity whose unit differs between members.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "results/store/provenance.hpp"

namespace langer {

// One member of a sweep with its results.
struct GatherInput {
  std::string path;             // the name of the member
  std::vector<std::string> at;  // its value on each axis, as text
  std::vector<Summary> summary;
};

// One axis, with the value of each member as text.
struct SweepAxis {
  std::string name, unit;
  std::vector<std::string> values;  // one per member
  bool samples = false;             // the values number samples of parameters (sweep/spread.hpp)
};

// One quantity of all members.
struct SweepColumn {
  std::string name, unit;
  std::vector<double> values;  // one per member
};

// The table: axes first, then quantities.
struct Sweep {
  std::vector<std::string> members;
  std::vector<SweepAxis> axes;
  std::vector<SweepColumn> columns;
};

// `axes` come without values. If `columns` is empty, the table has all quantities of the first
// member. `columns_at`: the place of the key, for messages.
Sweep gather(const std::vector<std::string>& columns, std::vector<SweepAxis> axes,
             const std::vector<GatherInput>& members, const Place& columns_at = {});

// The table as CSV: a header, and one line per member.
std::string csv(const Sweep& sweep);

}  // namespace langer
