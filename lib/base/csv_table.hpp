// A CSV file as a table of texts with their places: comments start with #, the first other line names the columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace langer {

struct CsvCell {
  std::string text;
  int column = 1;  // of its first character in the line
};

struct CsvRow {
  int line = 0;
  std::vector<CsvCell> cells;
};

struct CsvTable {
  std::string name;  // of the file, for messages
  CsvRow header;
  std::vector<CsvRow> rows;
};

std::vector<CsvCell> csv_cells(const std::string& line);
std::optional<double> csv_number(const std::string& text);  // the whole text as a number

// throws Failure(input) for a row with more or fewer cells than the header
CsvTable parse_table(const std::string& text, const std::string& shown_name);
CsvTable read_table(const std::string& path);

}  // namespace langer
