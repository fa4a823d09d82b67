#include "core/base/csv_table.hpp"
#include "core/base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <sstream>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "core/base/lower_case.hpp"
#include "core/base/measured_units.hpp"

namespace langer {

namespace {

constexpr const char* blanks = " \t";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

// The cells of a line whose columns are separated by blanks, as many as there may be.
std::vector<CsvCell> words_of(const std::string& line) {
  std::vector<CsvCell> row;
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    row.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line.find_first_not_of(blanks, end);
  }
  return row;
}

// of a quoted cell that begins at `begin`; `end` is put behind its last quote
std::string unquoted(const std::string& line, std::size_t begin, std::size_t& end) {
  std::string text;
  for (end = begin + 1; end < line.size(); ++end) {
    if (line[end] != '"')
      text += line[end];
    else if (end + 1 < line.size() && line[end + 1] == '"')
      text += line[++end];
    else
      break;
  }
  end = std::min(end + 1, line.size());
  return text;
}

// How a text may be read as a number.
struct Digits {
  bool number = false, point = false, comma = false;
  bool thousands = false;  // its comma may part thousands: 1,234 and 12,345,678, not 0,123
  bool both = false;       // 1.234,5 or several commas: no number, but meant as one
};

// Decides what signs a number has, not which of them is the decimal sign: that is decided for the
// whole file. Exponents are allowed, and one sign in front.
Digits digits_of(const std::string& text) {
  Digits d;
  const auto is_digit = [](char c) {
    return c >= '0' && c <= '9';
  };
  const std::size_t from = text.find_first_not_of("+-");
  if (from == std::string::npos || from > 1) return d;
  const std::size_t mantissa = std::min(text.find_first_of("eE", from), text.size());
  const std::string m = text.substr(from, mantissa - from);
  if (m.empty() || m.find_first_not_of("0123456789.,") != std::string::npos ||
      !std::any_of(m.begin(), m.end(), is_digit))
    return d;
  const auto commas = std::count(m.begin(), m.end(), ',');
  const auto points = std::count(m.begin(), m.end(), '.');
  std::string as_point = text;
  std::replace(as_point.begin(), as_point.end(), ',', '.');
  d.comma = commas > 0;
  d.point = points > 0;
  d.both = (commas > 0 && points > 0) || commas > 1;
  d.number = !d.both && csv_number(as_point).has_value();
  const std::size_t comma = m.find(',');
  d.thousands = d.number && d.comma && mantissa == text.size() && comma >= 1 && comma <= 3 &&
                m[0] != '0' && m.size() == comma + 4;
  return d;
}

// The lines that count, with what a dialect makes of them.
struct CsvLine {
  int number = 0;
  std::string text;
  bool comment = false;
};

// Errors that spreadsheets put into cells, in English and German. A row that begins with one is no
// comment although it begins with #.
const std::set<std::string>& spreadsheet_errors() {
  static const std::set<std::string> known{"#N/A",  "#NV",   "#DIV/0!", "#VALUE!", "#WERT!",
                                           "#REF!", "#NUM!", "#ZAHL!",  "#NAME?",  "#NULL!"};
  return known;
}

// A line that begins with #, unless # begins an error of a spreadsheet.
bool is_comment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(blanks);
  if (line[first] != '#') {
    return false;
  }
  const std::size_t end = std::min(line.find_first_of(",;\t ", first), line.size());
  return spreadsheet_errors().count(line.substr(first, end - first)) == 0;
}

// Whether a text has bytes that no table has: zeros, and control characters other than ends of
// lines and tabulators.
bool is_binary(std::string_view text) {
  return std::ranges::any_of(text.substr(0, 4096), [](unsigned char c) {
    constexpr std::string_view of_text = "\n\r\t\f\v\x1a";
    return c < 0x20 && of_text.find(static_cast<char>(c)) == std::string_view::npos;
  });
}

