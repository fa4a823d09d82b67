#include "results/store/record_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "results/store/curves_file.hpp"
#include "results/store/matrices.hpp"

namespace langer {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

RecordColumn& RecordTable::column(const std::string& wanted, const std::string& unit) {
  const auto found = std::ranges::find(columns, wanted, &RecordColumn::name);
  if (found != columns.end()) return *found;
  columns.push_back({wanted, unit, {}});
  return columns.back();
}

std::string csv(const RecordTable& table) {
  std::string text = table.row;
  for (const RecordColumn& column : table.columns) text += "," + csv_name(column.name, column.unit);
  text += "\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    text += csv_cell(table.rows[i]);
    for (const RecordColumn& column : table.columns) {
      text += ",";
      if (std::isfinite(column.values[i])) text += fmt::format("{:.10g}", column.values[i]);
    }
    text += "\n";
  }
  return text;
}

void write_tables(const h5::Group& root, const std::vector<RecordTable>& tables) {
  if (tables.empty()) return;
  const h5::Group all = root.make_group("tables");
  for (const RecordTable& table : tables) {
    const h5::Group one = all.make_group(table.name);
    std::vector<std::string> names;
    for (const RecordColumn& column : table.columns) {
      write_vector(one, column.name, column.values, column.unit);
      names.push_back(column.name);
    }
    one.attribute("row", table.row);
    one.attribute("rows", fmt::format("{}", fmt::join(table.rows, "\n")));
    one.attribute("columns", fmt::format("{}", fmt::join(names, "\n")));
  }
}

std::vector<RecordTable> read_tables(const h5::Group& root) {
  std::vector<RecordTable> tables;
  if (!root.has("tables")) return tables;
  const h5::Group all = root.group("tables");
  for (const std::string& name : all.groups()) {
    const h5::Group one = all.group(name);
    RecordTable table;
    table.name = name;
    table.row = one.text_attribute("row");
    table.rows = lines_of(one.text_attribute("rows"));
    for (const std::string& column : lines_of(one.text_attribute("columns"))) {
      const auto values = one.read<double>(column, {table.rows.size()}).values;
      table.columns.push_back({column, one.unit(column), values});
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace langer
