#include "identification/fit/test_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/base/error.hpp"
#include "core/base/measured_units.hpp"
#include "core/base/text.hpp"
#include "identification/fit/test_cycles.hpp"
#include "identification/fit/test_range.hpp"
#include "identification/fit/test_signs.hpp"

namespace langer {

namespace {

template <class E>
std::string word(E e) {
  return names(e)[static_cast<std::size_t>(e)];
}

// One axis of the test: where its numbers stand and what they are.
struct AxisColumns {
  std::size_t strain = 0, stress = 0;
  bool has_strain = false, has_stress = false;
  StrainMeasure measure = StrainMeasure::engineering;
  double strain_factor = 1;  // to a plain strain or stretch
  double stress_factor = 1;  // to MPa
};

// The reading of one table: errors are gathered and thrown together.
struct Reading {
  Reading(const CsvTable& read, const TestFormat& wanted) : table(read), format(wanted) {}

  const CsvTable& table;
  TestFormat format;
  std::vector<Error> errors;
  std::vector<std::string> notes;

  // Adds an error; ten of them are enough to see what is wrong with a file.
  void say(int line, int column, std::string key, std::string found, std::string expected,
           std::string hint = "") {
    if (errors.size() < 10)
      errors.push_back({{table.name, line, column},
                        std::move(key),
                        std::move(found),
                        std::move(expected),
                        std::move(hint)});
  }
  // The same at the heading of a column.
  void report_column(std::size_t column, std::string key, std::string found, std::string expected,
                     std::string hint = "") {
    say(table.header.line, table.header.cells[column].column, std::move(key), std::move(found),
        std::move(expected), std::move(hint));
  }
  // What was decided without a key, for the log: a reader of the config should know of it.
  void note(std::size_t column, const std::string& text) {
    notes.push_back(fmt::format("{}:{}:{}: {}", table.name, table.header.line,
                                table.header.cells[column].column, text));
  }
  void check() const {
    if (!errors.empty()) throw Failure(Exit::input, errors);
  }

  const std::string& name(std::size_t column) const { return table.header.cells[column].text; }
  ColumnMeaning meaning(std::size_t column) const {
    return column_meaning(name(column), column < table.units.size() ? table.units[column] : "");
  }
  std::string all_names() const {
    std::string all;
    for (const CsvCell& cell : table.header.cells) append(all, ", ", cell.text);
    return all;
  }

  // By its name, or by its place: "column 3". Of two columns of one name the first is read.
  std::optional<std::size_t> column(const std::string& wanted, const char* key) {
    std::optional<std::size_t> found;
    std::size_t same = 0;
    for (std::size_t i = 0; i < table.header.cells.size(); ++i) {
      if (name(i) != wanted) continue;
      if (!found) found = i;
      ++same;
    }
    if (same > 1) {
      note(*found, fmt::format("{} columns are called \"{}\": column {} is read; {}: \"column 3\" "
                               "names one by its place",
                               same, wanted, *found + 1, key));
    }
    if (!found) found = column_at(wanted);
    if (!found) {
      say(table.header.line, 1, key, "no column \"" + wanted + "\"", "one of " + all_names());
    }
    return found;
  }

  // "column 3" as a place, counted from 1.
  std::optional<std::size_t> column_at(const std::string& wanted) const {
    const std::string word = "column ";
    if (!wanted.starts_with(word)) return std::nullopt;
    const auto place = csv_number(wanted.substr(word.size()));
    for (std::size_t i = 0; i < table.header.cells.size(); ++i) {
      if (place && *place == static_cast<double>(i + 1)) return i;
    }
    return std::nullopt;
  }