// A page of a browser, which some programs save as .xls. Machines write other lines with < at the
// beginning of their files.
bool is_web_page(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos) return false;
  const std::string begin = lower_case(text.substr(first, 10));
  return std::ranges::any_of(std::array{"<!doctype", "<html", "<?xml", "<table"},
                             [&](const char* tag) { return begin.starts_with(tag); });
}

// Refuses files that are no table of text, with what their owner has to do.
void refuse_other_formats(const std::string& text, const std::string& name) {
  constexpr const char* convert =
      "open it and save the sheet with the curve as \"CSV UTF-8\", or: "
      "libreoffice --headless --convert-to csv FILE";
  const auto refuse = [&](const char* found, const char* hint) {
    throw Failure(Exit::input, {{name, 1, 1}, "", found, "a table as text (CSV)", hint});
  };
  if (text.starts_with("PK\x03\x04"))
    refuse("found a workbook (.xlsx, .ods) or another zip archive", convert);
  if (text.starts_with("\xD0\xCF\x11\xE0")) refuse("found a workbook of old Excel (.xls)", convert);
  if (text.starts_with("\x89HDF\r\n")) refuse("found an HDF5 file", convert);
  if (text.starts_with("\x1f\x8b")) {
    refuse("found a file compressed by gzip", "unpack it: gunzip FILE");
  }
  if (text.starts_with("%PDF"))
    refuse("found a PDF document", "ask for the numbers as a table; a PDF holds a picture of them");
  if (is_web_page(text)) refuse("found a web page or XML", convert);
  if (is_binary(text))
    refuse("found a binary file", "export the curve as a table from the program that wrote it");
}

// Lines with content. A mark of the byte order and the \r of Windows are removed; lines that
// contain separators only do not count.
std::vector<CsvLine> lines_of(const std::string& text, const std::string& name) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw Failure(Exit::input, {{name, 1, 1},
                                "",
                                "found text in UTF-16",
                                "UTF-8",
                                "save it as \"CSV UTF-8\", or: iconv -f UTF-16 -t UTF-8"});
  refuse_other_formats(text, name);
  std::vector<CsvLine> lines;
  // files of old Macintosh programs end their lines by \r alone
  char end = '\n';
  if (text.find('\n') == std::string::npos && text.find('\r') != std::string::npos) end = '\r';
  std::istringstream in(text);
  int number = 0;
  for (std::string line; std::getline(in, line, end);) {
    if (++number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.ends_with('\r')) line.pop_back();
    const std::size_t first = line.find_first_not_of(blanks);
    if (first == std::string::npos || line.find_first_not_of(",;\" \t") == std::string::npos)
      continue;
    lines.push_back({number, line, is_comment(line)});
  }
  return lines;
}

CsvRow row_of(const CsvLine& line, char separator) {
  return {line.number, csv_cells(line.text, separator)};
}

CsvRow commented_row(const CsvLine& line, char separator) {  // what stands behind the #
  const std::size_t first = line.text.find_first_not_of("# \t");
  if (first == std::string::npos) return {line.number, {}};
  CsvRow row{line.number, csv_cells(line.text.substr(first), separator)};
  for (CsvCell& cell : row.cells) cell.column += static_cast<int>(first);
  return row;
}

bool all_numbers(const CsvRow& row) {
  return !row.cells.empty() &&
         std::all_of(row.cells.begin(), row.cells.end(),
                     [](const CsvCell& c) { return digits_of(c.text).number; });
}

// Spreadsheets write "sep=;" into the first line.
std::optional<char> declared_separator(const std::vector<CsvLine>& lines) {
  if (lines.empty() || lines[0].text.size() != 5) return std::nullopt;
  if (lower_case(lines[0].text.substr(0, 4)) == "sep=") return std::optional(lines[0].text[4]);
  return std::nullopt;
}

// The line of column names, the separator that splits it, and where the rows begin.
struct HeaderPosition {
  CsvRow header;
  std::size_t next = 0;  // the line after it
  char separator = ',';
};

