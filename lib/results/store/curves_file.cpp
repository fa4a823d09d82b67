#include "results/store/curves_file.hpp"

#include <cmath>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "core/base/text.hpp"
#include "core/hdf5/h5.hpp"
#include "core/hdf5/seal.hpp"
#include "core/hdf5/unit_attribute.hpp"

namespace langer {

// The name of a CSV column with its unit as a part of it, so that a table explains itself and the
// name is an identifier in every language: N/mm becomes _N_per_mm, a blank an underscore. Columns
// without a unit keep their name.
std::string csv_name(const std::string& name, const std::string& unit) {
  if (unit.empty() || unit == "-") return name;
  if (unit == "m/s") return name + "_m_s";
  // Energies of motion are called so in the tables of other programs.
  const bool of_motion = name == "kinetic_energy" || name == "energy_balance";
  if (unit == "N mm" && of_motion) return name + "_Nmm";
  std::string rest = unit;
  std::string word;
  if (rest.starts_with("1/")) {
    word = "per_";
    rest = rest.substr(2);
  }
  for (const char c : rest) {
    if (c == '/') {
      word += "_per_";
    } else if (c == ' ') {
      word += '_';
    } else {
      word += c;
    }
  }
  return name + "_" + word;
}

std::string csv_cell(const std::string& text) {
  const bool blank =
      !text.empty() && (text.front() == ' ' || text.back() == ' ' || text.front() == '#');
  if (!blank && text.find_first_of(",;\"\n\r\t") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';  // a quote within quotes is doubled
    quoted += c;
  }
  return quoted + "\"";
}

// The table as CSV, one row per state.
std::string csv(const std::vector<Column>& columns) {
  std::string text;
  std::size_t rows = 0;
  if (!columns.empty()) rows = columns[0].values.size();
  for (const Column& c : columns) {
    if (c.values.size() != rows)
      throw Failure(Exit::bug, Error{{},
                                     c.name,
                                     fmt::format("{} values", c.values.size()),
                                     fmt::format("{} rows", rows),
                                     ""});
    append(text, ",", csv_cell(csv_name(c.name, c.unit)));
  }
  text += "\n";
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      // {} writes the shortest digits that read back as the same number.
      if (c > 0) text += ",";
      const double value = columns[c].values[i];
      if (!std::isnan(value)) text += fmt::format("{}", value);
    }
    text += "\n";
  }
  return text;
}

std::vector<Column> columns_of(const SurfaceMap& map) {
  std::vector<Column> columns{{"x", "mm", {}}, {"z", "mm", {}}, {map.name, map.unit, map.values}};
  for (const auto& place : map.places)
    for (std::size_t i = 0; i < 2; ++i) columns[i].values.push_back(place[i]);
  return columns;
}

