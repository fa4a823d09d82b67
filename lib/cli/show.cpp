// `langer show`. Each kind of file has a function that prints its parts; a kind without one is
// shown as a list of its datasets. Values are rounded here; the file and its CSV tables have all
// digits.
#include "cli/show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <vector>

#include "core/base/split.hpp"
#include "core/base/text.hpp"
#include "mechanics/material/material.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"
#include "results/store/mesh_file.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {

// A file size with the unit that keeps it below 1000.
std::string size_words(std::uintmax_t bytes) {
  const auto b = static_cast<double>(bytes);
  if (b < 1e3) return fmt::format("{} bytes", bytes);
  if (b < 1e6) return fmt::format("{:.1f} kB", 1e-3 * b);
  return fmt::format("{:.1f} MB", 1e-6 * b);
}

// Lines with a heading, lists that are wrapped, and tables.
class Page {
 public:
  std::string text;
  void line(const std::string& key, const std::string& says) {
    text += fmt::format("{:<14}{}\n", key, says);
  }
  // A list in lines of at most 90 columns; the key is in front of the first one.
  void list(const std::string& key, const std::vector<std::string>& items) {
    std::string row;
    std::string heading = key;
    for (const std::string& item : items) {
      if (!row.empty() && row.size() + 2 + item.size() > 90) {
        line(heading, row + ",");
        heading.clear();
        row.clear();
      }
      append(row, ", ", item);
    }
    line(heading, text_or(row, "none"));
  }
  // Columns as wide as their widest cell. The first row is the head.
  void table(const std::string& heading, const std::vector<std::vector<std::string>>& rows) {
    if (rows.empty()) return;
    std::vector<std::size_t> width;
    for (const auto& row : rows)
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (i == width.size()) width.push_back(0);
        width[i] = std::max(width[i], row[i].size());
      }
    text += heading + "\n";
    for (const auto& row : rows) {
      std::string s;
      for (std::size_t i = 0; i < row.size(); ++i) s += fmt::format("  {:<{}}", row[i], width[i]);
      s.erase(s.find_last_not_of(' ') + 1);
      text += s + "\n";
    }
  }
};

// Six digits are enough to recognise a value; the file has all of them.
std::string number(double x) { return fmt::format("{:.6g}", x); }

// A number, or words where it is not finite.
std::string number_or(double x, std::string_view alternative) {
  if (!std::isfinite(x)) return std::string(alternative);
  return number(x);
}

std::string with_unit(const std::string& name, const std::string& unit) {
  if (unit.empty() || unit == "-") return name;
  return name + " [" + unit + "]";
}

// A set of one node is an observation point, and shown with its place.
void show_mesh(Page& page, const Mesh& mesh) {
  // Number of elements of each body.
  std::vector<int> cells(std::max<std::size_t>(1, mesh.bodies.size()));
  for (int b : mesh.body) ++cells.at(static_cast<std::size_t>(b));
  std::vector<std::string> bodies;
  for (std::size_t i = 0; i < mesh.bodies.size(); ++i)
    bodies.push_back(fmt::format("{} ({} cells)", mesh.bodies[i], cells[i]));
  page.line("size", fmt::format("{} cells, {} nodes", mesh.n_cells(), mesh.n_nodes()));
  page.list("bodies", bodies);
  if (mesh.section) {
    std::string unit = " mm";
    if (mesh.section->of == SectionOf::axisymmetric) unit = " for each mm of radius";
    page.line("section", fmt::format("{}, {} deep{}",
                                     names(mesh.section->of)[static_cast<int>(mesh.section->of)],
                                     number(mesh.section->depth), unit));
  }
  Vec3 low = Vec3::Constant(INFINITY);
  Vec3 high = -low;
  for (const Vec3& X : mesh.X) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  page.line("box",
            fmt::format("x {} to {}, y {} to {}, z {} to {} mm", number(low[0]), number(high[0]),
                        number(low[1]), number(high[1]), number(low[2]), number(high[2])));
  std::vector<std::string> nodes;
  std::vector<std::string> points;
  std::vector<std::string> facets;
  for (const auto& [name, set] : mesh.node_sets) {
    if (set.size() == 1) {
      const Vec3& X = mesh.X[static_cast<std::size_t>(set[0])];
      points.push_back(
          fmt::format("{} ({}, {}, {})", name, number(X[0]), number(X[1]), number(X[2])));
    } else {
      nodes.push_back(fmt::format("{} {}", name, set.size()));
    }
  }
  for (const auto& [name, set] : mesh.facet_sets)
    facets.push_back(fmt::format("{} {}", name, set.size()));
  page.list("node sets", nodes);
  page.list("points", points);
  page.list("facet sets", facets);
}