// The line of names that the caller recognises, with any of the separators.
std::optional<HeaderPosition> find_header(const std::vector<CsvLine>& lines,
                                          const std::string& separators,
                                          const CsvReading& reading) {
  if (!reading.is_header) return std::nullopt;
  // Blanks divide names that commas divide, too. They do not divide columns if a row has none.
  const auto divides = [&](char separator) {
    const auto row = std::ranges::find_if(lines.rbegin(), lines.rend(),
                                          [](const CsvLine& line) { return !line.comment; });
    return separator != ' ' || row == lines.rend() || row_of(*row, ' ').cells.size() > 1;
  };
  for (char separator : separators) {
    if (!divides(separator)) continue;
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (!lines[i].comment)
        if (CsvRow row = row_of(lines[i], separator); reading.is_header(row.cells))
          return HeaderPosition{std::move(row), i + 1, separator};
  }
  // a comment among those before the first numbers
  std::size_t first = 0;
  while (first < lines.size() && lines[first].comment) ++first;
  for (char separator : separators)
    for (std::size_t i = first;
         i-- > 0 && first < lines.size() && all_numbers(row_of(lines[first], separator));)
      if (CsvRow row = commented_row(lines[i], separator); reading.is_header(row.cells))
        return HeaderPosition{std::move(row), first, separator};
  return std::nullopt;
}

// The names above the first rows of numbers, below what a machine writes about the test: the top of
// the lines of texts, without a gap, that have as many cells as the last row. Nothing where that is
// the first line of the file.
std::optional<HeaderPosition> header_below_preamble(const std::vector<CsvLine>& lines,
                                                    const std::vector<std::size_t>& plain,
                                                    const std::string& separators) {
  const auto all_texts = [](const CsvRow& row) {
    return std::none_of(row.cells.begin(), row.cells.end(),
                        [](const CsvCell& c) { return digits_of(c.text).number; });
  };
  for (char separator : separators) {
    const auto row = [&](std::size_t k) {
      return row_of(lines[plain[k]], separator);
    };
    const CsvRow last = row(plain.size() - 1);
    if (last.cells.size() < 2 || !all_numbers(last)) continue;
    const std::size_t columns = last.cells.size();
    std::size_t numbers = 0;
    while (row(numbers).cells.size() != columns || !all_numbers(row(numbers))) ++numbers;
    std::size_t top = numbers;
    while (top > 0 && lines[plain[top - 1]].number + 1 == lines[plain[top]].number &&
           row(top - 1).cells.size() == columns && all_texts(row(top - 1)))
      --top;
    if (top == 0 || top == numbers) continue;
    return HeaderPosition{row(top), plain[top] + 1, separator};
  }
  return std::nullopt;
}

// Without a line that the caller recognises: the first line with the first separator that splits
// both it and the last line, or the comment above it if it has numbers only.
HeaderPosition first_header(const std::vector<CsvLine>& lines, const std::string& separators,
                            const std::string& name) {
  std::vector<std::size_t> plain;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!lines[i].comment) plain.push_back(i);
  if (plain.empty()) return {};
  if (auto header = header_below_preamble(lines, plain, separators)) return *std::move(header);
  const CsvLine &first = lines[plain.front()], &last = lines[plain.back()];
  char separator = ',';
  for (char c : separators)
    if (row_of(first, c).cells.size() > 1 && row_of(last, c).cells.size() > 1 &&
        (c != ' ' || all_numbers(row_of(last, c)))) {
      separator = c;
      break;
    }
  CsvRow row = row_of(first, separator);
  if (!all_numbers(row)) return {std::move(row), plain.front() + 1, separator};
  if (plain.front() > 0) {
    CsvRow above = commented_row(lines[plain.front() - 1], separator);
    if (above.cells.size() != row.cells.size() && separator != ' ')
      above = commented_row(lines[plain.front() - 1], ' ');
    if (above.cells.size() == row.cells.size() && !all_numbers(above))
      return {std::move(above), plain.front(), separator};
  }
  throw Failure(Exit::input,
                {{name, first.number, 1},
                 "",
                 "found numbers where the columns should have their names",
                 "a line of names above them, such as strain,nominal_stress_MPa",
                 "numpy.savetxt writes one with header=\"strain,nominal_stress_MPa\""});
}

