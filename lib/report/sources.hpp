// The files that a report is made from, by kind, and what each kind adds to the page.
//
// A report shows one run, which may be a sweep of many members. Files of one kind are compared with
// each other, so each needs a short label; it is made from the parts of the paths that differ.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/page.hpp"
#include "report/report_config.hpp"

namespace langer::report {

// One file of a report.
struct Source {
  std::string path, label;
  double angle = 0;  // the number in the label, which differs between members of a sweep
  bool numbered = false;
};

// Labels from the folders in which the paths differ: alpha_030/post/curves.h5 is "alpha = 30". A
// single file is labelled by its own folder.
std::vector<Source> labelled(const std::vector<std::string>& paths);

// Each adds the tables, charts and verdicts of one kind of file to the page.
void add_solutions(ReportPage& page, const std::vector<Source>& sources,
                   const ReportConfig& config);
void add_curves(ReportPage& page, const std::vector<Source>& sources);
void add_sweeps(ReportPage& page, const std::vector<Source>& sources);
void add_materials(ReportPage& page, const std::vector<Source>& sources);
void add_sensitivities(ReportPage& page, const std::vector<Source>& sources);
// A table of /summary of the files of one kind, one row for each.
void add_summaries(ReportPage& page, const std::string& title, const std::vector<Source>& sources);
// Which program made a file, when, where, and from which inputs.
void add_origin(ReportPage& page, const Source& source);

}  // namespace langer::report