void show_model(Page& page, const Material& material) {
  page.text += "material\n";
  for (const std::string& line : split(to_yaml(material), '\n')) page.text += "  " + line + "\n";
}

// The material model, and the parameters and tests of a fitted one.
void show_material(Page& page, const std::string& path) {
  const MaterialFile file = read_material(path);
  show_model(page, file.material);
  if (!file.fit) return;
  std::vector<std::vector<std::string>> rows{
      {"parameter", "value", "standard error", "bounds", "unit"}};
  for (const FittedParameter& p : file.fit->parameters)
    rows.push_back({p.name, number(p.value), number_or(p.standard_error, "not determined"),
                    fmt::format("{} to {}", number(p.lower), number(p.upper)), p.unit});
  page.table("fitted", rows);
  rows = {{"test", "kind", "points", "r2", "mean error %", "largest error %"}};
  for (const FittedTest& t : file.fit->tests)
    rows.push_back({t.name, t.kind, std::to_string(t.first.size()), fmt::format("{:.5f}", t.r2),
                    fmt::format("{:.3g}", t.mean_error_percent),
                    fmt::format("{:.3g}", t.max_error_percent)});
  page.table("tests", rows);
}

// The table of steps of a solution. With several indenters each has a column of its force: the sum
// of their forces may vanish, as in a pinch. Of many steps only the first and last five are shown.
void show_steps(Page& page, const SolutionReader& file) {
  const SolutionHeader& header = file.header();
  const bool contact = !header.contact_nodes.empty();
  std::vector<std::string> forces;  // columns of several indenters
  if (header.contact_nodes.size() > 1)
    for (const auto& [name, nodes] : header.contact_nodes) forces.push_back("force_" + name);
  std::vector<std::vector<std::string>> rows{{"step", "t", "iterations", "residual"}};
  if (contact) rows[0].push_back("u_ind mm");
  if (contact && forces.empty()) rows[0].push_back("force N");
  for (const std::string& force : forces) rows[0].push_back(force + " N");
  rows[0].push_back("largest u mm");
  for (int i = 0; i < file.n_steps(); ++i) {
    if (file.n_steps() > 12 && i == 5) rows.push_back({"..."});
    if (file.n_steps() > 12 && i >= 5 && i < file.n_steps() - 5) continue;
    const StepRecord step = file.step(i);
    double u = 0;
    for (const Vec3& v : step.u) u = std::max(u, v.norm());
    rows.push_back({std::to_string(i + 1), number(step.t), std::to_string(step.iterations),
                    fmt::format("{:.1e}", step.residual)});
    if (contact) rows.back().push_back(number(step.u_ind.norm()));
    if (contact && forces.empty()) rows.back().push_back(number(step.force_ind.norm()));
    for (const std::string& force : forces) {
      const auto found = step.scalars.find(force);
      std::string value;
      if (found != step.scalars.end()) value = number(found->second);
      rows.back().push_back(value);
    }
    rows.back().push_back(number(u));
  }
  page.table(fmt::format("{} steps", file.n_steps()), rows);
}

