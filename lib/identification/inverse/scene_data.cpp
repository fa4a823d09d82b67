#include "identification/inverse/scene_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>

#include "core/base/csv_table.hpp"
#include "core/base/measured_units.hpp"
#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

// What a unit measures.
UnitKind quantity_of(const std::string& unit) {
  if (unit == "mm") return UnitKind::length;
  if (unit == "N") return UnitKind::force;
  if (unit == "MPa") return UnitKind::stress;
  if (unit == "s") return UnitKind::time;
  return UnitKind::ratio;
}

// The unit of a heading: travel_mm, Force (N), "Standardkraft [N]", Extension / mm, t_min. Behind a
// blank or an underscore h and d are units in columns of times only: u_h is no time.
std::optional<MeasuredUnit> unit_in_name(const std::string& name, UnitKind quantity) {
  for (const std::string separator : {"[", "(", "/", ",", "_", " "}) {
    const std::size_t at = name.find_last_of(separator);
    if (at == std::string::npos || at + 1 >= name.size()) continue;
    std::string text = name.substr(at + 1);
    std::erase_if(text, [](char c) { return c == ']' || c == ')'; });
    const auto unit = measured_unit(text);
    if (!unit || unit->quantity == UnitKind::ratio) continue;
    const bool joined = separator == "_" || separator == " ";
    const bool may_be_index = unit->name == "h" || unit->name == "d" || unit->name == "in";
    if (joined && may_be_index && unit->quantity != quantity) continue;
    return unit;
  }
  return std::nullopt;
}

// Of a column of times the words may be the unit: "Minutes".
std::optional<MeasuredUnit> unit_of(const std::string& name, const std::string& below,
                                    UnitKind quantity) {
  const auto unit = measured_unit(below);
  if (unit && unit->quantity != UnitKind::ratio) {
    return unit;
  }
  if (quantity == UnitKind::time) {
    const auto time = measured_unit(time_unit_text(name, ""));
    if (time) return time;
  }
  return unit_in_name(name, quantity);
}

// The columns that the config names, by their keys.
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

// The units that a column may have, for a message.
std::string known_units(const std::string& unit) {
  if (unit == "mm") return "one of length: mm, um, cm, m, in";
  if (unit == "N") return "one of force: N, mN, kN, gf, kgf, lbf";
  if (unit == "s") return "one of time: s, ms, min, h";
  if (unit == "MPa") return "one of pressure: MPa, kPa, Pa, mbar, psi";
  return "no unit";
}

// The factor from the unit of a column to mm, N, MPa or s.
double factor_of(const SceneColumn& column, const std::optional<MeasuredUnit>& unit) {
  if (!unit) return 1;
  if (unit->quantity != quantity_of(column.unit)) {
    refuse(column.place, "columns." + column.key,
           fmt::format("the unit {} of the column \"{}\"", unit->name, column.header),
           known_units(column.unit));
  }
  return unit->factor;
}

// The index of a column by its name; refuses a name that the file does not have.
std::size_t column_called(const std::vector<std::string>& names, const std::string& wanted,
                          const std::string& key, const Place& at) {
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::string near = nearest(wanted, names);
  refuse(at, "columns." + key, "no column \"" + wanted + "\"", "one of " + list_words(names),
         did_you_mean(near));
}

// Columns of a curves file of Langer.
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
    auto unit = measured_unit(column.unit);
    if (unit && unit->quantity == UnitKind::ratio) unit.reset();
    const double factor = factor_of(one, unit);
    for (double& value : one.values) value *= factor;
    read.columns.push_back(std::move(one));
  }
  read.rows.assign(read.columns.front().values.size(), Place{file});
  return read;
}

// Columns of a CSV file, restricted to the rows that `where` chooses.
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
  // rows at the end without a value in any of the columns: another record was longer
  std::vector<std::size_t> places;
  for (const auto& [key, wanted] : columns) {
    places.push_back(column_called(names, *wanted, key, header));
  }
  const auto is_blank = [&](const CsvRow& row) {
    return std::all_of(places.begin(), places.end(),
                       [&](std::size_t at) { return is_blank_cell(row.cells[at].text); });
  };
  while (!rows.empty() && is_blank(*rows.back())) rows.pop_back();

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
    std::string below;
    if (!table.units.empty()) below = table.units[at];
    const double factor = factor_of(one, unit_of(*wanted, below, quantity_of(one.unit)));
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
  if (key == "force" || key.starts_with("reaction")) return "N";
  return "mm";
}

const SceneColumn* SceneData::find(const std::string& key) const {
  for (const SceneColumn& column : columns)
    if (column.key == key) return &column;
  return nullptr;
}

SceneData read_scene_data(const FitData& data, const std::string& file) {
  SceneData read;
  if (std::filesystem::path(file).extension() == ".h5") {
    read = from_curves(data, file);
  } else {
    read = from_table(data, file);
  }
  if (data.name.empty()) {
    read.name = std::filesystem::path(file).stem().string();
  } else {
    read.name = data.name;
  }
  return read;
}

}  // namespace langer
