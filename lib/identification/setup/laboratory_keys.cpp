// Keys of an item of `data` that say how a machine and its operator wrote a file.
#include <cmath>

#include "identification/setup/file_name_sizes.hpp"
#include "identification/setup/fit_config.hpp"

namespace langer {

// Checks keys that describe how a file was written.
void FitData::complain_of_laboratory_keys(std::vector<Complaint>& all) const {
  const auto complain = [&](std::string key, std::string found, std::string expected,
                            std::string hint = "") {
    all.push_back({std::move(key), std::move(found), std::move(expected), std::move(hint)});
  };
  const bool has_times = columns && !columns->time.empty();

  for (const auto& [key, given] :
       {std::pair("sign", sign), {"strain_sign", strain_sign}, {"stress_sign", stress_sign}}) {
    if (given && std::abs(*given) != 1) {
      complain(key, "found a factor", "1 or -1", "units have keys of their own: stress_unit");
    }
  }
  if (sign && (strain_sign || stress_sign)) {
    complain("sign", "found with strain_sign or stress_sign", "one of them",
             "sign is the sign of strain and stress together");
  }

  if (time_unit && !has_times) {
    complain("time_unit", "found without a column of times", "columns: {time: ...}");
  }
  for (const auto& [key, given] : {std::pair("step_at", step_at), {"ramp", ramp}}) {
    if (given && !has_times) {
      complain(key, "found without a column of times", "columns: {time: ...}");
    }
  }

  if (ratio && kind != DataKind::biaxial) {
    complain("ratio", "found in a test that is not biaxial", "kind: biaxial");
  }
  if (ratio && columns && columns->strain_z.empty() && !columns->stress_z.empty()) {
    complain("columns.strain_z", "missing with stress_z",
             "the deformation along z at which stress_z was measured",
             "with ratio: each axis has a grid of its own");
  }

  if (cycle == KeptCycle::last && skip_cycles > 0) {
    complain("skip_cycles", "found with cycle: last", "one of the two");
  }
  if (branch != KeptBranch::all && has_times) {
    complain("branch", "found with columns.time",
             "none: a history, of which no part can be left out",
             "without columns.time the times are not read");
  }
  const bool chooses_cycle = cycle == KeptCycle::last || skip_cycles > 0;
  if (chooses_cycle && compare_from) {
    complain("compare_from", "found with a choice of cycles", "one of the two",
             "both define where the comparison begins");
  }

  if (!name_pattern.empty()) {
    const std::string mistake = mistake_in_pattern(name_pattern);
    if (!mistake.empty()) {
      complain("name_pattern", mistake,
               "width, thickness, gauge_length, width_z, gauge_length_z or fibre_angle in braces",
               "such as *_w{width}_t{thickness}_L{gauge_length}");
    }
  }
}

}  // namespace langer