// Mesh, contacts, materials and steps of a solution.
void show_solution(Page& page, const std::string& path) {
  const SolutionReader file(path);
  const SolutionHeader& header = file.header();
  show_mesh(page, header.mesh);
  page.line("formulation", header.formulation);
  std::vector<std::string> contacts;
  for (const auto& [name, nodes] : header.contact_nodes)
    contacts.push_back(fmt::format("{} ({} candidates)", name, nodes.size()));
  page.list("contacts", contacts);
  if (header.materials.empty())
    show_model(page, header.material);
  else
    for (const Material& m : header.materials) show_model(page, m);
  std::vector<std::string> fields;
  if (file.n_steps() > 0)
    for (const auto& [name, values] : file.step(0).cell_fields) fields.push_back(name);
  page.list("cell fields", fields);
  show_steps(page, file);
}

// A row of the table of columns: name, number of rows, first, last, smallest and largest value.
std::vector<std::string> column_row(const Column& c) {
  std::vector<std::string> row{
      with_unit(c.name, c.unit), std::to_string(c.values.size()), "-", "-", "-", "-"};
  if (c.values.empty()) return row;
  row[2] = number(c.values.front());
  row[3] = number(c.values.back());
  double low = INFINITY;
  double high = -INFINITY;
  for (const double x : c.values) {
    if (!std::isfinite(x)) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  row[4] = number_or(low, "-");
  row[5] = number_or(high, "-");
  return row;
}

// The range of each column; the values themselves are in the CSV file.
void show_curves(Page& page, const std::string& path) {
  const Curves curves = read_curves(path).curves;
  std::vector<std::vector<std::string>> rows{
      {"column", "rows", "first", "last", "least", "largest"}};
  for (const Column& c : curves.columns) rows.push_back(column_row(c));
  page.table("columns", rows);
  std::vector<std::string> maps;
  std::vector<std::string> names;
  for (const SurfaceMap& m : curves.maps)
    maps.push_back(fmt::format("{} of {} at t = {} ({} nodes)", m.name, with_unit(m.label, m.unit),
                               number(m.t), m.values.size()));
  for (const NamedCurve& c : curves.curves) names.push_back(c.name);
  page.list("curves", names);
  page.list("maps", maps);
}

// All datasets of a kind of file that has no reader of its own.
void show_tree(Page& page, const h5::Group& group, const std::string& prefix) {
  for (const std::string& name : group.datasets()) {
    std::string shape;
    for (std::size_t n : group.shape(name)) append(shape, ", ", std::to_string(n));
    page.line("", fmt::format("{}{} ({}) {}", prefix, name, shape, group.unit(name)));
  }
  for (const std::string& name : group.groups())
    if (!(prefix == "/" && (name == "provenance" || name == "summary")))
      show_tree(page, group.group(name), prefix + name + "/");
}

// A column of a sweep's table: its name and its values, which may be words.
std::vector<std::string> sweep_column(const h5::Group& group, const std::string& name) {
  std::vector<std::string> column{with_unit(name, group.unit(name))};
  const std::vector<std::string> words = split(group.annotation(name, "words"), ' ');
  if (words.empty()) {
    for (double x : group.read<double>(name, {h5::any}).values) column.push_back(number_or(x, "-"));
  } else {
    for (std::int64_t i : group.read<std::int64_t>(name, {h5::any}).values)
      column.push_back(words.at(static_cast<std::size_t>(i)));
  }
  return column;
}

// A row for each member. Columns are the axes, then the quantities.
void show_sweep(Page& page, const h5::Group& root) {
  const std::string members = root.read_text("members");
  std::vector<std::vector<std::string>> rows{{}};
  std::vector<std::vector<std::string>> columns;
  for (const char* kind : {"axis", "values"}) {
    if (!root.has(kind)) continue;
    const h5::Group group = root.group(kind);
    for (const std::string& name : group.datasets()) columns.push_back(sweep_column(group, name));
  }
  rows.clear();
  if (!columns.empty()) rows.resize(columns[0].size());
  for (const auto& column : columns)
    for (std::size_t i = 0; i < column.size() && i < rows.size(); ++i) rows[i].push_back(column[i]);
  page.table(fmt::format("{} members",
                         std::count(members.begin(), members.end(), '\n') + !members.empty()),
             rows);
  if (root.has("effects")) page.list("effects of", root.group("effects").groups());
}

// The ranked parameters with their bounds. The effects themselves are in the CSV files.
void show_sensitivity(Page& page, const h5::Group& root) {
  const h5::Group parameters = root.group("parameters");
  std::vector<std::vector<std::string>> rows{{"parameter", "value", "lower", "upper", "unit"}};
  for (const std::string& name : parameters.groups()) {
    const h5::Group p = parameters.group(name);
    rows.push_back({name, number(p.read_scalar("value")), number(p.read_scalar("lower")),
                    number(p.read_scalar("upper")), p.unit("value")});
  }
  page.table("parameters", rows);
  const std::vector<double> strain = root.read<double>("strain", {h5::any}).values;
  if (!strain.empty())
    page.line("strains", fmt::format("{}, {} to {}", strain.size(), number(strain.front()),
                                     number(strain.back())));
  std::vector<std::string> methods{"one at a time"};
  for (const char* method : {"morris", "sobol"})
    if (root.has(method)) methods.push_back(method);
  page.list("methods", methods);
}

// The parts of a file, by its kind.
void show_parts(Page& page, const std::string& schema, const std::string& path,
                const h5::Group& root) {
  if (schema == mesh_schema.name) return show_mesh(page, read_mesh(path).mesh);
  if (schema == material_schema.name) return show_material(page, path);
  if (schema == solution_schema.name) return show_solution(page, path);
  if (schema == curves_schema.name) return show_curves(page, path);
  if (schema == sweep_schema.name) return show_sweep(page, root);
  if (schema == sensitivity_schema.name) return show_sensitivity(page, root);
  page.line("datasets", "");
  show_tree(page, root, "/");
}

}  // namespace