  // puts the names of the one column of deformation and the one of stress into the format
  void find_columns() {
    constexpr const char* expected =
        "one column of strain, strain_percent or stretch, and one of cauchy_stress_MPa or nominal_stress_MPa (or kPa, Pa), or of a "
        "force in N and an elongation in mm";
    constexpr const char* cure =
        "name those to take in the item of `data`: columns: {strain_x: \"...\", stress_x: \"...\"}; of "
        "several of one name \"column 3\" names one by its place";
    for (std::size_t i = 0; i < table.header.cells.size(); ++i) {
      const ColumnMeaning m = meaning(i);
      if (m.of == ColumnMeaning::Of::unknown) continue;
      const bool deformation = m.of == ColumnMeaning::Of::deformation;
      std::string& slot = deformation ? format.strain_x : format.stress_x;
      if (!slot.empty())
        report_column(i, "columns",
                      fmt::format("a second column of {}: \"{}\"",
                                  deformation ? "deformation" : "stress", name(i)),
                      expected, cure);
      slot = name(i);
    }
    if (errors.empty() && (format.strain_x.empty() || format.stress_x.empty()))
      say(table.header.line, 1, "columns", "found " + all_names(), expected,
          "or name them in the item of `data`: columns: {strain_x: \"...\", stress_x: \"...\"}");
    check();
  }

  // a key and a column's name: what both say has to agree
  template <class T>
  std::optional<T> agreed(const std::optional<T>& key, const std::optional<T>& column,
                          std::size_t at, const char* name_of_key, const char* what) {
    if (key && column && *key != *column)
      report_column(at, name_of_key, fmt::format("{} for the column \"{}\"", word(*key), name(at)),
                    fmt::format("the {} that the column's name carries", what),
                    fmt::format("leave {} out: the name says it", name_of_key));
    return key ? key : column;
  }

  double size(const std::optional<double>& given, std::size_t column, const char* key,
              const char* what) {
    if (given) return *given;
    report_column(column, key, fmt::format("missing, for the column \"{}\"", name(column)), what,
                  fmt::format("{}: 10 (mm) in the item of `data`", key));
    return 1;
  }

  // The heading of a column and the use that the config makes of it have to agree.
  void check_quantity(std::size_t column, const ColumnMeaning& m, ColumnMeaning::Of used_as) {
    const bool as_stress = used_as == ColumnMeaning::Of::stress;
    const bool other_noun = m.noun != ColumnMeaning::Of::unknown && m.noun != used_as;
    bool other_unit = m.stress_unit.has_value();
    if (as_stress) {
      other_unit = m.strain_unit && is_length(*m.strain_unit);
    }
    if (!other_noun && !other_unit) {
      return;
    }
    report_column(column, as_stress ? "columns.stress_x" : "columns.strain_x",
                  "the column \"" + name(column) + "\"",
                  as_stress ? "a column of stress or force" : "a column of deformation",
                  "the columns of strain and stress may have been exchanged");
  }

  void add_stress(AxisColumns& axis, std::size_t column, const std::optional<double>& width,
                  const char* width_key) {
    axis.has_stress = true;
    axis.stress = column;
    const ColumnMeaning m = meaning(column);
    check_quantity(column, m, ColumnMeaning::Of::stress);
    says_compression = says_compression || m.compression;
    std::optional<StressUnit> unit =
        agreed(format.stress_unit, m.stress_unit, column, "stress_unit", "unit");
    if (!unit && format.normalised) unit = StressUnit::MPa;  // any serves
    if (!unit)
      return report_column(
          column, "stress_unit",
          m.foreign_unit.empty()
              ? "no unit for the column \"" + name(column) + "\""
              : fmt::format("the unit \"{}\" of the column \"{}\"", m.foreign_unit, name(column)),
          "stress_unit, or a name that ends in _MPa, _kPa or _Pa",
          "of a force: N, mN, kN, gf, kgf or lbf, with width and thickness");
    axis.stress_factor = format.stress_sign.value_or(1) * factor(*unit);
    std::optional<StressMeasure> named = m.stress;
    if (is_force(*unit) && format.normalised) {
      named = StressMeasure::nominal;
    } else if (is_force(*unit)) {
      axis.stress_factor /=
          size(width, column, width_key, "the width of the specimen in mm, across this force");
      axis.stress_factor /=
          size(format.thickness, column, "thickness", "the thickness of the specimen in mm");
      if (width && format.thickness && *format.thickness > 5 * *width)
        note(column, fmt::format("thickness: {:.4g} mm is {:.3g} times the width; is it in "
                                 "micrometres?",
                                 *format.thickness, *format.thickness / *width));
      named = StressMeasure::nominal;
    }
    const auto measure =
        agreed(stress_by_key, named, column, "stress",
               is_force(*unit) ? "measure of a force over the area at rest:" : "measure");
    if (measure) {
      check_one_measure(column, *measure);
      format.like.measure = *measure;
    } else if (!m.stress_question.empty()) {
      report_column(column, "stress",
                    fmt::format("the column \"{}\", which {}", name(column), m.stress_question),
                    "stress: cauchy, nominal (first Piola-Kirchhoff) or second_piola",
                    "in the item of `data`");
    } else if (found_by_name) {
      report_column(
          column, "stress", "not known for the column \"" + name(column) + "\"",
          "stress: cauchy (true) or nominal (force over the area at rest)",
          "in the item of `data`, or in the column's name: cauchy_stress_kPa, nominal_stress_kPa");
    } else if (!guessed_stress && format.like.measure == StressMeasure::cauchy) {
      note(
          column,
          fmt::format(
              "the measure of \"{}\" is not known: taken as cauchy (true); say stress: cauchy, or nominal (force over the area at rest)",
              name(column)));
      guessed_stress = true;
    }
  }

