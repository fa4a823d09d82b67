// A CSV file as a table of texts with their places, as laboratories and spreadsheets write them.
//   separators  tab, semicolon, comma or blanks: the one that gives the line of names; "sep=;" is obeyed; cells may be "quoted"
//   comments    lines that start with #; blank lines, lines of separators only and separators at the ends are left out
//   names       the first line that the caller recognises (lines before it are the machine's preamble);
//               else the first line; if that has numbers only, the comment right above it, as
//               numpy.savetxt writes it
//   units       a line of units only, right below the names
//   decimals    points or commas, not both in one file; commas that could separate thousands (1,234)
//               are refused unless the caller decides
//   blocks      a repeated line of names begins a new block of rows: one specimen after another
// Workbooks (.xlsx, .xls) are recognised by their first bytes and refused: a sheet has to be saved
// as CSV.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace langer {

enum class DecimalSign { point, comma };
constexpr auto names(DecimalSign) { return std::array{"point", "comma"}; }

struct CsvCell {
  std::string text;
  int column = 1;  // of its first character in the line
};

struct CsvRow {
  int line = 0;
  std::vector<CsvCell> cells;
  std::size_t block = 0;  // of CsvTable::blocks
};

struct CsvTable {
  std::string name;  // of the file, for messages
  CsvRow header;
  std::vector<std::string> units;  // by column, from a line below the names; empty: there is none
  std::vector<CsvRow> rows;
  // the line above each repeated line of names, such as "Specimen 2"; one entry: no blocks
  std::vector<std::string> blocks{""};
  DecimalSign decimal = DecimalSign::point;
  std::optional<double> number(const CsvCell& cell) const;  // the whole cell as a number
};

struct CsvReading {
  std::optional<DecimalSign> decimal;  // none: as the file shows
  std::function<bool(const std::vector<CsvCell>&)> is_header =
      {};  // knows the line of names; none: the first
};

std::vector<CsvCell> csv_cells(const std::string& line,
                               char separator = ',');       // ' ': any number of blanks
std::optional<double> csv_number(const std::string& text);  // the whole text as a number
// A cell without a value, as spreadsheets and scripts write it: empty, #N/A, NaN, NA, null.
bool is_blank_cell(const std::string& text);
bool is_unit(
    const std::string& text);  // "MPa", "[mm]", "(N/mm^2)", "%", "-": may stand below a name

// throws Failure(input): rows with more or fewer cells than the header, no names, text in UTF-16,
// decimals of two kinds
CsvTable parse_table(const std::string& text, const std::string& shown_name,
                     const CsvReading& reading = {});
std::string text_of_table(const std::string& path);  // throws Failure(input)
CsvTable read_table(const std::string& path, const CsvReading& reading = {});

}  // namespace langer
