#include "fit/test_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace langer {

namespace {

constexpr double MPa_per[] = {1, 1e-3, 1e-6};

// The reading of one table: errors are gathered and thrown together.
struct Reading {
  const CsvTable& table;
  const TestFormat& format;
  std::vector<Error> errors;

  void say(int line, int column, std::string key, std::string found, std::string expected) {
    if (errors.size() < 10)
      errors.push_back({{table.name, line, column}, std::move(key), std::move(found), std::move(expected), ""});
  }

  std::optional<std::size_t> column(const std::string& name, const char* key) {
    const auto& cells = table.header.cells;
    std::string all;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].text == name) return i;
      all += (i ? ", " : "") + cells[i].text;
    }
    say(table.header.line, 1, key, "no column \"" + name + "\"", "one of " + all);
    return std::nullopt;
  }

  // MPa in one unit of the column
  double stress_factor(const std::string& name) {
    std::optional<StressUnit> told = format.stress_unit;
    for (StressUnit unit : {StressUnit::MPa, StressUnit::kPa, StressUnit::Pa})
      if (name.ends_with(fmt::format("_{}", names(unit)[static_cast<std::size_t>(unit)]))) {
        if (told && *told != unit)
          say(table.header.line, 1, "stress_unit",
              fmt::format("{} for the column \"{}\"", names(unit)[static_cast<std::size_t>(*told)], name),
              "the unit that the column's name carries");
        told = unit;
      }
    if (!told) {
      say(table.header.line, 1, "stress_unit", "no unit for the column \"" + name + "\"",
          "stress_unit, or a name that ends in _MPa, _kPa or _Pa");
      return 1;
    }
    return MPa_per[static_cast<std::size_t>(*told)];
  }

  double number(const CsvRow& row, std::size_t column) {
    const CsvCell& cell = row.cells[column];
    const auto x = csv_number(cell.text);
    if (x && std::isfinite(*x)) return *x;
    say(row.line, cell.column, "", cell.text.empty() ? "found nothing" : "found " + cell.text, "a finite number");
    return 0;
  }

  double stretch(const CsvRow& row, std::size_t column) {
    const double e = number(row, column) * (format.strain_unit == StrainUnit::percent ? 0.01 : 1);
    const double l = format.strain == StrainMeasure::stretch          ? e
                     : format.strain == StrainMeasure::engineering    ? 1 + e
                     : format.strain == StrainMeasure::green_lagrange ? std::sqrt(1 + 2 * e)
                                                                      : std::exp(e);
    if (l > 0 && std::isfinite(l)) return l;
    say(row.line, row.cells[column].column, "", fmt::format("found the stretch {}", l), "a stretch > 0");
    return 1;
  }
};

}  // namespace

std::vector<Test> tests_of(const CsvTable& table, const TestFormat& format) {
  Reading in{table, format, {}};
  const bool biaxial = format.like.kind == TestKind::biaxial, slides = format.like.kind == TestKind::simple_shear;
  const auto strain_x = in.column(format.strain_x, "columns.strain_x"),
             stress_x = in.column(format.stress_x, "columns.stress_x");
  std::optional<std::size_t> strain_z, stress_z, split;
  if (biaxial) strain_z = in.column(format.strain_z, "columns.strain_z");
  if (!format.stress_z.empty()) stress_z = in.column(format.stress_z, "columns.stress_z");
  if (!format.split.empty()) split = in.column(format.split, "split");
  std::vector<std::pair<std::size_t, std::string>> where;
  for (const auto& [name, text] : format.where)
    if (const auto c = in.column(name, "where")) where.emplace_back(*c, text);
  const double factor_x = in.stress_factor(format.stress_x), factor_z = stress_z ? in.stress_factor(format.stress_z) : 1;
  if (!in.errors.empty()) throw Failure(Exit::input, in.errors);

  std::vector<Test> tests;
  for (const CsvRow& row : table.rows) {
    if (!std::all_of(where.begin(), where.end(), [&](const auto& w) { return row.cells[w.first].text == w.second; })) continue;
    const std::string name = split ? row.cells[*split].text : "";
    auto test = std::find_if(tests.begin(), tests.end(), [&](const Test& t) { return t.name == name; });
    if (test == tests.end()) {
      test = tests.insert(tests.end(), format.like);
      test->name = name;
    }
    const double first = slides ? in.number(row, *strain_x) * (format.strain_unit == StrainUnit::percent ? 0.01 : 1)
                                : in.stretch(row, *strain_x);
    const double strain = slides ? first : first - 1;
    if (strain < format.strain_from || strain > format.strain_to) continue;
    test->first.push_back(first);
    if (strain_z) test->second.push_back(in.stretch(row, *strain_z));
    test->stress_x.push_back(factor_x * in.number(row, *stress_x));
    if (stress_z) test->stress_z.push_back(factor_z * in.number(row, *stress_z));
  }
  if (!in.errors.empty()) throw Failure(Exit::input, in.errors);
  if (tests.empty()) tests.push_back(format.like);
  for (Test& test : tests) {
    if (test.points() < 2)
      throw Failure(Exit::input, {{table.name, 0, 0},
                                  split ? format.split + " = " + test.name : std::string(),
                                  fmt::format("found {} points in the range", test.points()),
                                  "two at least",
                                  ""});
    test.name = !split ? format.like.name : format.like.name.empty() ? test.name : format.like.name + "_" + test.name;
  }
  return tests;
}

Test test_of(const Curve& curve, const std::string& name) {
  Test test;
  test.name = name;
  test.measure = curve.measure;
  for (double e : curve.strain) test.first.push_back(1 + e);
  test.stress_x = curve.stress;
  return test;
}

double largest_stress(const Test& test) {
  double s = 0;
  for (const auto* list : {&test.stress_x, &test.stress_z})
    for (double x : *list) s = std::max(s, std::abs(x));
  return s;
}

}  // namespace langer