  // Both axes of a test are in one measure of stress.
  void check_one_measure(std::size_t column, StressMeasure measure) {
    const bool differs = named_stress && *named_stress != measure;
    if (differs || (guessed_stress && measure != StressMeasure::cauchy)) {
      report_column(column, "stress",
                    fmt::format("{} for the column \"{}\", unlike the other axis", word(measure),
                                name(column)),
                    "one measure for both axes",
                    "stress: " + word(measure) + " states it for both");
    }
    named_stress = measure;
  }

  void add_strain(AxisColumns& axis, std::size_t column, const std::optional<double>& length,
                  const char* length_key) {
    axis.has_strain = true;
    axis.strain = column;
    const ColumnMeaning m = meaning(column);
    check_quantity(column, m, ColumnMeaning::Of::deformation);
    says_compression = says_compression || m.compression;
    const bool slides = format.like.kind == TestKind::simple_shear;
    std::optional<StrainUnit> unit =
        agreed(format.strain_unit, m.strain_unit, column, "strain_unit", "unit");
    if (!unit && (m.lengths || format.gauge_length || !m.foreign_unit.empty()) && !slides)
      report_column(column, "strain_unit",
                    m.foreign_unit.empty() ? "no unit for the column \"" + name(column) + "\""
                                           : fmt::format("the unit \"{}\" of the column \"{}\"",
                                                         m.foreign_unit, name(column)),
                    "strain_unit: fraction, percent, mm or um, or a name that ends in it");
    axis.strain_factor = factor(unit.value_or(StrainUnit::fraction));
    if (unit && is_length(*unit))
      axis.strain_factor /=
          size(length, column, length_key, "the length at rest between grips or marks in mm");
    const std::optional<StrainMeasure> measure =
        agreed(format.strain, m.strain, column, "strain", "measure");
    if (unit && is_length(*unit) && measure && *measure > StrainMeasure::stretch)
      report_column(column, "strain", word(*measure) + " for lengths",
                    "engineering (an elongation) or stretch (a length)");
    if (!measure && !m.strain_question.empty() && !slides) {
      report_column(column, "strain",
                    fmt::format("the column \"{}\", which {}", name(column), m.strain_question),
                    "strain: engineering, stretch, log or green_lagrange", "in the item of `data`");
      return;
    }
    const double sign = format.strain_sign.value_or(1);
    if (measure) {
      axis.measure = *measure;
    } else if (!slides) {
      axis.measure = measure_by_values(axis, column, m);
    }
    // a stretch has no sign
    if (axis.measure != StrainMeasure::stretch || slides) {
      axis.strain_factor *= sign;
    } else if (strain_sign_alone && sign < 0) {
      report_column(column, "strain_sign",
                    fmt::format("-1 for the stretches of the column \"{}\"", name(column)),
                    "a strain or an elongation", "a stretch below 1 is compression in any case");
    }
  }

