#include "identification/fit/test_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/base/error.hpp"
#include "identification/fit/test_range.hpp"

namespace langer {

namespace {

constexpr double per_unit_of_stress[] = {1, 1e-3, 1e-6, 1, 1e-3, 1e3};  // MPa or N
constexpr double per_unit_of_strain[] = {1, 0.01, 1, 1e-3};             // 1 or mm

template <class E>
std::string word(E e) {
  return names(e)[static_cast<std::size_t>(e)];
}

// One axis of the test: where its numbers stand and what they are.
struct AxisColumns {
  std::size_t strain = 0, stress = 0;
  bool has_strain = false, has_stress = false;
  StrainMeasure measure = StrainMeasure::engineering;
  double strain_factor = 1, stress_factor = 1;  // to a plain strain or stretch, and to MPa
};

// The reading of one table: errors are gathered and thrown together.
struct Reading {
  const CsvTable& table;
  TestFormat format;
  std::vector<Error> errors;
  std::vector<std::string> notes;

  void say(int line, int column, std::string key, std::string found, std::string expected,
           std::string hint = "") {
    if (errors.size() < 10)
      errors.push_back({{table.name, line, column},
                        std::move(key),
                        std::move(found),
                        std::move(expected),
                        std::move(hint)});
  }
  void say_of_column(std::size_t column, std::string key, std::string found, std::string expected,
                     std::string hint = "") {
    say(table.header.line, table.header.cells[column].column, std::move(key), std::move(found),
        std::move(expected), std::move(hint));
  }
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
    for (const CsvCell& cell : table.header.cells) all += (all.empty() ? "" : ", ") + cell.text;
    return all;
  }

  std::optional<std::size_t> column(const std::string& wanted, const char* key) {
    for (std::size_t i = 0; i < table.header.cells.size(); ++i)
      if (name(i) == wanted) return i;
    say(table.header.line, 1, key, "no column \"" + wanted + "\"", "one of " + all_names());
    return std::nullopt;
  }