// Exports often end their lines with separators: the empty cells behind the last column.
void drop_empty_end(std::vector<CsvCell>& cells, std::size_t down_to) {
  while (cells.size() > down_to && cells.back().text.empty()) cells.pop_back();
}

// A line of units has at least one that is no number: "1" and "-" may also be values.
bool is_line_of_units(const CsvRow& row) {
  bool some = false;
  for (const CsvCell& cell : row.cells) {
    if (!cell.text.empty() && !is_unit(cell.text)) return false;
    some = some || cell.text.find_first_not_of("1-") != std::string::npos;
  }
  return some;
}

// The decimal sign of a file; throws if the file does not show it. A comma in 1,234 may separate
// thousands; in 1,23 it cannot.
DecimalSign decimal_sign(const CsvTable& table) {
  const CsvCell* with_point = nullptr;
  const CsvCell* with_comma = nullptr;
  const CsvCell* maybe_thousands = nullptr;
  int line_of_point = 0;
  int line_of_comma = 0;
  int line_of_thousands = 0;
  for (const CsvRow& row : table.rows)
    for (const CsvCell& cell : row.cells) {
      if (cell.text.find_first_of(".,") == std::string::npos) continue;
      const Digits d = digits_of(cell.text);
      if (!d.number) continue;
      if (d.point && !with_point) {
        with_point = &cell;
        line_of_point = row.line;
      }
      if (d.comma && d.thousands && !maybe_thousands) {
        maybe_thousands = &cell;
        line_of_thousands = row.line;
      }
      if (d.comma && !d.thousands && !with_comma) {
        with_comma = &cell;
        line_of_comma = row.line;
      }
    }
  if (!with_comma && !maybe_thousands) return DecimalSign::point;
  const CsvCell& comma = with_comma ? *with_comma : *maybe_thousands;
  if (!with_comma) line_of_comma = line_of_thousands;
  if (with_point)
    throw Failure(
        Exit::input,
        {{table.name, line_of_comma, comma.column},
         "",
         fmt::format("found {} in a file with {} (line {})", comma.text, with_point->text,
                     line_of_point),
         "one decimal sign and no thousands separator",
         "in a fit, decimal: comma or decimal: point in the item of `data` says which of the two counts"});
  if (!with_comma)
    throw Failure(
        Exit::input,
        {{table.name, line_of_comma, comma.column},
         "",
         fmt::format("found {}, and no other number shows whether its comma is a decimal comma",
                     comma.text),
         "numbers with only one possible value",
         "in a fit, decimal: comma in the item of `data`; remove commas that separate thousands"});
  return DecimalSign::comma;
}

// Twice as many cells as names: each number was split at its decimal comma.
std::string hint_for_cells(const CsvTable& table, std::size_t found, char separator) {
  if (separator == ',' && table.header.cells.size() > 1 && found == 2 * table.header.cells.size())
    return "decimal commas need another separator of columns: semicolons or tabs, or quoted cells";
  return "";
}

}  // namespace

// Quotes protect separators and decimal commas; a doubled quote is one quote. Columns are counted
// in bytes from 1, so that a message can name the place.
std::vector<CsvCell> csv_cells(const std::string& line, char separator) {
  if (separator == ' ') return words_of(line);
  std::vector<CsvCell> row;
  std::size_t begin = 0;
  while (true) {
    std::size_t first = line.find_first_not_of(separator == '\t' ? " " : blanks, begin);
    std::size_t end = 0;
    if (first != std::string::npos && line[first] == '"') {
      const std::string text = unquoted(line, first, end);
      row.push_back({trimmed(text), static_cast<int>(first) + 1});
      end = std::min(line.find(separator, end), line.size());
    } else {
      end = std::min(line.find(separator, begin), line.size());
      if (first == std::string::npos || first >= end) first = begin;
      row.push_back({trimmed(line.substr(first, end - first)), static_cast<int>(first) + 1});
    }
    if (end == line.size()) return row;
    begin = end + 1;
  }
}