  // No name gives the measure: the first value decides, or the file is refused.
  StrainMeasure measure_by_values(const AxisColumns& axis, std::size_t column,
                                  const ColumnMeaning& m) {
    const auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const CsvRow& r) {
      return chosen(r) && table.number(r.cells[column]);
    });
    if (row == table.rows.end())
      return StrainMeasure::engineering;  // said where the numbers are read
    const double first = axis.strain_factor * *table.number(row->cells[column]);
    const bool documented = name(column) == "strain" || name(column) == "strain_percent";
    constexpr double near = 0.1;
    if (m.position && std::abs(first) > 0.01) {
      say(row->line, row->cells[column].column, "columns.strain_x",
          fmt::format("the position \"{}\", which does not start at 0", name(column)),
          "an elongation", "subtract its first value; strain: stretch if it is the length itself");
    } else if (std::abs(first - 1) <= near) {
      if (!documented) {
        note(column, fmt::format("\"{}\" starts at {:g}: taken as stretch; say strain: stretch",
                                 name(column), first));
        return StrainMeasure::stretch;
      }
      say(row->line, row->cells[column].column, "strain",
          fmt::format("a column \"{}\" that starts at {:g}", name(column), first),
          "the name stretch if it is one",
          "or strain: stretch, or strain: engineering, in the item of `data`");
    } else if (std::abs(first) <= near || m.lengths) {
      if (!documented && !m.lengths)
        note(
            column,
            fmt::format(
                "the measure of \"{}\" is not known: taken as engineering strain; say strain: engineering, log or green_lagrange",
                name(column)));
    } else if (!documented) {
      say(row->line, row->cells[column].column, "strain",
          fmt::format("a column \"{}\" that starts at {:g}, neither 0 nor 1", name(column), first),
          "strain: engineering, stretch, log or green_lagrange", "in the item of `data`");
    }
    return StrainMeasure::engineering;
  }

  // A number of a cell. What is none becomes an error with a hint of the likely cause: the decimal
  // sign, or a cell without a value between two points.
  double number(const CsvRow& row, std::size_t column) {
    const CsvCell& cell = row.cells[column];
    const auto x = table.number(cell);
    if (x && std::isfinite(*x)) return *x;
    const bool decimals = !x &&
                          cell.text.find_first_not_of("+-0123456789.,eE") == std::string::npos &&
                          cell.text.find_first_of(".,") != std::string::npos;
    // one message for a row without values
    if (is_blank_cell(cell.text) && line_of_blank == row.line) return 0;
    if (is_blank_cell(cell.text)) line_of_blank = row.line;
    std::string hint;
    if (decimals) {
      hint = fmt::format("decimal {}s are read here, without thousands separators",
                         word(table.decimal));
    } else if (is_blank_cell(cell.text)) {
      hint = "cells without a value may stand below the last point of a test, not between points";
    }
    say(row.line, cell.column, "", cell.text.empty() ? "found nothing" : "found " + cell.text,
        "a finite number", hint);
    return 0;
  }

  // A number times a factor of units, which may leave the range of numbers.
  double scaled(const CsvRow& row, std::size_t column, double unit) {
    const double x = unit * number(row, column);
    constexpr double largest = 1e100;  // its square has to stay finite
    if (std::abs(x) <= largest) return x;
    say(row.line, row.cells[column].column, "", "found " + row.cells[column].text,
        fmt::format("a number of at most {:g} in MPa and s", largest));
    return 0;
  }

  // The stretch of the other axis, which follows from the row by the ratio.
  double stretch_above_0(const CsvRow& row, const AxisColumns& axis, double stretch) {
    if (stretch > 0 && std::isfinite(stretch)) return stretch;
    say(row.line, row.cells[axis.strain].column, "ratio",
        fmt::format("found the stretch {} along the other axis", stretch), "a stretch > 0");
    return 1;
  }

  // The stretch from any measure of strain: 1 + e, sqrt(1 + 2 E), exp(ln stretch). In simple shear
  // the column is the amount of shear itself.
  double stretch(const CsvRow& row, const AxisColumns& axis) {
    const std::size_t before = errors.size();
    const double e = number(row, axis.strain) * axis.strain_factor;
    if (format.like.kind == TestKind::simple_shear) return e;
    double l = 0;
    if (axis.measure == StrainMeasure::stretch) {
      l = e;
    } else if (axis.measure == StrainMeasure::engineering) {
      l = 1 + e;
    } else if (axis.measure == StrainMeasure::green_lagrange) {
      l = std::sqrt(1 + 2 * e);
    } else {
      l = std::exp(e);
    }
    if (errors.size() > before) return 1;
    if (l > 0 && std::isfinite(l)) return l;
    // where one stretch is impossible those behind it are so for the same reason
    if (found_bad_stretch) return 1;
    found_bad_stretch = true;
    const bool may_be_turned = axis.measure != StrainMeasure::stretch && !format.strain_sign;
    say(row.line, row.cells[axis.strain].column, "", fmt::format("found the stretch {}", l),
        "a stretch > 0",
        may_be_turned ? "sign: -1 in the item of `data` where pulling counts negative" : "");
    return 1;
  }

