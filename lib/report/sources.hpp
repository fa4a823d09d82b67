// The files a report is made of, by kind, and what each kind adds to the page.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/page.hpp"
#include "report/report_config.hpp"

namespace langer::report {

struct Source {
  std::string path, label;
  double angle = 0;  // a number that tells the members of a sweep apart, in the label
  bool numbered = false;
};

// Labels from the folders that tell the files apart: alpha_030/post/curves.h5 is "alpha = 30"; a
// file alone by its own folder.
std::vector<Source> labelled(const std::vector<std::string>& paths);

void add_solutions(ReportPage& page, const std::vector<Source>& sources,
                   const ReportConfig& config);
void add_curves(ReportPage& page, const std::vector<Source>& sources);
void add_sweeps(ReportPage& page, const std::vector<Source>& sources);
void add_materials(ReportPage& page, const std::vector<Source>& sources);
void add_sensitivities(ReportPage& page, const std::vector<Source>& sources);
// /summary of the files of one kind, one row for each
void add_summaries(ReportPage& page, const std::string& title, const std::vector<Source>& sources);
// who made a file and from what
void add_origin(ReportPage& page, const Source& source);

}  // namespace langer::report