namespace {

// The numbers of an array of rows, one after another.
template <class To, class From, std::size_t n>
std::vector<To> flat_rows(const std::vector<std::array<From, n>>& rows) {
  std::vector<To> values;
  for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

// The inverse of flat_rows(): rows of n numbers.
template <class To, std::size_t n, class From>
std::vector<std::array<To, n>> rows_of(const std::vector<From>& values) {
  std::vector<std::array<To, n>> rows(values.size() / n);
  for (std::size_t i = 0; i < values.size(); ++i) rows[i / n][i % n] = static_cast<To>(values[i]);
  return rows;
}

// Group /maps/<name>: places, values, facets, fibres and named points.
void write_map(const h5::Group& group, const SurfaceMap& map) {
  const std::size_t n = map.places.size();
  const std::size_t m = map.facets.size();
  group.write_scalar("t", map.t, "-");
  group.write<double>("places", {n, 2}, flat_rows<double>(map.places), "mm");
  group.write<double>("values", {n}, map.values, map.unit);
  group.annotate("values", "label", map.label);
  group.write<std::int64_t>("facets", {m, 4}, flat_rows<std::int64_t>(map.facets));
  group.write<double>("fibres", {map.fibres.size(), 2}, flat_rows<double>(map.fibres), "-");
  std::string names;
  std::vector<std::array<double, 2>> points;
  for (const auto& [name, at] : map.points) {
    append(names, " ", name);
    points.push_back(at);
  }
  group.write<double>("points", {points.size(), 2}, flat_rows<double>(points), "mm");
  group.annotate("points", "names", names);
}

// Reads a map and refuses facets and fibres that do not fit its nodes.
SurfaceMap read_map(const h5::Group& group, const std::string& name) {
  SurfaceMap map{name,
                 group.annotation("values", "label"),
                 group.unit("values"),
                 group.read_scalar("t"),
                 {},
                 {},
                 {},
                 {},
                 {}};
  // Units, places, and facets whose nodes exist.
  require_known_unit(group, "values");
  for (const char* name : {"places", "points"}) require_unit(group, name, "mm");
  map.values = group.read_finite("values", {h5::any});
  const std::size_t n = map.values.size();
  map.places = rows_of<double, 2>(group.read_finite("places", {n, 2}));
  map.facets = rows_of<int, 4>(group.read<std::int64_t>("facets", {h5::any, 4}).values);
  for (const auto& facet : map.facets)
    for (int node : facet)
      if (node < 0 || node >= static_cast<int>(n))
        group.refuse("facets", fmt::format("node {}", node), "a node of the map");
  map.fibres = rows_of<double, 2>(group.read_finite("fibres", {h5::any, 2}));
  if (!map.fibres.empty() && map.fibres.size() != map.facets.size())
    group.refuse("fibres", fmt::format("{} rows", map.fibres.size()), "one for each facet");
  std::istringstream names(group.annotation("points", "names"));
  const auto points = rows_of<double, 2>(group.read_finite("points", {h5::any, 2}));
  std::string point;
  for (const auto& at : points)
    if (names >> point) map.points[point] = at;
  return map;
}

}  // namespace

void write_curves(const std::string& path, const Curves& all, const Identity& identity) {
  if (!all.columns.empty())
    write_text_file(std::filesystem::path(path).replace_extension(".csv").string(),
                    csv(all.columns));
  h5::File file = h5::File::create(path);
  write_identity(file.root(), curves_schema, identity);
  const h5::Group curves = file.root().make_group("curves");
  const h5::Group columns = file.root().make_group("columns");
  for (const NamedCurve& c : all.curves) {
    const h5::Group one = curves.make_group(c.name);
    one.write<double>("x", {c.x.size()}, c.x, c.x_unit);
    one.write<double>("y", {c.y.size()}, c.y, c.y_unit);
    one.annotate("x", "label", c.x_label);
    one.annotate("y", "label", c.y_label);
  }
  // HDF5 lists datasets by name. The attribute `order` keeps the order of the config.
  std::string order;
  for (const Column& c : all.columns) {
    columns.write<double>(c.name, {c.values.size()}, c.values, c.unit);
    append(order, " ", c.name);
  }
  columns.attribute("order", order);
  if (!all.maps.empty()) {
    const h5::Group maps = file.root().make_group("maps");
    for (const SurfaceMap& map : all.maps) write_map(maps.make_group(map.name), map);
  }
  write_summary(file.root(), all.summary);
  file.commit();
}

// Reads the whole file. Units must be known and columns must have equal length.
CurvesFile read_curves(const std::string& path) {
  const h5::File file = h5::File::open(path);
  CurvesFile result;
  result.content_id = content_id(read_identity(file.root(), curves_schema), curves_schema.version);
  const h5::Group curves = file.root().group("curves");
  const h5::Group columns = file.root().group("columns");
  for (const std::string& name : curves.groups()) {
    const h5::Group one = curves.group(name);
    NamedCurve c{name,
                 one.annotation("x", "label"),
                 one.unit("x"),
                 one.annotation("y", "label"),
                 one.unit("y"),
                 {},
                 {}};
    for (const char* axis : {"x", "y"}) require_known_unit(one, axis);
    c.x = one.read<double>("x", {h5::any}).values;
    c.y = one.read<double>("y", {c.x.size()}).values;
    result.curves.curves.push_back(std::move(c));
  }
  std::istringstream order(columns.text_attribute("order"));
  std::size_t rows = h5::any;
  for (std::string name; order >> name;) {
    require_known_unit(columns, name);
    Column c{name, columns.unit(name), columns.read<double>(name, {rows}).values};
    rows = c.values.size();
    result.curves.columns.push_back(std::move(c));
  }
  if (file.root().has("maps")) {
    const h5::Group maps = file.root().group("maps");
    for (const std::string& name : maps.groups())
      result.curves.maps.push_back(read_map(maps.group(name), name));
  }
  result.curves.summary = read_summary(file.root());
  return result;
}

}  // namespace langer