  // Whether the config wants this row: by the block that it is in, and by texts in other columns.
  bool chosen(const CsvRow& row) const {
    if (block && row.block != *block) return false;
    return std::all_of(where.begin(), where.end(),
                       [&](const auto& w) { return row.cells[w.first].text == w.second; });
  }

  bool several_blocks() const { return table.blocks.size() > 1 && !block; }

  // A machine may write one block after another, each with its own line of names.
  void choose_block() {
    if (format.block.empty()) return;
    const auto found = std::find(table.blocks.begin(), table.blocks.end(), format.block);
    if (found != table.blocks.end()) {
      block = static_cast<std::size_t>(found - table.blocks.begin());
      return;
    }
    std::string all;
    for (const std::string& label : table.blocks) append(all, ", ", label);
    say(table.header.line, 1, "block", "no block \"" + format.block + "\"",
        table.blocks.size() > 1 ? "one of " + all
                                : "a file in which the line of names is repeated");
  }
  bool is_empty(const CsvRow& row, const AxisColumns& axis) const {
    return row.cells[axis.strain].text.empty() && row.cells[axis.stress].text.empty();
  }

  // The heading, the line of units or the key says the unit; none of them: seconds.
  void add_time(std::size_t column) {
    time_column = column;
    std::string below;
    if (column < table.units.size()) below = table.units[column];
    const std::string text = time_unit_text(name(column), below);
    const auto unit = measured_unit(text);
    const bool is_time = unit && unit->quantity == UnitKind::time;
    if (format.time_unit) {
      time_factor = factor(*format.time_unit);
      if (is_time && unit->factor != time_factor) {
        report_column(
            column, "time_unit",
            fmt::format("{} for the column \"{}\"", word(*format.time_unit), name(column)),
            "the unit that the column's name carries", "leave time_unit out: the name says it");
      }
    } else if (is_time) {
      time_factor = unit->factor;
    } else if (!text.empty()) {
      report_column(column, "time_unit",
                    fmt::format("the unit \"{}\" of the column \"{}\"", text, name(column)),
                    "a unit of time: s, ms, min or h", "time_unit: s in the item of `data`");
    }
  }

  // [s]; that of one row after another of a test does not go back
  double time(const CsvRow& row, const Test& test) {
    const double t = scaled(row, *time_column, time_factor);
    if (!test.time.empty() && t < test.time.back())
      say(row.line, row.cells[*time_column].column, "columns.time",
          fmt::format("found {:g} s after {:g} s", t, test.time.back()),
          "times that do not go back");
    return t;
  }

  std::optional<std::size_t> time_column;
  std::optional<std::size_t> block;  // the one that is read; none: all
  double time_factor = 1;            // to s
  std::vector<std::pair<std::size_t, std::string>> where;
  bool found_by_name = false;
  std::optional<StressMeasure> stress_by_key = format.stress;
  std::optional<StressMeasure> named_stress;  // by the key or by a column
  bool guessed_stress = false;
  bool says_compression = false;  // a heading
  int line_of_blank = 0;          // the last row that was refused for a cell without a value
  bool found_bad_stretch = false;
  bool strain_sign_alone = format.strain_sign && !format.stress_sign;
};

// The rows of one test: those of one block, and of one text in the column `split`.
struct RowGroup {
  std::string name;
  std::vector<const CsvRow*> rows;
};

// "Specimen 2" -> Specimen_2: names of tests become names of files and figures.
std::string block_name(const CsvTable& table, std::size_t block) {
  std::string name;
  for (const char c : table.blocks[block]) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (plain) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (name.ends_with('_')) name.pop_back();
  if (name.empty()) name = std::to_string(block + 1);
  return name;
}

