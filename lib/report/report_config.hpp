// Config of the stage report.
#pragma once

#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "results/post/nodal_fields.hpp"
#include "results/post/quantity.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// The config of report. Every key has a default, so a report needs no config file.
struct ReportConfig {
  std::string title;
  std::vector<Quantity> shown{quantity("von_mises"), quantity("pressure"), quantity("sigma_1"),
                              quantity("J"), quantity("fibre_stretch")};
  StressAt stress = StressAt::nodal_average;
  int states = 25;
  double megabytes = 9;
  std::string accuracy = "3%";
  static void fields(auto& v) {
    v(&ReportConfig::title, "title", unit::none,
      "heading of the page; by default the names of the files' folders");
    v(&ReportConfig::shown, "fields", unit::none,
      "colours of the deformed body, in addition to its displacement; quantities of points");
    v(&ReportConfig::stress, "stress", unit::none, "how values of Gauss points come to nodes");
    v(&ReportConfig::states, "states", unit::none,
      "largest number of states of each solution in which the body is shown", at_least(2));
    v(&ReportConfig::megabytes, "megabytes", unit::none,
      "largest size of the page; if it is too small, bodies have fewer states, then only their "
      "surface",
      at_least(1.2));
    v(&ReportConfig::accuracy, "accuracy", unit::none,
      "acceptable error of a result, such as 3%: the report calls a result good only if its "
      "estimated error is below");
  }
  // What single keys cannot check: the form of the percentage, and that each quantity has values at
  // points. Displacements have none, and are always on the page.
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> all;
    if (!percent_of(accuracy))
      all.push_back(
          {"accuracy", "found \"" + accuracy + "\"", "a percentage above 0, such as 3%", ""});
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const QuantityLine& line = line_of(shown[i]);
      if (is<OfPoint>(line)) continue;
      std::string hint;
      if (is<OfNodes>(line)) hint = "displacements are always shown";
      all.push_back({"fields[" + std::to_string(i) + "]", line.word,
                     "a quantity of points, as von_mises or J", hint});
    }
    return all;
  }
};

}  // namespace langer