// A number with a decimal point that fills the whole text; independent of the locale.
std::optional<double> csv_number(const std::string& text) {
  double x = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), x);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return x;
}

std::optional<double> CsvTable::number(const CsvCell& cell) const {
  if (decimal == DecimalSign::point) return csv_number(cell.text);
  if (cell.text.find('.') != std::string::npos) return std::nullopt;
  std::string text = cell.text;
  const std::size_t comma = text.find(',');
  if (comma != std::string::npos) text[comma] = '.';
  return csv_number(text);
}

// Cells without a value, as statistics programs and spreadsheets write them.
bool is_blank_cell(const std::string& text) {
  static const std::set<std::string> known{"",    "NaN", "nan", "NAN",  "NA",
                                           "N/A", "n/a", "na",  "null", "NULL"};
  return known.count(text) > 0 || spreadsheet_errors().count(text) > 0;
}

bool is_unit(const std::string& text) {
  // units of columns that are not read, which may stand in a line of units all the same
  static const std::set<std::string> others{"Hz",
                                            "mm/s",
                                            "mm/min",
                                            "%/s",
                                            "1/s",
                                            "%/min",
                                            "deg",
                                            "J",
                                            "mJ",
                                            "\xC2\xB0",
                                            "K",
                                            "V",
                                            "mV",
                                            "\xC2\xB0"
                                            "C",
                                            "N/mm",
                                            "N/m",
                                            "in/min",
                                            "in/s",
                                            "mm2",
                                            "mm^2"};
  std::string inner = trimmed(text);
  const bool in_brackets = inner.size() > 2 && ((inner.front() == '(' && inner.back() == ')') ||
                                                (inner.front() == '[' && inner.back() == ']'));
  if (in_brackets) {
    inner = trimmed(inner.substr(1, inner.size() - 2));
  }
  return others.count(inner) > 0 || measured_unit(inner).has_value();
}

// Where the line of names is repeated: the numbers of these lines among those that count.
std::vector<std::size_t> repeated_names(const std::vector<CsvLine>& lines,
                                        const HeaderPosition& begin) {
  std::vector<std::size_t> found;
  const auto same = [](const CsvCell& a, const CsvCell& b) {
    return a.text == b.text;
  };
  for (std::size_t i = begin.next; i < lines.size(); ++i) {
    if (lines[i].comment) {
      continue;
    }
    CsvRow row = row_of(lines[i], begin.separator);
    drop_empty_end(row.cells, 1);
    CsvRow names = begin.header;
    drop_empty_end(names.cells, 1);
    if (std::equal(row.cells.begin(), row.cells.end(), names.cells.begin(), names.cells.end(),
                   same)) {
      found.push_back(i);
    }
  }
  return found;
}

bool has_numbers(const CsvRow& row) {
  return std::any_of(row.cells.begin(), row.cells.end(),
                     [](const CsvCell& cell) { return digits_of(cell.text).number; });
}

bool begins_with_text(const CsvRow& row) {
  const std::string& first = row.cells.front().text;
  return !digits_of(first).number && !is_blank_cell(first);
}

// Whether the rows of a table begin with a text, such as the name of a protocol.
bool rows_begin_with_text(const std::vector<CsvLine>& lines, const HeaderPosition& begin) {
  for (std::size_t i = begin.next; i < lines.size(); ++i) {
    const CsvRow row = row_of(lines[i], begin.separator);
    if (!lines[i].comment && has_numbers(row)) {
      return begins_with_text(row);
    }
  }
  return false;
}

// Whether a line belongs to what a machine writes between two blocks: it begins with a text and
// cannot be a row of the table.
bool is_between_blocks(const CsvLine& line, const HeaderPosition& begin, bool text_rows) {
  CsvRow row = row_of(line, begin.separator);
  drop_empty_end(row.cells, 1);
  if (!begins_with_text(row)) {
    return false;
  }
  const bool other_size = row.cells.size() != begin.header.cells.size();
  return !has_numbers(row) || (other_size && !text_rows);
}

