#include "fit/curve.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/csv_table.hpp"

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
};

constexpr const char* expected_columns =
    "one column of strain, strain_percent or stretch, and one of "
    "cauchy_stress_MPa or nominal_stress_MPa (or kPa, Pa)";

Columns read_columns(const std::vector<CsvCell>& header, const Place& place) {
  Columns c;
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

Curve curve_of(const CsvTable& table) {
  constexpr std::size_t most_errors = 10;
  Curve curve;
  const auto few = [&] {
    return Failure(Exit::input, {{table.name, 0, 0}, "", fmt::format("found {} points", curve.size()), "two at least", ""});
  };
  if (table.header.cells.empty()) throw few();
  const Columns columns = read_columns(table.header.cells, {table.name, table.header.line, 1});
  curve.measure = columns.of_stress.measure;
  std::vector<Error> errors;
  for (const CsvRow& row : table.rows) {
    const auto say = [&](const CsvCell& cell, std::string found, std::string expected) {
      if (errors.size() < most_errors)
        errors.push_back({{table.name, row.line, cell.column}, "", std::move(found), std::move(expected), ""});
    };
    const auto value = [&](int column, const Meaning& m) {
      const CsvCell& cell = row.cells[static_cast<std::size_t>(column)];
      const auto x = csv_number(cell.text);
      if (x && std::isfinite(*x)) return m.factor * *x + m.offset;
      say(cell, cell.text.empty() ? "found nothing" : "found " + cell.text, "a finite number");
      return 0.;
    };
    const double strain = value(columns.deformation, columns.of_deformation);
    const double stress = value(columns.stress, columns.of_stress);
    if (!(strain > -1))
      say(row.cells[static_cast<std::size_t>(columns.deformation)], fmt::format("found the stretch {}", 1 + strain),
          "a stretch > 0");
    curve.strain.push_back(strain);
    curve.stress.push_back(stress);
  }
  if (!errors.empty()) throw Failure(Exit::input, errors);
  if (curve.size() < 2) throw few();
  return curve;
}

Curve parse_curve(const std::string& text, const std::string& shown_name) { return curve_of(parse_table(text, shown_name)); }

Curve read_curve(const std::string& path) { return curve_of(read_table(path)); }

Curve between_strains(const Curve& curve, double strain_from, double strain_to) {
  Curve part;
  part.measure = curve.measure;
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (curve.strain[i] >= strain_from && curve.strain[i] <= strain_to)
      part.strain.push_back(curve.strain[i]), part.stress.push_back(curve.stress[i]);
  return part;
}

}  // namespace langer
