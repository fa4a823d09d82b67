#include "base/csv_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include "base/error.hpp"

namespace langer {

std::vector<CsvCell> csv_cells(const std::string& line) {
  std::vector<CsvCell> row;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::size_t first = line.find_first_not_of(" \t", begin);
    if (first == std::string::npos || first >= end)
      row.push_back({"", static_cast<int>(begin) + 1});
    else
      row.push_back({line.substr(first, line.find_last_not_of(" \t", end - 1) + 1 - first), static_cast<int>(first) + 1});
    if (end == line.size()) return row;
    begin = end + 1;
  }
}

std::optional<double> csv_number(const std::string& text) {
  double x = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), x);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return x;
}

CsvTable parse_table(const std::string& text, const std::string& shown_name) {
  constexpr std::size_t most_errors = 10;
  CsvTable table;
  table.name = shown_name;
  std::vector<Error> errors;
  std::istringstream in(text);
  int line_number = 0;
  for (std::string line; std::getline(in, line) && errors.size() < most_errors;) {
    ++line_number;
    if (line_number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.ends_with('\r')) line.pop_back();
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos || line[first] == '#') continue;
    CsvRow row{line_number, csv_cells(line)};
    if (table.header.cells.empty())
      table.header = std::move(row);
    else if (row.cells.size() != table.header.cells.size())
      errors.push_back({{shown_name, line_number, 1},
                        "",
                        fmt::format("found {} cells", row.cells.size()),
                        fmt::format("{}, as in the line that names the columns", table.header.cells.size()),
                        ""});
    else
      table.rows.push_back(std::move(row));
  }
  if (!errors.empty()) throw Failure(Exit::input, errors);
  return table;
}

CsvTable read_table(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw Failure(Exit::input, {{path, 0, 0}, "", "cannot be read, or is empty", "a CSV file with a measured test", ""});
  return parse_table(text.str(), path);
}

}  // namespace langer
