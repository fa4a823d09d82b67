// What the post stage's YAML may say.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "post/curves.hpp"
#include "post/figure.hpp"
#include "post/render.hpp"
#include "post/steps.hpp"

namespace langer {

struct PostConfig {
  StressAt stress = StressAt::nodal_average;
  std::vector<ColumnChoice> columns, further;
  std::vector<std::string> snapshots;
  std::map<std::string, FigureChoice> figures;
  std::optional<RenderChoice> render;
  static void fields(auto& v) {
    v(&PostConfig::stress, "stress", unit::none, "how stress at a node is taken from the Gauss points around it");
    v(&PostConfig::columns, "columns", unit::none, "the table, curves.csv and curves.h5; one row per state", required);
    v(&PostConfig::further, "further", unit::none, "more curves, in curves.h5 and its summary only");
    v(&PostConfig::snapshots, "snapshots", unit::none,
      "states written as snapshot_<row>.hdf for ParaView: last, a row of the table (0 is unloaded), or t=0.5");
    v(&PostConfig::figures, "figures", unit::none, "x-y figures by name, <name>.svg and <name>.png");
    v(&PostConfig::render, "render", unit::none, "picture of the deformed body, render.svg and render.png");
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
        all.push_back({std::string(key) + "[" + std::to_string(i) + "]", "a second column called " + name, "each name once",
                       "give it another name"});
  };
  once("columns", columns);
  once("further", further);
  constexpr const char* steps = "last, a row of the table, or t=0.5";
  for (std::size_t i = 0; i < snapshots.size(); ++i)
    if (!parse_step(snapshots[i]))
      all.push_back({"snapshots[" + std::to_string(i) + "]", "\"" + snapshots[i] + "\"", steps, ""});
  if (render && !parse_step(render->step)) all.push_back({"render.step", "\"" + render->step + "\"", steps, ""});
  for (const auto& [name, figure] : figures) {
    if (name == "render") all.push_back({"figures.render", "the name of the picture of the body", "another name", ""});
    for (Complaint c : langer::complaints(figure, columns)) {
      c.key = "figures." + name + "." + c.key;
      all.push_back(std::move(c));
    }
  }
  return all;
}

}  // namespace langer