// Rows of each test: `split` makes one test for each text of its column.
std::vector<RowGroup> groups_of_rows(const Reading& in, const std::optional<std::size_t>& split) {
  std::vector<RowGroup> groups;
  for (const CsvRow& row : in.table.rows) {
    if (!in.chosen(row)) continue;
    std::string name;
    if (in.several_blocks()) name = block_name(in.table, row.block);
    if (split) append(name, "_", row.cells[*split].text);
    const auto found = std::ranges::find(groups, name, &RowGroup::name);
    if (found != groups.end()) {
      found->rows.push_back(&row);
    } else {
      groups.push_back({name, {&row}});
    }
  }
  return groups;
}

// Without the rows at the end that hold no value in any of the columns.
std::vector<const CsvRow*> without_blank_end(std::vector<const CsvRow*> rows,
                                             const std::vector<std::size_t>& columns) {
  const auto is_blank = [&](const CsvRow& row) {
    return std::all_of(columns.begin(), columns.end(),
                       [&](std::size_t c) { return is_blank_cell(row.cells[c].text); });
  };
  while (!rows.empty() && is_blank(*rows.back())) rows.pop_back();
  return rows;
}

// The other axis of a test whose axes have grids of their own: the same specimen turned by 90
// degrees.
Test turned(const TestFormat& format, const std::string& name) {
  Test t = format.like;
  t.name = name;
  t.fibre_angle_deg += 90;
  if (t.kind == TestKind::pure_shear) t.kind = TestKind::biaxial;
  return t;
}

// Both axes at the same instants, or one axis alone. With `ratio` the deformation along z follows.
Test read_axis(Reading& in, const AxisColumns& x, const AxisColumns& z, const RowGroup& group) {
  std::vector<std::size_t> columns{x.strain, x.stress};
  if (z.has_strain) columns.push_back(z.strain);
  if (z.has_stress) columns.push_back(z.stress);

  Test test = in.format.like;
  test.name = group.name;
  for (const CsvRow* row : without_blank_end(group.rows, columns)) {
    if (in.time_column) test.time.push_back(in.time(*row, test));
    const double stretch = in.stretch(*row, x);
    test.first.push_back(stretch);
    if (z.has_strain) {
      test.second.push_back(in.stretch(*row, z));
    } else if (in.format.ratio) {
      test.second.push_back(in.stretch_above_0(*row, x, 1 + *in.format.ratio * (stretch - 1)));
    }
    test.stress_x.push_back(in.scaled(*row, x.stress, x.stress_factor));
    if (z.has_stress) test.stress_z.push_back(in.scaled(*row, z.stress, z.stress_factor));
  }
  return test;
}

// Axes with grids of their own: rows in which one axis has no cells belong to the other.
std::array<Test, 2> read_own_grids(Reading& in, const AxisColumns& x, const AxisColumns& z,
                                   const RowGroup& group) {
  Test along = in.format.like;
  along.name = group.name;
  for (const CsvRow* row : without_blank_end(group.rows, {x.strain, x.stress})) {
    if (in.is_empty(*row, x)) continue;
    const double stretch = in.stretch(*row, x);
    along.first.push_back(stretch);
    if (in.format.ratio) {
      along.second.push_back(in.stretch_above_0(*row, x, 1 + *in.format.ratio * (stretch - 1)));
    }
    along.stress_x.push_back(in.scaled(*row, x.stress, x.stress_factor));
  }

  Test across = turned(in.format, group.name);
  for (const CsvRow* row : without_blank_end(group.rows, {z.strain, z.stress})) {
    if (in.is_empty(*row, z)) continue;
    const double stretch = in.stretch(*row, z);
    if (in.format.ratio) {
      across.first.push_back(stretch);
      across.second.push_back(in.stretch_above_0(*row, z, 1 + (stretch - 1) / *in.format.ratio));
    } else if (across.kind == TestKind::biaxial) {
      across.first.push_back(1);
      across.second.push_back(stretch);
    } else {
      across.first.push_back(stretch);
    }
    across.stress_x.push_back(in.scaled(*row, z.stress, z.stress_factor));
  }
  return {along, across};
}