  // puts the names of the one column of deformation and the one of stress into the format
  void find_columns() {
    constexpr const char* expected =
        "one column of strain, strain_percent or stretch, and one of cauchy_stress_MPa or nominal_stress_MPa (or kPa, Pa), or of a "
        "force in N and an elongation in mm";
    for (std::size_t i = 0; i < table.header.cells.size(); ++i) {
      const ColumnMeaning m = meaning(i);
      if (m.of == ColumnMeaning::Of::unknown) continue;
      const bool deformation = m.of == ColumnMeaning::Of::deformation;
      std::string& slot = deformation ? format.strain_x : format.stress_x;
      if (!slot.empty())
        say_of_column(
            i, "columns",
            fmt::format("a second column of {}: \"{}\"", deformation ? "deformation" : "stress",
                        name(i)),
            expected,
            "name those to take in the item of `data`: columns: {strain_x: \"...\", stress_x: \"...\"}");
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
      say_of_column(at, name_of_key, fmt::format("{} for the column \"{}\"", word(*key), name(at)),
                    fmt::format("the {} that the column's name carries", what));
    return key ? key : column;
  }

  double size(const std::optional<double>& given, std::size_t column, const char* key,
              const char* what) {
    if (given) return *given;
    say_of_column(column, key, fmt::format("missing, for the column \"{}\"", name(column)), what,
                  fmt::format("{}: 10 (mm) in the item of `data`", key));
    return 1;
  }

  void add_stress(AxisColumns& axis, std::size_t column, const std::optional<double>& width,
                  const char* width_key) {
    axis.has_stress = true, axis.stress = column;
    const ColumnMeaning m = meaning(column);
    std::optional<StressUnit> unit =
        agreed(format.stress_unit, m.stress_unit, column, "stress_unit", "unit");
    if (!unit && format.normalised) unit = StressUnit::MPa;  // any serves
    if (!unit)
      return say_of_column(
          column, "stress_unit",
          m.foreign_unit.empty()
              ? "no unit for the column \"" + name(column) + "\""
              : fmt::format("the unit \"{}\" of the column \"{}\"", m.foreign_unit, name(column)),
          "stress_unit, or a name that ends in _MPa, _kPa or _Pa",
          "of a force: N, mN or kN, with width and thickness");
    axis.stress_factor = per_unit_of_stress[static_cast<std::size_t>(*unit)];
    std::optional<StressMeasure> told = m.stress;
    if (is_force(*unit) && format.normalised) {
      told = StressMeasure::nominal;
    } else if (is_force(*unit)) {
      axis.stress_factor /=
          size(width, column, width_key, "the width of the specimen in mm, across this force");
      axis.stress_factor /=
          size(format.thickness, column, "thickness", "the thickness of the specimen in mm");
      told = StressMeasure::nominal;
    }
    const auto measure =
        agreed(format.stress, told, column, "stress",
               is_force(*unit) ? "measure of a force over the area at rest:" : "measure");
    if (measure) {
      format.like.measure = *measure;
    } else if (found_by_name) {
      say_of_column(
          column, "stress", "not told for the column \"" + name(column) + "\"",
          "stress: cauchy (true) or nominal (force over the area at rest)",
          "in the item of `data`, or in the column's name: cauchy_stress_kPa, nominal_stress_kPa");
    } else if (format.like.measure == StressMeasure::cauchy) {
      note(
          column,
          fmt::format(
              "the measure of \"{}\" is not told: taken as cauchy (true); say stress: cauchy, or nominal (force over the area at rest)",
              name(column)));
      format.stress = StressMeasure::cauchy;  // once
    }
  }

  void add_strain(AxisColumns& axis, std::size_t column, const std::optional<double>& length,
                  const char* length_key) {
    axis.has_strain = true, axis.strain = column;
    const ColumnMeaning m = meaning(column);
    const bool slides = format.like.kind == TestKind::simple_shear;
    std::optional<StrainUnit> unit =
        agreed(format.strain_unit, m.strain_unit, column, "strain_unit", "unit");
    if (!unit && (m.lengths || format.gauge_length || !m.foreign_unit.empty()) && !slides)
      say_of_column(column, "strain_unit",
                    m.foreign_unit.empty() ? "no unit for the column \"" + name(column) + "\""
                                           : fmt::format("the unit \"{}\" of the column \"{}\"",
                                                         m.foreign_unit, name(column)),
                    "strain_unit: fraction, percent, mm or um, or a name that ends in it");
    axis.strain_factor =
        per_unit_of_strain[static_cast<std::size_t>(unit.value_or(StrainUnit::fraction))];
    if (unit && is_length(*unit))
      axis.strain_factor /=
          size(length, column, length_key, "the length at rest between grips or marks in mm");
    const std::optional<StrainMeasure> measure =
        agreed(format.strain, m.strain, column, "strain", "measure");
    if (unit && is_length(*unit) && measure && *measure > StrainMeasure::stretch)
      say_of_column(column, "strain", word(*measure) + " for lengths",
                    "engineering (an elongation) or stretch (a length)");
    axis.measure = measure  ? *measure
                   : slides ? StrainMeasure::engineering
                            : measure_by_values(axis, column, m);
  }

  // nobody told: the first value does, or is asked about
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
    if (std::abs(first - 1) <= near) {
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
                "the measure of \"{}\" is not told: taken as engineering strain; say strain: engineering, log or green_lagrange",
                name(column)));
    } else if (!documented) {
      say(row->line, row->cells[column].column, "strain",
          fmt::format("a column \"{}\" that starts at {:g}, neither 0 nor 1", name(column), first),
          "strain: engineering, stretch, log or green_lagrange", "in the item of `data`");
    }
    return StrainMeasure::engineering;
  }

  double number(const CsvRow& row, std::size_t column) {
    const CsvCell& cell = row.cells[column];
    const auto x = table.number(cell);
    if (x && std::isfinite(*x)) return *x;
    const bool decimals = !x &&
                          cell.text.find_first_not_of("+-0123456789.,eE") == std::string::npos &&
                          cell.text.find_first_of(".,") != std::string::npos;
    say(row.line, cell.column, "", cell.text.empty() ? "found nothing" : "found " + cell.text,
        "a finite number",
        decimals ? fmt::format("decimal {}s are read here, without thousands separators",
                               word(table.decimal))
                 : "");
    return 0;
  }

  double stretch(const CsvRow& row, const AxisColumns& axis) {
    const std::size_t before = errors.size();
    const double e = number(row, axis.strain) * axis.strain_factor;
    if (format.like.kind == TestKind::simple_shear) return e;
    const double l = axis.measure == StrainMeasure::stretch          ? e
                     : axis.measure == StrainMeasure::engineering    ? 1 + e
                     : axis.measure == StrainMeasure::green_lagrange ? std::sqrt(1 + 2 * e)
                                                                     : std::exp(e);
    if (errors.size() > before) return 1;
    if (l > 0 && std::isfinite(l)) return l;
    say(row.line, row.cells[axis.strain].column, "", fmt::format("found the stretch {}", l),
        "a stretch > 0");
    return 1;
  }

  bool chosen(const CsvRow& row) const {
    return std::all_of(where.begin(), where.end(),
                       [&](const auto& w) { return row.cells[w.first].text == w.second; });
  }
  bool is_empty(const CsvRow& row, const AxisColumns& axis) const {
    return row.cells[axis.strain].text.empty() && row.cells[axis.stress].text.empty();
  }

  // [s]; that of one row after another of a test does not go back
  double time(const CsvRow& row, const Test& test) {
    const double t = number(row, *time_column);
    if (!test.time.empty() && t < test.time.back())
      say(row.line, row.cells[*time_column].column, "columns.time",
          fmt::format("found {:g} s after {:g} s", t, test.time.back()),
          "times that do not go back");
    return t;
  }

  std::optional<std::size_t> time_column;
  std::vector<std::pair<std::size_t, std::string>> where;
  bool found_by_name = false;
};

