// langer-report: one page that shows what a run has made; opens offline in any browser.
//   langer-report report.yaml --solution solution.h5 --curves curves.h5 -o report.html
#include <algorithm>
#include <filesystem>

#include "core/base/counted.hpp"
#include "core/base/text.hpp"
#include "core/hdf5/seal.hpp"
#include "report/page.hpp"
#include "report/report_config.hpp"
#include "report/sources.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// The default title: names of the two innermost folders of the page.
std::string folder_title(const std::string& output) {
  const auto folder = std::filesystem::absolute(output).lexically_normal().parent_path();
  return folder.parent_path().filename().string() + ": " + folder.filename().string();
}

bool is_warning(const report::Verdict& v) { return v.level == report::Level::warning; }

// Each kind of file adds its part to the page; the order of the calls is the order on the page.
std::vector<Summary> report_on(const Job<ReportConfig>& job) {
  using namespace report;
  if (job.inputs.empty())
    throw Failure(Exit::config, Error{{"the command line"},
                                      "",
                                      "no file to report on",
                                      "--solution, --curves, --table, --material, ...",
                                      ""});
  ReportPage page;
  page.title = text_or(job.config.title, folder_title(job.output));
  std::map<std::string, std::vector<Source>> sources;  // by the name of their port
  for (const auto& [port, files] : job.inputs) sources[port] = labelled(files);
  add_materials(page, sources["material"]);
  add_solutions(page, sources["solution"], job.config);
  add_curves(page, sources["curves"]);
  add_sweeps(page, sources["table"]);
  add_sensitivities(page, sources["sensitivity"]);
  for (const auto& [port, title] : {std::pair{"curves", "Curves: last state"},
                                    {"material", "Fits"},
                                    {"sensitivity", "Sensitivity"},
                                    {"mesh", "Meshes"}})
    if (!sources[port].empty()) add_summaries(page, title, sources[port]);
  for (const char* port : {"mesh", "material", "sensitivity", "solution", "curves", "table"})
    for (const Source& source : sources[port]) add_origin(page, source);
  const std::string text = html(page);
  write_text_file(job.output, text);
  const auto warnings = static_cast<std::size_t>(std::ranges::count_if(page.verdicts, is_warning));
  job.say("{}: {:.1f} MB, {}, {}, {}, {}{}", std::filesystem::path(job.output).filename().string(),
          static_cast<double>(text.size()) * 1e-6, counted(warnings, "warning"),
          counted(page.charts.size() + page.polars.size(), "chart"),
          counted(page.tables.size(), "table"), counted(page.bodies.size(), "body"),
          has_three() ? "" : " (built without three.js)");
  return {{"warnings", static_cast<double>(warnings), "-"}};
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::ReportConfig>(argc, argv, "report", langer::report_on);
}