// Every file begins with its origin and ends with its summary; between them are the parts of its
// kind.
std::string show(const std::string& path) {
  const Origin origin = read_origin(path);
  Page page;
  page.text = fmt::format("{}: {}, schema {}, {}\n", path, origin.schema, origin.version,
                          size_words(std::filesystem::file_size(path)));
  const h5::File file = h5::File::open(path);
  const h5::Group root = file.root();
  // Time, host and version are stored apart from the identity, because they are no part of it.
  std::string when;
  if (root.has("provenance"))
    for (const char* name : {"created_utc", "host", "code_version"})
      if (root.group("provenance").has(name))
        append(when, ", ", root.group("provenance").read_text(name));
  page.line("made by", text_or(origin.identity.command, "langer-" + origin.identity.stage));
  if (!when.empty()) page.line("", when);
  page.line("content",
            fmt::format("{} (config {})", origin.content_id, origin.identity.config_hash));
  std::vector<std::string> inputs;
  for (const auto& [port, id] : origin.identity.inputs) inputs.push_back(port + " " + id);
  page.list("inputs", inputs);
  show_parts(page, origin.schema, path, root);
  std::vector<std::vector<std::string>> rows;
  for (const Summary& s : read_summary(root)) rows.push_back({s.name, number(s.value), s.unit});
  page.table("summary", rows);
  return page.text;
}

// The config in a file is the effective one: with it the run can be repeated.
std::string show_config(const std::string& path) {
  const Origin origin = read_origin(path);
  if (origin.identity.config.empty())
    throw Failure(
        Exit::input,
        Error{{path, 0, 0}, "/provenance/config", "missing", "a file as a stage wrote it", ""});
  return origin.identity.config;
}

std::string show_summary(const std::string& path) {
  const Origin origin = read_origin(path);
  std::string s =
      fmt::format("{{\"schema\": \"{}\", \"content_id\": \"{}\"", origin.schema, origin.content_id);
  for (const Summary& r : read_summary(path)) {
    std::string value = "null";
    if (std::isfinite(r.value)) value = number_text(r.value);
    s += fmt::format(", \"{}\": {}", csv_name(r.name, r.unit), value);
  }
  return s + "}\n";
}

}  // namespace langer