Test& test_named(std::vector<Test>& tests, const Test& like, const std::string& name) {
  const auto found =
      std::find_if(tests.begin(), tests.end(), [&](const Test& t) { return t.name == name; });
  if (found != tests.end()) return *found;
  tests.push_back(like);
  tests.back().name = name;
  return tests.back();
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

// others: of axes with grids of their own, the second ones
void read_rows(Reading& in, const AxisColumns& x, const AxisColumns& z,
               const std::optional<std::size_t>& split, bool own_grids, std::vector<Test>& tests,
               std::vector<Test>& others) {
  for (const CsvRow& row : in.table.rows) {
    if (!in.chosen(row)) continue;
    const std::string name = split ? row.cells[*split].text : "";
    if (own_grids && !in.is_empty(row, z)) {
      Test& other = test_named(others, turned(in.format, name), name);
      const double l = in.stretch(row, z);
      if (other.kind == TestKind::biaxial) other.first.push_back(1), other.second.push_back(l);
      if (other.kind != TestKind::biaxial) other.first.push_back(l);
      other.stress_x.push_back(z.stress_factor * in.number(row, z.stress));
    }
    if (own_grids && in.is_empty(row, x)) continue;
    Test& test = test_named(tests, in.format.like, name);
    if (in.time_column) test.time.push_back(in.time(row, test));
    test.first.push_back(in.stretch(row, x));
    if (z.has_strain && !own_grids) test.second.push_back(in.stretch(row, z));
    test.stress_x.push_back(x.stress_factor * in.number(row, x.stress));
    if (z.has_stress && !own_grids)
      test.stress_z.push_back(z.stress_factor * in.number(row, z.stress));
  }
}

}  // namespace