// Whether the deformation along x of the specimen is the second one of this test.
bool runs_along_second(const TestFormat& format, bool own_grids, bool across, const Test& test) {
  return own_grids && !test.second.empty() && (across || !format.ratio);
}

// Refuses a file that is named a compression test but has tension only, unless a sign is given.
void check_compression(const Test& test, const Reading& in) {
  const bool sign_is_given = in.format.strain_sign || in.format.stress_sign;
  const bool says_so = in.says_compression ||
                       names_compression(std::filesystem::path(in.table.name).stem().string()) ||
                       names_compression(in.format.like.name);
  if (sign_is_given || !says_so || !only_tension(test)) {
    return;
  }
  throw Failure(Exit::input,
                {{in.table.name, in.table.header.line, 1},
                 "sign",
                 "found a compression test by its name, with strains and stresses above 0",
                 "the sign of compression",
                 "sign: -1 in the item of `data` where the file counts compression positive, "
                 "sign: 1 where it is tension"});
}

// Cuts a test that was read, and refuses what cannot be fitted.
void finish(Test& test, const Reading& in, bool along_second) {
  const TestFormat& f = in.format;
  const std::string& file = in.table.name;
  keep_times(test, f.part.time_from, f.part.time_to);
  if (test.time.empty()) keep_cycles(test, f.cycles, file);
  if (f.toe && test.points() > 0) shift_to_toe(test, *f.toe, file);
  if (f.rest_at_start && test.points() > 0) shift_to_start(test);
  const std::vector<double> along = along_second ? test.second : test.first;
  keep_range(test, along, f.part.strain_from, f.part.strain_to);
  compare_from(test, f.part.compare_from);
  if (!test.time.empty()) keep_cycles(test, f.cycles, file);

  const bool is_part = f.toe || !f.where.empty() || f.part.leaves_out() || f.cycles.leaves_out();
  if (test.points() < 2) {
    throw Failure(Exit::input,
                  {{file, 0, 0},
                   f.split.empty() ? std::string() : f.split + " = " + test.name,
                   fmt::format("found {} points{}", test.points(), is_part ? " in the range" : ""),
                   "two at least",
                   ""});
  }
  check_compression(test, in);
  check_signs(test, file);
  const StepStart step{f.step_at, f.ramp};
  if (step.is_given()) {
    add_step(test, step, file);
  } else if (f.viscous && starts_loaded(test)) {
    double first_time = 0;
    if (test.before.time.empty()) {
      first_time = test.time[0];
    } else {
      first_time = test.before.time[0];
    }
    throw Failure(
        Exit::input,
        {{file, in.table.header.line, 1},
         "step_at",
         fmt::format(
             "missing: the first reading, at {:g} s, is of a deformed and stressed specimen",
             first_time),
         "the time at which the specimen was deformed",
         "step_at: 0 in the item of `data`, and ramp: (s) if the step took time"});
  }
  if (f.normalised) normalise(test, file);
}

}  // namespace

