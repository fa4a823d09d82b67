// What the post stage's YAML may say.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "results/plot/figure_style.hpp"
#include "results/post/curves.hpp"
#include "results/post/cycle.hpp"
#include "results/post/figure.hpp"
#include "results/post/map.hpp"
#include "results/post/reading.hpp"
#include "results/post/render.hpp"
#include "results/post/steps.hpp"

namespace langer {

// When gnuplot draws: members of a large sweep are seldom looked at.
enum class Draw { always, on_request };
constexpr auto names(Draw) { return std::array{"always", "on_request"}; }

struct PostConfig {
  StressAt stress = StressAt::nodal_average;
  std::vector<ColumnChoice> columns, further;
  std::map<std::string, std::string> summary_at;
  std::map<std::string, CycleChoice> cycles;
  std::map<std::string, ReadingChoice> readings;
  std::vector<std::string> snapshots;
  bool series = false;
  std::map<std::string, FigureChoice> figures;
  std::map<std::string, MapChoice> maps;
  std::optional<RenderChoice> render;
  std::map<std::string, RenderChoice> renders;
  FigureStyle figure_style;
  Draw draw = Draw::always;
  static void fields(auto& v) {
    v(&PostConfig::stress, "stress", unit::none,
      "how stress at a node is taken from the Gauss points around it");
    v(&PostConfig::columns, "columns", unit::none,
      "the table, curves.csv and curves.h5; one row per state", required);
    v(&PostConfig::further, "further", unit::none,
      "more curves, in curves.h5 and its summary only");
    v(&PostConfig::summary_at, "summary_at", unit::none,
      "the summary, for tables over a sweep, is the last row; under <column>_<name> it also has these states by name: a row of "
      "the table, t=0.5 or u_ind=0.5, and the path must stop there");
    v(&PostConfig::cycles, "cycles", unit::none,
      "of periodic tests, by name: storage_<name>, loss_<name> and tan_delta_<name> of the last cycle, in the summary");
    v(&PostConfig::readings, "readings", unit::none,
      "what devices report, by name, in the summary: a column at a force or depth, a stiffness, the hysteresis of a cycle, R0 to R9 of "
      "a suction");
    v(&PostConfig::snapshots, "snapshots", unit::none,
      "states written as snapshot_<row>.hdf for ParaView: last, a row of the table (0 is unloaded), t=0.5 or u_ind=0.5");
    v(&PostConfig::series, "series", unit::none,
      "all states with their times for ParaView, PyVista and meshio: series.pvd, and series/step_<row>.vtu with what a snapshot has");
    v(&PostConfig::figures, "figures", unit::none,
      "x-y figures by name, <name>.svg and <name>.png, or in the formats of figure_style");
    v(&PostConfig::maps, "maps", unit::none,
      "fields on the surface by name, <name>.svg, .png and .csv; <name>_min and _max are in the summary");
    v(&PostConfig::render, "render", unit::none,
      "picture of the deformed body, render.svg and render.png");
    v(&PostConfig::renders, "renders", unit::none,
      "more such pictures by name, <name>.svg and <name>.png");
    v(&PostConfig::figure_style, "figure_style", unit::none,
      "how figures, maps and pictures are made");
    v(&PostConfig::draw, "draw", unit::none,
      "on_request: figures are left as scripts, and `gnuplot <name>.gp` in their folder draws one; for members of a large sweep, whose "
      "pictures take more time than they do");
  }
  std::vector<Complaint> complaints() const;
};

inline std::vector<Complaint> PostConfig::complaints() const {
  std::vector<Complaint> all;
  if (columns.empty()) all.push_back({"columns", "an empty list", "one or more columns", ""});
  std::set<std::string> seen;
  const auto once = [&](const char* key, const std::vector<ColumnChoice>& choices) {
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (const std::string name = column_name(choices[i]); !seen.insert(name).second)
        all.push_back({std::string(key) + "[" + std::to_string(i) + "]",
                       "a second column called " + name, "each name once", "give it another name"});
  };
  once("columns", columns);
  once("further", further);
  constexpr const char* steps = "last, a row of the table, t=0.5 or u_ind=0.5";
  for (std::size_t i = 0; i < snapshots.size(); ++i)
    if (!parse_step(snapshots[i]))
      all.push_back(
          {"snapshots[" + std::to_string(i) + "]", "\"" + snapshots[i] + "\"", steps, ""});
  if (render && !parse_step(render->step))
    all.push_back({"render.step", "\"" + render->step + "\"", steps, ""});
  for (const auto& [name, choice] : renders) {
    if (!parse_step(choice.step))
      all.push_back({"renders." + name + ".step", "\"" + choice.step + "\"", steps, ""});
    if (!is_column_name(name))
      all.push_back({"renders." + name, "\"" + name + "\"", column_letters, ""});
    if (name == "render" || figures.count(name) || maps.count(name))
      all.push_back({"renders." + name, "the name of another picture", "another name", ""});
  }
  for (const auto& [name, step] : summary_at) {
    if (!parse_step(step)) all.push_back({"summary_at." + name, "\"" + step + "\"", steps, ""});
    if (!is_column_name(name))
      all.push_back({"summary_at." + name, "\"" + name + "\"", column_letters, ""});
  }
  for (const auto& [name, cycle] : cycles) {
    if (!is_column_name(name))
      all.push_back({"cycles." + name, "\"" + name + "\"", column_letters, ""});
    for (const auto& [key, column] : {std::pair{".of", &cycle.of}, {".over", &cycle.over}})
      if (!seen.count(*column))
        all.push_back({"cycles." + name + key, "\"" + *column + "\"",
                       "the name of a column, without its unit", ""});
    for (const char* part : {"storage_", "loss_", "tan_delta_"})
      if (seen.count(part + name))
        all.push_back(
            {"cycles." + name, "a column is called " + (part + name), "another name", ""});
  }
  for (const auto& [name, reading] : readings) {
    const std::string key = "readings." + name;
    if (!is_column_name(name)) all.push_back({key, "\"" + name + "\"", column_letters, ""});
    if (seen.count(name)) all.push_back({key, "the name of a column", "another name", ""});
    for (const auto& [part, column] : {std::pair{".value_of", &reading.value_of},
                                       {".slope_of", &reading.slope_of},
                                       {".hysteresis_of", &reading.hysteresis_of},
                                       {".suction_of", &reading.suction_of},
                                       {".over", &reading.over}})
      if (*column && !seen.count(**column))
        all.push_back(
            {key + part, "\"" + **column + "\"", "the name of a column, without its unit", ""});
  }
  for (const auto& [name, map] : maps) {
    if (!is_column_name(name))
      all.push_back({"maps." + name, "\"" + name + "\"", column_letters, ""});
    if (!parse_step(map.step))
      all.push_back({"maps." + name + ".step", "\"" + map.step + "\"", steps, ""});
    if (name == "render" || figures.count(name))
      all.push_back({"maps." + name, "the name of another picture", "another name", ""});
    for (const char* end : {"_min", "_max"})
      if (seen.count(name + end))
        all.push_back({"maps." + name, "a column is called " + name + end, "another name", ""});
  }
  for (const auto& [key, choices] : {std::pair{"columns", &columns}, {"further", &further}})
    for (std::size_t i = 0; i < choices->size(); ++i)
      for (Complaint c : quotient_complaints((*choices)[i], columns, further)) {
        c.key = std::string(key) + "[" + std::to_string(i) + "]." + c.key;
        all.push_back(std::move(c));
      }
  for (const auto& [name, figure] : figures) {
    if (name == "render")
      all.push_back({"figures.render", "the name of the picture of the body", "another name", ""});
    for (Complaint c : langer::complaints(figure, columns)) {
      c.key = "figures." + name + "." + c.key;
      all.push_back(std::move(c));
    }
  }
  return all;
}

}  // namespace langer