// "Specimen 2" of the line above a line of names; cells of that line are joined.
std::string label_above(const std::vector<CsvLine>& lines, std::size_t names, char separator) {
  if (names == 0) {
    return "";
  }
  std::string label;
  for (const CsvCell& cell : row_of(lines[names - 1], separator).cells) {
    if (!cell.text.empty()) {
      append(label, " ", cell.text);
    }
  }
  return label;
}

CsvTable parse_table(const std::string& text, const std::string& shown_name,
                     const CsvReading& reading) {
  constexpr std::size_t most_errors = 10;
  CsvTable table;
  table.name = shown_name;
  std::vector<CsvLine> lines = lines_of(text, shown_name);
  std::string separators = "\t;, ";
  if (const auto told = declared_separator(lines)) {
    separators = *told;
    lines.erase(lines.begin());
  }
  std::optional<HeaderPosition> known = find_header(lines, separators, reading);
  const bool known_header = known.has_value();
  const HeaderPosition begin =
      known ? std::move(*known) : first_header(lines, separators, shown_name);
  table.header = begin.header;
  drop_empty_end(table.header.cells, 1);

  // Lines between the blocks are marked, so that they are not read as rows.
  std::vector<std::size_t> repeated;
  if (known_header) {
    repeated = repeated_names(lines, begin);
  } else {
    repeated = std::vector<std::size_t>();
  }
  const bool text_rows = !repeated.empty() && rows_begin_with_text(lines, begin);
  std::set<std::size_t> between;
  for (const std::size_t names : repeated) {
    between.insert(names);
    for (std::size_t i = names;
         i-- > begin.next && is_between_blocks(lines[i], begin, text_rows);) {
      between.insert(i);
    }
  }
  if (!repeated.empty()) {
    table.blocks = {label_above(lines, begin.next - 1, begin.separator)};
  }

  std::vector<Error> errors;
  bool units_may_follow = true;
  for (std::size_t i = begin.next; i < lines.size() && errors.size() < most_errors; ++i) {
    if (std::binary_search(repeated.begin(), repeated.end(), i)) {
      table.blocks.push_back(label_above(lines, i, begin.separator));
      units_may_follow = true;
    }
    if (lines[i].comment || between.count(i) > 0) continue;
    CsvRow row = row_of(lines[i], begin.separator);
    row.block = table.blocks.size() - 1;
    drop_empty_end(row.cells, table.header.cells.size());
    if (row.cells.size() != table.header.cells.size()) {
      errors.push_back(
          {{shown_name, row.line, 1},
           "",
           fmt::format("found {} cells", row.cells.size()),
           fmt::format("{}, as in the line that names the columns", table.header.cells.size()),
           hint_for_cells(table, row.cells.size(), begin.separator)});
    } else if (units_may_follow && row.cells.size() > 1 && is_line_of_units(row)) {
      std::vector<std::string> units;
      for (const CsvCell& cell : row.cells) units.push_back(cell.text);
      if (row.block > 0 && units != table.units) {
        errors.push_back({{shown_name, row.line, 1},
                          "",
                          "found units that differ from those of the first block",
                          "one line of units for all blocks",
                          "a file for each block"});
      }
      table.units = units;
      units_may_follow = false;
    } else {
      table.rows.push_back(std::move(row));
      units_may_follow = false;
    }
  }
  if (!errors.empty()) throw Failure(Exit::input, errors);
  if (reading.decimal) {
    table.decimal = *reading.decimal;
  } else {
    table.decimal = decimal_sign(table);
  }
  return table;
}

std::string text_of_table(const std::string& path) {
  const char* expected = "a CSV file with a measured test";
  std::string text = read_file(path, expected);
  if (text.empty()) throw Failure(Exit::input, Error{{path}, "", "is empty", expected, ""});
  return text;
}

CsvTable read_table(const std::string& path, const CsvReading& reading) {
  return parse_table(text_of_table(path), path, reading);
}

}  // namespace langer