// From a table to tests: find the columns and their measures, convert the rows, shift to rest, keep
// the chosen part, check signs.
std::vector<Test> tests_of(const CsvTable& table, const TestFormat& format) {
  Reading in(table, format);
  if (table.header.cells.empty())
    throw Failure(Exit::input, {{table.name, 0, 0}, "", "found 0 points", "two at least", ""});
  in.found_by_name = format.strain_x.empty() && format.stress_x.empty();
  if (in.found_by_name) in.find_columns();
  const TestFormat& f = in.format;
  const bool biaxial = f.like.kind == TestKind::biaxial;
  const bool own_grids = (!biaxial || f.ratio) && !f.strain_z.empty() && !f.stress_z.empty();
  const auto strain_x = in.column(f.strain_x, "columns.strain_x");
  const auto stress_x = in.column(f.stress_x, "columns.stress_x");
  std::optional<std::size_t> strain_z, stress_z, time, split;
  if (!f.strain_z.empty()) strain_z = in.column(f.strain_z, "columns.strain_z");
  if (!f.stress_z.empty()) stress_z = in.column(f.stress_z, "columns.stress_z");
  if (!f.time.empty()) time = in.column(f.time, "columns.time");
  if (!f.split.empty()) split = in.column(f.split, "split");
  for (const auto& [name, text] : f.where)
    if (const auto c = in.column(name, "where")) in.where.emplace_back(*c, text);
  in.choose_block();
  in.check();
  AxisColumns x, z;
  in.add_strain(x, *strain_x, f.gauge_length, "gauge_length");
  in.add_stress(x, *stress_x, f.width, "width");
  if (strain_z) in.add_strain(z, *strain_z, f.gauge_length_z, "gauge_length_z");
  if (stress_z) in.add_stress(z, *stress_z, f.width_z, "width_z");
  if (time) in.add_time(*time);
  in.check();

  std::vector<Test> tests;
  std::vector<Test> others;  // of axes with grids of their own, the second ones
  for (const RowGroup& group : groups_of_rows(in, split)) {
    if (own_grids) {
      const auto [along, across] = read_own_grids(in, x, z, group);
      if (along.points() > 0) tests.push_back(along);
      if (across.points() > 0) others.push_back(across);
    } else {
      tests.push_back(read_axis(in, x, z, group));
    }
  }
  in.check();
  if (tests.empty()) tests.push_back(f.like);
  const bool named = split || in.several_blocks();
  const auto finish_all = [&](std::vector<Test>& all, bool across) {
    for (Test& test : all) {
      finish(test, in, runs_along_second(f, own_grids, across, test));
      if (!named) {
        test.name = f.like.name;
      } else if (!f.like.name.empty()) {
        test.name = f.like.name + "_" + test.name;
      }
      if (across) test.name += "_z";
    }
  };
  finish_all(tests, false);
  finish_all(others, true);
  for (Test& other : others) tests.push_back(std::move(other));
  if (in.several_blocks()) {
    in.notes.push_back(fmt::format("{}: {} blocks of rows, each a test of its own", table.name,
                                   table.blocks.size()));
  }
  tests.front().notes = in.notes;
  return tests;
}

// Reads the tests of a table in a text.
std::vector<Test> parse_tests(const std::string& text, const std::string& shown_name,
                              const TestFormat& format) {
  // Whether a line of the file has this name, or at the place "column 3" a text that is no number.
  const auto has = [](const std::vector<CsvCell>& cells, const std::string& name) {
    const std::string word = "column ";
    if (name.starts_with(word)) {
      const auto place = csv_number(name.substr(word.size()));
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const bool is_there = place && *place == static_cast<double>(i + 1);
        if (is_there && !cells[i].text.empty() && !csv_number(cells[i].text)) return true;
      }
    }
    return name.empty() || std::any_of(cells.begin(), cells.end(),
                                       [&](const CsvCell& c) { return c.text == name; });
  };
  const auto names_columns = [&](const std::vector<CsvCell>& cells) {
    if (!format.strain_x.empty()) {
      return has(cells, format.strain_x) && has(cells, format.stress_x) &&
             has(cells, format.strain_z) && has(cells, format.stress_z) && has(cells, format.time);
    }
    // rows of numbers, and lines in another separator, are recognised without reading words
    if (cells.size() < 2 || csv_number(cells.front().text)) {
      return false;
    }
    bool deformation = false;
    bool stress = false;
    for (const CsvCell& cell : cells) {
      const ColumnMeaning m = column_meaning(cell.text);
      deformation = deformation || m.of == ColumnMeaning::Of::deformation;
      stress = stress || m.of == ColumnMeaning::Of::stress;
    }
    return deformation && stress;
  };
  return tests_of(parse_table(text, shown_name, {format.decimal, names_columns}), format);
}

// Reads the tests of a file; errors name its lines and columns.
std::vector<Test> read_tests(const std::string& path, const TestFormat& format) {
  return parse_tests(text_of_table(path), path, format);
}

// Stretch minus 1, without the rounding error that the subtraction leaves: 1.1 gives 0.1.
double engineering_strain(double stretch) {
  constexpr double digits = 1e15;
  if (std::abs(stretch) < 8) return std::round((stretch - 1) * digits) / digits;
  return stretch - 1;
}

// The largest absolute stress of both axes.
double largest_stress(const Test& test) {
  double s = 0;
  for (const auto* list : {&test.stress_x, &test.stress_z})
    for (double x : *list) s = std::max(s, std::abs(x));
  return s;
}

}  // namespace langer