std::vector<Test> tests_of(const CsvTable& table, const TestFormat& format) {
  Reading in{table, format, {}, {}, {}, {}, false};
  if (table.header.cells.empty())
    throw Failure(Exit::input, {{table.name, 0, 0}, "", "found 0 points", "two at least", ""});
  in.found_by_name = format.strain_x.empty() && format.stress_x.empty();
  if (in.found_by_name) in.find_columns();
  const TestFormat& f = in.format;
  const bool biaxial = f.like.kind == TestKind::biaxial;
  const bool own_grids = !biaxial && !f.strain_z.empty() && !f.stress_z.empty();
  const auto strain_x = in.column(f.strain_x, "columns.strain_x"),
             stress_x = in.column(f.stress_x, "columns.stress_x");
  std::optional<std::size_t> strain_z, stress_z, split;
  if (!f.strain_z.empty()) strain_z = in.column(f.strain_z, "columns.strain_z");
  if (!f.stress_z.empty()) stress_z = in.column(f.stress_z, "columns.stress_z");
  if (!f.time.empty()) in.time_column = in.column(f.time, "columns.time");
  if (!f.split.empty()) split = in.column(f.split, "split");
  for (const auto& [name, text] : f.where)
    if (const auto c = in.column(name, "where")) in.where.emplace_back(*c, text);
  in.check();
  AxisColumns x, z;
  in.add_strain(x, *strain_x, f.gauge_length, "gauge_length");
  in.add_stress(x, *stress_x, f.width, "width");
  if (strain_z) in.add_strain(z, *strain_z, f.gauge_length_z, "gauge_length_z");
  if (stress_z) in.add_stress(z, *stress_z, f.width_z, "width_z");
  in.check();

  std::vector<Test> tests, others;
  read_rows(in, x, z, split, own_grids, tests, others);
  in.check();
  if (tests.empty()) tests.push_back(f.like);
  const bool is_part = f.toe || !f.where.empty() || f.part.leaves_out();
  const auto finish = [&](Test& test, const char* end) {
    keep_times(test, f.part.time_from, f.part.time_to);
    if (f.toe && test.points() > 0) shift_to_toe(test, *f.toe, table.name);
    if (f.rest_at_start && test.points() > 0) shift_to_start(test);
    keep_range(test,
               std::vector<double>(own_grids && !test.second.empty() ? test.second : test.first),
               f.part.strain_from, f.part.strain_to);
    compare_from(test, f.part.compare_from);
    if (test.points() < 2)
      throw Failure(Exit::input, {{table.name, 0, 0},
                                  split ? f.split + " = " + test.name : std::string(),
                                  fmt::format("found {} points{}", test.points(),
                                              is_part ? " in the range" : ""),
                                  "two at least",
                                  ""});
    if (f.normalised) normalise(test, table.name);
    test.name = (!split                ? f.like.name
                 : f.like.name.empty() ? test.name
                                       : f.like.name + "_" + test.name) +
                end;
  };
  for (Test& test : tests) finish(test, "");
  for (Test& test : others) finish(test, "_z");
  for (Test& other : others) tests.push_back(std::move(other));
  tests.front().notes = in.notes;
  return tests;
}

std::vector<Test> parse_tests(const std::string& text, const std::string& shown_name,
                              const TestFormat& format) {
  const auto names_columns = [&](const std::vector<CsvCell>& cells) {
    const auto has = [&](const std::string& name) {
      return name.empty() || std::any_of(cells.begin(), cells.end(),
                                         [&](const CsvCell& c) { return c.text == name; });
    };
    if (!format.strain_x.empty())
      return has(format.strain_x) && has(format.stress_x) && has(format.strain_z) &&
             has(format.stress_z) && has(format.time);
    bool deformation = false, stress = false;
    for (const CsvCell& cell : cells) {
      const ColumnMeaning m = column_meaning(cell.text);
      deformation = deformation || m.of == ColumnMeaning::Of::deformation,
      stress = stress || m.of == ColumnMeaning::Of::stress;
    }
    return deformation && stress;
  };
  return tests_of(parse_table(text, shown_name, {format.decimal, names_columns}), format);
}

std::vector<Test> read_tests(const std::string& path, const TestFormat& format) {
  return parse_tests(text_of_table(path), path, format);
}

double engineering_strain(double stretch) {
  constexpr double digits = 1e15;
  return std::abs(stretch) < 8 ? std::round((stretch - 1) * digits) / digits : stretch - 1;
}

double largest_stress(const Test& test) {
  double s = 0;
  for (const auto* list : {&test.stress_x, &test.stress_z})
    for (double x : *list) s = std::max(s, std::abs(x));
  return s;
}

}  // namespace langer
