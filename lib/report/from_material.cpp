#include <algorithm>

#include "report/sources.hpp"
#include "store/h5.hpp"
#include "store/material_file.hpp"

namespace langer::report {

namespace {

// measured points and the law's line; the x of a test is its stretch, or the amount of shear
void add_tests(ReportPage& page, const Source& source, const FitRecord& fit) {
  for (const FittedTest& test : fit.tests) {
    Chart chart{"fits", fmt::format("{}: {}", source.label, test.name), test.kind == "simple_shear" ? "amount of shear" : "stretch along x",
                "-", fmt::format("stress ({})", test.measure), "MPa", {}, false};
    chart.series.push_back({"measured, x", test.first, test.stress_x, true});
    chart.series.push_back({"law, x", test.first, test.model_x, false});
    if (!test.stress_z.empty()) {
      chart.series.push_back({"measured, z", test.first, test.stress_z, true});
      chart.series.push_back({"law, z", test.first, test.model_z, false});
    }
    page.charts.push_back(std::move(chart));
  }
}

}  // namespace

void add_materials(ReportPage& page, const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    const auto fit = read_material(source.path).fit;
    if (!fit) continue;
    ReportTable table{"Parameters: " + source.label,
                      {{"parameter", "-"}, {"unit", "-"}, {"value", "-"}, {"standard error", "-"}, {"lower bound", "-"}, {"upper bound", "-"}},
                      {}};
    std::string open;
    for (const FittedParameter& p : fit->parameters) {
      table.rows.push_back({p.name, p.unit, p.value, p.standard_error, p.lower, p.upper});
      if (!(p.standard_error <= 0.5 * std::abs(p.value))) open += (open.empty() ? "" : ", ") + p.name;
    }
    page.tables.push_back(std::move(table));
    page.verdicts.push_back({Level::good, source.label,
                             fmt::format("fitted with a mean error of {:.2g} % and at most {:.2g} % of the largest stress; R² = {:.5f}",
                                         fit->mean_error_percent, fit->max_error_percent, fit->r2)});
    if (!open.empty())
      page.verdicts.push_back({Level::warning, source.label,
                               fmt::format("the tests hardly determine {}: standard error above half the value", open)});
    const h5::File file = h5::File::open(source.path);
    const auto said = [&](const char* group, const char* attribute) {
      if (!file.root().has(group) || !file.root().group(group).has_attribute(attribute)) return std::string();
      return file.root().group(group).text_attribute(attribute);
    };
    if (const std::string verdict = said("stability", "verdict"); !verdict.empty())
      page.verdicts.push_back({verdict.find("lost") == std::string::npos && verdict.find("loses") == std::string::npos ? Level::note : Level::warning,
                               source.label, verdict});
    if (const std::string least = said("identifiability", "words"); !least.empty())
      page.verdicts.push_back({Level::note, source.label, "least determined combination: " + least});
    add_tests(page, source, *fit);
  }
}

}  // namespace langer::report
