#include "identification/inverse/scene_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>

#include "core/base/csv_table.hpp"
#include "core/config/writer.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

struct KnownUnit {
  const char *word, *unit;
  double factor;
};
constexpr KnownUnit known_units[]{
    {"mm", "mm", 1},       {"um", "mm", 1e-3},   {"µm", "mm", 1e-3},
    {"cm", "mm", 10},      {"m", "mm", 1e3},     {"N", "N", 1},
    {"mN", "N", 1e-3},     {"kN", "N", 1e3},     {"gf", "N", 9.80665e-3},
    {"MPa", "MPa", 1},     {"kPa", "MPa", 1e-3}, {"Pa", "MPa", 1e-6},
    {"mbar", "MPa", 1e-4}, {"bar", "MPa", 0.1},  {"mmHg", "MPa", 1.33322387415e-4},
    {"s", "s", 1},         {"ms", "s", 1e-3},    {"min", "s", 60}};

const KnownUnit* find_unit(std::string text) {
  std::erase_if(text,
                [](char c) { return c == '[' || c == ']' || c == '(' || c == ')' || c == ' '; });
  for (const KnownUnit& one : known_units)
    if (text == one.word) return &one;
  return nullptr;
}

// travel_mm, Force (N), "Standardkraft [N]", Extension / mm
const KnownUnit* unit_in_name(const std::string& name) {
  for (const char* parts : {"[", "(", "/", "_", " "})
    if (const auto at = name.find_last_of(parts); at != std::string::npos && at + 1 < name.size())
      if (const KnownUnit* unit = find_unit(name.substr(at + 1))) return unit;
  return nullptr;
}

std::vector<std::pair<const char*, const std::string*>> asked(const FitColumns& c) {
  std::vector<std::pair<const char*, const std::string*>> all{{"t", &c.t},
                                                              {"time", &c.time},
                                                              {"u_ind", &c.u_ind},
                                                              {"displacement", &c.displacement},
                                                              {"pressure", &c.pressure},
                                                              {"force", &c.force},
                                                              {"reaction_x", &c.reaction_x},
                                                              {"reaction_y", &c.reaction_y},
                                                              {"reaction_z", &c.reaction_z},
                                                              {"u_x", &c.u_x},
                                                              {"u_y", &c.u_y},
                                                              {"u_z", &c.u_z},
                                                              {"x", &c.x},
                                                              {"y", &c.y},
                                                              {"z", &c.z}};
  std::erase_if(all, [](const auto& one) { return one.second->empty(); });
  return all;
}

[[noreturn]] void refuse(const Place& at, const std::string& key, std::string found,
                         std::string expected, std::string hint = "") {
  throw Failure(Exit::input,
                Error{at, key, std::move(found), std::move(expected), std::move(hint)});
}

double factor_of(const SceneColumn& column, const KnownUnit* unit) {
  if (!unit) return 1;
  if (std::string(unit->unit) != column.unit)
    refuse(column.place, "columns." + column.key,
           fmt::format("the unit {} of the column \"{}\"", unit->word, column.header),
           column.unit == "-"
               ? "no unit"
               : fmt::format("one of {}", column.unit == "mm"  ? "length: mm, um, cm, m"
                                          : column.unit == "N" ? "force: N, mN, kN"
                                          : column.unit == "s" ? "time: s, ms, min"
                                                               : "pressure: MPa, kPa, Pa, mbar"));
  return unit->factor;
}

std::size_t column_called(const std::vector<std::string>& names, const std::string& wanted,
                          const std::string& key, const Place& at) {
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::string near = nearest(wanted, names);
  refuse(at, "columns." + key, "no column \"" + wanted + "\"", "one of " + list_words(names),
         near.empty() ? "" : "did you mean \"" + near + "\"?");
}

SceneData from_curves(const FitData& data, const std::string& file) {
  const CurvesFile curves = read_curves(file);
  SceneData read;
  std::vector<std::string> names;
  for (const Column& column : curves.curves.columns) names.push_back(column.name);
  for (const auto& [key, wanted] : asked(*data.columns)) {
    std::string name = *wanted;
    for (const Column& column : curves.curves.columns)
      if (csv_name(column.name, column.unit) == name) name = column.name;
    const Column& column = curves.curves.columns[column_called(names, name, key, {file})];
    SceneColumn one{key, name, unit_of_column(key), column.values, {file}};
    const double factor = factor_of(one, find_unit(column.unit));
    for (double& value : one.values) value *= factor;
    read.columns.push_back(std::move(one));
  }
  read.rows.assign(read.columns.front().values.size(), Place{file});
  return read;
}

SceneData from_table(const FitData& data, const std::string& file) {
  const auto columns = asked(*data.columns);
  CsvReading reading{data.decimal};
  reading.is_header = [&](const std::vector<CsvCell>& cells) {
    return std::any_of(cells.begin(), cells.end(),
                       [&](const CsvCell& cell) { return cell.text == *columns.front().second; });
  };
  const CsvTable table = read_table(file, reading);
  std::vector<std::string> names;
  for (const CsvCell& cell : table.header.cells) names.push_back(cell.text);
  const Place header{file, table.header.line, 1};
  std::vector<const CsvRow*> rows;
  for (const CsvRow& row : table.rows)
    if (std::all_of(data.where.begin(), data.where.end(), [&](const auto& one) {
          return row.cells[column_called(names, one.first, "where", header)].text == one.second;
        }))
      rows.push_back(&row);
  SceneData read;
  if (rows.empty())
    refuse(header, "file", "no rows", "a row of numbers at least",
           data.where.empty() ? "" : "see `where`");
  for (const auto& [key, wanted] : columns) {
    const std::size_t at = column_called(names, *wanted, key, header);
    SceneColumn one{key,
                    *wanted,
                    unit_of_column(key),
                    {},
                    {file, table.header.line, table.header.cells[at].column}};
    const KnownUnit* below = table.units.empty() ? nullptr : find_unit(table.units[at]);
    const double factor = factor_of(one, below ? below : unit_in_name(*wanted));
    for (const CsvRow* row : rows) {
      const auto number = table.number(row->cells[at]);
      if (!number || !std::isfinite(*number))
        refuse({file, row->line, row->cells[at].column}, "columns." + std::string(key),
               "found \"" + row->cells[at].text + "\"", "a number");
      one.values.push_back(factor * *number);
    }
    read.columns.push_back(std::move(one));
  }
  for (const CsvRow* row : rows) read.rows.push_back({file, row->line, 1});
  return read;
}

}  // namespace

const char* unit_of_column(const std::string& key) {
  if (key == "t") return "-";
  if (key == "time") return "s";
  if (key == "pressure") return "MPa";
  return key == "force" || key.starts_with("reaction") ? "N" : "mm";
}

const SceneColumn* SceneData::find(const std::string& key) const {
  for (const SceneColumn& column : columns)
    if (column.key == key) return &column;
  return nullptr;
}

SceneData read_scene_data(const FitData& data, const std::string& file) {
  SceneData read = std::filesystem::path(file).extension() == ".h5" ? from_curves(data, file)
                                                                    : from_table(data, file);
  read.name = data.name.empty() ? std::filesystem::path(file).stem().string() : data.name;
  return read;
}

}  // namespace langer
