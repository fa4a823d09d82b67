// Config of gather. `axes` and `members` are written by plan. A config that is written by hand
// needs them only for columns of axes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "pipeline/sweep/design.hpp"
#include "pipeline/sweep/sweep_figure.hpp"
#include "results/plot/figure_style.hpp"

namespace langer {

// A column of axis values. `design` or `samples` add an analysis of the members.
struct GatherAxis {
  std::string name, unit = "-";
  std::optional<Design> design;
  std::optional<int> samples;
  static void fields(auto& v) {
    v(&GatherAxis::name, "name", unit::none, "name of the column", required);
    v(&GatherAxis::unit, "unit", unit::none, "unit of the values; - for words and pure numbers");
    v(&GatherAxis::design, "design", unit::none,
      "the values number the points of this design: effects are computed");
    v(&GatherAxis::samples, "samples", unit::none,
      "the values number so many samples of the fitted parameters: spread of each quantity, most "
      "important parameters, bands in figures",
      at_least(2));
  }
};

// Name and axis values of one gathered file.
struct GatherMember {
  std::string path;
  std::vector<std::string> at;
  static void fields(auto& v) {
    v(&GatherMember::path, "path", unit::none, "name of the member: its file in the run's folder",
      required);
    v(&GatherMember::at, "at", unit::none, "its value on each axis", required);
  }
};

// The rows of the table: members of the sweep, parameters of one fit, those of a table that a fit
// made (results/store/record_table.hpp), frequencies or modes of each member, or its steps.
enum class GatherRows {
  members,
  parameters,
  laws,
  terms,
  population,
  posterior,
  frequencies,
  modes,
  steps
};
constexpr auto names(GatherRows) {
  return std::array{"members",   "parameters",  "laws",  "terms", "population",
                    "posterior", "frequencies", "modes", "steps"};
}

// The config of gather. Without any key the table has all quantities of all files.
struct GatherConfig {
  GatherRows rows = GatherRows::members;
  std::vector<std::string> columns;
  std::vector<GatherAxis> axes;
  std::vector<GatherMember> members;
  std::map<std::string, SweepFigure> figures;
  std::map<std::string, SweepMap> maps;
  FigureStyle figure_style;
  static void fields(auto& v) {
    v(&GatherConfig::rows, "rows", unit::none,
      "members: one for each file; parameters: one for each fitted parameter of one fit, with its "
      "true value (of synthetic data), standard error and 95 % interval; laws, terms, population, "
      "posterior: the table of a fit that compared laws, discovered terms, has specimens or a "
      "posterior; frequencies: one for each frequency of each solution with `harmonic`; modes: one "
      "for each mode of each with `modes`; steps: one for each row of the curves of each member, "
      "columns names their columns");
    v(&GatherConfig::columns, "columns", unit::none,
      "names of /summary in the wanted order; by default all of the first member");
    v(&GatherConfig::figures, "figures", unit::none,
      "x-y figures by name, <name>.svg, .png and .csv");
    v(&GatherConfig::maps, "maps", unit::none,
      "maps of all members in one picture, on one colour scale, <name>.svg and .png; the name of a "
      "map that post made");
    v(&GatherConfig::figure_style, "figure_style", unit::none, "how figures and maps are made");
    v(&GatherConfig::axes, "axes", unit::none, "first columns of the table; written by plan");
    v(&GatherConfig::members, "members", unit::none,
      "one per file gathered, in the same order; written by plan");
  }
  // What single keys cannot check: values of members fit to the axes, a design or samples are the
  // only axis, and names of figures and maps are different.
  std::vector<Complaint> complaints() const;
};

inline std::vector<Complaint> GatherConfig::complaints() const {
  std::vector<Complaint> all;
  const bool has_own_columns =
      !columns.empty() || !axes.empty() || !figures.empty() || !maps.empty();
  const bool of_vibrations = rows == GatherRows::frequencies || rows == GatherRows::modes;
  const bool of_one_table =
      rows != GatherRows::members && rows != GatherRows::steps && !of_vibrations;
  if (of_one_table && has_own_columns)
    all.push_back({"rows",
                   std::string(names(rows)[static_cast<std::size_t>(rows)]) +
                       ", together with columns, axes, figures or maps",
                   "none of them", "the table has columns of its own"});
  bool analysed = false;
  for (const GatherAxis& axis : axes) analysed = analysed || axis.design || axis.samples;
  if (of_vibrations && (!columns.empty() || !maps.empty() || analysed))
    all.push_back({"rows", "rows of vibrations, together with columns, maps, a design or samples",
                   "none of them", "the table has columns of its own"});
  const std::string one_each = "one for each of the " + std::to_string(axes.size()) + " axes";
  for (std::size_t i = 0; i < members.size(); ++i)
    if (members[i].at.size() != axes.size())
      all.push_back({"members[" + std::to_string(i) + "].at",
                     "found " + std::to_string(members[i].at.size()) + " values", one_each, ""});
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].design && axes.size() > 1)
      all.push_back(
          {"axes[" + std::to_string(i) + "].design", "a design together with other axes",
           "the design as the only axis",
           "gather it alone: name one member of the other axes, or give each its own pipeline"});
  if (rows == GatherRows::steps && (analysed || !maps.empty()))
    all.push_back({"rows", "steps, together with maps, a design or samples", "none of them",
                   "they compare members, not their steps"});
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].samples && axes.size() > 1)
      all.push_back({"axes[" + std::to_string(i) + "].samples", "samples together with other axes",
                     "the samples as the only axis",
                     "gather them alone: name one member of the other axes"});
  for (const auto& [name, figure] : figures) {
    const bool duplicate = maps.count(name) > 0;
    if (!duplicate && name != "table" && is_column_name(name)) continue;
    all.push_back({"figures." + name, "the name " + name,
                   "another name: letters, digits, _, + and - only",
                   duplicate ? "a map has it" : ""});
  }
  for (const auto& [name, map] : maps)
    if (map.compare && map.compare->with.size() != axes.size() && !axes.empty())
      all.push_back({"maps." + name + ".compare.with",
                     "found " + std::to_string(map.compare->with.size()) + " values", one_each,
                     ""});
  if (members.empty() && !axes.empty())
    all.push_back({"axes", "there are axes and no members", "members with their values", ""});
  return all;
}

}  // namespace langer
