#include "fit/curve.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/error.hpp"
#include "fit/csv_table.hpp"

namespace langer {

namespace {

// what a column holds: deformation = factor * cell + offset, or stress = factor * cell
struct Meaning {
  bool deformation;
  double factor, offset;
  StressMeasure measure;
};

std::optional<Meaning> meaning(const std::string& name) {
  using enum StressMeasure;
  if (name == "strain") return Meaning{true, 1, 0, cauchy};
  if (name == "strain_percent") return Meaning{true, 0.01, 0, cauchy};
  if (name == "stretch") return Meaning{true, 1, -1, cauchy};
  for (StressMeasure measure : {cauchy, nominal})
    for (const auto& [unit, factor] : {std::pair{"Pa", 1e-6}, std::pair{"kPa", 1e-3}, std::pair{"MPa", 1.}})
      if (name == fmt::format("{}_stress_{}", names(measure)[static_cast<std::size_t>(measure)], unit))
        return Meaning{false, factor, 0, measure};
  return std::nullopt;
}

struct Columns {
  int deformation = -1, stress = -1;
  Meaning of_deformation, of_stress;
  std::size_t count = 0;
};

constexpr const char* expected_columns =
    "one column of strain, strain_percent or stretch, and one of "
    "cauchy_stress_MPa or nominal_stress_MPa (or kPa, Pa)";

Columns read_columns(const std::vector<CsvCell>& header, const Place& place) {
  Columns c;
  c.count = header.size();
  std::string found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    found += (i ? ", " : "") + header[i].text;
    const auto m = meaning(header[i].text);
    if (!m) continue;
    int& slot = m->deformation ? c.deformation : c.stress;
    if (slot >= 0)
      throw Failure(Exit::input,
                    {{place.file, place.line, header[i].column},
                     "columns",
                     fmt::format("a second column of {}: \"{}\"", m->deformation ? "deformation" : "stress", header[i].text),
                     expected_columns,
                     ""});
    slot = static_cast<int>(i);
    (m->deformation ? c.of_deformation : c.of_stress) = *m;
  }
  if (c.deformation < 0 || c.stress < 0) throw Failure(Exit::input, {place, "columns", "found " + found, expected_columns, ""});
  return c;
}

}  // namespace

Curve parse_curve(const std::string& text, const std::string& shown_name) {
  constexpr std::size_t most_errors = 10;
  Curve curve;
  std::optional<Columns> columns;
  std::vector<Error> errors;
  std::istringstream in(text);
  int line_number = 0;
  for (std::string line; std::getline(in, line) && errors.size() < most_errors;) {
    ++line_number;
    if (line_number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.ends_with('\r')) line.pop_back();
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::vector<CsvCell> row = csv_cells(line);
    if (!columns) {
      columns = read_columns(row, {shown_name, line_number, 1});
      curve.measure = columns->of_stress.measure;
      continue;
    }
    if (row.size() != columns->count) {
      errors.push_back({{shown_name, line_number, 1},
                        "",
                        fmt::format("found {} cells", row.size()),
                        fmt::format("{}, as in the line that names the columns", columns->count),
                        ""});
      continue;
    }
    const auto value = [&](int column, const Meaning& m) {
      const CsvCell& cell = row[static_cast<std::size_t>(column)];
      const auto x = csv_number(cell.text);
      if (x && std::isfinite(*x)) return m.factor * *x + m.offset;
      errors.push_back({{shown_name, line_number, cell.column},
                        "",
                        cell.text.empty() ? "found nothing" : "found " + cell.text,
                        "a finite number",
                        ""});
      return 0.;
    };
    const std::size_t before = errors.size();
    const double strain = value(columns->deformation, columns->of_deformation);
    const double stress = value(columns->stress, columns->of_stress);
    if (errors.size() == before && !(strain > -1))
      errors.push_back({{shown_name, line_number, row[static_cast<std::size_t>(columns->deformation)].column},
                        "",
                        fmt::format("found the stretch {}", 1 + strain),
                        "a stretch > 0",
                        ""});
    curve.strain.push_back(strain);
    curve.stress.push_back(stress);
  }
  if (!errors.empty()) throw Failure(Exit::input, errors);
  if (curve.size() < 2)
    throw Failure(Exit::input, {{shown_name, 0, 0}, "", fmt::format("found {} points", curve.size()), "two at least", ""});
  return curve;
}

Curve read_curve(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw Failure(Exit::input, {{path, 0, 0}, "", "cannot be read, or is empty", "a CSV file with a measured curve", ""});
  return parse_curve(text.str(), path);
}

Curve between_strains(const Curve& curve, double strain_from, double strain_to) {
  Curve part;
  part.measure = curve.measure;
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (curve.strain[i] >= strain_from && curve.strain[i] <= strain_to)
      part.strain.push_back(curve.strain[i]), part.stress.push_back(curve.stress[i]);
  return part;
}

}  // namespace langer
