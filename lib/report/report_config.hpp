// Config of the stage report.
#pragma once

#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "results/post/nodal_fields.hpp"
#include "results/post/quantity.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

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
      "above the page; by default the folders that the files lie in");
    v(&ReportConfig::shown, "fields", unit::none,
      "what colours the deformed body, beside its displacement; quantities of points");
    v(&ReportConfig::stress, "stress", unit::none, "how values of Gauss points come to nodes");
    v(&ReportConfig::states, "states", unit::none,
      "states of each solution that the body can be seen in, at most", at_least(2));
    v(&ReportConfig::megabytes, "megabytes", unit::none,
      "size of the page, at most; where it is short bodies have fewer states, then only their surface",
      at_least(1.2));
    v(&ReportConfig::accuracy, "accuracy", unit::none,
      "error that a result may have, such as 3%: only one whose estimated error is below is called good");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> all;
    if (!percent_of(accuracy))
      all.push_back(
          {"accuracy", "found \"" + accuracy + "\"", "a percentage above 0, such as 3%", ""});
    for (std::size_t i = 0; i < shown.size(); ++i)
      if (!is<OfPoint>(line_of(shown[i])))
        all.push_back({"fields[" + std::to_string(i) + "]", line_of(shown[i]).word,
                       "a quantity of points, as von_mises or J",
                       is<OfNodes>(line_of(shown[i])) ? "displacements are always there" : ""});
    return all;
  }
};

}  // namespace langer
